//! Which statement of a block leads where.

use super::MAX_DEPTH;
use super::error::{JobError, Mistake};
use super::expression::Variable;
use super::instruction::{Flow, Instruction};
use super::program::{Job, Link, Statement};

/// A block whose end has not come yet.
#[derive(Debug)]
enum Open<'a> {
    /// IFTHEN or SWITCH with the branches so far (the opening statement is the first), and whether ELSE or DEFAULT
    /// has come.
    Branches { is_if: bool, members: Vec<usize>, closed: bool },
    /// WHILE.
    While(usize),
    /// FOR and its counter.
    For(usize, &'a Variable),
}

/// Links of a job's statements, and the blocks that do not fit together.
pub(super) fn link(job: &Job) -> (Vec<Link>, Vec<JobError>) {
    let mut linker =
        Linker { job, links: vec![Link::None; job.program.len()], open: Vec::new(), errors: Vec::new() };
    for (index, statement) in job.program.iter().enumerate() {
        if let Instruction::Flow(flow) = &statement.instruction
            && let Err(mistake) = linker.statement(index, flow)
        {
            linker.complain(statement, mistake);
        }
    }
    linker.close();
    (linker.links, linker.errors)
}

struct Linker<'a> {
    job: &'a Job,
    links: Vec<Link>,
    open: Vec<Open<'a>>,
    errors: Vec<JobError>,
}

impl<'a> Linker<'a> {
    fn complain(&mut self, statement: &Statement, mistake: Mistake) {
        self.errors.push(self.job.error(statement.line, statement.column, mistake));
    }

    fn statement(&mut self, index: usize, flow: &'a Flow) -> Result<(), Mistake> {
        match flow {
            Flow::If(_) => self.push(Open::Branches { is_if: true, members: vec![index], closed: false }),
            Flow::Switch(_) => {
                self.push(Open::Branches { is_if: false, members: vec![index], closed: false })
            }
            Flow::While(_) => self.push(Open::While(index)),
            Flow::For { variable, .. } => self.push(Open::For(index, variable)),
            Flow::ElseIf(_) => self.branch(index, true, false, "ELSEIF", "IFTHEN"),
            Flow::Else => self.branch(index, true, true, "ELSE", "IFTHEN"),
            Flow::Case(_) => self.branch(index, false, false, "CASE", "SWITCH"),
            Flow::Default => self.branch(index, false, true, "DEFAULT", "SWITCH"),
            Flow::EndIf => self.end_branches(index, true, "ENDIF", "IFTHEN"),
            Flow::EndSwitch => self.end_branches(index, false, "ENDSWITCH", "SWITCH"),
            Flow::EndWhile => {
                let Some(Open::While(start)) = self.open.last() else {
                    return Err(Mistake::Unbalanced { found: "ENDWHILE", missing: "WHILE" });
                };
                let start = *start;
                self.open.pop();
                self.join(start, index);
                Ok(())
            }
            Flow::Next(variable) => self.next(index, variable),
            Flow::AndIf(_) => self.joins_condition(index, "ANDIF"),
            Flow::OrIf(_) => self.joins_condition(index, "ORIF"),
            Flow::Jump { .. }
            | Flow::Call { .. }
            | Flow::Return { .. }
            | Flow::Pause { .. }
            | Flow::Abort { .. }
            | Flow::End => Ok(()),
        }
    }

    fn push(&mut self, open: Open<'a>) -> Result<(), Mistake> {
        self.open.push(open);
        // Told once, at the first block that is too deep.
        if self.open.len() == MAX_DEPTH + 1 { Err(Mistake::TooDeep { limit: MAX_DEPTH }) } else { Ok(()) }
    }

    fn branch(
        &mut self,
        index: usize,
        wants_if: bool,
        closes: bool,
        found: &'static str,
        missing: &'static str,
    ) -> Result<(), Mistake> {
        match self.open.last_mut() {
            Some(Open::Branches { is_if, members, closed }) if *is_if == wants_if && !*closed => {
                members.push(index);
                *closed = closes;
                Ok(())
            }
            _ => Err(Mistake::Unbalanced { found, missing }),
        }
    }

    fn end_branches(
        &mut self,
        end: usize,
        wants_if: bool,
        found: &'static str,
        missing: &'static str,
    ) -> Result<(), Mistake> {
        match self.open.pop() {
            Some(Open::Branches { is_if, members, .. }) if is_if == wants_if => {
                let followers = members.iter().skip(1).copied().chain([end]);
                for (member, next) in members.iter().zip(followers) {
                    self.set(*member, Link::Branch { next, end });
                }
                Ok(())
            }
            other => {
                self.open.extend(other);
                Err(Mistake::Unbalanced { found, missing })
            }
        }
    }

    fn next(&mut self, index: usize, found: &Variable) -> Result<(), Mistake> {
        let Some(Open::For(start, counter)) = self.open.last() else {
            return Err(Mistake::Unbalanced { found: "NEXT", missing: "FOR" });
        };
        let (start, expected) = (*start, counter.to_string());
        self.open.pop();
        self.join(start, index);
        if found.to_string() == expected {
            return Ok(());
        }
        let line = self.job.program.get(start).map_or(0, |s| s.line);
        Err(Mistake::WrongLoopVariable { found: found.to_string(), expected, line })
    }

    /// ANDIF and ORIF stand directly under the condition that they join.
    fn joins_condition(&self, index: usize, found: &'static str) -> Result<(), Mistake> {
        let above = self.job.program.iter().take(index).rev().find(|s| s.instruction != Instruction::Nop);
        match above.map(|s| &s.instruction) {
            Some(Instruction::Flow(
                Flow::If(_) | Flow::ElseIf(_) | Flow::While(_) | Flow::AndIf(_) | Flow::OrIf(_),
            )) => Ok(()),
            _ => Err(Mistake::Unbalanced { found, missing: "IFTHEN, ELSEIF or WHILE above it" }),
        }
    }

    fn join(&mut self, start: usize, end: usize) {
        self.set(start, Link::End(end));
        self.set(end, Link::Start(start));
    }

    fn set(&mut self, index: usize, link: Link) {
        if let Some(slot) = self.links.get_mut(index) {
            *slot = link;
        }
    }

    /// Blocks still open at the end. Where another block is wrong already, that is the mistake to be told.
    fn close(&mut self) {
        if !self.errors.is_empty() {
            return;
        }
        let unclosed = std::mem::take(&mut self.open);
        let job = self.job;
        for open in unclosed {
            let (index, found, missing) = match open {
                Open::Branches { is_if: true, members, .. } => (members.first().copied(), "IFTHEN", "ENDIF"),
                Open::Branches { members, .. } => (members.first().copied(), "SWITCH", "ENDSWITCH"),
                Open::While(start) => (Some(start), "WHILE", "ENDWHILE"),
                Open::For(start, _) => (Some(start), "FOR", "NEXT"),
            };
            if let Some(statement) = index.and_then(|i| job.program.get(i)) {
                self.complain(statement, Mistake::Unbalanced { found, missing });
            }
        }
    }
}
