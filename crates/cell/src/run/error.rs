//! Why a job cannot be run, in one message.

use std::io;

use thiserror::Error;

use crate::job::JobError;
use crate::plan::{ArmError, Problem};

/// Why a job cannot be checked or run.
#[derive(Debug, Error)]
pub enum RunError {
    /// The cell's arm cannot be used.
    #[error("{0}")]
    Arm(#[from] ArmError),
    /// The cell's simulated drives cannot be set up.
    #[error("simulation: {0}")]
    Drive(#[from] crate::sim::SetupError),
    /// The program fails.
    #[error("{0}")]
    Job(#[from] JobError),
    /// A step cannot be planned.
    #[error("{file}:{line}: {problem}")]
    Plan {
        /// The job file.
        file: String,
        /// Line in it.
        line: u32,
        /// What is wrong.
        problem: Problem,
    },
    /// An input that the cell does not let be read.
    #[error(
        "{file}:{line}: input {number} has no script, and the cell refuses such inputs (io.unscripted_input)"
    )]
    UnscriptedInput {
        /// The job file.
        file: String,
        /// Line in it.
        line: u32,
        /// The input's number.
        number: u32,
    },
    /// A condition that never comes true.
    #[error(
        "{file}:{line}: WAIT is never met by the scripted inputs, and the cell stops there (io.unmet_wait)"
    )]
    UnmetWait {
        /// The job file.
        file: String,
        /// Line in it.
        line: u32,
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
