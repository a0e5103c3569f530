//! The answer: the motion of all axes.

use super::error::Error;
use super::extrema::PositionExtrema;
use super::input::{Input, State, Synchronization};
use super::profile::Profile;

/// The motion of every axis at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample<const N: usize> {
    /// Positions.
    pub position: [f64; N],
    /// Velocities.
    pub velocity: [f64; N],
    /// Accelerations.
    pub acceleration: [f64; N],
    /// Jerks.
    pub jerk: [f64; N],
}

impl<const N: usize> Sample<N> {
    /// Position, velocity and acceleration.
    #[must_use]
    pub fn state(&self) -> State<N> {
        State { position: self.position, velocity: self.velocity, acceleration: self.acceleration }
    }
}

/// The motion of all axes from the current state to the target. A plain value of about 0.8 kB an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trajectory<const N: usize> {
    pub(super) profiles: [Profile; N],
    pub(super) duration: f64,
    pub(super) duration_min: [f64; N],
    pub(super) synchronized: [Synchronization; N],
}

impl<const N: usize> Default for Trajectory<N> {
    /// No motion: every axis at rest at zero.
    fn default() -> Self {
        Self {
            profiles: [Profile::EMPTY; N],
            duration: 0.0,
            duration_min: [0.0; N],
            synchronized: [Synchronization::None; N],
        }
    }
}

impl<const N: usize> Trajectory<N> {
    /// Seconds until every axis has reached its target.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The least each axis alone would need, in seconds, brake included. Axes that keep to a line need what the
    /// motion along the line needs.
    #[must_use]
    pub fn duration_min(&self) -> &[f64; N] {
        &self.duration_min
    }

    /// How each axis is in fact synchronized: `None`, `Time` or `Phase`.
    #[must_use]
    pub fn synchronized(&self) -> &[Synchronization; N] {
        &self.synchronized
    }

    /// The motion of each axis.
    #[must_use]
    pub fn profiles(&self) -> &[Profile; N] {
        &self.profiles
    }

    /// The motion at a time, in seconds from the start.
    ///
    /// Before the start it is the start's, after the end the targets' going on at constant acceleration.
    #[must_use]
    pub fn at_time(&self, time: f64) -> Sample<N> {
        let zero = [0.0; N];
        let mut sample = Sample { position: zero, velocity: zero, acceleration: zero, jerk: zero };
        for (axis, profile) in self.profiles.iter().enumerate() {
            // At the duration it is the target's exactly, however the durations of the phases add up.
            let now = if time >= self.duration { profile.after_end(time) } else { profile.at(time) };
            sample.position[axis] = now.position;
            sample.velocity[axis] = now.velocity;
            sample.acceleration[axis] = now.acceleration;
            sample.jerk[axis] = now.jerk;
        }
        sample
    }

    /// The lowest and the highest position of each axis on the way, ends included.
    #[must_use]
    pub fn position_extrema(&self) -> [PositionExtrema; N] {
        core::array::from_fn(|axis| self.profiles[axis].position_extrema())
    }

    /// The first time at which an axis passes a position; `None` if it never does before the end, or there is no such axis.
    #[must_use]
    pub fn first_time_at_position(&self, axis: usize, position: f64) -> Option<f64> {
        self.profiles.get(axis)?.first_time_at_position(position)
    }

    /// Refuses a trajectory that leaves the position limits farther than its start does.
    pub(super) fn check_positions(&self, input: &Input<N>) -> Result<(), Error> {
        let (lowest, highest) = (&input.limits.position_min, &input.limits.position_max);
        for axis in 0..N {
            let limited = lowest[axis] > f64::NEG_INFINITY || highest[axis] < f64::INFINITY;
            if !limited || !input.enabled[axis] {
                continue;
            }
            let start = input.current.position[axis];
            let extrema = self.profiles[axis].position_extrema();
            if extrema.max > highest[axis].max(start) {
                let (position, time) = (extrema.max, extrema.time_max);
                return Err(Error::PositionLimit { axis, position, time, limit: highest[axis] });
            }
            if extrema.min < lowest[axis].min(start) {
                let (position, time) = (extrema.min, extrema.time_min);
                return Err(Error::PositionLimit { axis, position, time, limit: lowest[axis] });
            }
        }
        Ok(())
    }
}
