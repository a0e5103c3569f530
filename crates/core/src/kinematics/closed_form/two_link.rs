//! Two links in a plane: the middle of every arm here with a closed form.
//!
//! Directions are angles t with the unit vector (out, up) = (sin t, cos t): the upper link points at angle t, the second
//! one at t + bend.

use crate::kinematics::{InverseError, Singularity};
use crate::math::float::{sin, sin_cos, sqrt};
use crate::math::taylor::Taylor;

/// A length beyond the reach by less than this part of it is rounding. Leaves at most 8e-14 m on a 2 m arm.
pub(crate) const REACH_ROUNDING: f64 = 4e-14;
/// A point nearer to an axis than this part of the reach lies on it, and the joint is free.
pub(crate) const ON_AXIS: f64 = 1e-14;
/// Below this the sine of the bend may be rounding: the end is within 1e-14 of the reach.
const VANISHING_SINE: f64 = 1e-7;
/// What varies by less than this part of the whole motion stands still.
pub(crate) const STILL: f64 = 1e-12;

/// Lengths of the links in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TwoLink {
    pub(crate) upper: f64,
    pub(crate) fore: f64,
}

/// Cosine and (not negative) sine of the bend. The sine is zero where both bends are one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bend {
    pub(crate) cos: f64,
    pub(crate) sin: f64,
}

impl TwoLink {
    /// Greatest distance.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.upper + self.fore
    }

    /// The bend that reaches a point: law of cosines in the triangle of the two links.
    #[inline]
    pub(crate) fn bend(&self, [out, up]: [f64; 2]) -> Result<Bend, InverseError> {
        let Self { upper, fore } = *self;
        let distance_squared = out * out + up * up;
        let distance = sqrt(distance_squared);
        let (least, greatest) = ((upper - fore).abs(), upper + fore);
        let rounding = REACH_ROUNDING * greatest;
        if distance > greatest + rounding || distance < least - rounding {
            return Err(InverseError::OutOfReach { distance, least, greatest });
        }
        let scale = 0.5 / (upper * fore);
        let cos = (distance_squared - upper * upper - fore * fore) * scale;
        // sin² by factors that vanish where the arm is stretched and where it is folded.
        let stretch = (greatest - distance) * (greatest + distance);
        let fold = (distance - least) * (distance + least);
        Ok(Bend { cos: cos.clamp(-1.0, 1.0), sin: sqrt((stretch * fold).max(0.0)) * scale })
    }

    /// (sin, cos) of the upper link's direction, for a bend with this sign; `free` where the links lie folded on the
    /// first axis and any direction will do.
    #[inline]
    pub(crate) fn upper_direction(&self, [out, up]: [f64; 2], bend: Bend, free: f64) -> (f64, f64) {
        // The end as seen from the upper link, `along` it and `across`.
        let along = self.upper + self.fore * bend.cos;
        let across = self.fore * bend.sin;
        let distance_squared = out * out + up * up;
        let on_axis = ON_AXIS * self.reach();
        if distance_squared <= on_axis * on_axis {
            return sin_cos(free);
        }
        // Scaled to a unit vector: where rounding left the distance beside the reach, the two lengths differ.
        let scale = 1.0 / sqrt((along * along + across * across) * distance_squared);
        ((out * along - up * across) * scale, (up * along + out * across) * scale)
    }

    /// The angle of the upper link and the bend as series, with these values, for a moving end point. `still` is the
    /// largest coefficient that counts as rounding.
    #[inline]
    pub(crate) fn series(
        &self,
        [out, up]: [Taylor; 2],
        [angle, bend]: [f64; 2],
        still: f64,
    ) -> Result<[Taylor; 2], InverseError> {
        let Self { upper, fore } = *self;
        let distance_squared = out.squared() + up.squared();
        let cos_bend = (distance_squared + -(upper * upper + fore * fore)) * (0.5 / (upper * fore));
        let sin_value = sin(bend);
        let (bend, sin_bend) = if sin_value.abs() > VANISHING_SINE {
            let sin_bend = (-cos_bend.squared()).sqrt_from(sin_value);
            (Taylor::angle(cos_bend, sin_bend, bend), sin_bend)
        } else if cos_bend.variation() <= still {
            (Taylor::constant(bend), Taylor::constant(sin_value))
        } else {
            let distance = sin_value.abs();
            return Err(InverseError::Singular { singularity: Singularity::Elbow, distance });
        };
        let on_axis = ON_AXIS * self.reach();
        if distance_squared.value() <= on_axis * on_axis {
            return Ok([Taylor::constant(angle), bend]);
        }
        let (along, across) = (cos_bend * fore + upper, sin_bend * fore);
        Ok([Taylor::angle(up * along + out * across, out * along - up * across, angle), bend])
    }
}
