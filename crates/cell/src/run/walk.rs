//! Interpreter and planner side by side: one step of the job, and what it becomes.

use super::error::{Place, RunError};
use super::world::CellWorld;
use crate::cell::{Cell, SpeedUnit};
use crate::job::{Condition, Interpreter, JobSet, LinearSpeedUnit, SignalKind, Step, World};
use crate::plan::{Arm, PlanError, Planned, Planner, PlanningArm};

/// How long a WAIT without limit is tried, in seconds.
pub(super) const WAIT_MAX: f64 = 3600.0;

/// A walk through a job.
#[derive(Debug)]
pub(super) struct Walk<'a, const N: usize, K> {
    jobs: &'a JobSet,
    interpreter: Interpreter,
    planner: Planner<'a, N, K>,
    world: CellWorld<'a, N, K>,
}

impl<'a, const N: usize, K: PlanningArm<N>> Walk<'a, N, K> {
    pub(super) fn new(jobs: &'a JobSet, cell: &'a Cell, arm: &'a Arm<N, K>) -> Result<Self, RunError> {
        let unit = match cell.job.speed_unit {
            SpeedUnit::MillimetrePerSecond => LinearSpeedUnit::MillimetrePerSecond,
            SpeedUnit::CentimetrePerMinute => LinearSpeedUnit::CentimetrePerMinute,
        };
        let entry = jobs.entry();
        let at = Place { file: entry.file.to_string(), line: entry.line, column: 1 };
        let planner = Planner::new(arm, cell, arm.home).map_err(|problem| RunError::Plan { at, problem })?;
        Ok(Self {
            jobs,
            interpreter: Interpreter::new(jobs, unit),
            planner,
            world: CellWorld::new(cell, arm),
        })
    }

    /// The next step of the program, read at `time` seconds after its start; `None` after the end.
    pub(super) fn next(&mut self, time: f64) -> Result<Option<Step>, RunError> {
        self.world.time = time;
        self.world.joints = *self.planner.joints();
        let step = self.interpreter.next(&mut self.world)?;
        match (self.world.refused.take(), &step) {
            (Some(number), Some(step)) => Err(RunError::UnscriptedInput { at: self.place(step), number }),
            _ => Ok(step),
        }
    }

    /// What the step becomes; the planner stays where it was where that fails.
    pub(super) fn plan(&mut self, step: &Step) -> Result<Planned<N>, RunError> {
        self.planner
            .plan(step)
            .map_err(|PlanError { problem, .. }| RunError::Plan { at: self.place(step), problem })
    }

    /// Goes on from the step's target as if it had been reached.
    pub(super) fn skip(&mut self, step: &Step) {
        self.planner.skip(step);
    }

    /// Whether a condition on the cell's signals holds at `time`.
    pub(super) fn holds(&mut self, condition: &Condition, time: f64) -> bool {
        self.world.time = time;
        let world = &mut self.world;
        condition.holds(&mut |kind: SignalKind, number| world.input(kind, number))
    }

    /// Whether a condition may still come true after `time`: the scripts change no more after their last toggle.
    pub(super) fn may_still_hold(&mut self, condition: &Condition, time: f64) -> bool {
        let last = self.cell().io.inputs.iter().flat_map(|input| input.toggles.last().copied());
        let last = last.fold(0.0, f64::max);
        time <= last || self.holds(condition, time)
    }

    pub(super) fn cell(&self) -> &'a Cell {
        self.world.cell
    }

    /// Inputs read so far.
    pub(super) fn inputs_read(&self) -> u64 {
        self.world.inputs_read
    }

    /// Where a step's instruction stands.
    pub(super) fn place(&self, step: &Step) -> Place {
        let job = self.jobs.jobs().find(|job| job.name == step.at.job);
        let statement = job.and_then(|job| job.program.iter().find(|s| s.line == step.at.line));
        Place {
            file: job.map_or_else(|| step.at.job.to_string(), |job| job.file.to_string()),
            line: step.at.line,
            column: statement.map_or(1, |statement| statement.column),
        }
    }
}
