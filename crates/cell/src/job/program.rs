//! A job file in memory: the bytes as they were, and the jobs in typed form.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::error::{JobError, Mistake};
use super::instruction::Instruction;
use super::position::{Frame, JobPosition, PositionName};

/// A job file: its bytes and the jobs that stand in it.
#[derive(Debug, Clone, PartialEq)]
pub struct JobFile {
    /// The file as its caller named it; error messages begin with it.
    pub name: Arc<str>,
    /// The jobs, in file order; at least one.
    pub jobs: Vec<Job>,
    pub(super) bytes: Vec<u8>,
}

impl JobFile {
    /// The file as it was read, byte for byte.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The file as controllers require it: the same lines, each ended by CR LF.
    #[must_use]
    pub fn to_crlf(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(self.bytes.len() + self.bytes.len() / 16);
        for line in self.bytes.split_inclusive(|b| *b == b'\n') {
            match line.strip_suffix(b"\n") {
                Some(text) => {
                    out.extend_from_slice(text.strip_suffix(b"\r").unwrap_or(text));
                    out.extend_from_slice(b"\r\n");
                }
                None => out.extend_from_slice(line),
            }
        }
        out
    }
}

/// One job.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    /// `//NAME`.
    pub name: Arc<str>,
    /// The file that holds it, as its caller named it.
    pub file: Arc<str>,
    /// The line of `//NAME`.
    pub line: u32,
    /// The header.
    pub header: Header,
    /// The positions of `//POS`, by name: C steps of the job, and position variables that it brings along.
    pub positions: BTreeMap<PositionName, JobPosition>,
    /// The program, in file order; the last statement is END.
    pub program: Vec<Statement>,
    /// Labels: index of the statement that defines them.
    pub labels: BTreeMap<String, usize>,
    /// The flow of blocks, one entry a statement.
    pub(super) links: Vec<Link>,
}

impl Job {
    /// The error that a mistake at a place in this job makes.
    #[must_use]
    pub fn error(&self, line: u32, column: u32, mistake: Mistake) -> JobError {
        JobError { file: Arc::clone(&self.file), line, column, mistake }
    }
}

/// Header of a job.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Header {
    /// `///FOLDERNAME`.
    pub folder: Option<String>,
    /// `///DATE`, as written.
    pub date: Option<String>,
    /// `///COMM`, as bytes (often Shift-JIS).
    pub comment: Vec<u8>,
    /// `///ATTR`: SC, RW, RJ and so on; digits in the ERC era.
    pub attributes: Vec<String>,
    /// `////FRAME` of a relative job.
    pub frame: Option<Frame>,
    /// `///GROUP1`, `///GROUP2` …: the axes of each group.
    pub groups: Vec<Vec<String>>,
    /// `///LVARS`: how many local B, I, D, R, S, P, BP, EX variables there are; `None` where the line is missing.
    pub locals: Option<[u32; 8]>,
    /// `///ARGTYPE`: types of the arguments, empty where not used.
    pub argument_types: Vec<String>,
    /// The eight free lines under `///COMMENT` in `//ARGINFO`, as bytes.
    pub argument_comments: Vec<Vec<u8>>,
}

/// One line of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// Line in the file, from 1.
    pub line: u32,
    /// Column of its first character, from 1.
    pub column: u32,
    /// The instruction as written, without indent and comment.
    pub text: String,
    /// `'text` or ` //text`, without the mark, as bytes.
    pub comment: Option<Vec<u8>>,
    /// The instruction.
    pub instruction: Instruction,
}

/// Where a statement of a block leads: indices of statements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Link {
    /// No block statement.
    #[default]
    None,
    /// IFTHEN, ELSEIF, ELSE: the next branch of the chain (ELSEIF, ELSE or ENDIF), and its ENDIF.
    Branch {
        /// Tested next where the condition fails.
        next: usize,
        /// Where the chain ends.
        end: usize,
    },
    /// WHILE and FOR: their ENDWHILE or NEXT; SWITCH, CASE, DEFAULT: their ENDSWITCH.
    End(usize),
    /// ENDWHILE and NEXT: their WHILE or FOR.
    Start(usize),
}
