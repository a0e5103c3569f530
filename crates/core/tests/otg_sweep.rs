//! Random problems of every distribution, each trajectory judged by integration.
#![allow(clippy::panic)] // what its tests share is test code too

mod otg_support;

use otg_support::cases::{self, Distribution, random_input};
use otg_support::judge::judge;
use otg_support::random::Random;
use seamline::otg::{Control, Input, State, Synchronization, calculate};

/// Calculates and judges; the first failure ends the sweep, and names seed and verdict.
fn sweep<const N: usize>(
    distribution: Distribution,
    cases: usize,
    synchronization: Synchronization,
    control: Control,
) {
    let mut random = Random(1);
    for case in 0..cases {
        let seed = random.0;
        let mut input = random_input::<N>(&mut random, distribution);
        input.synchronization = [synchronization; N];
        input.control = [control; N];
        let trajectory = calculate(&input).unwrap_or_else(|error| {
            panic!("{distribution:?} {case} (seed {seed}): {error}\n{input:?}");
        });
        let verdict = judge(&input, &trajectory, synchronization == Synchronization::Time);
        assert!(verdict.is_good(), "{distribution:?} {case} (seed {seed}): {verdict:?}\n{input:?}");
    }
}

/// 9 × 20,000 problems of one axis: every one has a trajectory that keeps its limits and reaches its target.
#[test]
fn single_axis() {
    for distribution in cases::ALL {
        sweep::<1>(distribution, 20_000, Synchronization::None, Control::Position);
    }
}

/// 9 × 5,000 problems of six axes that arrive together.
#[test]
fn six_axes_in_time() {
    for distribution in cases::ALL {
        sweep::<6>(distribution, 5_000, Synchronization::Time, Control::Position);
    }
}

/// 9 × 5,000 problems of three axes of which those at rest at the target may arrive early.
#[test]
fn three_axes_in_time_if_necessary() {
    for distribution in cases::ALL {
        sweep::<3>(distribution, 5_000, Synchronization::TimeIfNecessary, Control::Position);
    }
}

/// 9 × (20,000 + 5,000) problems of velocity control, one axis and six that arrive together.
#[test]
fn velocity_control() {
    for distribution in cases::ALL {
        sweep::<1>(distribution, 20_000, Synchronization::None, Control::Velocity);
        sweep::<6>(distribution, 5_000, Synchronization::Time, Control::Velocity);
    }
}

/// 9 × 2 × 5,000 problems of six axes from rest to rest, in time and along lines; one limit in ten is infinite.
#[test]
fn rest_to_rest() {
    for distribution in cases::ALL {
        for synchronization in [Synchronization::Time, Synchronization::PhaseStrict] {
            let mut random = Random(2);
            for case in 0..5_000 {
                let mut input: Input<6> = random_input(&mut random, distribution);
                input.current = State::at_rest(input.current.position);
                input.target = State::at_rest(input.target.position);
                input.synchronization = [synchronization; 6];
                let l = &mut input.limits;
                for limit in l.velocity_max.iter_mut().chain(&mut l.acceleration_max) {
                    *limit = if random.chance(0.1) { f64::INFINITY } else { *limit };
                }
                for limit in l.velocity_min.iter_mut().chain(&mut l.acceleration_min) {
                    *limit = if random.chance(0.1) { f64::NEG_INFINITY } else { *limit };
                }
                if random.chance(0.3) {
                    let least = calculate(&input).map_or(0.0, |trajectory| trajectory.duration());
                    input.duration_min = Some(least * (1.0 + random.log_uniform(1e-15, 1e6)));
                }
                let trajectory = calculate(&input).unwrap_or_else(|error| {
                    panic!("{distribution:?} {synchronization:?} {case}: {error}\n{input:?}");
                });
                let verdict = judge(&input, &trajectory, true);
                assert!(
                    verdict.is_good(),
                    "{distribution:?} {synchronization:?} {case}: {verdict:?}\n{input:?}"
                );
            }
        }
    }
}
