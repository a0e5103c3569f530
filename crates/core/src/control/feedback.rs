//! Tier 1: what the drives measured, held against what they should have done.

use crate::math::float::exp;
use crate::safety::Fault;

/// Share of the innovation that the observer takes over in each cycle.
const OBSERVER_GAIN: f64 = 0.2;

/// The drives' expected behaviour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoModel<const N: usize> {
    /// Time constant of each joint's first-order lag, in seconds; 0 where the drive follows at once.
    pub lag: [f64; N],
    /// Permitted deviation of the measurement from the model, rad or m.
    pub following_error: [f64; N],
}

/// Expected and estimated joint positions.
///
/// Expected (no measurement enters, so that a sticking axis shows): ê[k+1] = ê[k] + (1 − e^(−T/τ)) (u[k] − ê[k]), the
/// exact discrete first-order lag τ of the command u; gain 1, delay τ. Estimated: the same step from the last estimate,
/// corrected by a fifth of the difference to the measurement; gain 1, no delay beyond the drive's own, and a fifth of
/// the encoder's noise in amplitude at the highest frequencies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observer<const N: usize> {
    model: ServoModel<N>,
    share: [f64; N],
    expected: [f64; N],
    estimated: [f64; N],
}

impl<const N: usize> Observer<N> {
    pub(super) fn at_rest(position: [f64; N], model: ServoModel<N>, period: f64) -> Self {
        let share = model.lag.map(|lag| if lag > 0.0 { 1.0 - exp(-period / lag) } else { 1.0 });
        Self { model, share, expected: position, estimated: position }
    }

    pub(super) fn restart(&mut self, position: [f64; N]) {
        (self.expected, self.estimated) = (position, position);
    }

    /// Filtered joint positions.
    pub(super) fn estimated(&self) -> &[f64; N] {
        &self.estimated
    }

    /// Takes over the measurement that answers `command`; the joint that is furthest off its model beyond what is
    /// permitted is a fault.
    pub(super) fn update(&mut self, command: &[f64; N], measured: &[f64; N]) -> Result<(), Fault> {
        let mut worst = Ok(());
        let mut excess = 1.0;
        for axis in 0..N {
            if !measured[axis].is_finite() {
                return Err(Fault::NotFinite { axis });
            }
            let share = self.share[axis];
            self.expected[axis] += share * (command[axis] - self.expected[axis]);
            let predicted = self.estimated[axis] + share * (command[axis] - self.estimated[axis]);
            self.estimated[axis] = predicted + OBSERVER_GAIN * (measured[axis] - predicted);
            let value = measured[axis] - self.expected[axis];
            let limit = self.model.following_error[axis];
            if value.abs() > excess * limit {
                excess = value.abs() / limit;
                worst = Err(Fault::FollowingError { axis, value, limit });
            }
        }
        worst
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: ServoModel<2> = ServoModel { lag: [0.01, 0.0], following_error: [0.02, 0.01] };

    #[test]
    fn a_drive_that_follows_its_model_is_no_fault_and_a_sticking_one_is() {
        let mut observer = Observer::at_rest([0.0; 2], MODEL, 1e-3);
        let mut joint = [0.0, 0.0];
        for k in 0..2_000 {
            let command = [0.002 * f64::from(k), -0.001 * f64::from(k)];
            joint[0] += (1.0 - (-0.1_f64).exp()) * (command[0] - joint[0]);
            joint[1] = command[1];
            assert_eq!(observer.update(&command, &joint), Ok(()));
            assert!((observer.estimated()[0] - joint[0]).abs() < 1e-12);
        }
        let stuck = joint;
        let fault = (0..100).find_map(|k| {
            let command = [4.0, -2.0 - 0.001 * f64::from(k)];
            joint[0] += (1.0 - (-0.1_f64).exp()) * (command[0] - joint[0]);
            observer.update(&command, &[joint[0], stuck[1]]).err()
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
