//! Exact joint derivatives: the closed-form inverse, on the branch of given joint positions, in Taylor arithmetic.
//!
//! Values come from the joint positions, derivatives from the flange's motion: beside a singularity the joints are known
//! better than the rounded pose says. Where a root vanishes the branch meets another and has no derivatives, unless the
//! motion stands still there or passes straight through (an arm that moves in its own plane): then it has.

use super::SphericalWristArm;
use crate::geometry::{PoseJet, Vector3};
use crate::kinematics::closed_form::{Polar, STILL};
use crate::kinematics::{InverseError, JointJet, Singularity};
use crate::math::float::{sin_cos, sqrt};
use crate::math::taylor::Taylor;

/// With a lateral offset the wrist centre's radial coordinate is a root of what is itself known to rounding: it is zero
/// but for that below this, per root of offset and reach.
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
        if !(base_from_flange.is_finite() && q.iter().sum::<f64>().is_finite()) {
            return Err(InverseError::NotFinite);
        }
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
        let (reach, offset) = (self.links.reach(), self.geometry.lateral_offset);
        let [x, y, _] = motion.centre;
        let value = self.wrist_radius(theta);
        let singular = InverseError::Singular { singularity: Singularity::Shoulder, distance: value.abs() };
        let (theta1, radial) = if offset == 0.0 {
            let polar = Polar::of([x, y], value, theta[0], reach, motion.variation).ok_or(singular)?;
            (polar.angle, polar.radius)
        } else if value.abs() > VANISHING_ROOT * sqrt(offset.abs() * reach) {
            let (sin1, cos1) = sin_cos(theta[0]);
            let x = x.with_value(cos1 * value - sin1 * offset);
            let y = y.with_value(sin1 * value + cos1 * offset);
            let radial = (x.squared() + y.squared()).sqrt_from(value);
            (Taylor::angle(x * radial + y * offset, y * radial + x * -offset, theta[0]), radial)
        } else if x.variation().max(y.variation()) <= STILL * reach * motion.variation {
            (Taylor::constant(theta[0]), Taylor::constant(value))
        } else {
            return Err(singular);
        };
        Ok((theta1, radial + -self.geometry.shoulder_offset))
    }
}

/// θ₄, θ₅ and θ₆ of the wrist's rotation h relative to the forearm.
///
/// The same components as in the inverse itself: with σ, δ half the sum and half the difference of θ₄ and θ₆, the
/// quaternion is (cos(θ₅/2) cos σ, −sin(θ₅/2) sin δ, sin(θ₅/2) cos δ, cos(θ₅/2) sin σ), or the negative of that.
#[inline]
fn wrist_series(
    motion: &WristMotion,
    h: &QuaternionSeries,
    theta: &[f64; 6],
) -> Result<[Taylor; 3], InverseError> {
    let [_, _, _, theta4, theta5, theta6] = *theta;
    let (sum, difference) = (0.5 * (theta4 + theta6), 0.5 * (theta4 - theta6));
    let (sin, cos) = sin_cos(0.5 * theta5);
    let (straight, bent) = ([h.w, h.z], [h.y, -h.x]);
    let sign = 1.0_f64.copysign(cos * towards(straight, sum) + sin * towards(bent, difference));
    let distance = 2.0 * (sin * cos).abs();
    let singular = InverseError::Singular { singularity: Singularity::Wrist, distance };
    let polar = |point, radius, angle| Polar::of(point, radius, angle, 1.0, motion.variation).ok_or(singular);
    let (straight, bent) = (polar(straight, sign * cos, sum)?, polar(bent, sign * sin, difference)?);
    let theta5 = Taylor::angle(straight.radius, bent.radius, 0.5 * theta5) * 2.0;
    // A wrist that rests at its pole keeps θ₄, and turns by θ₆ alone.
    let theta4_held = Taylor::constant(theta4);
    if bent.at_rest {
        return Ok([theta4_held, theta5, straight.angle * 2.0 - theta4_held]);
    }
    if straight.at_rest {
        return Ok([theta4_held, theta5, theta4_held - bent.angle * 2.0]);
    }
    Ok([straight.angle + bent.angle, theta5, straight.angle - bent.angle])
}

/// The coordinate of a point along a direction.
#[inline]
fn towards([x, y]: [Taylor; 2], angle: f64) -> f64 {
    let (sin, cos) = sin_cos(angle);
    x.value() * cos + y.value() * sin
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
