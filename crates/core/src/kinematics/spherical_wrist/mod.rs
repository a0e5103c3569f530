//! Six-axis arms with parallel shoulder and elbow axes and three wrist axes that meet in one point.
//!
//! Dimensions and angles θ are those of Brandstötter, Angerer, Hofbaur, *An Analytical Solution of the Inverse
//! Kinematics Problem of Industrial Serial Manipulators with an Ortho-parallel Basis and a Spherical Wrist*, 2014
//! (fig. 2): axis 1 is z, axes 2 and 3 are y, the wrist is z, y, z, and at θ = 0 the arm stands straight up. The
//! maker's joint positions are q = sign · (θ − zero). The shoulder frame has its z axis on axis 1 and its origin at
//! the height of axis 2; the wrist frame its origin where axes 4, 5 and 6 meet and its z axis on axis 6.

mod inverse;
mod jet;
mod posture;
mod singularity;
mod solutions;

pub use posture::{Configuration, Elbow, Posture, Shoulder, Wrist};
pub use singularity::SingularityDistances;
pub use solutions::{Solution, Solutions};

use nalgebra::{Quaternion, UnitQuaternion};

use super::closed_form::TwoLink;
use super::{
    Branches, InverseError, JointAxes, JointAxis, JointJet, JointKind, JointLimits, Kinematics, ModelError,
};
use crate::geometry::{Pose, PoseJet, Vector3, is_finite};
use crate::math::float::{atan2, hypot, sin_cos};

/// The arm's dimensions (metres) and where its zero lies. Plain data; [`SphericalWristArm::try_new`] checks it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphericalWristGeometry {
    /// From axis 1 to axis 2, along the shoulder's x axis (a₁).
    pub shoulder_offset: f64,
    /// From axis 2 to axis 3, along the upper arm (c₂). Positive.
    pub upper_arm: f64,
    /// From axis 3 to axis 4, along the arm's x axis at θ = 0 (a₂): negative where the forearm lies above the elbow.
    pub elbow_offset: f64,
    /// From axis 3 to the wrist centre, along axis 4 (c₃).
    pub forearm: f64,
    /// Lateral offset of the arm's plane from axis 1, along the shoulder's y axis (b).
    pub lateral_offset: f64,
    /// Where the shoulder frame stands.
    pub base_from_shoulder: Pose,
    /// Where the flange sits on the last link.
    pub wrist_from_flange: Pose,
    /// +1 where the maker turns a joint as θ does, −1 where he turns it the other way.
    pub signs: [f64; 6],
    /// θ at q = 0, in radians.
    pub zeros: [f64; 6],
}

/// The seven dimensions of an ortho-parallel arm with spherical wrist (metres), with offsets (radians) and signs as
/// published in the tables of the ROS-Industrial community: θ = sign · q − offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpwParameters {
    /// From axis 1 to axis 2.
    pub a1: f64,
    /// From axis 3 to axis 4.
    pub a2: f64,
    /// Lateral offset.
    pub b: f64,
    /// Height of axis 2.
    pub c1: f64,
    /// Upper arm.
    pub c2: f64,
    /// Forearm.
    pub c3: f64,
    /// From the wrist centre to the flange.
    pub c4: f64,
    /// Joint offsets.
    pub offsets: [f64; 6],
    /// Joint directions, each +1 or −1.
    pub signs: [f64; 6],
}

impl OpwParameters {
    /// The same arm in this library's terms: the base frame's z axis is axis 1, the flange's z axis is axis 6.
    #[must_use]
    pub fn geometry(&self) -> SphericalWristGeometry {
        SphericalWristGeometry {
            shoulder_offset: self.a1,
            upper_arm: self.c2,
            elbow_offset: self.a2,
            forearm: self.c3,
            lateral_offset: self.b,
            base_from_shoulder: Pose::translation(0.0, 0.0, self.c1),
            wrist_from_flange: Pose::translation(0.0, 0.0, self.c4),
            signs: self.signs,
            zeros: self.offsets.map(|offset| -offset),
        }
    }
}

/// A six-axis arm with spherical wrist: forward, inverse with all branches, and joint derivatives in closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphericalWristArm {
    geometry: SphericalWristGeometry,
    limits: JointLimits<6>,
    /// Upper arm, and the line from axis 3 to the wrist centre.
    links: TwoLink,
    /// Angle of the wrist centre about axis 3 at θ₃ = 0, with its sine and cosine.
    elbow_angle: f64,
    elbow_sin: f64,
    elbow_cos: f64,
    shoulder_from_base: Pose,
    flange_from_wrist: Pose,
}

impl SphericalWristArm {
    /// An arm from its dimensions and limits.
    ///
    /// # Errors
    /// [`ModelError`] for a number that is not finite, a link without length, a sign that is neither +1 nor −1.
    pub fn try_new(geometry: SphericalWristGeometry, limits: JointLimits<6>) -> Result<Self, ModelError> {
        let g = &geometry;
        let lengths = [g.shoulder_offset, g.upper_arm, g.elbow_offset, g.forearm, g.lateral_offset];
        let finite = lengths.iter().chain(&g.zeros).all(|x| x.is_finite());
        if !(finite && is_finite(&g.base_from_shoulder) && is_finite(&g.wrist_from_flange)) {
            return Err(ModelError::NotFinite);
        }
        for value in [g.upper_arm, hypot(g.elbow_offset, g.forearm)] {
            if value <= 0.0 {
                return Err(ModelError::Length { value });
            }
        }
        for (axis, &value) in g.signs.iter().enumerate() {
            if value != 1.0 && value != -1.0 {
                return Err(ModelError::Sign { axis, value });
            }
        }
        Ok(Self::of_valid(geometry, limits))
    }

    /// An arm from dimensions that are known to be valid.
    pub(super) fn of_valid(geometry: SphericalWristGeometry, limits: JointLimits<6>) -> Self {
        let g = &geometry;
        let elbow_to_wrist = hypot(g.elbow_offset, g.forearm);
        Self {
            links: TwoLink { upper: g.upper_arm, fore: elbow_to_wrist },
            elbow_angle: atan2(g.elbow_offset, g.forearm),
            elbow_sin: g.elbow_offset / elbow_to_wrist,
            elbow_cos: g.forearm / elbow_to_wrist,
            shoulder_from_base: g.base_from_shoulder.inverse(),
            flange_from_wrist: g.wrist_from_flange.inverse(),
            geometry,
            limits,
        }
    }

    /// The arm's dimensions.
    #[must_use]
    pub fn geometry(&self) -> &SphericalWristGeometry {
        &self.geometry
    }

    /// Distance from axis 3 to the wrist centre, in metres.
    #[must_use]
    pub fn elbow_to_wrist(&self) -> f64 {
        self.links.fore
    }

    /// The arm's limits.
    #[must_use]
    pub fn limits(&self) -> &JointLimits<6> {
        &self.limits
    }

    /// The paper's angles θ of joint positions q.
    #[inline]
    fn thetas(&self, q: &[f64; 6]) -> [f64; 6] {
        let g = &self.geometry;
        core::array::from_fn(|i| g.signs[i] * q[i] + g.zeros[i])
    }

    /// Sines and cosines at joint positions q: of half angles where the quaternion needs them.
    #[inline]
    fn trigonometry(&self, q: &[f64; 6]) -> Trigonometry {
        let [t1, t2, t3, t4, t5, t6] = self.thetas(q);
        Trigonometry {
            half1: sin_cos(0.5 * t1),
            half23: sin_cos(0.5 * (t2 + t3)),
            theta2: sin_cos(t2),
            half5: sin_cos(0.5 * t5),
            half_sum46: sin_cos(0.5 * (t4 + t6)),
            half_difference46: sin_cos(0.5 * (t4 - t6)),
        }
    }

    /// The wrist centre's coordinates from axis 1, in the arm's plane: (out, up).
    #[inline]
    fn wrist_in_plane(&self, t: &Trigonometry) -> (f64, f64) {
        let g = &self.geometry;
        let ((sin2, cos2), (sin23, cos23)) = (t.theta2, doubled(t.half23));
        let out = g.shoulder_offset + g.upper_arm * sin2 + g.elbow_offset * cos23 + g.forearm * sin23;
        let up = g.upper_arm * cos2 - g.elbow_offset * sin23 + g.forearm * cos23;
        (out, up)
    }

    /// The wrist's pose in the shoulder frame.
    ///
    /// R = Rz(θ₁)·Ry(θ₂+θ₃) · Rz(θ₄)·Ry(θ₅)·Rz(θ₆) as quaternions: of half angles, so that no normalization and no
    /// conversion from a matrix is needed.
    #[inline]
    fn shoulder_from_wrist(&self, t: &Trigonometry) -> Pose {
        let ((s1, c1), (s23, c23), (s5, c5)) = (t.half1, t.half23, t.half5);
        let ((s_sum, c_sum), (s_difference, c_difference)) = (t.half_sum46, t.half_difference46);
        let arm = Quaternion::new(c1 * c23, -s1 * s23, c1 * s23, s1 * c23);
        let wrist = Quaternion::new(c5 * c_sum, -s5 * s_difference, s5 * c_difference, c5 * s_sum);
        let (out, up) = self.wrist_in_plane(t);
        let position = turned_z(doubled(t.half1), [out, self.geometry.lateral_offset, up]);
        Pose::from_parts(position.into(), UnitQuaternion::new_unchecked(arm * wrist))
    }
}

/// (sin, cos) pairs.
struct Trigonometry {
    half1: (f64, f64),
    half23: (f64, f64),
    theta2: (f64, f64),
    half5: (f64, f64),
    half_sum46: (f64, f64),
    half_difference46: (f64, f64),
}

/// (sin, cos) of the double angle.
#[inline]
fn doubled((sin, cos): (f64, f64)) -> (f64, f64) {
    (2.0 * sin * cos, cos * cos - sin * sin)
}

/// Rz·v, for an angle's (sin, cos).
#[inline]
fn turned_z((sin, cos): (f64, f64), [x, y, z]: [f64; 3]) -> Vector3 {
    Vector3::new(cos * x - sin * y, sin * x + cos * y, z)
}

impl Kinematics<6> for SphericalWristArm {
    #[inline]
    fn forward(&self, q: &[f64; 6]) -> Pose {
        let g = &self.geometry;
        g.base_from_shoulder * self.shoulder_from_wrist(&self.trigonometry(q)) * g.wrist_from_flange
    }

    #[inline]
    fn axes(&self, q: &[f64; 6]) -> JointAxes<6> {
        let g = &self.geometry;
        let t = self.trigonometry(q);
        let base_from_wrist = g.base_from_shoulder * self.shoulder_from_wrist(&t);
        let (theta1, (sin2, cos2), (sin23, cos23)) = (doubled(t.half1), t.theta2, doubled(t.half23));
        let (sin5, cos5) = doubled(t.half5);
        // θ₄ is the sum of half the sum and half the difference of θ₄ and θ₆.
        let ((s_sum, c_sum), (s_difference, c_difference)) = (t.half_sum46, t.half_difference46);
        let sin4 = s_sum * c_difference + c_sum * s_difference;
        let cos4 = c_sum * c_difference - s_sum * s_difference;
        let turned = |v| g.base_from_shoulder.rotation * turned_z(theta1, v);
        let origin = g.base_from_shoulder.translation.vector;
        let elbow_out = g.shoulder_offset + g.upper_arm * sin2;
        let across = turned([0.0, 1.0, 0.0]);
        let last = [cos23 * cos4 * sin5 + sin23 * cos5, sin4 * sin5, cos23 * cos5 - sin23 * cos4 * sin5];
        let shoulder = origin + turned([g.shoulder_offset, 0.0, 0.0]);
        let elbow = origin + turned([elbow_out, 0.0, g.upper_arm * cos2]);
        let centre = base_from_wrist.translation.vector;
        let lines = [
            (turned([0.0, 0.0, 1.0]), origin),
            (across, shoulder),
            (across, elbow),
            (turned([sin23, 0.0, cos23]), centre),
            (turned([-sin4 * cos23, cos4, sin4 * sin23]), centre),
            (turned(last), centre),
        ];
        let axis = |i: usize| JointAxis {
            direction: lines[i].0 * g.signs[i],
            point: lines[i].1,
            kind: JointKind::Revolute,
        };
        JointAxes {
            axes: core::array::from_fn(axis),
            base_from_flange: base_from_wrist * g.wrist_from_flange,
        }
    }

    fn inverse_nearest(&self, base_from_flange: &Pose, seed: &[f64; 6]) -> Result<[f64; 6], InverseError> {
        self.nearest(base_from_flange, seed)
    }

    fn inverse_branches(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<Branches<[f64; 6], 8>, InverseError> {
        Ok(self.inverse_within_limits(base_from_flange, reference)?.map(|solution| solution.q))
    }

    fn joint_jet(&self, base_from_flange: &PoseJet, q: &[f64; 6]) -> Result<JointJet<6>, InverseError> {
        self.jet(base_from_flange, q)
    }

    fn position_limits(&self) -> &[(f64, f64); 6] {
        self.limits.position()
    }

    fn velocity_limits(&self) -> &[f64; 6] {
        self.limits.velocity()
    }
}
