//! The motion as curves: position, velocity, acceleration and jerk over time.

use seamline::otg::Sample;

use super::Arguments;
use super::page::{Chart, page as page_of};
use super::run::Run;

/// Instants drawn: more than a chart has pixels.
const POINTS: u32 = 2001;

pub(super) fn page(arguments: &Arguments, run: &Run) -> String {
    let samples: Vec<(f64, Sample<1>)> = run.instants(POINTS).map(|time| (time, run.at(time).1)).collect();
    let mark = run.retarget.as_ref().map(|retarget| (retarget.at, "new target"));
    let chart = |title, value: fn(&Sample<1>) -> [f64; 1]| Chart {
        title,
        points: samples.iter().map(|(time, sample)| (*time, value(sample)[0])).collect(),
        mark,
    };
    let charts = [
        chart("Position, mm", |sample| sample.position),
        chart("Velocity, mm/s", |sample| sample.velocity),
        chart("Acceleration, mm/s²", |sample| sample.acceleration),
        chart("Jerk, mm/s³", |sample| sample.jerk),
    ];
    page_of("Timed profile", &text(arguments, run), "time, s", &charts)
}

/// What is drawn, in words.
fn text(arguments: &Arguments, run: &Run) -> String {
    let ([v], [a], [j]) = (run.profile.velocity(), run.profile.acceleration(), run.profile.jerk());
    let Arguments { from_mm, to_mm, time, n, .. } = arguments;
    let profile = format!(
        "From {from_mm} to {to_mm} mm in {time} s with n = {n:.4}: V = {v:.4} mm/s, A = {a:.4} mm/s², J = {j:.4} mm/s³."
    );
    let Some(retarget) = &run.retarget else { return profile };
    let (mode, [jump]) = (arguments.mode.name(), retarget.planned.velocity_jump);
    format!(
        "{profile} New target {} mm at {} s, {mode}: there at {:.4} s; the velocity jumps by {jump:.4} mm/s.",
        retarget.target, retarget.at, run.end
    )
}
