//! The plain motion: rest to rest under path limits alone, seven phases of constant jerk.

use super::PathLimits;
use super::motion::{PathState, TimingPiece, constant_jerk};

/// The time-optimal motion over `length` from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SCurve {
    pub(super) length: f64,
    /// Highest speed.
    pub(super) speed: f64,
    jerk: f64,
    /// Durations of one jerk phase, of constant acceleration, and of constant speed.
    jerk_time: f64,
    acceleration_time: f64,
    cruise_time: f64,
}

impl SCurve {
    pub(super) fn new(length: f64, limits: &PathLimits) -> Self {
        let PathLimits { speed, acceleration, jerk } = *limits;
        // The speed at which the acceleration is reached for an instant only.
        let knee = acceleration * acceleration / jerk;
        let highest = if 2.0 * knee * acceleration / jerk <= length {
            // L = v (v/A + A/J), solved without cancellation.
            let root = (knee * knee + 4.0 * acceleration * length).sqrt();
            2.0 * acceleration * length / (knee + root)
        } else {
            // L = 2 v √(v/J)
            (length * length * jerk / 4.0).cbrt()
        };
        let peak = speed.min(highest);
        let (jerk_time, acceleration_time) = if peak >= knee {
            (acceleration / jerk, (peak / acceleration - acceleration / jerk).max(0.0))
        } else {
            ((peak / jerk).sqrt(), 0.0)
        };
        let ramp = peak * (2.0 * jerk_time + acceleration_time);
        let cruise_time = if highest <= speed { 0.0 } else { ((length - ramp) / peak).max(0.0) };
        Self { length, speed: peak, jerk, jerk_time, acceleration_time, cruise_time }
    }

    /// Length of the way that either ramp takes; constant speed is held from here to the same distance from
    /// the end.
    pub(super) fn ramp(&self) -> f64 {
        (self.length - self.speed * self.cruise_time) / 2.0
    }

    /// The pieces of the way from rest to the highest speed.
    pub(super) fn accelerating(&self) -> impl Iterator<Item = TimingPiece> + use<> {
        self.phases(&PathState::default(), self.jerk)
    }

    /// The piece at the highest speed between two places.
    pub(super) fn cruising(&self, from: f64, to: f64) -> TimingPiece {
        TimingPiece {
            duration: (to - from) / self.speed,
            position: from,
            velocity: self.speed,
            ..TimingPiece::default()
        }
    }

    /// The pieces of the way from the highest speed to rest at the end.
    pub(super) fn decelerating(&self) -> impl Iterator<Item = TimingPiece> + use<> {
        let start =
            PathState { position: self.length - self.ramp(), velocity: self.speed, ..PathState::default() };
        self.phases(&start, -self.jerk)
    }

    /// All pieces.
    pub(super) fn pieces(&self) -> Vec<TimingPiece> {
        let cruise = self.cruising(self.ramp(), self.length - self.ramp());
        let cruise = (self.cruise_time > 0.0).then_some(cruise);
        self.accelerating().chain(cruise).chain(self.decelerating()).collect()
    }

    fn phases(&self, start: &PathState, jerk: f64) -> impl Iterator<Item = TimingPiece> + use<> {
        let phases = [(jerk, self.jerk_time), (0.0, self.acceleration_time), (-jerk, self.jerk_time)];
        let mut state = *start;
        phases.into_iter().filter(|&(_, duration)| duration > 0.0).map(move |(jerk, duration)| {
            let piece = constant_jerk(&state, jerk, duration);
            state = piece.end();
            piece
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: PathLimits = PathLimits { speed: 0.25, acceleration: 10.0, jerk: 500.0 };

    /// Lengths over seven decades and three speeds: the motion ends at rest at the end, keeps its limits, and
    /// one of them is always at work.
    #[test]
    fn every_length_ends_at_rest_within_its_limits() {
        for speed in [0.005, 0.25, 3.0] {
            let limits = PathLimits { speed, ..LIMITS };
            for step in 0..140 {
                let length = 10f64.powf(-5.0 + 0.05 * f64::from(step));
                let curve = SCurve::new(length, &limits);
                let pieces = curve.pieces();
                let mut state = PathState::default();
                for piece in &pieces {
                    let start = piece.at(0.0);
                    assert!((start.position - state.position).abs() <= 1e-12 * length, "{length} {speed}");
                    assert!((start.velocity - state.velocity).abs() <= 1e-12 * speed);
                    assert!((start.acceleration - state.acceleration).abs() <= 1e-10 * limits.acceleration);
                    state = piece.end();
                    assert!(state.velocity <= speed * (1.0 + 1e-12));
                    assert!(state.acceleration.abs() <= limits.acceleration * (1.0 + 1e-12));
                    assert!(piece.jerk.abs() <= limits.jerk);
                }
                assert!((state.position - length).abs() <= 1e-12 * length);
                assert!(state.velocity.abs() <= 1e-12 * speed);
                let reaches_speed = curve.speed >= speed;
                assert!(reaches_speed || curve.cruise_time == 0.0);
            }
        }
    }
}
