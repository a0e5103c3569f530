//! Motion off the path: every joint within its own limits, to rest as soon as it can, or back to the path.

use crate::drive::JointCommand;
use crate::otg::{Control, Input, Limits, State, Trajectory, calculate};
use crate::safety::MotionLimits;

/// Share of the joints' velocity and acceleration limits on the way back.
const GENTLE: f64 = 0.2;

/// A motion under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct OffPath<const N: usize> {
    /// `None` where the state to start from was unusable: then the arm holds its position.
    trajectory: Option<Trajectory<N>>,
    position: [f64; N],
    elapsed: f64,
    returns: bool,
}

impl<const N: usize> OffPath<N> {
    /// Stops from the state last commanded.
    pub(super) fn stop(from: &JointCommand<N>, limits: &MotionLimits<N>) -> Self {
        let motion = Limits::symmetric(limits.velocity, limits.acceleration, limits.jerk);
        let mut input = Input::new(state(from), State::at_rest(from.position), motion);
        input.control = [Control::Velocity; N];
        Self::along(&input, false)
    }

    /// Goes from the state last commanded to rest at joint positions of the path.
    pub(super) fn back_to(position: [f64; N], from: &JointCommand<N>, limits: &MotionLimits<N>) -> Self {
        let gentle = |limit: [f64; N]| limit.map(|value| GENTLE * value);
        let motion = Limits::symmetric(gentle(limits.velocity), gentle(limits.acceleration), limits.jerk);
        Self::along(&Input::new(state(from), State::at_rest(position), motion), true)
    }

    fn along(input: &Input<N>, returns: bool) -> Self {
        let position = input.current.position;
        Self { trajectory: calculate(input).ok(), position, elapsed: 0.0, returns }
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

    /// It leads back to the path; otherwise it is a stop.
    pub(super) fn returns(&self) -> bool {
        self.returns
    }
}

fn state<const N: usize>(command: &JointCommand<N>) -> State<N> {
    let JointCommand { position, velocity, acceleration } = *command;
    State { position, velocity, acceleration }
}
