//! `seamline experiment`: published experiments in simulation.

use std::io::Write as _;
use std::path::PathBuf;

use seamline_cell::experiment::{CORNER_ERRORS, Outcome, ScaraRun, scara};
use seamline_cell::identify::amplitude_spectrum;
use serde::Serialize;

use super::modes::number;
use crate::json_lines::print_line;
use crate::plot::{Chart, Page, Series};

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
  seamline experiment scara --plant-drift-pct 15 --plot scara.html";

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
    /// Draw feedrates, corners and vibration on a page that opens offline.
    #[arg(long, value_name = "F.html")]
    plot: Option<PathBuf>,
}

fn drift(text: &str) -> Result<f64, String> {
    number(text, |x| (-90.0..=900.0).contains(&x), "a number from -90 to 900")
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let Experiment::Scara(arguments) = &arguments.experiment;
    let outcome = scara(0.01 * arguments.plant_drift_pct)?;
    let answer = Answer::of(&outcome);
    if let Some(path) = &arguments.plot {
        page(&outcome, arguments.plant_drift_pct).write(path)?;
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
        let bare = outcome.bare(*permitted).unwrap_or(run);
        Self {
            prefilter: prefilter.name(),
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
        let worst = row.corner_errors_mm.iter().copied().fold(0.0, f64::max);
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
            worst
        )?;
    }
    Ok(())
}

/// Points that a chart of a whole run keeps, at most.
const KEPT: usize = 1500;

fn page(outcome: &Outcome, drift: f64) -> Page {
    let identified = &outcome.identified;
    let facts = vec![
        ("identified".to_owned(), format!("{:.4} Hz, ζ {:.5}", identified.frequency_hz, identified.damping)),
        ("plant's drift".to_owned(), format!("{drift} %")),
    ];
    let mut charts = measured(outcome);
    for permitted in CORNER_ERRORS {
        charts.push(over_time(outcome, permitted, "Feedrate", "mm/s", &speeds));
    }
    charts.extend((0..4).map(|corner| close_up(outcome, corner)));
    for permitted in CORNER_ERRORS {
        charts.push(over_time(outcome, permitted, "Acceleration of the tool", "g", &accelerations));
    }
    Page { title: "SCARA experiment".to_owned(), facts, charts }
}

/// The vibration that the mode was identified from, and its spectrum.
fn measured(outcome: &Outcome) -> Vec<Chart> {
    let signal = &outcome.measured;
    let values = signal.times.iter().zip(&signal.values).map(|(t, value)| (*t, value / G));
    let spectrum = amplitude_spectrum(signal).into_iter().take_while(|(f, _)| *f <= 20.0);
    let vibration = Chart {
        title: "Vibration left by the bare command, as measured".to_owned(),
        x: "time, s".to_owned(),
        y: "acceleration in x, g".to_owned(),
        series: vec![Series::new("measured", values)],
        ..Chart::default()
    };
    let frequency = outcome.identified.frequency_hz;
    let spectrum = Chart {
        title: "Its spectrum".to_owned(),
        x: "frequency, Hz".to_owned(),
        y: "amplitude, g".to_owned(),
        series: vec![Series::new("measured", spectrum.map(|(f, amplitude)| (f, amplitude / G)))],
        marks: vec![(frequency, format!("{frequency:.3} Hz"))],
        ..Chart::default()
    };
    vec![vibration, spectrum]
}

fn speeds(run: &ScaraRun) -> Vec<(f64, f64)> {
    let steps = run.run.trace.windows(2);
    let speed = |pair: &[seamline_cell::experiment::Sample]| {
        let (from, to) = (&pair[0], &pair[1]);
        (to.time, 1e3 * (to.command - from.command).norm() / (to.time - from.time))
    };
    steps.map(speed).take_while(|(time, _)| *time <= run.run.path_time + 0.05).collect()
}

fn accelerations(run: &ScaraRun) -> Vec<(f64, f64)> {
    run.run.trace.iter().map(|sample| (sample.time, sample.acceleration.norm() / G)).collect()
}

type Curve<'a> = &'a dyn Fn(&ScaraRun) -> Vec<(f64, f64)>;

fn over_time(outcome: &Outcome, permitted: f64, title: &str, unit: &str, curve: Curve<'_>) -> Chart {
    let runs = outcome.runs.iter().filter(|run| run.permitted == permitted);
    let series = runs.map(|run| {
        let points = curve(run);
        let every = points.len().div_ceil(KEPT).max(1);
        Series::new(run.prefilter.name(), points.into_iter().step_by(every))
    });
    Chart {
        title: format!("{title}, corner error {:.0} µm", 1e6 * permitted),
        x: "time, s".to_owned(),
        y: unit.to_owned(),
        series: series.collect(),
        wide: true,
        ..Chart::default()
    }
}

/// The commanded paths around a corner, for the greater corner error.
fn close_up(outcome: &Outcome, corner: usize) -> Chart {
    const CORNERS_MM: [[f64; 2]; 4] = [[140.0, 40.0], [275.0, 100.0], [410.0, 40.0], [360.0, 90.0]];
    const SHOWN_MM: f64 = 2.5;
    let [x, y] = CORNERS_MM[corner];
    let near = |p: &(f64, f64)| (p.0 - x).abs() < SHOWN_MM && (p.1 - y).abs() < SHOWN_MM;
    let runs = outcome.runs.iter().filter(|run| run.permitted == CORNER_ERRORS[1]);
    let series = runs.map(|run| {
        let places = run.run.trace.iter().map(|s| (1e3 * s.command.x, 1e3 * s.command.y));
        Series::new(run.prefilter.name(), places.filter(near))
    });
    let angle = outcome
        .runs
        .first()
        .and_then(|run| run.run.corners.get(corner))
        .map_or(0.0, |c| c.angle.to_degrees());
    Chart {
        title: format!("Corner {} of {angle:.2}°, commanded, 500 µm", corner + 1),
        x: "x, mm".to_owned(),
        y: "y, mm".to_owned(),
        series: series.collect(),
        equal: true,
        ..Chart::default()
    }
}
