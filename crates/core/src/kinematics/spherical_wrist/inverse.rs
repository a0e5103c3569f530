//! The closed-form inverse, one branch at a time.
//!
//! Wrist centre → arm plane (front or rear) → two-link arm in that plane (upper or lower) → wrist angles (flip or
//! not). No angle is taken by arc cosine: sines and cosines come from lengths, each by a form that does not cancel,
//! so that the pose is met to rounding also beside the singularities. Where a joint is free (wrist at its pole,
//! wrist centre on axis 1) it is kept from the reference.

use nalgebra::Quaternion;

use super::{Posture, Shoulder, SphericalWristArm, Wrist};
use crate::geometry::{Pose, Vector3, is_finite};
use crate::kinematics::InverseError;
use crate::kinematics::closed_form::{ArmPlane, Bend, ThreeTurns, unturned_y, unturned_z};
use crate::kinematics::limits::principal;
use crate::math::float::atan2;

/// What every branch starts from.
pub(super) struct Target {
    /// Wrist centre in the shoulder frame.
    centre: Vector3,
    /// Rotation of the wrist frame in the shoulder frame.
    rotation: Quaternion<f64>,
    /// Values for free joints.
    free_theta1: f64,
    free_theta2: f64,
    free_theta4: f64,
}

/// The arm's plane turned towards the wrist centre, which has these coordinates (out, up) in it, seen from axis 2.
#[derive(Clone, Copy)]
pub(super) struct Side {
    pub(super) front: bool,
    pub(super) plane: ArmPlane,
    point: [f64; 2],
}

/// The two links laid to the wrist centre.
#[derive(Clone, Copy)]
pub(super) struct Links {
    theta2: f64,
    theta3: f64,
    cos23: f64,
    sin23: f64,
}

impl SphericalWristArm {
    /// The wrist's pose in the shoulder frame, and the reference's values for free joints.
    #[inline]
    pub(super) fn target(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<Target, InverseError> {
        let reference_sum: f64 = reference.iter().sum();
        if !(is_finite(base_from_flange) && reference_sum.is_finite()) {
            return Err(InverseError::NotFinite);
        }
        let shoulder_from_wrist = self.shoulder_from_base * base_from_flange * self.flange_from_wrist;
        let theta = self.thetas(reference);
        Ok(Target {
            centre: shoulder_from_wrist.translation.vector,
            rotation: shoulder_from_wrist.rotation.into_inner(),
            free_theta1: theta[0],
            free_theta2: theta[1],
            free_theta4: theta[3],
        })
    }

    /// The arm's plane on one side of axis 1.
    #[inline]
    pub(super) fn side(&self, target: &Target, shoulder: Shoulder) -> Result<Side, InverseError> {
        let front = shoulder == Shoulder::Front;
        let (point, offset) = ([target.centre.x, target.centre.y], self.geometry.lateral_offset);
        let plane = ArmPlane::through(point, offset, front, self.links.reach(), target.free_theta1)?;
        let point = [plane.radial - self.geometry.shoulder_offset, target.centre.z];
        Ok(Side { front, plane, point })
    }

    /// The bend that lays the two links to the wrist centre, forward or back.
    #[inline]
    pub(super) fn bend(&self, side: &Side) -> Result<Bend, InverseError> {
        self.links.bend(side.point)
    }

    /// The two links, bent forward (towards the arm's front) or back.
    #[inline]
    pub(super) fn links(&self, target: &Target, side: &Side, bend: Bend, forward: bool) -> Links {
        let bend = if forward { bend } else { Bend { sin: -bend.sin, ..bend } };
        let (sin2, cos2) = self.links.upper_direction(side.point, bend, target.free_theta2);
        let sin3 = bend.sin * self.elbow_cos - bend.cos * self.elbow_sin;
        let cos3 = bend.cos * self.elbow_cos + bend.sin * self.elbow_sin;
        Links {
            theta2: atan2(sin2, cos2),
            theta3: atan2(sin3, cos3),
            cos23: cos2 * cos3 - sin2 * sin3,
            sin23: sin2 * cos3 + cos2 * sin3,
        }
    }

    /// θ₄, θ₅ ≥ 0 and θ₆ behind a given arm.
    #[inline]
    pub(super) fn wrist(&self, target: &Target, side: &Side, links: &Links) -> ThreeTurns {
        let behind_shoulder = unturned_z(target.rotation, (side.plane.sin1, side.plane.cos1));
        ThreeTurns::zyz(unturned_y(behind_shoulder, (links.sin23, links.cos23)), target.free_theta4)
    }

    /// The maker's joint positions, each in (−π, π], of a wrist on one side of its pole.
    #[inline]
    pub(super) fn joints(&self, side: &Side, links: &Links, turns: ThreeTurns, wrist: Wrist) -> [f64; 6] {
        let g = &self.geometry;
        let positive = (wrist == Wrist::Flip) == (g.signs[4] > 0.0);
        let turns = if positive || turns.at_pole { turns } else { turns.flipped() };
        let ThreeTurns { first, middle, last, .. } = turns;
        let theta = [side.plane.theta1, links.theta2, links.theta3, first, middle, last];
        core::array::from_fn(|i| principal(g.signs[i] * (theta[i] - g.zeros[i])))
    }
}

/// The posture in which a branch comes out.
#[inline]
pub(super) fn named(side: &Side, forward: bool, wrist: Wrist) -> Posture {
    Posture::new(side.front, forward, wrist == Wrist::Flip)
}
