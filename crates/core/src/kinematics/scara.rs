//! Four-axis SCARA arms: two links in a level plane, a stroke along their axes, and a turn.
//!
//! q₁ and q₂ turn about the shoulder frame's z axis, q₃ slides along it and q₄ turns about it again.

use super::branches::{Branches, nearest};
use super::closed_form::{Bend, STILL, TwoLink};
use super::limits::principal;
use super::{InverseError, JointAxes, JointAxis, JointJet, JointKind, JointLimits, Kinematics, ModelError};
use crate::geometry::{Pose, PoseJet, Rotation, Vector3, is_finite};
use crate::math::float::{atan2, hypot, sin, sin_cos};
use crate::math::taylor::Taylor;

/// A flange tilted by no more than this (radians) stands upright; so does one in a motion that tilts it by no more than
/// this part of its turn, or of its way over the arm's reach.
const UPRIGHT: f64 = 1e-9;

const KINDS: [JointKind; 4] =
    [JointKind::Revolute, JointKind::Revolute, JointKind::Prismatic, JointKind::Revolute];

/// The arm's dimensions (metres). Plain data; [`ScaraArm::try_new`] checks it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaraGeometry {
    /// From axis 1 to axis 2.
    pub upper_arm: f64,
    /// From axis 2 to axis 4.
    pub forearm: f64,
    /// Where the shoulder frame stands: its z axis on axis 1, its x axis along the links at zero.
    pub base_from_shoulder: Pose,
    /// Where the flange sits on the last link, whose frame at zero is the shoulder's, moved to axis 4.
    pub last_from_flange: Pose,
}

/// To which side the arm is bent, seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Handedness {
    /// The elbow lies to the right of the line from axis 1 to axis 4 (q₂ ≥ 0): like a right arm.
    Right,
    /// The elbow lies to the left of it.
    Left,
}

/// One branch of the inverse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaraSolution {
    /// Joint positions: radians, radians, metres, radians.
    pub q: [f64; 4],
    /// Which branch.
    pub handedness: Handedness,
}

/// Right before left; one where the arm is stretched or folded.
pub type ScaraSolutions = Branches<ScaraSolution, 2>;

/// A four-axis SCARA arm in closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaraArm {
    geometry: ScaraGeometry,
    limits: JointLimits<4>,
    shoulder_from_base: Pose,
    flange_from_last: Pose,
}

impl ScaraArm {
    /// An arm from its dimensions and limits.
    ///
    /// # Errors
    /// [`ModelError`] for a number that is not finite or a link without length.
    pub fn try_new(geometry: ScaraGeometry, limits: JointLimits<4>) -> Result<Self, ModelError> {
        let ScaraGeometry { upper_arm, forearm, base_from_shoulder, last_from_flange } = &geometry;
        let finite = (upper_arm + forearm).is_finite();
        if !(finite && is_finite(base_from_shoulder) && is_finite(last_from_flange)) {
            return Err(ModelError::NotFinite);
        }
        for &value in [upper_arm, forearm] {
            if value <= 0.0 {
                return Err(ModelError::Length { value });
            }
        }
        Ok(Self::of_valid(geometry, limits))
    }

    /// An arm from dimensions that are known to be valid.
    pub(super) fn of_valid(geometry: ScaraGeometry, limits: JointLimits<4>) -> Self {
        let shoulder_from_base = geometry.base_from_shoulder.inverse();
        let flange_from_last = geometry.last_from_flange.inverse();
        Self { geometry, limits, shoulder_from_base, flange_from_last }
    }

    /// The arm's dimensions.
    #[must_use]
    pub fn geometry(&self) -> &ScaraGeometry {
        &self.geometry
    }

    /// The arm's limits.
    #[must_use]
    pub fn limits(&self) -> &JointLimits<4> {
        &self.limits
    }

    /// Both branches, limits left aside; turning joints in (−π, π], a free joint 1 from `reference`.
    ///
    /// # Errors
    /// [`InverseError::OutOfReach`], [`InverseError::OutOfOrientation`] for a flange that is not upright,
    /// [`InverseError::NotFinite`].
    pub fn inverse(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 4],
    ) -> Result<ScaraSolutions, InverseError> {
        if !(is_finite(base_from_flange) && reference.iter().sum::<f64>().is_finite()) {
            return Err(InverseError::NotFinite);
        }
        let shoulder_from_last = self.shoulder_from_base * base_from_flange * self.flange_from_last;
        let h = shoulder_from_last.rotation.into_inner();
        let angle = 2.0 * atan2(hypot(h.i, h.j), hypot(h.w, h.k));
        if angle > UPRIGHT {
            return Err(InverseError::OutOfOrientation { angle });
        }
        let turn = 2.0 * atan2(h.k, h.w);
        let position = shoulder_from_last.translation.vector;
        // The two links' directions are counted from `up` towards `out`: from x towards y.
        let point = [position.y, position.x];
        let bend = self.links().bend(point)?;
        let branch = |sin_bend: f64, handedness| {
            let bend = Bend { sin: sin_bend, ..bend };
            let (sin1, cos1) = self.links().upper_direction(point, bend, reference[0]);
            let (q1, q2) = (atan2(sin1, cos1), atan2(bend.sin, bend.cos));
            ScaraSolution { q: [q1, q2, position.z, principal(turn - q1 - q2)], handedness }
        };
        let right = branch(bend.sin, Handedness::Right);
        let mut found = ScaraSolutions::none(right);
        found.push(right);
        if bend.sin > 0.0 {
            found.push(branch(-bend.sin, Handedness::Left));
        }
        Ok(found)
    }

    /// The joint positions within the limits that are bent to a side, each joint in the turn nearest to `reference`. A stretched
    /// or folded arm is bent to both.
    ///
    /// # Errors
    /// As [`ScaraArm::inverse`], and [`InverseError::PositionLimit`] of this side.
    pub fn inverse_bent(
        &self,
        base_from_flange: &Pose,
        side: Handedness,
        reference: &[f64; 4],
    ) -> Result<[f64; 4], InverseError> {
        let all = self.inverse(base_from_flange, reference)?;
        let [.., last] = all.as_slice() else { return Err(InverseError::NotFinite) };
        let bent = all.as_slice().iter().find(|solution| solution.handedness == side).unwrap_or(last);
        let within: Branches<[f64; 4], 1> = self.limits.branches_within(&[bent.q], reference, &KINDS)?;
        Ok(within.as_slice().first().copied().unwrap_or(bent.q))
    }

    /// To which side the arm is bent at joint positions `q`; right where it is stretched or folded.
    #[must_use]
    pub fn handedness(&self, q: &[f64; 4]) -> Handedness {
        if sin(q[1]) >= 0.0 { Handedness::Right } else { Handedness::Left }
    }

    /// The flange's orientation in the base frame that the arm can take and that lies nearest to this one.
    #[must_use]
    pub fn upright(&self, base_from_flange: &Rotation) -> Rotation {
        let (base_from_shoulder, last_from_flange) =
            (&self.geometry.base_from_shoulder.rotation, &self.geometry.last_from_flange.rotation);
        let h = (base_from_shoulder.inverse() * base_from_flange * last_from_flange.inverse()).into_inner();
        let (sin_half, cos_half) = sin_cos(atan2(h.k, h.w));
        let turn = Rotation::new_unchecked(nalgebra::Quaternion::new(cos_half, 0.0, 0.0, sin_half));
        base_from_shoulder * turn * last_from_flange
    }

    /// Distance from the elbow's singularity at joint positions `q`: |sin q₂|, zero stretched and folded.
    #[must_use]
    pub fn elbow_distance(&self, q: &[f64; 4]) -> f64 {
        sin(q[1]).abs()
    }

    #[inline]
    fn links(&self) -> TwoLink {
        TwoLink { upper: self.geometry.upper_arm, fore: self.geometry.forearm }
    }
}

impl Kinematics<4> for ScaraArm {
    fn forward(&self, q: &[f64; 4]) -> Pose {
        self.axes(q).base_from_flange
    }

    fn axes(&self, q: &[f64; 4]) -> JointAxes<4> {
        let ScaraGeometry { upper_arm, forearm, base_from_shoulder, last_from_flange } = &self.geometry;
        let ((sin1, cos1), (sin12, cos12)) = (sin_cos(q[0]), sin_cos(q[0] + q[1]));
        let elbow = Vector3::new(upper_arm * cos1, upper_arm * sin1, 0.0);
        let last = elbow + Vector3::new(forearm * cos12, forearm * sin12, q[2]);
        let (sin_half, cos_half) = sin_cos(0.5 * (q[0] + q[1] + q[3]));
        let turn = nalgebra::Quaternion::new(cos_half, 0.0, 0.0, sin_half);
        let shoulder_from_last = Pose::from_parts(last.into(), nalgebra::UnitQuaternion::new_unchecked(turn));
        let direction = base_from_shoulder.rotation * Vector3::z();
        let axis = |point: Vector3, kind| JointAxis {
            direction,
            point: (base_from_shoulder * nalgebra::Point3::from(point)).coords,
            kind,
        };
        let points = [Vector3::zeros(), elbow, last, last];
        JointAxes {
            axes: core::array::from_fn(|i| axis(points[i], KINDS[i])),
            base_from_flange: base_from_shoulder * shoulder_from_last * last_from_flange,
        }
    }

    fn inverse_nearest(&self, base_from_flange: &Pose, seed: &[f64; 4]) -> Result<[f64; 4], InverseError> {
        let within = self.inverse_branches(base_from_flange, seed)?;
        // There is at least one: none within the limits is an error above.
        Ok(nearest(within.as_slice().iter().copied(), seed).unwrap_or(*seed))
    }

    fn inverse_branches(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 4],
    ) -> Result<Branches<[f64; 4], 8>, InverseError> {
        let all = self.inverse(base_from_flange, reference)?;
        self.limits.branches_within(all.map(|solution| solution.q).as_slice(), reference, &KINDS)
    }

    fn joint_jet(&self, base_from_flange: &PoseJet, q: &[f64; 4]) -> Result<JointJet<4>, InverseError> {
        if !(base_from_flange.is_finite() && q.iter().sum::<f64>().is_finite()) {
            return Err(InverseError::NotFinite);
        }
        let jet = base_from_flange.seen_from(&self.shoulder_from_base).attached(&self.flange_from_last);
        let tilting = jet.angular.iter().fold(0.0, |most: f64, w| most.max(hypot(w.x, w.y)));
        let turning = jet.angular.iter().fold(0.0, |most: f64, w| most.max(w.norm()));
        // A motion that does not turn has rounding for a turn: what the arm's length makes of it is small beside the rest.
        let travelling = jet.linear.iter().fold(0.0, |most: f64, v| most.max(v.norm()));
        if tilting > UPRIGHT * turning.max(travelling / self.links().reach()) {
            return Err(InverseError::NotFollowed { missing: tilting });
        }
        let position = jet.pose.translation.vector;
        let [d1, d2, d3] = jet.linear;
        let [x, y, z] = [0, 1, 2].map(|i| Taylor::from_derivatives(position[i], d1[i], d2[i], d3[i]));
        let still = STILL * x.variation().max(y.variation()) / self.links().reach();
        let [q1, q2] = self.links().series([y, x], [q[0], q[1]], still)?;
        let [w, dw, ddw] = jet.angular;
        let turn = Taylor::from_derivatives(q[0] + q[1] + q[3], w.z, dw.z, ddw.z);
        Ok(JointJet::of_series(*q, [q1, q2, z, turn - q1 - q2]))
    }

    fn position_limits(&self) -> &[(f64, f64); 4] {
        self.limits.position()
    }

    fn velocity_limits(&self) -> &[f64; 4] {
        self.limits.velocity()
    }
}
