//! What a new target does to axes in motion.
//!
//! # The limits of a continuous takeover
//! The generator needs limits, and a timed motion has none: V, A and J follow from the way and the time. An axis with
//! velocity v₀ and acceleration a₀ gets limits within which it can surely arrive at T, because the sum of these three
//! motions does:
//!
//! 1. the acceleration falls to zero at constant jerk, in n²T, the time of the profile's own jerk phases. That adds the
//!    velocity a₀n²T/2;
//! 2. the velocity v₁ = v₀ + a₀n²T/2 is taken away by the profile's own ramp, in nT; its acceleration and jerk are (5)
//!    and (6) with v₁ for V. With 1 and 2 alone the axis would rest d = v₀nT/2 + a₀n²T (nT/4 − n²T/6) from its start;
//! 3. the rest of the way, G − p₀ − d, is a timed profile of duration T, whose velocity V′ is (4).
//!
//! The sum begins with p₀, v₀, a₀, ends at rest in G after T, and keeps
//!
//! ```text
//! V = |V′| + |v₀| + |a₀| n²T/2      A = (|V′| + |v₁|) / (T (n − n²)) + |a₀|      J = A / (T n²)
//! ```
//!
//! So T is possible within them, and the generator, asked for T at least, arrives at T. The three are sums of greatest
//! values: the motion itself mostly stays below. At rest they are (4), (5) and (6), and the motion is the profile. The
//! start lies within them (v₀ + a₀²/(2J) ≤ V), so that no brake comes first.

use super::error::Error;
use crate::otg::{Input, Limits, State, Synchronization, Trajectory, calculate};

/// What a new target does to axes in motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Takeover {
    /// The new plan takes over position, velocity and acceleration: nothing jumps but the jerk.
    #[default]
    Continuous,
    /// The new plan starts at rest where the axes are, as the paper prints it: velocity and acceleration jump to zero.
    RestartFromRest,
}

/// The limits of a motion from `current` to rest in `target` in the time `duration`; derivation above.
pub(super) fn limits<const N: usize>(
    current: &State<N>,
    target: &[f64; N],
    duration: f64,
    n: f64,
) -> Limits<N> {
    let (ramp, jerk_phase) = (n * duration, n * n * duration);
    let (mut velocity, mut acceleration) = ([0.0; N], [0.0; N]);
    for axis in 0..N {
        let (v0, a0) = (current.velocity[axis], current.acceleration[axis]);
        let v1 = v0 + a0 * jerk_phase / 2.0;
        let stop = v0 * ramp / 2.0 + a0 * jerk_phase * (ramp / 4.0 - jerk_phase / 6.0);
        let way = target[axis] - current.position[axis] - stop;
        let cruise = (way / (duration * (1.0 - n))).abs();
        velocity[axis] = cruise + v0.abs() + a0.abs() * jerk_phase / 2.0;
        acceleration[axis] = (cruise + v1.abs()) / (ramp - jerk_phase) + a0.abs();
    }
    Limits::symmetric(velocity, acceleration, acceleration.map(|a| a / jerk_phase))
}

/// The motion from `current` to rest in `target` within these limits that takes at least `duration` seconds.
///
/// Where way, velocities and accelerations are parallel, the axes keep to the line.
pub(super) fn plan<const N: usize>(
    current: &State<N>,
    target: &[f64; N],
    duration: f64,
    limits: &Limits<N>,
) -> Result<Trajectory<N>, Error> {
    let mut input = Input::new(*current, State::at_rest(*target), *limits);
    input.duration_min = Some(duration);
    input.synchronization = [Synchronization::Phase; N];
    // An axis without limits rests where it is to be.
    input.enabled = limits.acceleration_max.map(|limit| limit > 0.0);
    calculate(&input).map_err(Error::Takeover)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::timed::TimedProfile;

    const N: f64 = 0.3;
    const DURATION: f64 = 2.0;

    /// From rest the generator finds the profile itself, within the profile's own velocity, acceleration and jerk.
    #[test]
    fn from_rest_the_takeover_is_the_profile() {
        let (current, target) = (State::at_rest([0.2, 1.0]), [0.7, -3.0]);
        let profile = TimedProfile::new(current.position, target, DURATION, N).unwrap();
        let limits = limits(&current, &target, DURATION, N);
        for axis in 0..2 {
            let close = |a: f64, b: f64| assert!((a - b.abs()).abs() <= 1e-14 * a, "{a} {b}");
            close(limits.velocity_max[axis], profile.velocity()[axis]);
            close(limits.acceleration_max[axis], profile.acceleration()[axis]);
            close(limits.jerk_max[axis], profile.jerk()[axis]);
        }
        let trajectory = plan(&current, &target, DURATION, &limits).unwrap();
        assert!((trajectory.duration() - DURATION).abs() < 1e-14);
        for step in 0..=100 {
            let time = 0.02 * f64::from(step);
            let (one, other) = (trajectory.at_time(time), profile.at_time(time));
            for axis in 0..2 {
                assert!((one.position[axis] - other.position[axis]).abs() < 1e-12);
                assert!((one.velocity[axis] - other.velocity[axis]).abs() < 1e-11);
            }
        }
    }

    /// What starts within its limits needs no brake, whatever the signs.
    #[test]
    fn no_brake_comes_first() {
        for velocity in [-3.0, -0.1, 0.0, 2.0] {
            for acceleration in [-5.0, 0.0, 0.3, 40.0] {
                for target in [-2.0, 0.0, 0.01, 7.0] {
                    let current =
                        State { position: [0.0], velocity: [velocity], acceleration: [acceleration] };
                    let limits = limits(&current, &[target], DURATION, N);
                    let trajectory = plan(&current, &[target], DURATION, &limits).unwrap();
                    assert!(trajectory.profiles()[0].brake().is_empty(), "{current:?} {target}");
                    assert!((trajectory.duration() - DURATION).abs() <= 1e-12, "{current:?} {target}");
                }
            }
        }
    }
}
