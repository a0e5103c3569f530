//! Tier 1: what the drives measured, held against what they should have done.

use crate::math::float::exp;
use crate::safety::Fault;

/// Share of the innovation that the observer takes over in each cycle.
const OBSERVER_GAIN: f64 = 0.2;

/// The drives' expected behaviour: a first-order lag with velocity feed-forward, τ ẏ = u + k τ u̇ − y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoModel<const N: usize> {
    /// Time constant τ of each joint, in seconds; 0 where the drive follows at once.
    pub lag: [f64; N],
    /// Feed-forward k of each joint, 0 … 1.
    pub feed_forward: [f64; N],
    /// Permitted deviation of the measurement from the model, rad or m.
    pub following_error: [f64; N],
}

/// Expected and estimated joint positions.
///
/// Expected (no measurement enters, so that a sticking axis shows): ê[k+1] = ê[k] + (1 − e^(−T/τ)) (w[k] − ê[k]), the
/// exact discrete lag of the driven position w = u + k τ u̇; gain 1, delay (1 − k) τ. Estimated: the same step from the
/// last estimate, corrected by a fifth of the difference to the measurement; gain 1, no delay beyond the drive's own,
/// and a fifth of the encoder's noise in amplitude at the highest frequencies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observer<const N: usize> {
    model: ServoModel<N>,
    period: f64,
    share: [f64; N],
    /// The command before the last.
    command: [f64; N],
    expected: [f64; N],
    estimated: [f64; N],
}

impl<const N: usize> Observer<N> {
    pub(super) fn at_rest(position: [f64; N], model: ServoModel<N>, period: f64) -> Self {
        let share = model.lag.map(|lag| if lag > 0.0 { 1.0 - exp(-period / lag) } else { 1.0 });
        Self { model, period, share, command: position, expected: position, estimated: position }
    }

    pub(super) fn restart(&mut self, position: [f64; N]) {
        (self.command, self.expected, self.estimated) = (position, position, position);
    }

    /// Filtered joint positions.
    pub(super) fn estimated(&self) -> &[f64; N] {
        &self.estimated
    }

    /// Takes the positions that were measured when `command` was handed over, and then lets the model follow that
    /// command for one period. The joint that is furthest off its model beyond what is permitted is a fault.
    pub(super) fn update(&mut self, command: &[f64; N], measured: &[f64; N]) -> Result<(), Fault> {
        let mut worst = Ok(());
        let mut excess = 1.0;
        for axis in 0..N {
            if !measured[axis].is_finite() {
                return Err(Fault::NotFinite { axis });
            }
            let value = measured[axis] - self.expected[axis];
            let limit = self.model.following_error[axis];
            if value.abs() > excess * limit {
                excess = value.abs() / limit;
                worst = Err(Fault::FollowingError { axis, value, limit });
            }
            self.estimated[axis] += OBSERVER_GAIN * (measured[axis] - self.estimated[axis]);
            let speed = (command[axis] - self.command[axis]) / self.period;
            let driven = command[axis] + self.model.feed_forward[axis] * self.model.lag[axis] * speed;
            self.expected[axis] += self.share[axis] * (driven - self.expected[axis]);
            self.estimated[axis] += self.share[axis] * (driven - self.estimated[axis]);
        }
        self.command = *command;
        worst
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: ServoModel<2> =
        ServoModel { lag: [0.01, 0.0], feed_forward: [0.5, 0.0], following_error: [0.02, 0.01] };

    /// Two drives by the recurrence of their law; the reading comes before the command acts.
    struct Drives {
        position: [f64; 2],
        command: f64,
    }

    impl Drives {
        fn exchange(&mut self, command: [f64; 2]) -> [f64; 2] {
            let reading = self.position;
            let driven = command[0] + 0.5 * 0.01 * (command[0] - self.command) / 1e-3;
            self.position[0] += (1.0 - (-0.1_f64).exp()) * (driven - self.position[0]);
            self.position[1] = command[1];
            self.command = command[0];
            reading
        }
    }

    #[test]
    fn a_drive_that_follows_its_model_is_no_fault_and_a_sticking_one_is() {
        let mut observer = Observer::at_rest([0.0; 2], MODEL, 1e-3);
        let mut drives = Drives { position: [0.0; 2], command: 0.0 };
        for k in 0..2_000 {
            let command = [0.002 * f64::from(k), -0.001 * f64::from(k)];
            let reading = drives.exchange(command);
            assert_eq!(observer.update(&command, &reading), Ok(()));
            assert!((observer.estimated()[0] - drives.position[0]).abs() < 1e-12);
        }
        let stuck = drives.position[1];
        let fault = (0..100).find_map(|k| {
            let command = [4.0, stuck - 0.001 * f64::from(k)];
            let reading = drives.exchange(command);
            observer.update(&command, &[reading[0], stuck]).err()
        });
        assert!(matches!(fault, Some(Fault::FollowingError { axis: 1, limit: 0.01, .. })), "{fault:?}");
    }

    #[test]
    fn encoder_noise_is_damped() {
        let mut observer = Observer::at_rest([0.0; 2], MODEL, 1e-3);
        let mut largest = 0.0_f64;
        for k in 0..1_000 {
            let noise = if k % 2 == 0 { 1e-3 } else { -1e-3 };
            observer.update(&[0.0; 2], &[noise; 2]).unwrap();
            largest = largest.max(observer.estimated()[0].abs());
        }
        assert!(largest < 2.5e-4, "{largest}");
    }

    #[test]
    fn not_a_number_is_named() {
        let mut observer = Observer::at_rest([0.0; 2], MODEL, 1e-3);
        assert_eq!(observer.update(&[0.0; 2], &[0.0, f64::NAN]), Err(Fault::NotFinite { axis: 1 }));
    }
}
