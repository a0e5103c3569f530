//! Exact joint derivatives: the closed-form inverse, on the branch of given joint positions, in Taylor arithmetic.
//!
//! Values come from the joint positions, derivatives from the flange's motion. Where a root vanishes the branch
//! meets another and has no derivatives, unless what it depends on stands still: then the joint does too.

use super::SphericalWristArm;
use crate::geometry::{PoseJet, Vector3};
use crate::kinematics::two_link::STILL;
use crate::kinematics::{InverseError, JointJet, Singularity};
use crate::math::float::{cos, sin, sqrt};
use crate::math::taylor::Taylor;

/// A measure of distance below this is zero but for rounding.
const VANISHING: f64 = 1e-12;
/// A root of what is itself known to rounding, below this.
const VANISHING_ROOT: f64 = 1e-7;

/// The wrist's motion in the shoulder frame.
struct WristMotion {
    centre: [Taylor; 3],
    rotation: QuaternionSeries,
    /// The largest coefficient of the motion, per reach and per radian.
    variation: f64,
}

/// A unit quaternion's components as series.
#[derive(Clone, Copy)]
struct QuaternionSeries {
    w: Taylor,
    x: Taylor,
    y: Taylor,
    z: Taylor,
}

impl SphericalWristArm {
    pub(super) fn jet(&self, base_from_flange: &PoseJet, q: &[f64; 6]) -> Result<JointJet<6>, InverseError> {
        let theta = self.thetas(q);
        let motion = self.wrist_motion(base_from_flange);
        let (theta1, out) = self.shoulder_series(&motion, &theta)?;
        let values = [theta[1], theta[2] + self.elbow_angle];
        let still = STILL * motion.variation;
        let [theta2, bend] = self.links.series([out, motion.centre[2]], values, still)?;
        let theta3 = bend + -self.elbow_angle;
        let wrist = motion.rotation.unturned_z(theta1).unturned_y(theta2 + theta3);
        let [theta4, theta5, theta6] = wrist_series(&motion, &wrist, &theta)?;
        let series = [theta1, theta2, theta3, theta4, theta5, theta6];
        Ok(JointJet::of_series(*q, core::array::from_fn(|i| series[i] * self.geometry.signs[i])))
    }

    #[inline]
    fn wrist_motion(&self, base_from_flange: &PoseJet) -> WristMotion {
        let jet = base_from_flange.seen_from(&self.shoulder_from_base).attached(&self.flange_from_wrist);
        let position = jet.pose.translation.vector;
        let [d1, d2, d3] = jet.linear;
        let centre = [0, 1, 2].map(|i| Taylor::from_derivatives(position[i], d1[i], d2[i], d3[i]));
        let rotation = QuaternionSeries::of(&jet);
        let reach = self.links.reach();
        let moved = centre.iter().fold(0.0, |most: f64, c| most.max(c.variation())) / reach;
        let variation = moved.max(rotation.variation());
        WristMotion { centre, rotation, variation }
    }

    /// θ₁, and the wrist centre's coordinate along the arm's plane, seen from axis 2.
    #[inline]
    fn shoulder_series(
        &self,
        motion: &WristMotion,
        theta: &[f64; 6],
    ) -> Result<(Taylor, Taylor), InverseError> {
        let g = &self.geometry;
        let reach = self.links.reach();
        let [x, y, _] = motion.centre;
        let b = g.lateral_offset;
        let value = self.wrist_radius(theta);
        let vanishing = (VANISHING * reach).max(VANISHING_ROOT * sqrt(b.abs() * reach));
        if value.abs() <= vanishing {
            if x.variation().max(y.variation()) <= STILL * reach * motion.variation {
                return Ok((Taylor::constant(theta[0]), Taylor::constant(value - g.shoulder_offset)));
            }
            return Err(InverseError::Singular { singularity: Singularity::Shoulder, distance: value.abs() });
        }
        let radial = (x.squared() + y.squared()).sqrt_from(value);
        let theta1 = Taylor::angle(x * radial + y * b, y * radial + x * -b, theta[0]);
        Ok((theta1, radial + -g.shoulder_offset))
    }
}

/// θ₄, θ₅ and θ₆ of the wrist's rotation relative to the forearm.
///
/// The same components as in the inverse itself: with σ, δ half the sum and half the difference of θ₄ and θ₆, the
/// quaternion is (cos(θ₅/2) cos σ, −sin(θ₅/2) sin δ, sin(θ₅/2) cos δ, cos(θ₅/2) sin σ).
#[inline]
fn wrist_series(
    motion: &WristMotion,
    h: &QuaternionSeries,
    theta: &[f64; 6],
) -> Result<[Taylor; 3], InverseError> {
    let [_, _, _, theta4, theta5, theta6] = *theta;
    let sin5 = sin(theta5);
    let still = STILL * motion.variation;
    if sin5.abs() <= VANISHING {
        let held = (Taylor::constant(theta4), Taylor::constant(theta5));
        let upright = cos(theta5) > 0.0;
        if upright && h.x.variation().max(h.y.variation()) <= still {
            let sum = Taylor::angle(h.w, h.z, 0.5 * (theta4 + theta6)) * 2.0;
            return Ok([held.0, held.1, sum - held.0]);
        }
        if !upright && h.w.variation().max(h.z.variation()) <= still {
            let difference = Taylor::angle(h.y, -h.x, 0.5 * (theta4 - theta6)) * 2.0;
            return Ok([held.0, held.1, held.0 - difference]);
        }
        return Err(InverseError::Singular { singularity: Singularity::Wrist, distance: sin5.abs() });
    }
    let half_sum = Taylor::angle(h.w, h.z, 0.5 * (theta4 + theta6));
    let half_difference = Taylor::angle(h.y, -h.x, 0.5 * (theta4 - theta6));
    // cos θ₅ and sin θ₅, from the squares of cos(θ₅/2) and sin(θ₅/2).
    let straight = h.w.squared() + h.z.squared();
    let bent = h.x.squared() + h.y.squared();
    let half_sine = (straight * bent).sqrt_from(0.5 * sin5);
    let theta5 = Taylor::angle(straight - bent, half_sine * 2.0, theta5);
    Ok([half_sum + half_difference, theta5, half_sum - half_difference])
}

impl QuaternionSeries {
    /// From h′ = ½ ω h, with ω as a pure quaternion in the parent frame.
    #[inline]
    fn of(jet: &PoseJet) -> Self {
        let h0 = jet.pose.rotation.into_inner();
        let half = |v: &Vector3| nalgebra::Quaternion::from_imag(v * 0.5);
        let [w0, w1, w2] = [half(&jet.angular[0]), half(&jet.angular[1]), half(&jet.angular[2])];
        let h1 = w0 * h0;
        let h2 = w1 * h0 + w0 * h1;
        let h3 = w2 * h0 + w1 * h1 * 2.0 + w0 * h2;
        Self {
            w: Taylor::from_derivatives(h0.w, h1.w, h2.w, h3.w),
            x: Taylor::from_derivatives(h0.i, h1.i, h2.i, h3.i),
            y: Taylor::from_derivatives(h0.j, h1.j, h2.j, h3.j),
            z: Taylor::from_derivatives(h0.k, h1.k, h2.k, h3.k),
        }
    }

    fn variation(&self) -> f64 {
        [self.w, self.x, self.y, self.z].iter().fold(0.0, |most: f64, c| most.max(c.variation()))
    }

    /// Rz(−α)·self.
    #[inline]
    fn unturned_z(&self, angle: Taylor) -> Self {
        let (s, c) = (angle * 0.5).sin_cos();
        let Self { w, x, y, z } = *self;
        Self { w: c * w + s * z, x: c * x + s * y, y: c * y - s * x, z: c * z - s * w }
    }

    /// Ry(−α)·self.
    #[inline]
    fn unturned_y(&self, angle: Taylor) -> Self {
        let (s, c) = (angle * 0.5).sin_cos();
        let Self { w, x, y, z } = *self;
        Self { w: c * w + s * y, x: c * x - s * z, y: c * y - s * w, z: c * z + s * x }
    }
}
