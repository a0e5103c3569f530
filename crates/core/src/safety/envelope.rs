//! The envelope: what no command may leave, judged on the commands themselves.

use super::Fault;
use crate::geometry::Vector3;

/// Limits of the joints. Velocity, acceleration and jerk are symmetric and positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionLimits<const N: usize> {
    /// Lowest and highest position.
    pub position: [(f64, f64); N],
    /// Velocity.
    pub velocity: [f64; N],
    /// Acceleration.
    pub acceleration: [f64; N],
    /// Jerk.
    pub jerk: [f64; N],
}

/// A box in the base frame that the tool centre point must not leave, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorkspaceBox {
    /// Lowest corner.
    pub low: Vector3,
    /// Highest corner.
    pub high: Vector3,
}

/// Slack over the limits that rounding may use: positions are of the order of 1, differences divide by the period.
const VELOCITY_SLACK: f64 = 1.0 + 1e-6;
const ACCELERATION_SLACK: f64 = 1.0 + 1e-3;
/// Third differences of a command whose jerk switches within the period.
const JERK_SLACK: f64 = 1.01;
/// Rounding of a position, rad or m.
const POSITION_ROUNDING: f64 = 1e-14;

/// The last three commands, and the judgement over the next one: by differences, as a drive sees it.
#[derive(Debug, Clone, Copy)]
pub struct Envelope<const N: usize> {
    limits: MotionLimits<N>,
    workspace: WorkspaceBox,
    period: f64,
    /// The last three positions, latest first.
    history: [[f64; N]; 3],
}

impl<const N: usize> Envelope<N> {
    /// An envelope around an arm that stands still at `position`, commanded once per `period` (seconds).
    #[must_use]
    pub fn at_rest(
        position: [f64; N],
        limits: MotionLimits<N>,
        workspace: WorkspaceBox,
        period: f64,
    ) -> Self {
        Self { limits, workspace, period, history: [position; 3] }
    }

    /// Starts anew from standstill at `position`.
    pub fn restart(&mut self, position: [f64; N]) {
        self.history = [position; 3];
    }

    /// The last accepted command.
    #[must_use]
    pub fn last(&self) -> &[f64; N] {
        &self.history[0]
    }

    /// Accepts a command and remembers it.
    pub fn accept(&mut self, position: [f64; N]) {
        self.history = [position, self.history[0], self.history[1]];
    }

    /// Judges the next command with its tool centre point (base frame); `last` gives that of the last accepted command, where it is needed.
    ///
    /// # Errors
    /// The first [`Fault`] found; the command must then not be sent.
    pub fn judge(
        &self,
        position: &[f64; N],
        tcp: &Vector3,
        last: impl FnOnce() -> Vector3,
    ) -> Result<(), Fault> {
        for (axis, value) in position.iter().enumerate() {
            self.judge_axis(axis, *value)?;
        }
        let beyond = |at: &Vector3| (at - self.workspace.high).sup(&(self.workspace.low - at));
        let outside = beyond(tcp);
        let inside = |k: usize| outside[k] <= 0.0;
        // Where it stands outside, having been moved there without power, it may stay and move back.
        let nearer = |before: &Vector3| (0..3).all(|k| inside(k) || outside[k] <= before[k]);
        let permitted = (0..3).all(inside) || nearer(&beyond(&last()));
        if permitted { Ok(()) } else { Err(Fault::Workspace { position: *tcp }) }
    }

    fn judge_axis(&self, axis: usize, value: f64) -> Result<(), Fault> {
        if !value.is_finite() {
            return Err(Fault::NotFinite { axis });
        }
        let limits = &self.limits;
        let (low, high) = limits.position[axis];
        let past = [self.history[0][axis], self.history[1][axis], self.history[2][axis]];
        // An arm that stands outside its range may move back into it.
        if value < low && value < past[0] {
            return Err(Fault::PositionLimit { axis, value, limit: low });
        }
        if value > high && value > past[0] {
            return Err(Fault::PositionLimit { axis, value, limit: high });
        }
        let (t, rounding) = (self.period, POSITION_ROUNDING * (1.0 + value.abs()));
        let velocity = (value - past[0]) / t;
        if velocity.abs() > limits.velocity[axis] * VELOCITY_SLACK + rounding / t {
            return Err(Fault::VelocityLimit { axis, value: velocity, limit: limits.velocity[axis] });
        }
        let acceleration = (value - 2.0 * past[0] + past[1]) / (t * t);
        if acceleration.abs() > limits.acceleration[axis] * ACCELERATION_SLACK + rounding / (t * t) {
            return Err(Fault::AccelerationLimit {
                axis,
                value: acceleration,
                limit: limits.acceleration[axis],
            });
        }
        let jerk = (value - 3.0 * past[0] + 3.0 * past[1] - past[2]) / (t * t * t);
        if jerk.abs() > limits.jerk[axis] * JERK_SLACK + rounding / (t * t * t) {
            return Err(Fault::JerkLimit { axis, value: jerk, limit: limits.jerk[axis] });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: MotionLimits<1> =
        MotionLimits { position: [(-1.0, 1.0)], velocity: [2.0], acceleration: [10.0], jerk: [500.0] };
    const BOX: WorkspaceBox =
        WorkspaceBox { low: Vector3::new(-2.0, -2.0, -2.0), high: Vector3::new(2.0, 2.0, 2.0) };

    fn after(commands: &[f64]) -> Envelope<1> {
        let mut envelope = Envelope::at_rest([commands[0]], LIMITS, BOX, 1e-3);
        commands.iter().for_each(|q| envelope.accept([*q]));
        envelope
    }

    /// Positions of a constant velocity, three cycles long.
    fn steady(velocity: f64, end: f64) -> Envelope<1> {
        let at = |k: f64| end + velocity * 1e-3 * k;
        after(&[at(-2.0), at(-1.0), at(0.0)])
    }

    #[test]
    fn each_limit_is_found_and_named() {
        let tcp = Vector3::zeros();
        let judge = |envelope: Envelope<1>, q: f64| envelope.judge(&[q], &tcp, Vector3::zeros);
        assert_eq!(judge(steady(2.0, 0.5), 0.502), Ok(()));
        assert!(matches!(judge(steady(2.0, 0.5), 0.502_01), Err(Fault::VelocityLimit { axis: 0, .. })));
        assert!(matches!(judge(steady(1.0, 0.5), 0.501 + 1.1e-5), Err(Fault::AccelerationLimit { .. })));
        assert!(matches!(judge(steady(1.0, 0.5), 0.501 + 0.6e-6), Err(Fault::JerkLimit { .. })));
        assert_eq!(judge(steady(1.0, 0.5), 0.501 + 0.5e-6), Ok(()));
        assert!(matches!(judge(steady(1.0, 0.9995), 1.0005), Err(Fault::PositionLimit { limit: 1.0, .. })));
        assert_eq!(judge(steady(-1.0, 1.2), 1.199), Ok(()), "back into the range");
        assert_eq!(judge(steady(0.0, 0.0), f64::NAN), Err(Fault::NotFinite { axis: 0 }));
        let outside = Vector3::new(0.0, 2.1, 0.0);
        let from = |tcp: Vector3, last: Vector3| steady(0.0, 0.0).judge(&[0.0], &tcp, || last);
        assert!(matches!(from(outside, Vector3::zeros()), Err(Fault::Workspace { .. })));
        assert!(from(outside, Vector3::new(0.0, 2.09, 0.0)).is_err(), "farther out");
        assert!(from(Vector3::new(-2.1, 2.05, 0.0), outside).is_err(), "out on another side");
        assert_eq!(from(outside, outside), Ok(()), "where it stands");
        assert_eq!(from(Vector3::new(1.0, 2.09, 0.0), outside), Ok(()), "back into the box");
        let nowhere = Vector3::new(f64::NAN, 0.0, 0.0);
        assert!(from(nowhere, Vector3::zeros()).is_err() && from(nowhere, nowhere).is_err());
        assert!(from(outside, nowhere).is_err());
    }
}
