//! Why there is no trajectory.

use core::fmt;

/// The quantities an input holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// `current.position`.
    CurrentPosition,
    /// `current.velocity`.
    CurrentVelocity,
    /// `current.acceleration`.
    CurrentAcceleration,
    /// `target.position`.
    TargetPosition,
    /// `target.velocity`.
    TargetVelocity,
    /// `target.acceleration`.
    TargetAcceleration,
    /// `limits.velocity_max`.
    VelocityMax,
    /// `limits.velocity_min`.
    VelocityMin,
    /// `limits.acceleration_max`.
    AccelerationMax,
    /// `limits.acceleration_min`.
    AccelerationMin,
    /// `limits.jerk_max`.
    JerkMax,
    /// `limits.position_max`.
    PositionMax,
    /// `limits.position_min`.
    PositionMin,
}

impl Quantity {
    fn name(self) -> &'static str {
        match self {
            Self::CurrentPosition => "current position",
            Self::CurrentVelocity => "current velocity",
            Self::CurrentAcceleration => "current acceleration",
            Self::TargetPosition => "target position",
            Self::TargetVelocity => "target velocity",
            Self::TargetAcceleration => "target acceleration",
            Self::VelocityMax => "maximum velocity",
            Self::VelocityMin => "minimum velocity",
            Self::AccelerationMax => "maximum acceleration",
            Self::AccelerationMin => "minimum acceleration",
            Self::JerkMax => "maximum jerk",
            Self::PositionMax => "maximum position",
            Self::PositionMin => "minimum position",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Why there is no trajectory: which axis, which quantity, which values. Axes count from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Error {
    /// A number that must be finite is not.
    NotFinite {
        /// Axis.
        axis: usize,
        /// What is not finite.
        quantity: Quantity,
        /// Its value.
        value: f64,
    },
    /// A limit is not a number or has the wrong sign.
    BadLimit {
        /// Axis.
        axis: usize,
        /// Which limit.
        quantity: Quantity,
        /// Its value.
        value: f64,
    },
    /// The target state is beyond a limit, or cannot be reached without passing it.
    TargetBeyondLimit {
        /// Axis.
        axis: usize,
        /// Which part of the target.
        quantity: Quantity,
        /// Its value; for a velocity the one that the target acceleration makes unavoidable on the way.
        value: f64,
        /// The limit.
        limit: f64,
    },
    /// The requested minimum duration or duration step is negative, zero or not a number.
    BadDuration {
        /// What was asked for, in seconds.
        value: f64,
    },
    /// Nothing limits a motion that needs limits: velocity, acceleration and jerk are all infinite.
    Unlimited {
        /// Axis.
        axis: usize,
    },
    /// A zero limit keeps the axis from its target.
    Unreachable {
        /// Axis.
        axis: usize,
    },
    /// Phase synchronization was demanded, and the axes' displacements, velocities and accelerations are not parallel.
    NotCollinear {
        /// The axis that leaves the line.
        axis: usize,
    },
    /// The trajectory would leave the position limits.
    PositionLimit {
        /// Axis.
        axis: usize,
        /// The extreme position it would reach.
        position: f64,
        /// When, in seconds.
        time: f64,
        /// The limit.
        limit: f64,
    },
    /// The numbers are so large or so small that 64-bit floats cannot hold the solution.
    OutOfRange {
        /// Axis.
        axis: usize,
        /// What is farthest from one, by the number of digits.
        quantity: Quantity,
        /// Its value.
        value: f64,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { axis, quantity, value } => {
                write!(f, "axis {axis}: {quantity} is {value}, expected a finite number")
            }
            Self::BadLimit { axis, quantity, value } => {
                write!(f, "axis {axis}: {quantity} is {value}, which is not a number or has the wrong sign")
            }
            Self::TargetBeyondLimit { axis, quantity, value, limit } => {
                write!(f, "axis {axis}: {quantity} needs {value}, beyond the limit {limit}")
            }
            Self::BadDuration { value } => {
                write!(f, "a duration of {value} s was asked for, expected a positive finite one")
            }
            Self::Unlimited { axis } => {
                write!(f, "axis {axis}: velocity, acceleration and jerk are all unlimited")
            }
            Self::Unreachable { axis } => write!(f, "axis {axis}: a zero limit keeps it from its target"),
            Self::NotCollinear { axis } => {
                write!(f, "axis {axis}: displacement, velocity and acceleration are not parallel to the line")
            }
            Self::PositionLimit { axis, position, time, limit } => {
                write!(
                    f,
                    "axis {axis}: would reach position {position} at {time} s, beyond the limit {limit}"
                )
            }
            Self::OutOfRange { axis, quantity, value } => {
                write!(
                    f,
                    "axis {axis}: the solution is beyond the range of 64-bit floats; its {quantity} is {value}"
                )
            }
        }
    }
}

impl core::error::Error for Error {}
