//! The outline of a file: jobs, their sections, their statements.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use super::super::check::{self, Whole};
use super::super::error::{JobError, JobErrors, Mistake};
use super::super::instruction::{Flow, Instruction};
use super::super::lexer::{Fault, Lexer, TokenKind, column, printable};
use super::super::program::{Header, Job, JobFile, Statement};
use super::header::{PositionList, header_line};
use super::{MAX_LINE, is_local_name};

/// What some editors write before the first line.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// Ctrl-Z, what some tools write behind the last line.
const END_OF_FILE: &[u8] = b"\x1a";

impl JobFile {
    /// Reads a job file: every job in it, with labels, steps and blocks resolved within each job.
    ///
    /// # Errors
    /// Every mistake of the file, at most one a line, with line and column.
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self, JobErrors> {
        let mut reader = Reader::new(name);
        for (index, raw) in bytes.split(|b| *b == b'\n').enumerate() {
            reader.number = u32::try_from(index).map_or(u32::MAX, |i| i.saturating_add(1));
            let line = raw.strip_suffix(b"\r").unwrap_or(raw);
            if let Err(fault) = reader.line(line) {
                let error = reader.error(fault);
                reader.errors.push(error);
            }
        }
        reader.finish_job();
        reader.check_names();
        let Reader { file, jobs, errors, .. } = reader;
        JobErrors::check(errors)?;
        if jobs.is_empty() {
            return Err(JobError { file, line: 1, column: 1, mistake: Mistake::NoJob }.into());
        }
        Ok(Self { name: file, jobs, bytes: bytes.to_vec() })
    }
}

/// The part of a job that a line belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    /// After `/JOB`.
    Start,
    /// `//POS`.
    Positions,
    /// `//ARGINFO`, whose lines without slash are free text.
    Arguments,
    /// `//INST`, up to END.
    Program,
    /// After END.
    Ended,
    /// Any other: kept, not read.
    Unknown,
    /// A program without `//INST`: told once, then not read.
    Lost,
}

/// A job as far as it has been read.
#[derive(Debug)]
struct Draft {
    /// Empty where the name is wrong, which has been told.
    name: Option<(Arc<str>, u32)>,
    start: u32,
    section: Section,
    has_program: bool,
    /// No line of the program was wrong.
    whole: bool,
    header: Header,
    positions: PositionList,
    program: Vec<Statement>,
    labels: BTreeMap<String, usize>,
}

#[derive(Debug)]
struct Reader {
    file: Arc<str>,
    number: u32,
    current: Option<Draft>,
    /// Something stands before the first `/JOB`, which has been told.
    lost: bool,
    jobs: Vec<Job>,
    errors: Vec<JobError>,
}

impl Reader {
    fn new(name: &str) -> Self {
        let (jobs, errors) = (Vec::new(), Vec::new());
        Self { file: Arc::from(name), number: 0, current: None, lost: false, jobs, errors }
    }

    fn error(&self, fault: Fault) -> JobError {
        self.error_at(self.number, fault.column, fault.mistake)
    }

    fn error_at(&self, line: u32, column: u32, mistake: Mistake) -> JobError {
        JobError { file: Arc::clone(&self.file), line, column, mistake }
    }

    fn line(&mut self, line: &[u8]) -> Result<(), Fault> {
        let line = if self.number == 1 { line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(line) } else { line };
        let text = line.trim_ascii();
        if matches!(text, b"" | END_OF_FILE) {
            if let Some(draft) = self.current.as_mut().filter(|d| d.section == Section::Arguments) {
                draft.header.argument_comments.push(Vec::new());
            }
            return Ok(());
        }
        if text == b"/JOB" {
            self.finish_job();
            self.current = Some(Draft::new(self.number));
            return Ok(());
        }
        let number = self.number;
        let Some(draft) = &mut self.current else {
            let told = std::mem::replace(&mut self.lost, true);
            return if told { Ok(()) } else { Err(unexpected(line, "/JOB")) };
        };
        match draft.section {
            Section::Ended => Err(unexpected(line, "/JOB or the end of the file after END")),
            _ if text.starts_with(b"/") => draft.directive(line, number),
            Section::Arguments => {
                draft.header.argument_comments.push(text.to_vec());
                Ok(())
            }
            Section::Positions if !PositionList::may_hold(text) => {
                draft.section = Section::Lost;
                let mistake = Mistake::MissingHeader { what: "//INST", before: "the program" };
                Err(Fault { column: 1, mistake })
            }
            Section::Positions => draft.positions.line(line, number),
            Section::Program => {
                let read = draft.statement(line, number);
                draft.whole &= read.is_ok();
                read
            }
            Section::Unknown | Section::Lost => Ok(()),
            Section::Start => Err(unexpected(line, "//NAME, //POS or //INST")),
        }
    }

    /// The job that is being read is complete: what it lacks is found now.
    fn finish_job(&mut self) {
        let Some(draft) = self.current.take() else { return };
        let mut errors = Vec::new();
        let (name, line) = match draft.name {
            Some((name, line)) => (name, line),
            None => {
                errors.push((draft.start, Mistake::MissingHeader { what: "//NAME", before: "//POS" }));
                (Arc::from(""), draft.start)
            }
        };
        if draft.section == Section::Lost {
            // Told where the program began.
        } else if !draft.has_program {
            errors.push((draft.start, Mistake::MissingHeader { what: "//INST", before: "the program" }));
        } else if draft.section != Section::Ended {
            let last = draft.program.last().map_or(draft.start, |s| s.line);
            errors.push((last, Mistake::MissingEnd { job: name.to_string() }));
        }
        errors.extend(draft.positions.check());
        for (line, mistake) in errors {
            let error = self.error_at(line, 1, mistake);
            self.errors.push(error);
        }
        let whole = Whole { program: draft.whole, positions: draft.positions.is_whole() };
        let mut job = Job {
            name,
            file: Arc::clone(&self.file),
            line,
            header: draft.header,
            positions: draft.positions.into_positions(),
            program: draft.program,
            labels: draft.labels,
            links: Vec::new(),
        };
        self.errors.extend(check::resolve(&mut job, whole));
        self.jobs.push(job);
    }

    fn check_names(&mut self) {
        for (index, job) in self.jobs.iter().enumerate() {
            let same = |other: &&Job| other.name == job.name && !job.name.is_empty();
            let earlier = self.jobs.iter().take(index).find(same);
            if let Some(first) = earlier {
                let mistake =
                    Mistake::Duplicate { what: "job", name: job.name.to_string(), first: first.line };
                self.errors.push(job.error(job.line, 1, mistake));
            }
        }
    }
}

impl Draft {
    fn new(start: u32) -> Self {
        Self {
            name: None,
            start,
            section: Section::Start,
            has_program: false,
            whole: true,
            header: Header::default(),
            positions: PositionList::default(),
            program: Vec::new(),
            labels: BTreeMap::new(),
        }
    }

    /// A line that begins with a slash.
    fn directive(&mut self, line: &[u8], number: u32) -> Result<(), Fault> {
        let start = indent(line);
        let slashes = line.get(start..).unwrap_or_default().iter().take_while(|b| **b == b'/').count();
        let mut lexer = Lexer::new(line, start + slashes, line.len());
        let TokenKind::Word(word) = lexer.peek().kind else {
            return Err(unexpected(line, "/JOB, //NAME, //POS or another header line"));
        };
        if !self.program.is_empty() {
            return Err(unexpected(line, "an instruction or END"));
        }
        lexer.next();
        match (slashes, word) {
            (2, "NAME") => return self.set_name(&mut lexer, number),
            (2, "POS") => self.section = Section::Positions,
            (2, "ARGINFO") => self.section = Section::Arguments,
            (2, "INST") => {
                self.section = Section::Program;
                self.has_program = true;
            }
            (2, _) => self.section = Section::Unknown,
            (1, _) => return Err(unexpected(line, "/JOB, //NAME, //POS or another header line")),
            _ if self.section == Section::Positions => {
                return self.positions.directive(&mut lexer, word, number);
            }
            _ => return header_line(&mut self.header, &mut lexer, word),
        }
        Ok(())
    }

    fn set_name(&mut self, lexer: &mut Lexer<'_>, number: u32) -> Result<(), Fault> {
        if let Some((first, line)) = &self.name {
            let mistake = Mistake::Duplicate { what: "name", name: first.to_string(), first: *line };
            return Err(Fault { column: lexer.column(), mistake });
        }
        let name = job_name(lexer);
        let kept = name.as_ref().map_or("", String::as_str);
        self.name = Some((Arc::from(kept), number));
        name.map(|_| ())
    }

    fn statement(&mut self, line: &[u8], number: u32) -> Result<(), Fault> {
        if self.program.is_empty() && is_local_alias(line) {
            return Ok(());
        }
        let statement = statement(line, number)?;
        if let Instruction::Label(name) = &statement.instruction {
            match self.labels.entry(name.clone()) {
                Entry::Occupied(first) => {
                    let first = self.program.get(*first.get()).map_or(0, |s| s.line);
                    let mistake = Mistake::Duplicate { what: "label", name: format!("*{name}"), first };
                    return Err(Fault { column: statement.column, mistake });
                }
                Entry::Vacant(free) => {
                    free.insert(self.program.len());
                }
            }
        }
        if statement.instruction == Instruction::Flow(Flow::End) {
            self.section = Section::Ended;
        }
        self.program.push(statement);
        Ok(())
    }
}

fn job_name(lexer: &mut Lexer<'_>) -> Result<String, Fault> {
    const MAX_NAME: usize = 32;
    let fault = lexer.unexpected("the job's name");
    let TokenKind::Text(name) = lexer.name().kind else { return Err(fault) };
    super::operand::expect_end(lexer, "the end of the line: a job's name has no blanks")?;
    if name.len() <= MAX_NAME {
        return Ok(printable(name));
    }
    let found = name.len();
    let mistake =
        Mistake::WrongCount { what: "the job's name", found, unit: "characters", expected: "at most 32" };
    Err(Fault { column: fault.column, mistake })
}

/// One line of a program.
fn statement(line: &[u8], number: u32) -> Result<Statement, Fault> {
    let start = indent(line);
    let column = column(start);
    let text = line.get(start..).unwrap_or_default();
    let done = |text: &[u8], comment: Option<&[u8]>, instruction| Statement {
        line: number,
        column,
        text: printable(text.trim_ascii_end()),
        comment: comment.map(<[u8]>::to_vec),
        instruction,
    };
    if let Some(comment) = text.strip_prefix(b"'") {
        return Ok(done(b"", Some(comment), Instruction::Nop));
    }
    if line.len() > MAX_LINE {
        let mistake = Mistake::WrongCount {
            what: "the line",
            found: line.len(),
            unit: "characters",
            expected: "at most 1024",
        };
        return Err(Fault { column, mistake });
    }
    let (end, comment) = match comment_start(line) {
        Some(at) => (at, line.get(at + 2..)),
        None => (line.len(), None),
    };
    let instruction = super::instruction(&mut Lexer::new(line, start, end))?;
    Ok(done(line.get(start..end).unwrap_or_default(), comment, instruction))
}

/// Where ` //` begins a comment: behind a blank, outside quotes.
fn comment_start(line: &[u8]) -> Option<usize> {
    let mut quoted = false;
    for (i, window) in line.windows(3).enumerate() {
        match window {
            [b'"', ..] => quoted = !quoted,
            [b' ' | b'\t', b'/', b'/'] if !quoted => return Some(i + 1),
            _ => {}
        }
    }
    None
}

/// `LB000 COUNT`: a name for a local variable, under `///LVARS`. No instruction begins with a variable.
fn is_local_alias(line: &[u8]) -> bool {
    let lexer = Lexer::new(line, 0, line.len());
    matches!(lexer.peek().kind, TokenKind::Word(word) if is_local_name(word))
}

fn indent(line: &[u8]) -> usize {
    line.iter().take_while(|b| matches!(b, b' ' | b'\t')).count()
}

fn unexpected(line: &[u8], expected: &'static str) -> Fault {
    let start = indent(line);
    let mut lexer = Lexer::new(line, start, line.len());
    let TokenKind::Text(found) = lexer.name().kind else { return lexer.unexpected(expected) };
    let found = format!("`{}`", printable(found));
    Fault { column: column(start), mistake: Mistake::Unexpected { found, expected } }
}
