//! `seamline profile`: the timed profile by itself, and what a new target does to it.

mod answer;
mod page;
mod plot;
mod run;

use std::path::PathBuf;

use anyhow::Context as _;
use clap::ValueEnum;
use seamline::timed::Takeover;
use seamline_cell::record::write_whole;

use crate::json_lines::print_line;
use run::Run;

const HELP: &str = "\
With V = (G - S) / (T (1 - n)), A = V / (T (n - n^2)) and J = A / (T n^2), n above 0 and at most 0.5,
the axis is in G at rest after exactly T. The new target is to be reached in the same T and n, from
its own instant on; the axis may be moving then, or hold its target already.

The answer, on one line:
  {\"from_mm\", \"to_mm\", \"time_s\", \"n\", \"velocity_mm_s\": V, \"acceleration_mm_s2\": A, \"jerk_mm_s3\": J,
   \"switch_times_s\": [7], \"end_s\", \"retarget\": null or {\"mode\", \"at_s\", \"to_mm\", \"while\": \"moving\" or
   \"holding\", \"from\": SAMPLE, \"arrival_s\", \"limits\": {\"velocity_mm_s\", \"acceleration_mm_s2\",
   \"jerk_mm_s3\"}, \"velocity_jump_mm_s\", \"acceleration_jump_mm_s2\"}, \"samples\": [SAMPLE, ..]}
SAMPLE is {\"time_s\", \"activity\", \"position_mm\", \"velocity_mm_s\", \"acceleration_mm_s2\", \"jerk_mm_s3\"}; in
\"from\" it is what the axis did when the new target came.

Example:
  seamline profile --from-mm 0 --to-mm 100 --time 3 --n 0.3333 --retarget-at 1.2 --retarget-to-mm 40 \\
    --plot profile.html";

/// Move one axis to a target in a given time, on seven phases of constant jerk: JSON, and a plot.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Where the axis starts: S.
    #[arg(long, value_name = "MM", default_value_t = 0.0, allow_negative_numbers = true)]
    from_mm: f64,
    /// Where it is to be: G.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    to_mm: f64,
    /// When, in seconds: T.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    time: f64,
    /// Time-scale factor: the share of the time that each ramp takes.
    #[arg(long, default_value_t = 1.0 / 3.0, allow_negative_numbers = true)]
    n: f64,
    /// When a new target comes, in seconds from the start.
    #[arg(long, value_name = "S", requires = "retarget_to_mm", value_parser = instant)]
    retarget_at: Option<f64>,
    /// The new target.
    #[arg(long, value_name = "MM", requires = "retarget_at", allow_negative_numbers = true)]
    retarget_to_mm: Option<f64>,
    /// What the new target does to the motion.
    #[arg(long, value_enum, default_value_t = Mode::Continuous, requires = "retarget_at")]
    mode: Mode,
    /// Samples at equal intervals from start to end.
    #[arg(long, value_name = "N", default_value_t = 101, value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    samples: u32,
    /// Write the curves to a page that opens offline.
    #[arg(long, value_name = "F.html")]
    plot: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Mode {
    /// Velocity and acceleration are taken over.
    Continuous,
    /// The new profile starts at rest: velocity and acceleration jump.
    RestartFromRest,
}

impl Mode {
    fn name(self) -> &'static str {
        match self {
            Self::Continuous => "continuous",
            Self::RestartFromRest => "restart-from-rest",
        }
    }
}

impl From<Mode> for Takeover {
    fn from(mode: Mode) -> Self {
        match mode {
            Mode::Continuous => Self::Continuous,
            Mode::RestartFromRest => Self::RestartFromRest,
        }
    }
}

/// Not before the start.
fn instant(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected seconds from the start, 0 or more".into()),
    }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let run = Run::new(arguments)?;
    if let Some(path) = &arguments.plot {
        write_whole(path, plot::page(arguments, &run).as_bytes())
            .with_context(|| path.display().to_string())?;
    }
    print_line(&answer::Answer::new(arguments, &run))
}
