//! `seamline check`: the whole job, planned and not run.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::bail;
use seamline_cell::run::CheckReport;

use super::inputs::{CellArguments, load};

/// Parse, resolve and plan a job without running it, and name every problem.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  seamline check examples/jobs/near_wrist.JBI")]
pub(crate) struct Arguments {
    /// The job file: INFORM (.JBI), or G-code (.ngc, .nc, .gcode, .tap).
    job: PathBuf,
    #[command(flatten)]
    cell: CellArguments,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let inputs = load(&arguments.job, &arguments.cell)?;
    let report = inputs.arm.check(&inputs.program, &inputs.cell)?;
    print(&report)?;
    match report.errors.as_slice() {
        [] => Ok(()),
        [error] => bail!("{error}"),
        errors => {
            let text: Vec<String> = errors.iter().map(ToString::to_string).collect();
            bail!("{} problems\n{}", errors.len(), text.join("\n"))
        }
    }
}

fn print(report: &CheckReport) -> std::io::Result<()> {
    let mut stdout = std::io::stdout().lock();
    for finding in &report.findings {
        writeln!(stdout, "{}: {}", finding.at, finding.text)?;
    }
    writeln!(
        stdout,
        "{} steps, {} moves, {:.2} s at full override: {}",
        report.steps,
        report.moves,
        report.duration,
        if report.errors.is_empty() { "ready to run" } else { "cannot run" }
    )
}
