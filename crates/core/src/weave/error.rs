//! Why there is no such weave.

use core::fmt;

/// A weave that cannot be, with its evidence. Metres; shares of the period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WeaveError {
    /// The amplitude is negative or not a number.
    Amplitude {
        /// As given.
        value: f64,
    },
    /// A period without length.
    Wavelength {
        /// As given.
        value: f64,
    },
    /// A dwell is negative or not a number, or the dwells leave less than a tenth of the period to swing.
    Dwells {
        /// All of a period's dwells together.
        share: f64,
    },
    /// A figure of eight and a circle do not stop at the edges.
    NoDwells,
    /// Tilt or elevation is not a number.
    NotFinite,
    /// It ends before it begins.
    Part {
        /// Where it begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
}

impl fmt::Display for WeaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Amplitude { value } => {
                write!(f, "weave amplitude {:.3} mm: expected 0 or more", value * 1e3)
            }
            Self::Wavelength { value } => {
                write!(f, "way of a weave period {:.3} mm: expected more than 0", value * 1e3)
            }
            Self::Dwells { share } => {
                write!(f, "dwells take {:.0} % of the weave's period: expected at most 90 %", share * 100.0)
            }
            Self::NoDwells => write!(f, "a figure of eight or a circle has no dwells"),
            Self::NotFinite => write!(f, "a value of the weave is not a number"),
            Self::Part { from, to } => write!(f, "a weave from {from} m to {to} m of the seam"),
        }
    }
}

impl core::error::Error for WeaveError {}
