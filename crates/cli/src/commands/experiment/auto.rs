//! `seamline experiment scara --prefilter auto`: the motion of least time for a vibration bound, and what more or less vibration costs.

use std::io::Write as _;

use seamline_cell::experiment::{AutoOptions, AutoOutcome, CORNER_ERRORS, Compared, scara_auto};
use serde::Serialize;

use super::super::modes::{not_negative, number, positive};
use super::page::{ACCELERATION, Curve, FEEDRATE, accelerations, over_time, results, speeds};
use super::{Answer, G, Identified, Row, ScaraArguments, print_table};
use crate::json_lines::print_line;
use crate::plot::{Chart, Page, Series};

/// What `--prefilter auto` is asked for.
#[derive(Debug, clap::Args)]
pub(super) struct AutoArguments {
    /// In place of the six prefilters, the motion of least time for a vibration bound and a corner error, beside the bare command
    /// and FIR-ZVD.
    #[arg(long, value_name = "auto", value_parser = auto)]
    prefilter: Option<String>,
    /// With auto: corner errors in micrometres, with commas between them; 0 and 500 if not given.
    #[arg(long, value_name = "E", value_delimiter = ',', value_parser = not_negative, requires = "prefilter")]
    error_um: Vec<f64>,
    /// With auto: greatest acceleration of the tool, in g; that of FIR-ZVD if not given.
    #[arg(long, value_name = "G", value_parser = positive, requires = "prefilter")]
    max_g: Option<f64>,
    /// With auto: RMS of the tool's acceleration while it moves, in g; open if not given.
    #[arg(long, value_name = "G", value_parser = positive, requires = "prefilter")]
    rms_g: Option<f64>,
    /// With auto: how fast the command's acceleration may change, in m/s³; open if not given. 300 makes smooth feedrates.
    #[arg(long, value_name = "J", value_parser = positive, requires = "prefilter")]
    jerk_m_s3: Option<f64>,
    /// With auto: change of the mode's frequency up to which the residual stays small, in percent.
    #[arg(long, value_name = "P", default_value_t = 15.0, value_parser = safe, requires = "prefilter")]
    safe_drift_pct: f64,
}

fn auto(text: &str) -> Result<String, String> {
    if text == "auto" {
        Ok(text.to_owned())
    } else {
        Err("expected auto: without it, all six prefilters run".to_owned())
    }
}

fn safe(text: &str) -> Result<f64, String> {
    number(text, |x| (0.0..=30.0).contains(&x), "a number from 0 to 30")
}

impl AutoArguments {
    pub(super) fn asked(&self) -> bool {
        self.prefilter.is_some()
    }
}

pub(super) fn run(arguments: &ScaraArguments) -> anyhow::Result<()> {
    let auto = &arguments.auto;
    let corner_errors = if auto.error_um.is_empty() {
        CORNER_ERRORS.to_vec()
    } else {
        auto.error_um.iter().map(|error| 1e-6 * error).collect()
    };
    let outcome = scara_auto(&AutoOptions {
        plant_drift: 0.01 * arguments.plant_drift_pct,
        corner_errors,
        acceleration: auto.max_g.map(|g| g * G),
        acceleration_rms: auto.rms_g.map(|g| g * G),
        jerk: auto.jerk_m_s3,
        safe_drift: 0.01 * auto.safe_drift_pct,
    })?;
    let rows = outcome.compared.iter().flat_map(rows).collect();
    let identified =
        Identified { frequency_hz: outcome.identified.frequency_hz, damping: outcome.identified.damping };
    let answer = Answer { identified, runs: rows };
    if let Some(path) = &arguments.plot {
        page(&outcome, &answer, arguments)?.write(path)?;
    }
    let times: Vec<_> = outcome.compared.iter().map(Comparison::of).collect();
    if arguments.json {
        return print_line(&AutoAnswer { answer, against_fir_zvd: times });
    }
    print_table(&answer)?;
    Ok(print_comparison(&times)?)
}

fn rows(compared: &Compared) -> [Row; 3] {
    [("none", &compared.bare), ("FIR-ZVD", &compared.fir_zvd), ("auto", &compared.auto)]
        .map(|(name, run)| Row::beside(&compared.bare, name, compared.permitted, run))
}

#[derive(Serialize)]
struct AutoAnswer {
    #[serde(flatten)]
    answer: Answer,
    against_fir_zvd: Vec<Comparison>,
}

/// Auto over FIR-ZVD with the same corner error.
#[derive(Serialize)]
struct Comparison {
    error_um: f64,
    bound_g: f64,
    path_time: f64,
    max: f64,
    rms: f64,
    residual: f64,
}

impl Comparison {
    fn of(compared: &Compared) -> Self {
        let Compared { auto, fir_zvd, .. } = compared;
        Self {
            error_um: 1e6 * compared.permitted,
            bound_g: compared.bound / G,
            path_time: auto.path_time / fir_zvd.path_time,
            max: auto.acceleration_max / fir_zvd.acceleration_max,
            rms: auto.acceleration_rms / fir_zvd.acceleration_rms,
            residual: auto.residual_max / fir_zvd.residual_max,
        }
    }
}

fn print_comparison(times: &[Comparison]) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "\nauto over FIR-ZVD\n  corner error  bound g  path time     max     RMS  residual")?;
    for Comparison { error_um, bound_g, path_time, max, rms, residual } in times {
        writeln!(
            out,
            "  {error_um:9.0} um  {bound_g:7.4}  {path_time:9.4} {max:7.4} {rms:7.4} {residual:9.4}"
        )?;
    }
    Ok(())
}

/// Corner errors of the curves, in micrometres, and the vibration bounds of their points, in g.
const CURVES_UM: [f64; 4] = [0.0, 100.0, 500.0, 1000.0];
const BOUNDS_G: [f64; 8] = [0.07, 0.08, 0.09, 0.105, 0.125, 0.15, 0.2, 0.3];

fn page(outcome: &AutoOutcome, answer: &Answer, arguments: &ScaraArguments) -> anyhow::Result<Page> {
    let identified = &outcome.identified;
    let facts = vec![
        ("identified".to_owned(), format!("{:.4} Hz, ζ {:.5}", identified.frequency_hz, identified.damping)),
        ("plant's drift".to_owned(), format!("{} %", arguments.plant_drift_pct)),
        ("safe up to".to_owned(), format!("{} %", arguments.auto.safe_drift_pct)),
    ];
    let mut charts = vec![trade_off(outcome)?];
    for (kind, curve) in [(FEEDRATE, &speeds as Curve<'_>), (ACCELERATION, &accelerations)] {
        charts.extend(outcome.compared.iter().map(|compared| {
            let Compared { permitted, fir_zvd, auto, .. } = compared;
            over_time([("FIR-ZVD", fir_zvd), ("auto", auto)], *permitted, kind, curve)
        }));
    }
    let tables = outcome.compared.iter().map(|compared| results(answer, compared.permitted)).collect();
    Ok(Page { title: "SCARA experiment: least time for a vibration bound".to_owned(), facts, tables, charts })
}

/// Time against vibration, one curve a corner error; FIR-ZVD's vibration as an upright line, its path times as level ones.
fn trade_off(outcome: &AutoOutcome) -> anyhow::Result<Chart> {
    let bounds = BOUNDS_G.map(|g| g * G);
    let mut errors: Vec<f64> = CURVES_UM.map(|um| 1e-6 * um).into();
    errors.extend(outcome.compared.iter().map(|compared| compared.permitted));
    errors.sort_by(f64::total_cmp);
    errors.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let mut series = Vec::new();
    for error in errors {
        let points = outcome.trade_off(error, &bounds)?;
        let name = format!("auto, {:.0} µm", 1e6 * error);
        series.push(Series::new(name, points.into_iter().map(|[vibration, time]| (vibration / G, time))));
    }
    let level = |compared: &Compared| {
        (compared.fir_zvd.path_time, format!("FIR-ZVD, {:.0} µm", 1e6 * compared.permitted))
    };
    let vibration = outcome.compared.iter().map(|c| c.fir_zvd.acceleration_max / G).fold(0.0, f64::max);
    Ok(Chart {
        title: "Path time against vibration, one curve a corner error".to_owned(),
        x: "greatest acceleration of the tool, g".to_owned(),
        y: "path time, s".to_owned(),
        series,
        marks: vec![(vibration, "FIR-ZVD".to_owned())],
        levels: outcome.compared.iter().map(level).collect(),
        wide: true,
        ..Chart::default()
    })
}
