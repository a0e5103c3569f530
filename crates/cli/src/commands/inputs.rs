//! What `run` and `check` read: a job with the jobs it calls, and a cell.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use seamline::control::ActsOn;
use seamline::vibration::Prefilter;
use seamline_cell::cell::Cell;
use seamline_cell::plan::CellArm;
use seamline_cell::run::{Program, RunError};

use super::modes::prefilter;

/// The cell that a subcommand is about.
#[derive(Debug, clap::Args)]
pub(crate) struct CellArguments {
    /// Cell file (TOML), or a built-in cell (default, scara); without it the default.
    #[arg(long = "cell", value_name = "NAME|F.toml")]
    source: Option<PathBuf>,
    /// Prefilter, made for the cell's flexible modes, in place of the cell's own: none, zv, zvd, fir, fir-zv,
    /// fir-zvd, mzv, ei, 2hump-ei, 3hump-ei.
    #[arg(long, value_name = "NAME", value_parser = prefilter)]
    prefilter: Option<Prefilter>,
    /// What the prefilter acts on, in place of what the cell says: joints (paths and corners are left a little) or feedrate (the tool stays on
    /// its path).
    #[arg(long = "prefilter-on", value_name = "WHAT", value_parser = acts_on)]
    acts_on: Option<ActsOn>,
}

impl CellArguments {
    fn read(&self) -> anyhow::Result<Cell> {
        let mut cell = self.read_source()?;
        if let Some(prefilter) = self.prefilter {
            cell.vibration = cell.vibration.with_prefilter(prefilter).map_err(|error| {
                anyhow!("--prefilter {}: expected {error}", prefilter.name().to_lowercase())
            })?;
        }
        if let Some(acts_on) = self.acts_on {
            cell.vibration = cell.vibration.acting_on(acts_on);
        }
        Ok(cell)
    }

    fn read_source(&self) -> anyhow::Result<Cell> {
        let Some(path) = &self.source else { return Ok(Cell::default_cell()?) };
        match path.to_str().and_then(Cell::built_in) {
            Some(cell) => Ok(cell?),
            None => Ok(Cell::load(path)?),
        }
    }
}

fn acts_on(text: &str) -> Result<ActsOn, String> {
    match text {
        "joints" => Ok(ActsOn::Joints),
        "feedrate" => Ok(ActsOn::Feedrate),
        _ => Err("expected joints or feedrate".into()),
    }
}

/// A job and the cell it runs in.
#[derive(Debug)]
pub(crate) struct Inputs {
    pub(crate) program: Program,
    pub(crate) cell: Cell,
    pub(crate) arm: CellArm,
}

/// Reads both; the first wrong file is the error.
pub(crate) fn load(job: &Path, cell: &CellArguments) -> anyhow::Result<Inputs> {
    let cell = cell.read()?;
    let arm = CellArm::from_cell(&cell).map_err(RunError::from)?;
    let program = Program::load(job)?;
    Ok(Inputs { program, cell, arm })
}
