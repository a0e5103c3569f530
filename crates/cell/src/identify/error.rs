//! Why there is no identification.

use thiserror::Error;

use super::MIN_SAMPLES;

/// What is wrong with a signal.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum IdentifyError {
    /// Too few samples.
    #[error("{samples} samples: expected at least {MIN_SAMPLES}")]
    TooShort {
        /// How many there are.
        samples: usize,
    },
    /// A time or value that is not a number.
    #[error("sample {sample}: expected finite numbers")]
    NotFinite {
        /// Which, from 0.
        sample: usize,
    },
    /// Times that do not rise in nearly equal steps.
    #[error("sample {sample} comes {step} s after the one before: expected about {period} s, as on the mean")]
    Uneven {
        /// Which, from 0.
        sample: usize,
        /// Its distance from the one before, in seconds.
        step: f64,
        /// The mean distance, in seconds.
        period: f64,
    },
    /// Nothing but noise.
    #[error("no decaying vibration stands out of the noise")]
    NoVibration,
}

/// What is wrong with a file, and where.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CsvError {
    /// A line that is not two numbers.
    #[error(
        "line {line}: `{text}`: expected two numbers, time_s and acceleration, with a comma between them"
    )]
    Line {
        /// From 1.
        line: usize,
        /// What stands there, cut to a readable length.
        text: String,
    },
    /// A time that does not rise.
    #[error("line {line}: time {time} s: expected more than {last} s, the one before")]
    Time {
        /// From 1.
        line: usize,
        /// As it stands there.
        time: f64,
        /// The one before.
        last: f64,
    },
    /// A file without samples.
    #[error("no samples: expected lines of time_s, acceleration")]
    Empty,
}
