//! All branches, those within the limits, the one in a given configuration and the one nearest to a seed.

use core::f64::consts::PI;

use super::inverse::{Links, Side, Target, named};
use super::{Configuration, Elbow, Posture, Shoulder, SphericalWristArm, Wrist};
use crate::geometry::Pose;
use crate::kinematics::branches::{Branches, nearest};
use crate::kinematics::limits::{least_excess_turn, nearest_turn, nearest_turn_within};
use crate::kinematics::{InverseError, JointKind};
use crate::math::float::cos;

/// One branch of the inverse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution {
    /// Joint positions in radians.
    pub q: [f64; 6],
    /// Which branch.
    pub posture: Posture,
    /// The wrist stands at its pole: joint 4 is free and was kept from the reference; flip and no-flip are one.
    pub at_wrist_pole: bool,
}

/// Up to eight branches, each once: front before rear, upper before lower.
pub type Solutions = Branches<Solution, 8>;

const NOTHING: Solution = Solution {
    q: [0.0; 6],
    posture: Posture { shoulder: Shoulder::Front, elbow: Elbow::Upper, wrist: Wrist::Flip },
    at_wrist_pole: false,
};

const KINDS: [JointKind; 6] = [JointKind::Revolute; 6];

impl SphericalWristArm {
    /// All branches that reach the pose, limits left aside; every joint in (−π, π], free joints from `reference`.
    ///
    /// Branches that coincide (at a singularity) come once.
    ///
    /// # Errors
    /// [`InverseError::OutOfReach`], [`InverseError::InsideLateralOffset`], [`InverseError::NotFinite`].
    pub fn inverse(&self, base_from_flange: &Pose, reference: &[f64; 6]) -> Result<Solutions, InverseError> {
        let target = self.target(base_from_flange, reference)?;
        let mut found = Solutions::none(NOTHING);
        let front = self.side(&target, Shoulder::Front)?;
        let first_error = self.push_elbows(&mut found, &target, &front).err();
        if !front.plane.singular {
            let rear = self.side(&target, Shoulder::Rear)?;
            // The rear's reach is the harder one: where both fail, the front's evidence is the nearer.
            let _ = self.push_elbows(&mut found, &target, &rear);
        }
        match first_error {
            Some(error) if found.as_slice().is_empty() => Err(error),
            _ => Ok(found),
        }
    }

    #[inline]
    fn push_elbows(&self, found: &mut Solutions, target: &Target, side: &Side) -> Result<(), InverseError> {
        let bend = self.bend(side)?;
        // Seen from the rear, the upper arm is the one bent back.
        let first = side.front;
        self.push_wrists(found, target, side, first, &self.links(target, side, bend, first));
        if bend.sin > 0.0 {
            self.push_wrists(found, target, side, !first, &self.links(target, side, bend, !first));
        }
        Ok(())
    }

    #[inline]
    fn push_wrists(&self, found: &mut Solutions, target: &Target, side: &Side, forward: bool, links: &Links) {
        let angles = self.wrist(target, side, links);
        let at_wrist_pole = angles.at_pole;
        let mut push = |wrist| {
            let q = self.joints(side, links, angles, wrist);
            found.push(Solution { q, posture: named(side, forward, wrist), at_wrist_pole });
        };
        push(Wrist::Flip);
        if !at_wrist_pole {
            push(Wrist::NoFlip);
        }
    }

    /// All branches within the joint limits, each joint in the turn nearest to `reference`.
    ///
    /// # Errors
    /// As [`SphericalWristArm::inverse`], and [`InverseError::PositionLimit`] where no branch is within the limits.
    pub fn inverse_within_limits(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<Solutions, InverseError> {
        let all = self.inverse(base_from_flange, &self.clamped(reference))?;
        let mut kept = Solutions::none(NOTHING);
        for solution in all.as_slice() {
            if let Some(q) = self.turned_within(solution, reference) {
                kept.push(Solution { q, ..*solution });
            }
        }
        if kept.as_slice().is_empty() { Err(self.limit_evidence(&all, reference)) } else { Ok(kept) }
    }

    /// The joint positions within the limits nearest to `seed`.
    pub(super) fn nearest(&self, base_from_flange: &Pose, seed: &[f64; 6]) -> Result<[f64; 6], InverseError> {
        let all = self.inverse(base_from_flange, &self.clamped(seed))?;
        let within = all.as_slice().iter().filter_map(|solution| self.turned_within(solution, seed));
        nearest(within, seed).ok_or_else(|| self.limit_evidence(&all, seed))
    }

    /// The joint positions in a given configuration; joints 2, 3 and 5 in the turn nearest to `reference`.
    ///
    /// # Errors
    /// As [`SphericalWristArm::inverse`] for this one branch, and [`InverseError::PositionLimit`] where the
    /// configuration lies outside the limits.
    pub fn inverse_in_configuration(
        &self,
        base_from_flange: &Pose,
        configuration: &Configuration,
        reference: &[f64; 6],
    ) -> Result<[f64; 6], InverseError> {
        let Posture { shoulder, elbow, wrist } = configuration.posture;
        let target = self.target(base_from_flange, &self.clamped(reference))?;
        let side = self.side(&target, shoulder)?;
        let bend = self.bend(&side)?;
        let links = self.links(&target, &side, bend, side.front == (elbow == Elbow::Upper));
        let mut q = self.joints(&side, &links, self.wrist(&target, &side, &links), wrist);
        let Configuration { far_turn_1, far_turn_4, far_turn_6, .. } = *configuration;
        let far_turn = [Some(far_turn_1), None, None, Some(far_turn_4), None, Some(far_turn_6)];
        for (axis, far_turn) in far_turn.into_iter().enumerate() {
            let (min, max) = self.limits.position()[axis];
            let turned = match far_turn {
                None => nearest_turn_within(q[axis], reference[axis], (min, max)),
                Some(false) => nearest_turn_within(q[axis], 0.0, (min.max(-PI), max.min(PI))),
                Some(true) => {
                    let above = nearest_turn_within(q[axis], PI, (min.max(PI), max));
                    let below = nearest_turn_within(q[axis], -PI, (min, max.min(-PI)));
                    nearer(above, below, reference[axis])
                }
            };
            q[axis] = turned.ok_or(InverseError::PositionLimit { axis, value: q[axis], min, max })?;
        }
        Ok(q)
    }

    /// Each joint in the turn within the limits that is nearest to the reference.
    #[inline]
    fn turned_within(&self, solution: &Solution, reference: &[f64; 6]) -> Option<[f64; 6]> {
        let mut q = solution.q;
        if solution.at_wrist_pole {
            self.share_at_pole(&mut q);
        }
        self.limits.turned_within(&q, reference, &KINDS)
    }

    /// At the wrist's pole, lets joint 4 take over what joint 6 cannot turn.
    fn share_at_pole(&self, q: &mut [f64; 6]) {
        let g = &self.geometry;
        let (min, max) = self.limits.position()[5];
        let (turn, excess) = least_excess_turn(q[5], (min, max));
        if excess == 0.0 {
            return;
        }
        let kept = turn.max(min).min(max);
        let moved = g.signs[5] * (kept - turn);
        // θ₄ + θ₆ counts where θ₅ = 0, θ₄ − θ₆ where θ₅ = π.
        let theta5 = g.signs[4] * q[4] + g.zeros[4];
        let taken = if cos(theta5) > 0.0 { -moved } else { moved };
        q[3] += g.signs[3] * taken;
        q[5] = kept;
    }

    /// The reference within the limits, so that a free joint kept from it is.
    #[inline]
    fn clamped(&self, reference: &[f64; 6]) -> [f64; 6] {
        let limits = self.limits.position();
        core::array::from_fn(|i| match (reference[i], limits[i]) {
            (value, (min, _)) if value < min => min,
            (value, (_, max)) if value > max => max,
            // NaN passes on, to be named.
            (value, _) => value,
        })
    }

    /// Which joint keeps the branch nearest to the reference outside the limits.
    #[cold]
    fn limit_evidence(&self, all: &Solutions, reference: &[f64; 6]) -> InverseError {
        let turned = |s: &Solution| core::array::from_fn(|i| nearest_turn(s.q[i], reference[i]));
        // There is at least one branch: none at all is another error.
        let q = nearest(all.as_slice().iter().map(turned), reference).unwrap_or(*reference);
        self.limits.worst_violation(&q, &KINDS)
    }
}

/// Whichever there is, or the one nearer to the reference.
fn nearer(a: Option<f64>, b: Option<f64>, reference: f64) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if (a - reference).abs() <= (b - reference).abs() { a } else { b }),
        (a, b) => a.or(b),
    }
}
