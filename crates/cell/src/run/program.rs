//! What is run: an INFORM job with the jobs that it calls, or a G-code program.

use std::path::Path;

use super::error::Place;
use crate::gcode;
use crate::job::{JobSet, LoadError, Location};

/// File name extensions of G-code, in either case.
const GCODE: [&str; 4] = ["ngc", "nc", "gcode", "tap"];

/// A program in one of the job languages.
#[derive(Debug, Clone)]
pub enum Program {
    /// INFORM.
    Inform(JobSet),
    /// G-code.
    GCode(gcode::Program),
}

impl Program {
    /// Reads a file in the language that its extension names: G-code for `.ngc`, `.nc`, `.gcode` and `.tap`, INFORM for any other.
    ///
    /// # Errors
    /// Where the file cannot be read, or is wrong.
    pub fn load(path: &Path) -> Result<Self, LoadError> {
        let extension = path.extension().unwrap_or_default();
        if GCODE.iter().any(|known| extension.eq_ignore_ascii_case(known)) {
            gcode::Program::load(path).map(Self::GCode)
        } else {
            JobSet::load(path).map(Self::Inform)
        }
    }

    /// The name that reports show.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Inform(jobs) => &jobs.entry().name,
            Self::GCode(program) => &program.name,
        }
    }

    /// Where it begins.
    pub(super) fn start(&self) -> Place {
        match self {
            Self::Inform(jobs) => {
                let entry = jobs.entry();
                Place { file: entry.file.to_string(), line: entry.line, column: 1 }
            }
            Self::GCode(program) => Place { file: program.file.to_string(), line: 1, column: 1 },
        }
    }

    /// Where an instruction stands.
    pub(super) fn place(&self, at: &Location) -> Place {
        match self {
            Self::Inform(jobs) => {
                let job = jobs.jobs().find(|job| job.name == at.job);
                let statement = job.and_then(|job| job.program.iter().find(|s| s.line == at.line));
                Place {
                    file: job.map_or_else(|| at.job.to_string(), |job| job.file.to_string()),
                    line: at.line,
                    column: statement.map_or(1, |statement| statement.column),
                }
            }
            Self::GCode(program) => {
                Place { file: program.file.to_string(), line: at.line, column: program.column(at.line) }
            }
        }
    }
}

impl From<JobSet> for Program {
    fn from(jobs: JobSet) -> Self {
        Self::Inform(jobs)
    }
}

impl From<gcode::Program> for Program {
    fn from(program: gcode::Program) -> Self {
        Self::GCode(program)
    }
}
