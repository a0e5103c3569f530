//! What can be wrong with a job, and where.

use std::fmt;
use std::sync::Arc;

use thiserror::Error;

/// One mistake in a job file, with its place.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{file}:{line}:{column}: {mistake}")]
pub struct JobError {
    /// The file as its caller named it.
    pub file: Arc<str>,
    /// Line in the file, from 1.
    pub line: u32,
    /// Column in bytes, from 1.
    pub column: u32,
    /// What was found, and what was expected.
    pub mistake: Mistake,
}

/// Every mistake of one reading, in file order; at least one.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct JobErrors(Vec<JobError>);

impl JobErrors {
    /// The errors as a result: `Ok` where there are none.
    ///
    /// # Errors
    /// The list itself, sorted by file, line and column, where it is not empty.
    pub fn check(mut errors: Vec<JobError>) -> Result<(), Self> {
        if errors.is_empty() {
            return Ok(());
        }
        errors.sort_by(|a, b| (&a.file, a.line, a.column).cmp(&(&b.file, b.line, b.column)));
        Err(Self(errors))
    }

    /// The errors, in file order.
    pub fn iter(&self) -> impl Iterator<Item = &JobError> {
        self.0.iter()
    }
}

impl From<JobError> for JobErrors {
    fn from(error: JobError) -> Self {
        Self(vec![error])
    }
}

impl fmt::Display for JobErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.0.iter().enumerate() {
            let separator = if i == 0 { "" } else { "\n" };
            write!(f, "{separator}{error}")?;
        }
        Ok(())
    }
}

/// A job that could not be loaded.
#[derive(Debug, Error)]
pub enum LoadError {
    /// The file system refused.
    #[error("cannot read {path}: {reason}")]
    Read {
        /// The file or folder.
        path: String,
        /// The system's words.
        reason: std::io::Error,
    },
    /// The file was read and is wrong.
    #[error(transparent)]
    Jobs(#[from] JobErrors),
}

/// The nearest known name, as the end of a message.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Nearest(pub Option<String>);

impl fmt::Display for Nearest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.as_ref().map_or(Ok(()), |name| write!(f, "; did you mean `{name}`?"))
    }
}

/// What is wrong.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Mistake {
    /// Something else stood where a certain thing had to.
    #[error("found {found}, expected {expected}")]
    Unexpected {
        /// What stood there, in backquotes, or "the end of the line".
        found: String,
        /// What the grammar wants there.
        expected: &'static str,
    },
    /// A number that is none, or does not fit its kind.
    #[error("`{found}` is not a number: expected {expected}")]
    BadNumber {
        /// As written.
        found: String,
        /// The kind of number.
        expected: &'static str,
    },
    /// A value outside its range.
    #[error("{what} is {value}, expected {min} to {max}")]
    OutOfRange {
        /// The quantity with its unit.
        what: &'static str,
        /// What was found.
        value: f64,
        /// Least permitted value.
        min: f64,
        /// Greatest permitted value.
        max: f64,
    },
    /// Too few or too many values on a line.
    #[error("{what} has {found} {unit}, expected {expected}")]
    WrongCount {
        /// The line's kind.
        what: &'static str,
        /// How many were found.
        found: usize,
        /// What is counted: values, arguments, characters.
        unit: &'static str,
        /// How many are expected.
        expected: &'static str,
    },
    /// `///NPOS` announces another number of positions than the list has.
    #[error("///NPOS announces {announced} {kind} positions, but the list has {found}")]
    PositionCount {
        /// C, BC, EC, P, BP or EX.
        kind: &'static str,
        /// The number in `///NPOS`.
        announced: usize,
        /// The number of lines.
        found: usize,
    },
    /// A header line that must be there is not.
    #[error("the job has no {what}, expected it before {before}")]
    MissingHeader {
        /// The missing line.
        what: &'static str,
        /// What follows it.
        before: &'static str,
    },
    /// The program does not close with END.
    #[error("the job `{job}` has no END")]
    MissingEnd {
        /// The job.
        job: String,
    },
    /// The file holds no job at all.
    #[error("the file holds no job, expected /JOB")]
    NoJob,
    /// The same thing is defined twice.
    #[error("{what} `{name}` is already defined in line {first}")]
    Duplicate {
        /// Position, label or job.
        what: &'static str,
        /// Its name.
        name: String,
        /// Where it was defined first.
        first: u32,
    },
    /// A name that is defined nowhere.
    #[error("there is no {what} `{name}`{nearest}")]
    Unknown {
        /// Position, label, job or variable.
        what: &'static str,
        /// As written.
        name: String,
        /// The nearest name there is.
        nearest: Nearest,
    },
    /// A move without a target.
    #[error("{instruction} has no target position, expected one such as C00001 or P001")]
    MissingTarget {
        /// The move.
        instruction: String,
    },
    /// The same tag twice in an instruction, or two that exclude each other.
    #[error("`{tag}` stands here, but {instead} was already given")]
    TagConflict {
        /// The second tag.
        tag: String,
        /// The first.
        instead: String,
    },
    /// A block opened and not closed, or closed and not opened.
    #[error("{found} without {missing}")]
    Unbalanced {
        /// What stands here.
        found: &'static str,
        /// Its missing partner.
        missing: &'static str,
    },
    /// NEXT names another variable than its FOR.
    #[error("NEXT {found} closes the FOR of line {line}, which counts {expected}")]
    WrongLoopVariable {
        /// NEXT's variable.
        found: String,
        /// FOR's variable.
        expected: String,
        /// FOR's line.
        line: u32,
    },
    /// A local variable beyond those that `///LVARS` declares.
    #[error("`{name}` is not declared: ///LVARS gives {declared} of this kind")]
    UndeclaredLocal {
        /// The variable.
        name: String,
        /// How many are declared.
        declared: u32,
    },
    /// Blocks or parentheses nested too deeply.
    #[error("nested more than {limit} deep")]
    TooDeep {
        /// The bound.
        limit: usize,
    },
    /// An expression that mixes conditions and numbers.
    #[error("found {found}, expected {expected}")]
    WrongType {
        /// What the expression is.
        found: &'static str,
        /// What is needed.
        expected: &'static str,
    },
    /// Division by zero.
    #[error("division by zero")]
    DivisionByZero,
    /// A square root of a negative number.
    #[error("square root of {value}, expected a number that is not negative")]
    NegativeRoot {
        /// The number.
        value: f64,
    },
    /// A position variable that was never set.
    #[error("position variable {name} was never set")]
    UnsetPosition {
        /// The variable.
        name: String,
    },
    /// A position of another kind than the instruction needs.
    #[error("{name} holds {found}, expected {expected}")]
    WrongPosition {
        /// The position.
        name: String,
        /// What it is.
        found: &'static str,
        /// What is needed.
        expected: &'static str,
    },
    /// A move without speed, and no rule that supplies one.
    #[error(
        "{instruction} has no speed, and no SPEED instruction, arc condition or earlier move supplies one"
    )]
    NoSpeed {
        /// The move.
        instruction: &'static str,
    },
    /// An argument that the call did not pass.
    #[error("the call passes {passed} arguments, but the job reads argument {number}")]
    MissingArgument {
        /// IARG#'s number.
        number: u32,
        /// Arguments of the call.
        passed: usize,
    },
    /// `$RV` is read, but the last call returned nothing.
    #[error("$RV is empty: the last call returned no value")]
    NoReturnValue,
    /// Too many jobs called within each other.
    #[error("CALL nested more than {limit} deep")]
    CallDepth {
        /// The bound.
        limit: usize,
    },
    /// A loop in which nothing takes time.
    #[error("{limit} instructions ran without one that takes time: an endless loop?")]
    EndlessLoop {
        /// The bound.
        limit: u32,
    },
    /// Data that the world around the job could not give.
    #[error("{what} is not available")]
    Unavailable {
        /// The data.
        what: String,
    },
    /// A word of a G-code line that a run does not execute.
    #[error("`{text}` is refused: {reason}")]
    Refused {
        /// As written.
        text: String,
        /// Why.
        reason: &'static str,
    },
    /// A feed move before any F.
    #[error("`{word}` has no feed, expected an F in this line or before it")]
    NoFeed {
        /// The move's code.
        word: String,
    },
    /// An arc whose end is not as far from the centre as its start.
    #[error(
        "the arc starts {start_mm:.4} mm from its centre and ends {end_mm:.4} mm from it, expected the same to \
         {tolerance_mm:.4} mm"
    )]
    ArcRadius {
        /// Radius at the start.
        start_mm: f64,
        /// Radius at the end.
        end_mm: f64,
        /// How much they may differ.
        tolerance_mm: f64,
    },
    /// An arc whose radius does not span its ends.
    #[error(
        "R is {radius_mm} mm, but start and end are {apart_mm:.4} mm apart, expected at least half of that"
    )]
    ArcTooSmall {
        /// The radius.
        radius_mm: f64,
        /// Distance from start to end in the arc's plane.
        apart_mm: f64,
    },
    /// A G-code file that does not say where it ends.
    #[error("the file ends without M2, M30 or a closing %: it may have been cut off")]
    MissingProgramEnd,
}
