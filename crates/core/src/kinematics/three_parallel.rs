//! Six-axis arms with three parallel axes (2, 3 and 4), such as Universal Robots': inverse in closed form.
//!
//! Angles θ of this page: the shoulder frame has axis 1 as z and axis 2 as y; the links point at (sin θ₂, cos θ₂) and
//! at θ₂ + θ₃ in the plane (x, z); axis 5 points at α = θ₂ + θ₃ + θ₄; axis 6 is y turned about axis 5 by θ₅. The wrist
//! frame's origin is where axes 5 and 6 meet, its y axis is axis 6, and its rotation Rz(θ₁)·Ry(α)·Rz(θ₅)·Ry(θ₆).
//! Joint positions are q = sign · (θ − zero).

use super::branches::{Branches, nearest};
use super::closed_form::{ArmPlane, Bend, ThreeTurns, TwoLink, unturned_z};
use super::differential::inverse_jet;
use super::limits::principal;
use super::{InverseError, JointAxes, JointJet, JointKind, JointLimits, Kinematics, SerialChain};
use crate::geometry::{Pose, PoseJet, is_finite};
use crate::math::float::{atan2, sin_cos};

const KINDS: [JointKind; 6] = [JointKind::Revolute; 6];

/// Dimensions (metres) and zeros, as found in a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ThreeParallelGeometry {
    /// From axis 1 to axis 2, along the shoulder's x axis.
    pub(super) shoulder_offset: f64,
    /// From axis 2 to axis 3, and from axis 3 to axis 4.
    pub(super) links: TwoLink,
    /// Lateral offset of axis 5 from axis 1, along axis 2.
    pub(super) lateral_offset: f64,
    /// From axis 4 to axis 6, along axis 5.
    pub(super) wrist_offset: f64,
    pub(super) shoulder_from_base: Pose,
    pub(super) flange_from_wrist: Pose,
    pub(super) signs: [f64; 6],
    pub(super) zeros: [f64; 6],
}

/// A six-axis arm with axes 2, 3 and 4 parallel. It is found in a chain by [`SerialChain::three_parallel`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThreeParallelArm {
    chain: SerialChain<6>,
    geometry: ThreeParallelGeometry,
}

impl ThreeParallelArm {
    pub(super) fn new(chain: SerialChain<6>, geometry: ThreeParallelGeometry) -> Self {
        Self { chain, geometry }
    }

    /// The arm as a chain.
    #[must_use]
    pub fn chain(&self) -> &SerialChain<6> {
        &self.chain
    }

    /// The arm's limits.
    #[must_use]
    pub fn limits(&self) -> &JointLimits<6> {
        self.chain.limits()
    }

    /// All branches that reach the pose, limits left aside; every joint in (−π, π], free joints (axis 1 under the
    /// wrist, the turn α where axis 6 is parallel to axis 4) from `reference`.
    ///
    /// # Errors
    /// [`InverseError::OutOfReach`], [`InverseError::InsideLateralOffset`], [`InverseError::NotFinite`].
    pub fn inverse(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<Branches<[f64; 6], 8>, InverseError> {
        if !(is_finite(base_from_flange) && reference.iter().sum::<f64>().is_finite()) {
            return Err(InverseError::NotFinite);
        }
        let g = &self.geometry;
        let wrist = g.shoulder_from_base * base_from_flange * g.flange_from_wrist;
        let free: [f64; 6] = core::array::from_fn(|i| g.signs[i] * reference[i] + g.zeros[i]);
        let centre = wrist.translation.vector;
        let mut found = Branches::none(*reference);
        let mut error = None;
        for front in [true, false] {
            let (point, offset) = ([centre.x, centre.y], g.lateral_offset);
            let reach = g.links.reach() + g.wrist_offset.abs();
            let plane = ArmPlane::through(point, offset, front, reach, free[0])?;
            if plane.singular && !front {
                continue;
            }
            let behind_shoulder = unturned_z(wrist.rotation.into_inner(), (plane.sin1, plane.cos1));
            let turns = ThreeTurns::yzy(behind_shoulder, free[1] + free[2] + free[3]);
            let end = [plane.radial - g.shoulder_offset, centre.z];
            error = self.push_elbows(&mut found, plane.theta1, end, turns, free[1]).err().or(error);
            if !turns.at_pole {
                let flipped = turns.flipped();
                error = self.push_elbows(&mut found, plane.theta1, end, flipped, free[1]).err().or(error);
            }
        }
        match error {
            Some(error) if found.as_slice().is_empty() => Err(error),
            _ => Ok(found),
        }
    }

    /// Both bends of the links that carry a wrist with these turns to its place `end` in the arm's plane.
    fn push_elbows(
        &self,
        found: &mut Branches<[f64; 6], 8>,
        theta1: f64,
        [out, up]: [f64; 2],
        turns: ThreeTurns,
        free_theta2: f64,
    ) -> Result<(), InverseError> {
        let g = &self.geometry;
        let ThreeTurns { first: alpha, middle, last, .. } = turns;
        let (sin, cos) = sin_cos(alpha);
        let axis4 = [out - g.wrist_offset * sin, up - g.wrist_offset * cos];
        let bend = g.links.bend(axis4)?;
        let mut push = |sin_bend: f64| {
            let bend = Bend { sin: sin_bend, ..bend };
            let (sin2, cos2) = g.links.upper_direction(axis4, bend, free_theta2);
            let (theta2, theta3) = (atan2(sin2, cos2), atan2(bend.sin, bend.cos));
            let theta = [theta1, theta2, theta3, alpha - theta2 - theta3, middle, last];
            found.push(core::array::from_fn(|i| principal(g.signs[i] * (theta[i] - g.zeros[i]))));
        };
        push(bend.sin);
        if bend.sin > 0.0 {
            push(-bend.sin);
        }
        Ok(())
    }
}

impl Kinematics<6> for ThreeParallelArm {
    fn forward(&self, q: &[f64; 6]) -> Pose {
        self.chain.forward(q)
    }

    fn axes(&self, q: &[f64; 6]) -> JointAxes<6> {
        self.chain.axes(q)
    }

    fn inverse_nearest(&self, base_from_flange: &Pose, seed: &[f64; 6]) -> Result<[f64; 6], InverseError> {
        let within = self.inverse_branches(base_from_flange, seed)?;
        // There is at least one: none within the limits is an error above.
        Ok(nearest(within.as_slice().iter().copied(), seed).unwrap_or(*seed))
    }

    fn inverse_branches(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<Branches<[f64; 6], 8>, InverseError> {
        let all = self.inverse(base_from_flange, reference)?;
        self.limits().branches_within(all.as_slice(), reference, &KINDS)
    }

    fn joint_jet(&self, base_from_flange: &PoseJet, q: &[f64; 6]) -> Result<JointJet<6>, InverseError> {
        inverse_jet(&self.axes(q), base_from_flange, q)
    }

    fn position_limits(&self) -> &[(f64, f64); 6] {
        self.chain.position_limits()
    }

    fn velocity_limits(&self) -> &[f64; 6] {
        self.chain.velocity_limits()
    }
}
