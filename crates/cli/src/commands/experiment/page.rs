//! The SCARA experiment on a page: the document's figures 11 to 16 and its tables, in our data.

use std::f64::consts::TAU;

use seamline::vibration::{Mode, Ramp};
use seamline_cell::experiment::{CORNER_ERRORS, Outcome, PREFILTERS, Run, Sample, ScaraRun};
use seamline_cell::identify::amplitude_spectrum;

use super::{Answer, G, Row};
use crate::plot::{Chart, Page, Series, Table, spaced};

/// The corners of the test path, in mm.
const CORNERS_MM: [[f64; 2]; 4] = [[140.0, 40.0], [275.0, 100.0], [410.0, 40.0], [360.0, 90.0]];
/// Curves over time: title, unit, and what the chart may leave out.
pub(super) const FEEDRATE: (&str, &str, f64) = ("Feedrate", "mm/s", 0.1);
pub(super) const ACCELERATION: (&str, &str, f64) = ("Acceleration of the tool", "g", 2e-4);
/// How long the vibration is shown after the last command, in seconds.
const AFTER: f64 = 1.0;

pub(super) fn page(outcome: &Outcome, answer: &Answer, drift: f64) -> anyhow::Result<Page> {
    let identified = &outcome.identified;
    let facts = vec![
        ("identified".to_owned(), format!("{:.4} Hz, ζ {:.5}", identified.frequency_hz, identified.damping)),
        ("plant's drift".to_owned(), format!("{drift} %")),
    ];
    let mut tables: Vec<Table> = CORNER_ERRORS.map(|permitted| results(answer, permitted)).into();
    tables.extend(CORNER_ERRORS.map(|permitted| corner_times(outcome, permitted)));
    let mut charts = vec![test_path(outcome), filtered(outcome)?];
    charts.extend(measured(outcome));
    for permitted in CORNER_ERRORS {
        charts.push(over_time(named(outcome, permitted), permitted, FEEDRATE, &speeds));
    }
    charts.extend((0..CORNERS_MM.len()).map(|corner| close_up(outcome, corner)));
    for permitted in CORNER_ERRORS {
        charts.push(over_time(named(outcome, permitted), permitted, ACCELERATION, &accelerations));
    }
    charts.extend(CORNER_ERRORS.map(|permitted| residual_spectrum(outcome, permitted)));
    Ok(Page { title: "SCARA experiment".to_owned(), facts, tables, charts })
}

fn runs(outcome: &Outcome, permitted: f64) -> impl Iterator<Item = &ScaraRun> {
    outcome.runs.iter().filter(move |run| run.permitted == permitted)
}

fn named(outcome: &Outcome, permitted: f64) -> impl Iterator<Item = Line<'_>> {
    runs(outcome, permitted).map(|run| (run.prefilter.name(), &run.run))
}

fn micrometres(permitted: f64) -> String {
    format!("corner error {:.0} µm", 1e6 * permitted)
}

pub(super) fn results(answer: &Answer, permitted: f64) -> Table {
    let row = |row: &Row| {
        vec![
            row.prefilter.to_owned(),
            format!("{:.4}", row.max_g),
            format!("{:.2}", row.reduction_max_pct),
            format!("{:.4}", row.rms_g),
            format!("{:.2}", row.reduction_rms_pct),
            format!("{:.3}", row.residual_pct),
            format!("{:.3}", row.path_time_s),
            format!("{:.4}", row.worst_corner_mm()),
        ]
    };
    Table {
        title: format!("Vibration, {}", micrometres(permitted)),
        columns: vec![
            "prefilter",
            "max, g",
            "reduced, %",
            "RMS, g",
            "reduced, %",
            "residual, %",
            "path time, s",
            "error reached, mm",
        ],
        rows: answer.runs.iter().filter(|row| row.error_um == 1e6 * permitted).map(row).collect(),
    }
}

/// The document's tables 1 and 2.
fn corner_times(outcome: &Outcome, permitted: f64) -> Table {
    let row = |run: &ScaraRun| {
        let corners = &run.run.corners;
        let deceleration = corners.first().map_or(0.0, |corner| corner.overlap.deceleration);
        let times = corners.iter().map(|corner| {
            let overlap = &corner.overlap;
            [overlap.nearest, overlap.overlap, overlap.delay].map(milliseconds).join(" · ")
        });
        [run.prefilter.name().to_owned(), milliseconds(deceleration)].into_iter().chain(times).collect()
    };
    Table {
        title: format!("Corners in time, {}: t_m · t_c · t_d, in ms", micrometres(permitted)),
        columns: vec!["prefilter", "t_DEC1, ms", "66.04°", "47.92°", "158.96°", "90.00°"],
        rows: runs(outcome, permitted).skip(1).map(row).collect(),
    }
}

fn milliseconds(time: f64) -> String {
    format!("{:.0}", 1e3 * time)
}

fn places(run: &ScaraRun) -> impl Iterator<Item = (f64, f64)> {
    run.run.trace.iter().map(|sample| (1e3 * sample.command.x, 1e3 * sample.command.y))
}

/// As the document's figure 11.
fn test_path(outcome: &Outcome) -> Chart {
    let bare = runs(outcome, CORNER_ERRORS[0]).next().into_iter();
    Chart {
        title: "Test path, from (180, 0) to (270, 0) mm".to_owned(),
        x: "x, mm".to_owned(),
        y: "y, mm".to_owned(),
        // Places come back to an x: they cannot be thinned as values over it.
        series: bare.map(|run| Series::new("commanded", places(run).step_by(10))).collect(),
        equal: true,
        ..Chart::default()
    }
}

/// A feedrate for half a second through each prefilter, as the document's figure 13.
fn filtered(outcome: &Outcome) -> anyhow::Result<Chart> {
    const LENGTH: f64 = 0.5;
    const FEEDRATE_MM_S: f64 = 160.0;
    let identified = &outcome.identified;
    let mode = Mode::try_new(TAU * identified.frequency_hz, identified.damping.max(0.0))?;
    let mut series = Vec::new();
    for prefilter in PREFILTERS {
        let ramp = Ramp::from_kernel(&prefilter.kernel(&mode)?)?;
        let at = |t: f64| (t, FEEDRATE_MM_S * (ramp.value(t) - ramp.value(t - LENGTH)));
        series.push(Series::thinned(prefilter.name(), spaced(-0.05, 0.95, 1000).map(at), FEEDRATE.2));
    }
    Ok(Chart {
        title: "A feedrate of half a second through the prefilters".to_owned(),
        x: "time, s".to_owned(),
        y: "mm/s".to_owned(),
        series,
        ..Chart::default()
    })
}

/// The vibration that the mode was identified from, and its spectrum, as the document's figure 12.
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
    let spectrum = Chart {
        title: "Its spectrum".to_owned(),
        x: "frequency, Hz".to_owned(),
        y: "amplitude, g".to_owned(),
        series: vec![Series::new("measured", spectrum.map(|(f, amplitude)| (f, amplitude / G)))],
        marks: vec![mark(outcome)],
        ..Chart::default()
    };
    vec![vibration, spectrum]
}

fn mark(outcome: &Outcome) -> (f64, String) {
    let frequency = outcome.identified.frequency_hz;
    (frequency, format!("{frequency:.3} Hz"))
}

pub(super) fn speeds(run: &Run) -> Vec<(f64, f64)> {
    let steps = run.trace.windows(2);
    let speed = |pair: &[Sample]| {
        let (from, to) = (&pair[0], &pair[1]);
        (to.time, 1e3 * (to.command - from.command).norm() / (to.time - from.time))
    };
    steps.map(speed).take_while(|(time, _)| *time <= run.path_time + 0.05).collect()
}

pub(super) fn accelerations(run: &Run) -> Vec<(f64, f64)> {
    let shown = run.trace.iter().take_while(|sample| sample.time <= run.path_time + AFTER);
    shown.map(|sample| (sample.time, sample.acceleration.norm() / G)).collect()
}

pub(super) type Curve<'a> = &'a dyn Fn(&Run) -> Vec<(f64, f64)>;
type Line<'a> = (&'static str, &'a Run);

/// As the document's figures 14 and 16: runs by name.
pub(super) fn over_time<'a>(
    runs: impl IntoIterator<Item = Line<'a>>,
    permitted: f64,
    (title, unit, tolerance): (&str, &str, f64),
    curve: Curve<'_>,
) -> Chart {
    let series = runs.into_iter().map(|(name, run)| Series::thinned(name, curve(run), tolerance));
    Chart {
        title: format!("{title}, {}", micrometres(permitted)),
        x: "time, s".to_owned(),
        y: unit.to_owned(),
        series: series.collect(),
        wide: true,
        ..Chart::default()
    }
}

/// The commanded paths around a corner, for the greater corner error, as the document's figure 15.
fn close_up(outcome: &Outcome, corner: usize) -> Chart {
    const SHOWN_MM: f64 = 2.0;
    let permitted = CORNER_ERRORS[1];
    let [x, y] = CORNERS_MM[corner];
    let near = |p: &(f64, f64)| (p.0 - x).abs() < SHOWN_MM && (p.1 - y).abs() < SHOWN_MM;
    let series =
        runs(outcome, permitted).map(|run| Series::new(run.prefilter.name(), places(run).filter(near)));
    let round = |angle: f64| (x + 1e3 * permitted * angle.cos(), y + 1e3 * permitted * angle.sin());
    let circle = Series::new("0.5 mm around the corner", spaced(0.0, TAU, 60).map(round));
    let angle = outcome.runs[0].run.corners.get(corner).map_or(0.0, |corner| corner.angle.to_degrees());
    Chart {
        title: format!("Corner {} of {angle:.2}°, commanded, 500 µm", corner + 1),
        x: "x, mm".to_owned(),
        y: "y, mm".to_owned(),
        series: series.chain([circle]).collect(),
        equal: true,
        ..Chart::default()
    }
}

/// What still vibrates after the last command.
fn residual_spectrum(outcome: &Outcome, permitted: f64) -> Chart {
    let series = runs(outcome, permitted).map(|run| {
        let spectrum = amplitude_spectrum(&run.run.residual()).into_iter();
        let shown = spectrum.skip(1).take_while(|(f, _)| *f <= 20.0);
        Series::new(run.prefilter.name(), shown.map(|(f, amplitude)| (f, amplitude / G)))
    });
    Chart {
        title: format!("Spectrum of what is left after the last command, {}", micrometres(permitted)),
        x: "frequency, Hz".to_owned(),
        y: "amplitude in x, g".to_owned(),
        series: series.collect(),
        marks: vec![mark(outcome)],
        log: true,
        ..Chart::default()
    }
}
