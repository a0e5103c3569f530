//! The check before any motion: the whole job, step by step, planned and thrown away.

use super::announcement::announcement;
use super::error::{Place, RunError};
use super::program::Program;
use super::walk::{WAIT_MAX, Walk};
use crate::cell::{Cell, UnmetWait};
use crate::job::{Action, Condition, Location, Step};
use crate::plan::{Arm, Planned, PlanningArm};

/// Longest job that is checked: a job that loops for ever is checked so far, and said to.
const DURATION_MAX: f64 = 4.0 * 3600.0;
const STEPS_MAX: usize = 100_000;
/// How far apart the instants are at which a WAIT is tried against the scripted inputs, in seconds.
const WAIT_STEP: f64 = 0.01;

/// What a check found.
#[derive(Debug)]
pub struct CheckReport {
    /// In the order of the program; each line's finding once.
    pub findings: Vec<Finding>,
    /// Why the job cannot run; empty where it can.
    pub errors: Vec<RunError>,
    /// Duration at full override, in seconds.
    pub duration: f64,
    /// Steps walked.
    pub steps: usize,
    /// Moves among them.
    pub moves: usize,
    /// The program reads inputs, so that it cannot be planned ahead of the robot.
    pub reads_inputs: bool,
}

/// A remark on an instruction: accepted, and reported by the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The instruction.
    pub at: Place,
    /// What.
    pub text: String,
}

/// Walks the whole job without moving anything.
///
/// # Errors
/// Where the walk cannot even begin; problems on the way are in the report.
pub fn check<const N: usize, K: PlanningArm<N>>(
    program: &Program,
    cell: &Cell,
    arm: &Arm<N, K>,
) -> Result<CheckReport, RunError> {
    let report = walk_through(program, cell, arm, false)?;
    // The robot of a job that reads inputs arrives at each point before the next instruction is read.
    if report.reads_inputs { walk_through(program, cell, arm, true) } else { Ok(report) }
}

fn walk_through<const N: usize, K: PlanningArm<N>>(
    program: &Program,
    cell: &Cell,
    arm: &Arm<N, K>,
    in_step: bool,
) -> Result<CheckReport, RunError> {
    let mut walk = Walk::new(program, cell, arm)?;
    let mut report = CheckReport {
        findings: Vec::new(),
        errors: Vec::new(),
        duration: 0.0,
        steps: 0,
        moves: 0,
        reads_inputs: false,
    };
    while walk.is_straight() || (report.steps < STEPS_MAX && report.duration < DURATION_MAX) {
        if in_step && !walk.goes_on_ahead() {
            report.finish(&mut walk);
        }
        let before = walk.inputs_read();
        match walk.next(report.duration) {
            Ok(None) => {
                report.finish(&mut walk);
                return Ok(report);
            }
            Ok(Some(step)) => {
                report.steps += 1;
                report.moves += usize::from(matches!(step.action, Action::Move(_)));
                report.reads_inputs |= walk.inputs_read() > before;
                report.take(&mut walk, &step);
            }
            Err(error) if walk.is_straight() => report.add_error(error),
            Err(error) => {
                // The program itself fails: there is no next step.
                report.finish(&mut walk);
                report.errors.push(error);
                return Ok(report);
            }
        }
    }
    report.finish(&mut walk);
    let text = format!("the job does not end within {:.0} h; it is checked so far", report.duration / 3600.0);
    report.findings.push(Finding { at: program.start(), text });
    Ok(report)
}

impl CheckReport {
    fn take<const N: usize, K: PlanningArm<N>>(&mut self, walk: &mut Walk<'_, N, K>, step: &Step) {
        let mut parts = Vec::new();
        if let Err(error) = walk.plan(step, &mut parts) {
            self.add_error(error);
        }
        self.add(walk, parts);
    }

    /// What is left of the motion. Each error leaves a step out, so that this ends.
    fn finish<const N: usize, K: PlanningArm<N>>(&mut self, walk: &mut Walk<'_, N, K>) {
        loop {
            let mut parts = Vec::new();
            let result = walk.finish(&mut parts);
            self.add(walk, parts);
            match result {
                Ok(()) => return,
                Err(error) => self.add_error(error),
            }
        }
    }

    fn add<const N: usize, K: PlanningArm<N>>(&mut self, walk: &mut Walk<'_, N, K>, parts: Vec<Planned<N>>) {
        for part in parts {
            for notice in &part.notices {
                self.note(walk, &part.at, notice);
            }
            let action = part.action.as_ref();
            if let Some(Action::Wait { condition, timeout_seconds }) = action {
                self.wait(walk, &part.at, condition, *timeout_seconds);
            }
            self.duration += part.duration;
            if let Some(text) = action.and_then(announcement) {
                self.note(walk, &part.at, &text);
            }
        }
    }

    fn wait<const N: usize, K: PlanningArm<N>>(
        &mut self,
        walk: &mut Walk<'_, N, K>,
        at: &Location,
        condition: &Condition,
        timeout: Option<f64>,
    ) {
        self.reads_inputs = true;
        match waiting_time(walk, condition, timeout, self.duration) {
            Some(seconds) => self.duration += seconds,
            None if walk.stops_at_unmet_wait() => {
                self.errors.push(RunError::UnmetWait { at: walk.place(at) });
            }
            None => self.note(walk, at, "WAIT is never met by the scripted inputs: the run goes on at once"),
        }
    }

    fn add_error(&mut self, error: RunError) {
        // A line in a loop fails once.
        if !self.errors.iter().any(|known| known.to_string() == error.to_string()) {
            self.errors.push(error);
        }
    }

    fn note<const N: usize, K: PlanningArm<N>>(&mut self, walk: &Walk<'_, N, K>, at: &Location, text: &str) {
        let finding = Finding { at: walk.place(at), text: text.to_owned() };
        // A line in a loop is noted once.
        if !self.findings.contains(&finding) {
            self.findings.push(finding);
        }
    }
}

/// How long the program waits, by the scripted inputs; `None` where it waits in vain.
fn waiting_time<const N: usize, K: PlanningArm<N>>(
    walk: &mut Walk<'_, N, K>,
    condition: &Condition,
    timeout: Option<f64>,
    now: f64,
) -> Option<f64> {
    let limit = timeout.unwrap_or(WAIT_MAX);
    let tries = (limit / WAIT_STEP) as usize;
    let met = (0..=tries).map(|k| k as f64 * WAIT_STEP).find(|wait| walk.holds(condition, now + wait));
    met.or(timeout)
}

impl<const N: usize, K: PlanningArm<N>> Walk<'_, N, K> {
    fn stops_at_unmet_wait(&self) -> bool {
        self.cell().io.unmet_wait == UnmetWait::Stop
    }
}
