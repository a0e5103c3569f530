//! Reading a recording back.

use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use seamline::kinematics::JointKind;

use super::csv;
use super::sample::Sample;

/// A recording in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The robot's joints: turning or sliding.
    pub joints: Vec<JointKind>,
    /// One sample a cycle, bit for bit as recorded.
    pub samples: Vec<Sample>,
}

/// Why a file is not a recording. Lines and columns count from 1; columns are cells, not characters.
#[derive(Debug)]
pub enum RecordingError {
    /// The file cannot be read.
    Io(io::Error),
    /// The first line is not the header of a recording.
    Header,
    /// A cell is missing, superfluous, or not what its column holds.
    Cell {
        /// Line in the file.
        line: usize,
        /// Number of the cell in its line.
        column: usize,
        /// Name of the column; empty beyond the last.
        name: String,
    },
}

impl fmt::Display for RecordingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(f),
            Self::Header => f.write_str("line 1: this is not the header of a recording"),
            Self::Cell { line, column, name } if name.is_empty() => {
                write!(f, "line {line}, column {column}: one cell too many")
            }
            Self::Cell { line, column, name } => {
                write!(f, "line {line}, column {column} ({name}): missing or not readable")
            }
        }
    }
}

impl std::error::Error for RecordingError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for RecordingError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl Recording {
    /// Reads a `recording.csv`.
    ///
    /// # Errors
    /// [`RecordingError`] where the file cannot be read or is not a whole recording.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let mut lines = BufReader::new(File::open(path)?).lines();
        let header = lines.next().transpose()?.unwrap_or_default();
        let joints = csv::joints_of(&header).ok_or(RecordingError::Header)?;
        let mut samples = Vec::new();
        for (index, row) in lines.enumerate() {
            let sample = csv::parse_row(&row?, joints.len()).map_err(|column| RecordingError::Cell {
                line: index + 2,
                column,
                name: header.split(',').nth(column - 1).unwrap_or_default().to_owned(),
            })?;
            samples.push(sample);
        }
        Ok(Self { joints, samples })
    }
}
