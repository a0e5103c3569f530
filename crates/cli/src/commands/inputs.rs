//! What `run` and `check` read: a job with the jobs it calls, and a cell.

use std::path::Path;

use seamline::kinematics::SixAxisArm;
use seamline_cell::cell::Cell;
use seamline_cell::job::JobSet;
use seamline_cell::plan::Arm;
use seamline_cell::run::RunError;

/// A job and the cell it runs in.
#[derive(Debug)]
pub(crate) struct Inputs {
    pub(crate) jobs: JobSet,
    pub(crate) cell: Cell,
    pub(crate) arm: Arm<6, SixAxisArm>,
}

/// Reads both; the first wrong file is the error.
pub(crate) fn load(job: &Path, cell: Option<&Path>) -> anyhow::Result<Inputs> {
    let cell = match cell {
        Some(path) => Cell::load(path)?,
        None => Cell::default_cell()?,
    };
    let arm = Arm::from_cell(&cell).map_err(RunError::from)?;
    let jobs = JobSet::load(job)?;
    Ok(Inputs { jobs, cell, arm })
}
