//! Where a profile's position turns, and when it first passes a position.

use super::profile::{Phase, Profile};
use crate::math::float::sqrt;

/// The lowest and the highest position of a motion, and when they are reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionExtrema {
    /// Lowest position.
    pub min: f64,
    /// Highest position.
    pub max: f64,
    /// When the lowest position is first reached, in seconds.
    pub time_min: f64,
    /// When the highest position is first reached, in seconds.
    pub time_max: f64,
}

/// Steps of the bracketed search for a passage: each halves a bracket of 64-bit floats, or does better.
const MAX_STEPS: usize = 64;

impl Profile {
    /// The lowest and the highest position on the way, ends included.
    #[must_use]
    pub fn position_extrema(&self) -> PositionExtrema {
        let start = self.at(0.0).position;
        let mut extrema = PositionExtrema { min: start, max: start, time_min: 0.0, time_max: 0.0 };
        let mut elapsed = 0.0;
        for phase in self.phases() {
            for turn in turns(phase) {
                extrema.include(phase.at(turn).position, elapsed + turn);
            }
            elapsed += phase.duration;
        }
        extrema.include(self.end().position, elapsed);
        extrema
    }

    /// The first time at which the axis is at a position, in seconds; `None` if it is not until the end.
    #[must_use]
    pub fn first_time_at_position(&self, position: f64) -> Option<f64> {
        let mut elapsed = 0.0;
        for phase in self.phases() {
            let [first, second] = turns(phase);
            let mut low = 0.0;
            for high in [first, second, phase.duration] {
                if let Some(time) = passage(phase, position, low, high) {
                    return Some(elapsed + time);
                }
                low = high;
            }
            elapsed += phase.duration;
        }
        (self.end().position == position).then_some(elapsed)
    }
}

impl PositionExtrema {
    fn include(&mut self, position: f64, time: f64) {
        if position > self.max {
            (self.max, self.time_max) = (position, time);
        }
        if position < self.min {
            (self.min, self.time_min) = (position, time);
        }
    }
}

/// The times within a phase at which the velocity is zero, in order; its ends where there are none.
fn turns(phase: &Phase) -> [f64; 2] {
    let &Phase { duration, velocity: v, acceleration: a, jerk: j, .. } = phase;
    // v + a t + j t²/2 = 0, in the form that does not cancel.
    let discriminant = a * a - 2.0 * j * v;
    if discriminant < 0.0 {
        return [0.0, 0.0];
    }
    let q = -(a + sqrt(discriminant).copysign(a));
    let inside = |t: f64| if t > 0.0 && t < duration { t } else { 0.0 };
    let (first, second) = (inside(2.0 * v / q), inside(q / j));
    [first.min(second), first.max(second)]
}

/// The time in `low..=high` at which the phase passes a position; its velocity keeps its sign there.
fn passage(phase: &Phase, position: f64, mut low: f64, mut high: f64) -> Option<f64> {
    let off = |t: f64| phase.at(t).position - position;
    let (start, end) = (off(low), off(high));
    if start == 0.0 {
        return Some(low);
    }
    if (start > 0.0) == (end > 0.0) && end != 0.0 {
        return None;
    }
    let mut t = 0.5 * (low + high);
    for _ in 0..MAX_STEPS {
        let now = phase.at(t);
        let excess = now.position - position;
        if (excess > 0.0) == (start > 0.0) {
            low = t;
        } else {
            high = t;
        }
        let newton = t - excess / now.velocity;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if next == t || next <= low || next >= high {
            break;
        }
        t = next;
    }
    Some(t)
}
