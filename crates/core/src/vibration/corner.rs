//! Corners in time: two segments overlap, and the corner is rounded by as much as is permitted.
//!
//! The second segment starts before the first has come to rest. With A(t) what is left of the first and B(t) what is done of the second, the
//! point lies at −A·u₁ + B·u₂ from the corner, and e² = A² + B² − 2AB cos β. Source: Yeh & You (2026), section 4, equations 15 and 16,
//! algorithm 1. Two facts that hold for every pair of ramps (proofs in `docs/vibration.md`) make the search short and certain:
//!
//! 1. Along one corner, e falls and then rises: each stationary point is a least one, since the path turns towards the inside only.
//! 2. The least e grows with the overlap.

use nalgebra::Vector3;

use super::ramp::Ramp;
use crate::math::float;

/// A corner between two segments.
#[derive(Debug, Clone, Copy)]
pub struct Corner<'a> {
    /// Deceleration of the first segment: `first_feedrate × (1 − ramp)`.
    pub deceleration: &'a Ramp,
    /// Acceleration of the second segment: `second_feedrate × ramp`.
    pub acceleration: &'a Ramp,
    /// Feedrate before the corner, in m/s, ≥ 0.
    pub first_feedrate: f64,
    /// Feedrate after the corner, in m/s, ≥ 0.
    pub second_feedrate: f64,
    /// Change of direction β, angle between the tangents: 0 is straight on, π is back.
    pub angle: f64,
    /// The longest overlap that the segments' durations permit, in seconds; infinite if only the deceleration bounds it.
    pub longest: f64,
}

/// How two segments overlap. Times in seconds from where the first segment begins to decelerate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// How long the first segment decelerates, t_DEC1.
    pub deceleration: f64,
    /// When the path is nearest to the corner, t_m.
    pub nearest: f64,
    /// How long both move, t_c.
    pub overlap: f64,
    /// When the second segment starts, t_d.
    pub delay: f64,
    /// The corner error, in metres: distance of the path from the corner at its nearest.
    pub error: f64,
}

/// The error that is aimed at stays below the permitted one by this fraction; half of it is the search's tolerance.
const MARGIN: f64 = 1e-9;
/// Bounds of the search for an overlap: secants take about five steps; if they have not arrived after these, halvings do.
const SECANT_STEPS: usize = 20;
const OVERLAP_STEPS: usize = 100;
/// Bound of the search for the nearest point: a fourth of these, as halvings, exhaust the digits.
const NEAREST_STEPS: usize = 160;

impl Corner<'_> {
    /// The longest overlap whose corner error is at most the permitted one, in metres.
    ///
    /// An error of zero or less gives no overlap. Where even the longest overlap stays below the error, that is the answer. Costs
    /// 0.4 to 4 µs with the prefilters of the table.
    #[must_use]
    pub fn overlap(&self, permitted: f64) -> Overlap {
        let longest = self.deceleration.duration().min(self.longest.max(0.0));
        if permitted.is_nan() || permitted <= 0.0 {
            return self.at(0.0);
        }
        let whole = self.at(longest);
        if whole.error <= permitted {
            return whole;
        }
        self.search(permitted * (1.0 - 0.5 * MARGIN), whole)
    }

    /// The corner for a given overlap, in seconds.
    #[must_use]
    pub fn at(&self, overlap: f64) -> Overlap {
        let deceleration = self.deceleration.duration();
        let delay = deceleration - overlap;
        let nearest = if overlap > 0.0 { self.nearest(delay, deceleration) } else { deceleration };
        let error = self.state(nearest, delay).error(self.turn());
        Overlap { deceleration, nearest, overlap, delay, error }
    }

    /// The secant method for ln e over ln t_c, inside a bracket: e is nearly a power of the overlap, and exactly one as long as it stays
    /// within the first piece of one ramp and the last of the other. Then the first step is the closed form.
    fn search(&self, aim: f64, whole: Overlap) -> Overlap {
        let (mut low, mut high) = (self.at(0.0), whole);
        let mut at = high;
        let mut exponent = self.exponent(&at);
        for step in 0..OVERLAP_STEPS {
            let secant = at.overlap * float::powf(aim / at.error, 1.0 / exponent);
            let inside = secant > low.overlap && secant < high.overlap;
            let next =
                if inside && step < SECANT_STEPS { secant } else { 0.5 * (low.overlap + high.overlap) };
            let last = at;
            at = self.at(next);
            if (at.error - aim).abs() <= 0.5 * MARGIN * aim {
                return at;
            }
            exponent = float::ln(at.error / last.error) / float::ln(at.overlap / last.overlap);
            if at.error > aim {
                high = at;
            } else {
                low = at;
            }
        }
        low
    }

    /// d ln e / d ln t_c. Inside the overlap e does not change with the time at the nearest point, so that only the second segment's start
    /// counts: e ∂e/∂t_c = (B − A cos β) f₂. At its beginning e is A alone: e ∂e/∂t_c = A f₁.
    fn exponent(&self, at: &Overlap) -> f64 {
        let state = self.state(at.nearest, at.delay);
        let slope = if at.nearest > at.delay {
            (state.done - state.left + state.left * self.turn()) * state.second
        } else {
            state.left * state.first
        };
        slope * at.overlap / (at.error * at.error)
    }

    /// Where e stops falling, in [delay, end].
    fn nearest(&self, delay: f64, end: f64) -> f64 {
        let turn = self.turn();
        let rate = |time: f64| self.state(time, delay).rate(turn);
        let (mut low, mut high) = (delay, end);
        let (mut rate_low, mut rate_high) = (rate(low), rate(high));
        if rate_low >= 0.0 {
            return low;
        }
        if rate_high <= 0.0 {
            return high;
        }
        // Regula falsi with the Illinois rule, and every fourth step a halving.
        let mut side = 0.0;
        for step in 1..=NEAREST_STEPS {
            if high - low <= ROUNDING * end {
                break;
            }
            let secant = (low * rate_high - high * rate_low) / (rate_high - rate_low);
            let time = if step % 4 == 0 { 0.5 * (low + high) } else { secant.clamp(low, high) };
            let value = rate(time);
            if value == 0.0 {
                return time;
            }
            let again = value * side > 0.0;
            if value < 0.0 {
                (low, rate_low) = (time, value);
                rate_high *= if again { 0.5 } else { 1.0 };
            } else {
                (high, rate_high) = (time, value);
                rate_low *= if again { 0.5 } else { 1.0 };
            }
            side = value;
        }
        0.5 * (low + high)
    }

    /// 1 − cos β without loss of digits where the corner is flat.
    fn turn(&self) -> f64 {
        let sin = float::sin(0.5 * self.angle);
        2.0 * sin * sin
    }

    #[inline]
    fn state(&self, time: f64, delay: f64) -> State {
        let (ramp, integral) = self.acceleration.value_and_integral(time - delay);
        State {
            left: self.first_feedrate * self.deceleration.remaining(time),
            done: self.second_feedrate * integral,
            first: self.first_feedrate * (1.0 - self.deceleration.value(time)),
            second: self.second_feedrate * ramp,
        }
    }
}

/// An interval of time below this fraction is a point. The error is stationary there, so that it has twice the digits.
const ROUNDING: f64 = 1e-13;

/// A, B and the two feedrates at one instant.
#[derive(Debug, Clone, Copy)]
struct State {
    left: f64,
    done: f64,
    first: f64,
    second: f64,
}

impl State {
    /// Equation 16, as (A − B)² + 2AB(1 − cos β).
    fn error(&self, turn: f64) -> f64 {
        let &Self { left: a, done: b, .. } = self;
        float::sqrt((a - b) * (a - b) + 2.0 * a * b * turn)
    }

    /// e de/dt: equation 15 with its sign turned, so that it is negative while the path comes nearer.
    fn rate(&self, turn: f64) -> f64 {
        let &Self { left: a, done: b, first, second } = self;
        (b - a) * (first + second) - turn * (first * b - a * second)
    }
}

/// The overlap of two like trapezoids in closed form, in seconds: t_c = √(8 e t_DA / (F √(2(1 − cos β)))), at most t_DA.
///
/// `duration` is t_DA, `feedrate` F in m/s, `permitted` e in metres. Yeh & You (2026), section 4.
#[must_use]
pub fn trapezoid_overlap(feedrate: f64, duration: f64, angle: f64, permitted: f64) -> f64 {
    // √(2(1 − cos β)) without loss of digits.
    let chord = 2.0 * float::sin(0.5 * angle);
    let overlap = float::sqrt(8.0 * permitted.max(0.0) * duration / (feedrate * chord));
    // Straight on, no overlap makes an error: 0/0 or infinite.
    if overlap < duration { overlap } else { duration }
}

/// The feedrate that a segment reaches, in m/s: the wanted one, or less where the segment is too short to accelerate, and decelerate
/// after that, within its length, in metres.
///
/// At that feedrate the ramps of a segment never meet, so that the corners at its two ends are independent of each other.
#[must_use]
pub fn reachable_feedrate(length: f64, acceleration: &Ramp, deceleration: &Ramp, wanted: f64) -> f64 {
    // Both ramps at feedrate 1 cover this much.
    let covered = acceleration.integral(acceleration.duration()) + deceleration.remaining(0.0);
    if wanted * covered <= length { wanted } else { length / covered }
}

/// The angle between two directions in space, 0 to π, exact also near both ends. Zero if either has no length.
#[must_use]
pub fn angle_between(first: &Vector3<f64>, second: &Vector3<f64>) -> f64 {
    float::atan2(first.cross(second).norm(), first.dot(second))
}
