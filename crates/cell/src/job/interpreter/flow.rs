//! Program flow.

use std::sync::Arc;

use super::super::error::{Mistake, Nearest};
use super::super::expression::{Expression, Variable};
use super::super::instruction::{Flow, Instruction, JobReference, JumpTarget};
use super::super::lexer::Fault;
use super::super::program::{Job, Link};
use super::super::step::Action;
use super::super::world::World;
use super::{Call, Interpreter, MAX_CALLS, Outcome};

type Run<T> = Result<T, Fault>;

impl Interpreter {
    pub(super) fn flow(
        &mut self,
        job: &Arc<Job>,
        index: usize,
        column: u32,
        flow: &Flow,
        world: &mut impl World,
    ) -> Run<Outcome> {
        match flow {
            Flow::Jump { condition, .. }
            | Flow::Call { condition, .. }
            | Flow::Return { condition, .. }
            | Flow::Pause { condition }
            | Flow::Abort { condition }
                if !self.permitted(condition.as_ref(), world)? => {}
            Flow::Jump { target, .. } => self.jump(job, target)?,
            Flow::Call { target, arguments, .. } => self.call(target, arguments, world)?,
            Flow::Return { value, .. } => {
                self.returned = value.as_ref().map(|value| self.value(value, world)).transpose()?;
                return Ok(self.leave_job());
            }
            Flow::Pause { .. } => return Ok(Action::Pause.into()),
            Flow::Abort { .. } => {
                self.calls.clear();
                return Ok(Action::End.into());
            }
            Flow::End => return Ok(self.leave_job()),
            Flow::If(condition) => self.choose(job, index, condition, world)?,
            Flow::While(condition) => {
                let (holds, body) = self.chain(job, index, condition, world)?;
                self.go_to(if holds { body } else { after_end(job, index) });
            }
            Flow::For { variable, start, end, step } => {
                let value = self.number(start, world)?;
                self.set_counter(variable, value, world)?;
                if self.is_past(value, end, step.as_ref(), world)? {
                    self.go_to(after_end(job, index));
                }
            }
            Flow::Next(_) => self.count(job, index, column, world)?,
            Flow::Switch(selector) => self.switch(job, index, selector, world)?,
            Flow::EndWhile => {
                if let Some(Link::Start(start)) = job.links.get(index) {
                    self.go_to(*start);
                }
            }
            // Reached from the branch above, which is done.
            Flow::ElseIf(_) | Flow::Else | Flow::Case(_) | Flow::Default => {
                if let Some(Link::Branch { end, .. }) = job.links.get(index) {
                    self.go_to(end + 1);
                }
            }
            Flow::AndIf(_) | Flow::OrIf(_) | Flow::EndIf | Flow::EndSwitch => {}
        }
        Ok(Outcome::Nothing)
    }

    fn permitted(&self, condition: Option<&Expression>, world: &mut impl World) -> Run<bool> {
        condition.map_or(Ok(true), |condition| self.holds(condition, world))
    }

    /// RET and END: back to the caller, or the end of the run.
    fn leave_job(&mut self) -> Outcome {
        self.calls.pop();
        if self.calls.is_empty() { Action::End.into() } else { Outcome::Nothing }
    }

    fn jump(&mut self, job: &Arc<Job>, target: &JumpTarget) -> Run<()> {
        match target {
            JumpTarget::Label { column, name } => {
                let statement = job
                    .labels
                    .get(name)
                    .ok_or_else(|| Fault { column: *column, mistake: unknown("label", name) })?;
                self.go_to(*statement);
            }
            JumpTarget::Job(reference) => {
                let call = Call::new(self.job(reference)?, Vec::new());
                self.calls.pop();
                self.calls.push(call);
            }
        }
        Ok(())
    }

    fn call(&mut self, target: &JobReference, arguments: &[Expression], world: &mut impl World) -> Run<()> {
        if self.calls.len() >= MAX_CALLS {
            return Err(Fault { column: target.column, mistake: Mistake::CallDepth { limit: MAX_CALLS } });
        }
        let job = self.job(target)?;
        let arguments = arguments.iter().map(|a| self.value(a, world)).collect::<Run<Vec<_>>>()?;
        self.returned = None;
        self.calls.push(Call::new(job, arguments));
        Ok(())
    }

    fn job(&self, reference: &JobReference) -> Run<usize> {
        self.jobs
            .find(&reference.name)
            .ok_or_else(|| Fault { column: reference.column, mistake: unknown("job", &reference.name) })
    }

    /// Goes to the first branch whose condition holds.
    fn choose(&mut self, job: &Job, index: usize, condition: &Expression, world: &mut impl World) -> Run<()> {
        let (mut index, mut condition) = (index, condition);
        // Ends: the links of a chain lead down the program.
        loop {
            let (holds, body) = self.chain(job, index, condition, world)?;
            if holds {
                self.go_to(body);
                return Ok(());
            }
            let Some(Link::Branch { next, .. }) = job.links.get(index) else { return Ok(()) };
            match job.program.get(*next).map(|s| &s.instruction) {
                Some(Instruction::Flow(Flow::ElseIf(other))) => (index, condition) = (*next, other),
                _ => {
                    self.go_to(next + 1);
                    return Ok(());
                }
            }
        }
    }

    /// A condition joined with the ANDIF and ORIF lines under it, from top to bottom; and the statement behind them.
    fn chain(
        &self,
        job: &Job,
        index: usize,
        condition: &Expression,
        world: &mut impl World,
    ) -> Run<(bool, usize)> {
        let mut holds = self.holds(condition, world)?;
        let mut after = index + 1;
        for (i, statement) in job.program.iter().enumerate().skip(index + 1) {
            match &statement.instruction {
                Instruction::Nop => continue,
                Instruction::Flow(Flow::AndIf(more)) => holds = holds && self.holds(more, world)?,
                Instruction::Flow(Flow::OrIf(more)) => holds = holds || self.holds(more, world)?,
                _ => break,
            }
            after = i + 1;
        }
        Ok((holds, after))
    }

    fn switch(&mut self, job: &Job, index: usize, selector: &Expression, world: &mut impl World) -> Run<()> {
        let selected = self.value(selector, world)?;
        let mut at = index;
        // Ends: the links of a chain lead down the program.
        while let Some(Link::Branch { next, .. }) = job.links.get(at) {
            at = *next;
            if let Some(Instruction::Flow(Flow::Case(values))) = job.program.get(at).map(|s| &s.instruction) {
                let values = values.iter().map(|v| self.value(v, world)).collect::<Run<Vec<_>>>()?;
                if !values.contains(&selected) {
                    continue;
                }
            }
            break;
        }
        self.go_to(at + 1);
        Ok(())
    }

    fn set_counter(&mut self, variable: &Variable, value: f64, world: &mut impl World) -> Run<()> {
        let number = self.index(&variable.index, world)?;
        let scope = self.scope_mut(variable);
        let set = scope.set_number(variable.kind, number, value);
        set.map_err(|mistake| Fault { column: variable.column, mistake })
    }

    fn is_past(
        &self,
        value: f64,
        end: &Expression,
        step: Option<&Expression>,
        world: &mut impl World,
    ) -> Run<bool> {
        let end = self.number(end, world)?;
        Ok(if self.step(step, world)? > 0.0 { value > end } else { value < end })
    }

    fn step(&self, step: Option<&Expression>, world: &mut impl World) -> Run<f64> {
        let Some(expression) = step else { return Ok(1.0) };
        let value = self.number(expression, world)?;
        if value != 0.0 {
            return Ok(value);
        }
        let mistake = Mistake::Unexpected { found: "a step of 0".into(), expected: "a step that counts" };
        Err(Fault { column: expression.column, mistake })
    }

    /// NEXT: counts on and repeats the loop, or leaves it. The counter then keeps its last value within the loop,
    /// so that a B variable can count to 255.
    fn count(&mut self, job: &Arc<Job>, index: usize, column: u32, world: &mut impl World) -> Run<()> {
        let Some(Link::Start(start)) = job.links.get(index) else { return Ok(()) };
        let opening = job.program.get(*start).map(|s| &s.instruction);
        let Some(Instruction::Flow(Flow::For { variable, end, step, .. })) = opening else { return Ok(()) };
        // Columns in FOR's line mean nothing in NEXT's: an error here stands at NEXT.
        let here = |fault: Fault| Fault { column, ..fault };
        let number = self.index(&variable.index, world).map_err(here)?;
        let by = self.step(step.as_ref(), world).map_err(here)?;
        let value = self.scope_mut(variable).number(variable.kind, number) + by;
        if !self.is_past(value, end, step.as_ref(), world).map_err(here)? {
            self.set_counter(variable, value, world).map_err(here)?;
            self.go_to(start + 1);
        }
        Ok(())
    }
}

/// The statement behind the end of WHILE or FOR.
fn after_end(job: &Job, index: usize) -> usize {
    match job.links.get(index) {
        Some(Link::End(end)) => end + 1,
        _ => index + 1,
    }
}

fn unknown(what: &'static str, name: &str) -> Mistake {
    Mistake::Unknown { what, name: name.to_owned(), nearest: Nearest(None) }
}
