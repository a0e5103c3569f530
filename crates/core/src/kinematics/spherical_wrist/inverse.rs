//! The closed-form inverse, one branch at a time.
//!
//! Wrist centre → arm plane (front or rear) → two-link arm in that plane (upper or lower) → wrist angles (flip or
//! not). No angle is taken by arc cosine: sines and cosines come from lengths, each by a form that does not cancel,
//! so that the pose is met to rounding also beside the singularities. Where a joint is free (wrist at its pole,
//! wrist centre on axis 1) it is kept from the reference.

use core::f64::consts::PI;

use nalgebra::Quaternion;

use super::{Posture, Shoulder, SphericalWristArm, Wrist};
use crate::geometry::{Pose, Vector3, is_finite};
use crate::kinematics::InverseError;
use crate::kinematics::limits::principal;
use crate::kinematics::two_link::{Bend, ON_AXIS, REACH_ROUNDING};
use crate::math::float::{atan2, sin_cos, sqrt};

/// The wrist stands at its pole, and joint 4 is free, if tan(θ₅/2) or its reciprocal is below this: what is left
/// out turns the flange by 2e-13 rad.
const WRIST_POLE: f64 = 1e-13;

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

/// The arm's plane turned towards the wrist centre, which has the coordinates (out, up) in it, seen from axis 2.
#[derive(Clone, Copy)]
pub(super) struct Side {
    pub(super) front: bool,
    /// Front and rear are one: the arm's plane cannot be turned nearer to the wrist centre, or need not be.
    pub(super) singular: bool,
    theta1: f64,
    cos1: f64,
    sin1: f64,
    out: f64,
    up: f64,
}

/// The two links laid to the wrist centre.
#[derive(Clone, Copy)]
pub(super) struct Links {
    theta2: f64,
    theta3: f64,
    cos23: f64,
    sin23: f64,
}

/// Wrist angles with θ₅ in [0, π].
#[derive(Clone, Copy)]
pub(super) struct WristAngles {
    theta4: f64,
    theta5: f64,
    theta6: f64,
    /// Joint 4 was free.
    pub(super) at_pole: bool,
}

impl WristAngles {
    /// The same rotation with −θ₅.
    fn flipped(self) -> Self {
        Self { theta4: self.theta4 + PI, theta5: -self.theta5, theta6: self.theta6 - PI, ..self }
    }
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
    ///
    /// The wrist centre (x, y) = Rz(θ₁)·(radial, b), with radial = ±√(x² + y² − b²).
    #[inline]
    pub(super) fn side(&self, target: &Target, shoulder: Shoulder) -> Result<Side, InverseError> {
        let g = &self.geometry;
        let front = shoulder == Shoulder::Front;
        let (x, y, b) = (target.centre.x, target.centre.y, g.lateral_offset);
        let radius_squared = x * x + y * y;
        let radius = sqrt(radius_squared);
        let reach = self.links.reach();
        let up = target.centre.z;
        if radius <= ON_AXIS * reach && b.abs() <= ON_AXIS * reach {
            let (sin1, cos1) = sin_cos(target.free_theta1);
            let (theta1, out) = (target.free_theta1, -g.shoulder_offset);
            return Ok(Side { front, singular: true, theta1, cos1, sin1, out, up });
        }
        if radius < b.abs() - REACH_ROUNDING * reach {
            return Err(InverseError::InsideLateralOffset { radius, offset: b.abs() });
        }
        // (radius − b)(radius + b) keeps its digits where the two nearly agree.
        let magnitude = sqrt(((radius - b) * (radius + b)).max(0.0));
        let radial = if front { magnitude } else { -magnitude };
        // Scaled to a unit vector: where rounding left the radius short of b, radial² + b² is not radius².
        let scale = 1.0 / (radius * sqrt(radial * radial + b * b));
        let (cos1, sin1) = ((x * radial + y * b) * scale, (y * radial - x * b) * scale);
        let theta1 = atan2(sin1, cos1);
        let (singular, out) = (magnitude == 0.0, radial - g.shoulder_offset);
        Ok(Side { front, singular, theta1, cos1, sin1, out, up })
    }

    /// The bend that lays the two links to the wrist centre, forward or back.
    #[inline]
    pub(super) fn bend(&self, side: &Side) -> Result<Bend, InverseError> {
        self.links.bend([side.out, side.up])
    }

    /// The two links, bent forward (towards the arm's front) or back.
    #[inline]
    pub(super) fn links(&self, target: &Target, side: &Side, bend: Bend, forward: bool) -> Links {
        let bend = if forward { bend } else { Bend { sin: -bend.sin, ..bend } };
        let (sin2, cos2) = self.links.upper_direction([side.out, side.up], bend, target.free_theta2);
        let sin3 = bend.sin * self.elbow_cos - bend.cos * self.elbow_sin;
        let cos3 = bend.cos * self.elbow_cos + bend.sin * self.elbow_sin;
        Links {
            theta2: atan2(sin2, cos2),
            theta3: atan2(sin3, cos3),
            cos23: cos2 * cos3 - sin2 * sin3,
            sin23: sin2 * cos3 + cos2 * sin3,
        }
    }

    /// The wrist angles behind a given arm.
    ///
    /// With h the quaternion of Rz(θ₄)·Ry(θ₅)·Rz(θ₆), scaled by anything:
    /// h_w ~ cos(θ₅/2) cos σ, h_z ~ cos(θ₅/2) sin σ, h_x ~ −sin(θ₅/2) sin δ, h_y ~ sin(θ₅/2) cos δ, where σ and δ are
    /// half the sum and half the difference of θ₄ and θ₆. Beside a pole one of σ, δ is uncertain and the other is
    /// not, so that the rotation is met all the same.
    #[inline]
    pub(super) fn wrist(&self, target: &Target, side: &Side, links: &Links) -> WristAngles {
        let h = unturned_y(unturned_z(target.rotation, side.cos1, side.sin1), links.cos23, links.sin23);
        let bent = sqrt(h.i * h.i + h.j * h.j);
        let straight = sqrt(h.w * h.w + h.k * h.k);
        let half_sum = atan2(h.k, h.w);
        let half_difference = atan2(-h.i, h.j);
        let theta4 = target.free_theta4;
        if bent <= WRIST_POLE * straight {
            WristAngles { theta4, theta5: 0.0, theta6: 2.0 * half_sum - theta4, at_pole: true }
        } else if straight <= WRIST_POLE * bent {
            WristAngles { theta4, theta5: PI, theta6: theta4 - 2.0 * half_difference, at_pole: true }
        } else {
            WristAngles {
                theta4: half_sum + half_difference,
                theta5: 2.0 * atan2(bent, straight),
                theta6: half_sum - half_difference,
                at_pole: false,
            }
        }
    }

    /// The maker's joint positions, each in (−π, π], of a wrist on one side of its pole.
    #[inline]
    pub(super) fn joints(&self, side: &Side, links: &Links, angles: WristAngles, wrist: Wrist) -> [f64; 6] {
        let g = &self.geometry;
        let positive = (wrist == Wrist::Flip) == (g.signs[4] > 0.0);
        let WristAngles { theta4, theta5, theta6, .. } =
            if positive || angles.at_pole { angles } else { angles.flipped() };
        let theta = [side.theta1, links.theta2, links.theta3, theta4, theta5, theta6];
        core::array::from_fn(|i| principal(g.signs[i] * (theta[i] - g.zeros[i])))
    }
}

/// The posture in which a branch comes out.
#[inline]
pub(super) fn named(side: &Side, forward: bool, wrist: Wrist) -> Posture {
    Posture::new(side.front, forward, wrist == Wrist::Flip)
}

/// Rz(−α)·h for an angle with this cosine and sine, scaled: a quaternion of the half angle without a square root.
#[inline]
fn unturned_z(h: Quaternion<f64>, cos: f64, sin: f64) -> Quaternion<f64> {
    let (w, v) = half(cos, sin);
    Quaternion::new(w * h.w + v * h.k, w * h.i + v * h.j, w * h.j - v * h.i, w * h.k - v * h.w)
}

/// Ry(−α)·h, likewise.
#[inline]
fn unturned_y(h: Quaternion<f64>, cos: f64, sin: f64) -> Quaternion<f64> {
    let (w, v) = half(cos, sin);
    Quaternion::new(w * h.w + v * h.j, w * h.i - v * h.k, w * h.j - v * h.w, w * h.k + v * h.i)
}

/// Cosine and sine of half an angle, scaled by a common factor: (1 + cos, sin) = 2 cos(α/2)·(cos(α/2), sin(α/2)), or
/// (sin, 1 − cos) = 2 sin(α/2)·(cos(α/2), sin(α/2)), whichever is the longer.
#[inline]
fn half(cos: f64, sin: f64) -> (f64, f64) {
    if cos >= 0.0 { (1.0 + cos, sin) } else { (sin, 1.0 - cos) }
}
