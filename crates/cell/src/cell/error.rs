//! What can be wrong with a cell file.

use std::fmt;

/// One mistake in a cell file: where it is, what was found, what was expected.
///
/// Displays as `cell.toml:12:9: robot.joint[3].velocity_deg_s: found -5, expected a number from 0.001 to 10000`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellError {
    /// The file as the caller named it.
    pub file: String,
    /// Line and column, both from 1 (columns count characters); none where the file could not be read at all.
    pub place: Option<(usize, usize)>,
    /// The key with its tables, `robot.joint[3].velocity_deg_s`; empty for the file as a whole. The number in
    /// brackets is the table's own `number`.
    pub key: String,
    /// What is wrong there.
    pub problem: Problem,
}

/// What is wrong with one key of a cell file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Problem {
    /// The file cannot be read.
    Unreadable(String),
    /// The text is not TOML.
    Syntax(String),
    /// Nothing has this name; with the nearest name that exists, or all names that do.
    UnknownKey {
        /// What was probably meant, or a list of what there is.
        known: Suggestion,
    },
    /// A key that must be there is not.
    Missing {
        /// What its value would have to be.
        expected: String,
    },
    /// The value is of the wrong type, out of range, or does not go with another.
    Value {
        /// The value as it is written in the file.
        found: String,
        /// What it has to be.
        expected: String,
    },
    /// Two tables of one kind have the same number.
    DuplicateNumber {
        /// The line of the first.
        first_line: usize,
    },
}

/// What to offer instead of an unknown key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Suggestion {
    /// The one key that looks alike.
    Nearest(String),
    /// None looks alike: all keys of this table.
    All(Vec<String>),
}

impl fmt::Display for CellError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file)?;
        if let Some((line, column)) = self.place {
            write!(f, "{line}:{column}:")?;
        }
        if !self.key.is_empty() {
            write!(f, " {}:", self.key)?;
        }
        write!(f, " {}", self.problem)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(reason) => write!(f, "cannot be read: {reason}"),
            Self::Syntax(reason) => write!(f, "not TOML: {reason}"),
            Self::UnknownKey { known: Suggestion::Nearest(key) } => {
                write!(f, "unknown key, did you mean {key}?")
            }
            Self::UnknownKey { known: Suggestion::All(keys) } => {
                write!(f, "unknown key, expected one of {}", keys.join(", "))
            }
            Self::Missing { expected } => write!(f, "missing, expected {expected}"),
            Self::Value { found, expected } => write!(f, "found {found}, expected {expected}"),
            Self::DuplicateNumber { first_line } => {
                write!(f, "number given twice, first on line {first_line}")
            }
        }
    }
}

impl std::error::Error for CellError {}
