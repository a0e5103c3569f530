//! `seamline experiment`: published experiments in simulation.

mod auto;
mod page;

use std::io::Write as _;
use std::path::PathBuf;

use seamline_cell::experiment::{Outcome, Run, ScaraRun, scara};
use serde::Serialize;

use super::modes::number;
use crate::json_lines::print_line;

/// Repeat a published experiment in simulation.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  seamline experiment scara --plot scara.html")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    experiment: Experiment,
}

#[derive(Debug, clap::Subcommand)]
enum Experiment {
    Scara(ScaraArguments),
}

const SCARA_HELP: &str = "\
A SCARA of 325 mm and 275 mm links carries a flexible tool (6.340 Hz, damping ratio 0.022) along an arc and four lines
at 9600 mm/min. The mode is identified from the vibration that the bare command leaves, the prefilters are designed for
what was identified, and each runs with corner errors of 0 and 500 um. Accelerations are those of the tool; the
residual is what is left after the last command.

Example:
  seamline experiment scara --plant-drift-pct 15 --plot scara.html
  seamline experiment scara --prefilter auto --plot auto.html";

/// Vibration and corner error of a SCARA for each prefilter (Yeh & You 2026, section 5).
#[derive(Debug, clap::Args)]
#[command(after_help = SCARA_HELP)]
struct ScaraArguments {
    /// Print JSON in place of the table.
    #[arg(long)]
    json: bool,
    /// Change of the plant's frequency after the identification, in percent.
    #[arg(long, value_name = "P", default_value_t = 0.0, allow_hyphen_values = true, value_parser = drift)]
    plant_drift_pct: f64,
    /// Draw feedrates, corners, vibration and its spectrum on a page that opens offline.
    #[arg(long, value_name = "F.html")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    auto: auto::AutoArguments,
}

fn drift(text: &str) -> Result<f64, String> {
    number(text, |x| (-90.0..=900.0).contains(&x), "a number from -90 to 900")
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let Experiment::Scara(arguments) = &arguments.experiment;
    if arguments.auto.asked() {
        return auto::run(arguments);
    }
    let outcome = scara(0.01 * arguments.plant_drift_pct)?;
    let answer = Answer::of(&outcome);
    if let Some(path) = &arguments.plot {
        page::page(&outcome, &answer, arguments.plant_drift_pct)?.write(path)?;
    }
    if arguments.json { print_line(&answer) } else { Ok(print_table(&answer)?) }
}

#[derive(Serialize)]
struct Answer {
    identified: Identified,
    runs: Vec<Row>,
}

#[derive(Serialize)]
struct Identified {
    frequency_hz: f64,
    damping: f64,
}

#[derive(Serialize)]
struct Row {
    prefilter: &'static str,
    error_um: f64,
    max_g: f64,
    rms_g: f64,
    reduction_max_pct: f64,
    reduction_rms_pct: f64,
    residual_pct: f64,
    path_time_s: f64,
    corner_errors_mm: Vec<f64>,
}

/// Standard gravity, in m/s².
const G: f64 = 9.80665;

impl Answer {
    fn of(outcome: &Outcome) -> Self {
        let identified =
            Identified { frequency_hz: outcome.identified.frequency_hz, damping: outcome.identified.damping };
        Self { identified, runs: outcome.runs.iter().map(|run| Row::of(outcome, run)).collect() }
    }
}

impl Row {
    fn of(outcome: &Outcome, ScaraRun { prefilter, permitted, run }: &ScaraRun) -> Self {
        Self::beside(outcome.bare(*permitted).unwrap_or(run), prefilter.name(), *permitted, run)
    }

    /// Reductions refer to the bare command's run.
    fn beside(bare: &Run, prefilter: &'static str, permitted: f64, run: &Run) -> Self {
        Self {
            prefilter,
            error_um: 1e6 * permitted,
            max_g: run.acceleration_max / G,
            rms_g: run.acceleration_rms / G,
            reduction_max_pct: 100.0 * (1.0 - run.acceleration_max / bare.acceleration_max),
            reduction_rms_pct: 100.0 * (1.0 - run.acceleration_rms / bare.acceleration_rms),
            residual_pct: 100.0 * run.residual_max / bare.residual_max,
            path_time_s: run.path_time,
            corner_errors_mm: run.corners.iter().map(|corner| 1e3 * corner.error).collect(),
        }
    }

    fn worst_corner_mm(&self) -> f64 {
        self.corner_errors_mm.iter().copied().fold(0.0, f64::max)
    }
}

fn print_table(answer: &Answer) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    let Identified { frequency_hz, damping } = answer.identified;
    writeln!(out, "identified: {frequency_hz:.4} Hz, damping ratio {damping:.5}")?;
    let mut error = f64::NAN;
    for row in &answer.runs {
        if row.error_um != error {
            error = row.error_um;
            writeln!(out, "\ncorner error {error:.0} um")?;
            writeln!(
                out,
                "  prefilter   max g  reduced   RMS g  reduced  residual  path time  greatest corner error"
            )?;
        }
        writeln!(
            out,
            "  {:<9} {:7.4} {:6.2} % {:7.4} {:6.2} % {:7.3} % {:8.3} s {:13.4} mm",
            row.prefilter,
            row.max_g,
            row.reduction_max_pct,
            row.rms_g,
            row.reduction_rms_pct,
            row.residual_pct,
            row.path_time_s,
            row.worst_corner_mm()
        )?;
    }
    Ok(())
}
