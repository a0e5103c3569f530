//! The stop off the path: every joint comes to rest within its own limits, as soon as it can.

use crate::drive::JointCommand;
use crate::otg::{Control, Input, Limits, State, Trajectory, calculate};
use crate::safety::MotionLimits;

/// A stop under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Halt<const N: usize> {
    /// `None` where the state to stop from was unusable: then the arm holds its position.
    trajectory: Option<Trajectory<N>>,
    position: [f64; N],
    elapsed: f64,
}

impl<const N: usize> Halt<N> {
    /// Stops from the state last commanded.
    pub(super) fn new(from: &JointCommand<N>, limits: &MotionLimits<N>) -> Self {
        let JointCommand { position, velocity, acceleration } = *from;
        let current = State { position, velocity, acceleration };
        let motion = Limits::symmetric(limits.velocity, limits.acceleration, limits.jerk);
        let mut input = Input::new(current, State::at_rest(position), motion);
        input.control = [Control::Velocity; N];
        Self { trajectory: calculate(&input).ok(), position, elapsed: 0.0 }
    }

    /// The next command, one period on.
    pub(super) fn step(&mut self, period: f64) -> JointCommand<N> {
        self.elapsed += period;
        let Some(trajectory) = &self.trajectory else { return JointCommand::at_rest(self.position) };
        let sample = trajectory.at_time(self.elapsed);
        let (position, velocity) = (sample.position, sample.velocity);
        JointCommand { position, velocity, acceleration: sample.acceleration }
    }

    /// All joints are at rest.
    pub(super) fn is_done(&self) -> bool {
        self.trajectory.as_ref().is_none_or(|trajectory| self.elapsed >= trajectory.duration())
    }
}
