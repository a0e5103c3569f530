//! Interpreter and planner side by side: one step of the job, and what it becomes.

use super::error::{Place, RunError};
use super::passes;
use super::program::Program;
use super::world::CellWorld;
use crate::cell::{Cell, SpeedUnit};
use crate::gcode;
use crate::job::{Action, Condition, Interpreter, LinearSpeedUnit, Location, SignalKind, Step, World};
use crate::plan::{Arm, PlanError, Planned, Planner, PlanningArm};

/// How long a WAIT without limit is tried, in seconds.
pub(super) const WAIT_MAX: f64 = 3600.0;

/// What reads the program, by its language.
#[derive(Debug)]
enum Reader<'a> {
    Inform(Box<Interpreter>),
    GCode(Box<gcode::Interpreter<'a>>),
}

/// A walk through a job.
#[derive(Debug)]
pub(super) struct Walk<'a, const N: usize, K> {
    program: &'a Program,
    reader: Reader<'a>,
    planner: Planner<'a, N, K>,
    world: CellWorld<'a, N, K>,
}

impl<'a, const N: usize, K: PlanningArm<N>> Walk<'a, N, K> {
    pub(super) fn new(program: &'a Program, cell: &'a Cell, arm: &'a Arm<N, K>) -> Result<Self, RunError> {
        let mut planner = Planner::new(arm, cell, arm.home)
            .map_err(|problem| RunError::Plan { at: program.start(), problem })?;
        for (file, lanes) in passes::load(cell)? {
            planner.remember_passes(file, &lanes);
        }
        let world = CellWorld::new(cell, arm);
        let reader = match program {
            Program::Inform(jobs) => {
                let unit = match cell.job.speed_unit {
                    SpeedUnit::MillimetrePerSecond => LinearSpeedUnit::MillimetrePerSecond,
                    SpeedUnit::CentimetrePerMinute => LinearSpeedUnit::CentimetrePerMinute,
                };
                Reader::Inform(Box::new(Interpreter::new(jobs, unit)))
            }
            Program::GCode(program) => {
                Reader::GCode(Box::new(gcode::Interpreter::new(program, world.gcode_setup())))
            }
        };
        Ok(Self { program, reader, planner, world })
    }

    /// The next step of the program, read at `time` seconds after its start; `None` after the end.
    pub(super) fn next(&mut self, time: f64) -> Result<Option<Step>, RunError> {
        self.world.time = time;
        self.world.joints = *self.planner.joints();
        let step = match &mut self.reader {
            Reader::Inform(interpreter) => interpreter.next(&mut self.world)?,
            Reader::GCode(interpreter) => interpreter.next_step()?,
        };
        match (self.world.refused.take(), &step) {
            (Some(number), Some(step)) => Err(RunError::UnscriptedInput { at: self.place(&step.at), number }),
            _ => Ok(step),
        }
    }

    /// Whether the next step may be taken before the robot has done those before although the job reads inputs: along a tracked seam the way ahead
    /// must be known. A step that reads an input, or waits for one, may not.
    pub(super) fn goes_on_ahead(&self) -> bool {
        let Reader::Inform(interpreter) = &self.reader else { return false };
        if !self.planner.tracks() {
            return false;
        }
        let mut world = self.world.clone();
        let next = interpreter.as_ref().clone().next(&mut world);
        let waits = !matches!(next, Ok(Some(step)) if !matches!(step.action, Action::Wait { .. }));
        !waits && world.inputs_read == self.world.inputs_read
    }

    /// The program has no flow: it ends, and can be walked on behind a line that is wrong.
    pub(super) fn is_straight(&self) -> bool {
        matches!(self.reader, Reader::GCode(_))
    }

    /// Whether some of the steps taken have not been handed out.
    pub(super) fn holds_back(&self) -> bool {
        self.planner.holds_back()
    }

    /// Takes a step; hands out what is settled of the motion by now.
    pub(super) fn plan(&mut self, step: &Step, out: &mut Vec<Planned<N>>) -> Result<(), RunError> {
        self.planner.take(step, out).map_err(|error| self.plan_error(error))
    }

    /// Hands out what is left of the motion.
    pub(super) fn finish(&mut self, out: &mut Vec<Planned<N>>) -> Result<(), RunError> {
        self.planner.finish(out).map_err(|error| self.plan_error(error))
    }

    fn plan_error(&self, PlanError { at, problem }: PlanError) -> RunError {
        RunError::Plan { at: self.place(&at), problem }
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

    /// Where an instruction stands.
    pub(super) fn place(&self, at: &Location) -> Place {
        self.program.place(at)
    }
}
