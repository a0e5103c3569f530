//! What stands between the cycle and the motors.

/// Joint command of one cycle. Position units: radians (revolute) or metres (prismatic); derivatives per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointCommand<const N: usize> {
    /// Position set point.
    pub position: [f64; N],
    /// Velocity at this instant, for feed-forward.
    pub velocity: [f64; N],
    /// Acceleration at this instant, for feed-forward.
    pub acceleration: [f64; N],
}

impl<const N: usize> JointCommand<N> {
    /// Standing still at a position.
    #[must_use]
    pub fn at_rest(position: [f64; N]) -> Self {
        Self { position, velocity: [0.0; N], acceleration: [0.0; N] }
    }
}

/// Why a drive did not take a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveFault {
    /// No answer within the period.
    Silent,
    /// An axis reports a fault of its own (axis index, the drive's code).
    Axis(usize, u32),
}

/// A group of servo drives in cyclic synchronous position mode, simulated or real.
pub trait Drive<const N: usize> {
    /// Hands over the command of this cycle and returns the joint positions measured now.
    ///
    /// Called once per period (seconds); neither allocates nor blocks longer than the bus needs.
    ///
    /// # Errors
    /// [`DriveFault`] where the drives are silent or report a fault: the cycle then stops with category 0.
    fn exchange(&mut self, command: &JointCommand<N>, period: f64) -> Result<[f64; N], DriveFault>;
}
