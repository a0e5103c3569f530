//! Why there is no timed motion.

use core::fmt;

use crate::otg;

/// The quantities that a timed motion is asked for with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Where the motion starts.
    Start,
    /// Where it ends.
    Target,
}

/// Why there is no timed motion: which quantity, which value. Axes count from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Error {
    /// A position is not a finite number.
    NotFinite {
        /// Axis.
        axis: usize,
        /// Which position.
        quantity: Quantity,
        /// Its value.
        value: f64,
    },
    /// The duration is not a positive finite number.
    BadDuration {
        /// What was asked for, in seconds.
        value: f64,
    },
    /// The time-scale factor n is not above 0 and at most 1/2.
    BadTimeScale {
        /// What was asked for.
        value: f64,
    },
    /// The instant of a new target is not a finite number.
    BadInstant {
        /// What was given, in seconds.
        value: f64,
    },
    /// Velocity, acceleration or jerk is beyond the range of 64-bit floats.
    OutOfRange {
        /// Axis.
        axis: usize,
    },
    /// The generator found no motion from the axis' state to the target.
    Takeover(otg::Error),
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Start => "start",
            Self::Target => "target",
        })
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { axis, quantity, value } => {
                write!(f, "axis {axis}: {quantity} is {value}, expected a finite number")
            }
            Self::BadDuration { value } => {
                write!(f, "a duration of {value} s was asked for, expected a positive finite one")
            }
            Self::BadTimeScale { value } => {
                write!(f, "the time-scale factor n is {value}, expected a number above 0, at most 0.5")
            }
            Self::BadInstant { value } => {
                write!(f, "a new target came at {value} s, expected a finite number")
            }
            Self::OutOfRange { axis } => {
                write!(f, "axis {axis}: velocity, acceleration or jerk is beyond the range of 64-bit floats")
            }
            Self::Takeover(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for Error {}
