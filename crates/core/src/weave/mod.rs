//! Weaving: a periodic motion of the torch about the seam, as a function of the way travelled.
//!
//! ```text
//! w(s) = e(s) · pattern(s / λ)      λ: way of one period, e: ramps in and out
//! ```
//!
//! The offset is given in the moving frame of the seam (x along the travel, y to the left of it with the wire pointing
//! down, z out of the workpiece: [`crate::path::SeamFrame`]). Since it depends on the way and not on time, override, pause and
//! backing up keep the pattern where it is; at the programmed speed v the frequency is v/λ.
//!
//! | module | holds |
//! |---|---|
//! | `pattern` | one period without units |
//! | `error` | why there is no such weave |

mod error;
mod pattern;

pub use error::WeaveError;
pub use pattern::Pattern;

use crate::math::float::{hypot, sin_cos};
use crate::math::taylor::Taylor;
use pattern::Period;

/// Periods that each ramp takes.
const RAMP_PERIODS: f64 = 2.0;
/// What a ramp may add to velocity, acceleration and jerk of the full amplitude: close to its end the amplitude still grows.
const RAMP_ADDS: [f64; 3] = [1.01, 1.04, 1.1];

/// How a weave looks. SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeaveShape {
    /// The pattern.
    pub pattern: Pattern,
    /// Greatest distance from the seam to either side, in metres.
    pub amplitude: f64,
    /// Way of one period, in metres.
    pub wavelength: f64,
    /// Shares of the period in which the torch stays at the left edge, in the middle (at each crossing) and at the right edge.
    pub dwells: [f64; 3],
    /// Tilt of the weaving plane about the travel, in radians: positive lifts the left edge.
    pub tilt: f64,
    /// How much higher the edges lie than the middle, in metres.
    pub elevation: f64,
    /// The first swing goes to the right.
    pub right_first: bool,
}

/// A weave from one place of a seam to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weave {
    shape: WeaveShape,
    period: Period,
    /// (sin, cos) of the tilt.
    tilt: (f64, f64),
    from: f64,
    to: f64,
    /// Where in the pattern it begins, in periods.
    phase: f64,
    /// Length of each ramp, in metres.
    ramp: f64,
    /// Share of the amplitude that a short part leaves.
    width: f64,
}

/// Greatest velocity, acceleration and jerk across the travel, in m/s, m/s² and m/s³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeavePeaks {
    /// Velocity.
    pub velocity: f64,
    /// Acceleration.
    pub acceleration: f64,
    /// Jerk.
    pub jerk: f64,
}

impl Weave {
    /// A weave on the part of the seam between two coordinates, in metres. It swings in and out over two periods each. Where the
    /// part is shorter than both ramps they take half of it each, and the amplitude is less by the cube of that, so that
    /// the jerk is no greater.
    ///
    /// # Errors
    /// [`WeaveError`] for values without meaning, and dwells that leave no time to swing.
    pub fn try_new(shape: &WeaveShape, from: f64, to: f64) -> Result<Self, WeaveError> {
        let period = Period::try_new(shape)?;
        if !(from.is_finite() && to.is_finite() && from <= to) {
            return Err(WeaveError::Part { from, to });
        }
        let full = RAMP_PERIODS * shape.wavelength;
        let ramp = full.min(0.5 * (to - from));
        let width = (ramp / full) * (ramp / full) * (ramp / full);
        Ok(Self { shape: *shape, period, tilt: sin_cos(shape.tilt), from, to, phase: 0.0, ramp, width })
    }

    /// The same weave, so many periods further on in its pattern: where one goes on that was interrupted.
    #[must_use]
    pub fn at_phase(self, periods: f64) -> Self {
        Self { phase: periods, ..self }
    }

    /// The offset from the seam at coordinate `s` in metres, with its derivatives along s: (along the travel, to the left, out of
    /// the workpiece). Zero before and after the part.
    #[must_use]
    pub fn offset(&self, s: f64) -> [Taylor; 3] {
        if s <= self.from || s >= self.to {
            return [Taylor::constant(0.0); 3];
        }
        let WeaveShape { amplitude, wavelength, elevation, right_first, .. } = self.shape;
        let place = self.phase + (s - self.from) / wavelength;
        let [along, across] = self.period.at(place).map(|part| part.stretched(wavelength));
        let across = if right_first { -across } else { across };
        let width = self.width_at(s);
        let (sin, cos) = self.tilt;
        let lift = across.squared() * elevation * width;
        let across = across * amplitude * width;
        [along * amplitude * width, across * cos, across * sin + lift]
    }

    /// Bounds on what the weave asks of the tool at a travel speed in m/s, ramps included, where its frame turns by so many radians a metre
    /// ([`crate::path::SeamFrame::turn_rate`]; 1/radius on an arc): what the frame's turning adds is that of a steady turn.
    #[must_use]
    pub fn peaks(&self, speed: f64, turn_rate: f64) -> WeavePeaks {
        let frequency = speed / self.shape.wavelength;
        let [p1, p2, p3] = self.period.peaks();
        // Of the edges' height, which goes with the square of the way across.
        let lifted = [2.0 * p1, 2.0 * (p1 * p1 + p2), 6.0 * p1 * p2 + 2.0 * p3];
        let WeaveShape { amplitude, elevation, .. } = self.shape;
        let peak = |order: usize, across: f64| {
            RAMP_ADDS[order] * hypot(amplitude * across, elevation * lifted[order])
        };
        let offset = self.reach();
        let d1 = peak(0, p1) * frequency;
        let d2 = peak(1, p2) * frequency * frequency;
        let d3 = peak(2, p3) * frequency * frequency * frequency;
        // (d/dt + Ω×)ⁿ of the offset. Across the seam only, along n, the parts with Ω × n are at right angles to those with n and Ω × (Ω × n).
        let turn = speed * turn_rate;
        let with = |parts: [f64; 2]| {
            if self.period.is_across() && elevation == 0.0 {
                hypot(parts[0], parts[1])
            } else {
                parts[0] + parts[1]
            }
        };
        WeavePeaks {
            velocity: with([d1, turn * offset]),
            acceleration: with([d2 + turn * turn * offset, turn * 2.0 * d1]),
            jerk: with([d3 + turn * turn * 3.0 * d1, turn * (3.0 * d2 + turn * turn * offset)]),
        }
    }

    /// How far the torch may be from the seam, in metres.
    #[must_use]
    pub fn reach(&self) -> f64 {
        hypot(self.shape.amplitude, self.shape.elevation)
    }

    /// From where to where it leads.
    #[must_use]
    pub fn part(&self) -> (f64, f64) {
        (self.from, self.to)
    }

    /// How it looks.
    #[must_use]
    pub fn shape(&self) -> &WeaveShape {
        &self.shape
    }

    /// The share of the amplitude: from 0 with two continuous derivatives, and back.
    fn width_at(&self, s: f64) -> Taylor {
        let (begun, left, rate) = (s - self.from, self.to - s, 1.0 / self.ramp);
        let share = if begun < self.ramp {
            Taylor::smooth_step(begun * rate, rate)
        } else if left < self.ramp {
            Taylor::smooth_step(left * rate, -rate)
        } else {
            Taylor::constant(1.0)
        };
        share * self.width
    }
}
