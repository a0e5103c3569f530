//! Why a job cannot be run, in one message.

use std::fmt;
use std::io;

use thiserror::Error;

use crate::job::JobError;
use crate::plan::Problem;
use crate::robot::ArmError;

/// A place in a job file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file as its caller named it.
    pub file: String,
    /// Line, from 1.
    pub line: u32,
    /// Column in bytes, from 1.
    pub column: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file, self.line, self.column)
    }
}

/// Why a job cannot be checked or run.
#[derive(Debug, Error)]
pub enum RunError {
    /// The cell's arm cannot be used.
    #[error("robot: {0}")]
    Arm(#[from] ArmError),
    /// The cell's simulated drives cannot be set up.
    #[error("simulation: {0}")]
    Drive(#[from] crate::sim::SetupError),
    /// The cell's prefilters do not suit its cycle.
    #[error("vibration.prefilter: {0}")]
    Prefilter(#[from] seamline::vibration::StageError),
    /// The cell's seam sensor cannot be opened.
    #[error("{0}")]
    Sensor(#[from] crate::sensor::SensorError),
    /// A record of passes has a mistake.
    #[error("{path}: {mistake}")]
    Records {
        /// The file.
        path: String,
        /// Where, and what was expected.
        mistake: crate::sensor::TableError,
    },
    /// A record of passes leads too far.
    #[error(
        "{path}: a correction of {most_mm:.2} mm: expected up to {permitted_mm:.2} mm (sensor.correction_max_mm)"
    )]
    Correction {
        /// The file.
        path: String,
        /// The greatest correction.
        most_mm: f64,
        /// What the cell permits.
        permitted_mm: f64,
    },
    /// The program fails.
    #[error("{0}")]
    Job(#[from] JobError),
    /// A step cannot be planned.
    #[error("{at}: {problem}")]
    Plan {
        /// The instruction.
        at: Place,
        /// What is wrong.
        problem: Problem,
    },
    /// An input that the cell does not let be read.
    #[error("{at}: input {number} has no script, and the cell refuses such inputs (io.unscripted_input)")]
    UnscriptedInput {
        /// The instruction.
        at: Place,
        /// The input's number.
        number: u32,
    },
    /// A condition that never comes true.
    #[error("{at}: WAIT is never met by the scripted inputs, and the cell stops there (io.unmet_wait)")]
    UnmetWait {
        /// The instruction.
        at: Place,
    },
    /// The whole check found problems.
    #[error("{}", lines(.0))]
    Check(Vec<RunError>),
    /// The recording or another file cannot be written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// Why.
        source: io::Error,
    },
}

fn lines(errors: &[RunError]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}
