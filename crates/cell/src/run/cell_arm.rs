//! Checks and runs on the arm of a cell, whichever kind it is.

use super::check::{CheckReport, check};
use super::error::RunError;
use super::program::Program;
use super::session::{Progress, RunOptions, RunReport, run};
use crate::cell::Cell;
use crate::plan::CellArm;

impl CellArm {
    /// [`check()`] with this arm.
    ///
    /// # Errors
    /// As there.
    pub fn check(&self, program: &Program, cell: &Cell) -> Result<CheckReport, RunError> {
        match self {
            Self::SixAxis(arm) => check(program, cell, &**arm),
            Self::Scara(arm) => check(program, cell, &**arm),
        }
    }

    /// [`run()`] with this arm.
    ///
    /// # Errors
    /// As there.
    pub fn run(
        &self,
        program: &Program,
        cell: &Cell,
        options: &RunOptions,
        progress: impl FnMut(Progress),
    ) -> Result<RunReport, RunError> {
        match self {
            Self::SixAxis(arm) => run(program, cell, arm, options, progress),
            Self::Scara(arm) => run(program, cell, arm, options, progress),
        }
    }
}
