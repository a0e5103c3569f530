//! Draws the figures of docs/vibration.md: `cargo run --features std --example vibration_figures -- docs/figures`.
#![allow(clippy::print_stdout, reason = "a program")]

mod chart;

use std::f64::consts::TAU;
use std::path::Path;

use chart::{BOLD, Chart, DASHED, RED, THIN};
use seamline::vibration::{Corner, Mode, Prefilter, Ramp};

type Failure = Box<dyn std::error::Error>;

/// The document's mode and feedrate.
const FREQUENCY: f64 = 6.34;
const DAMPING: f64 = 0.022;
const FEEDRATE: f64 = 0.16;

/// Figure 1: residual vibration over the actual frequency.
fn sensitivity(folder: &Path) -> Result<(), Failure> {
    let mut chart = Chart::new((0.5, 1.5), (0.0, 60.0));
    let mode = Mode::try_new(TAU * FREQUENCY, DAMPING)?;
    let shown = [
        (Prefilter::Zv, THIN, (1.28, 50.0)),
        (Prefilter::Zvd, DASHED, (1.43, 29.0)),
        (Prefilter::Fir, RED, (0.605, 50.0)),
        (Prefilter::FirZvd, BOLD, (0.52, 8.0)),
    ];
    for (prefilter, style, label) in shown {
        let kernel = prefilter.kernel(&mode)?;
        let mut points = Vec::new();
        for n in 0..=200 {
            let ratio = 0.5 + 0.005 * f64::from(n);
            let actual = Mode::try_new(ratio * mode.omega(), DAMPING)?;
            points.push((ratio, (100.0 * kernel.residual_vibration(&actual)).min(60.0)));
        }
        chart.line(&points, style);
        chart.text(label, prefilter.name());
    }
    chart.axes("", "vibration left, %");
    for ratio in [0.5, 0.75, 1.0, 1.25, 1.5] {
        chart.text((ratio - 0.02, -4.0), &format!("{ratio}"));
    }
    Ok(chart.write(&folder.join("sensitivity.svg"))?)
}

/// Figure 2: what is left and what is done, for three overlaps, and the places 0.5 mm from the corner.
fn corner(folder: &Path) -> Result<(), Failure> {
    const MM: f64 = 1e3;
    let mode = Mode::try_new(TAU * FREQUENCY, DAMPING)?;
    let ramp = Ramp::from_kernel(&Prefilter::FirZvd.kernel(&mode)?)?;
    let angle = 66.038_f64.to_radians();
    let corner = Corner {
        deceleration: &ramp,
        acceleration: &ramp,
        first_feedrate: FEEDRATE,
        second_feedrate: FEEDRATE,
        angle,
        longest: f64::INFINITY,
    };
    let found = corner.overlap(0.5e-3);
    let mut chart = Chart::new((0.0, 2.0), (0.0, 1.4));
    let curve = |delay: f64| -> Vec<(f64, f64)> {
        let span = ramp.duration() - delay;
        let point = |n: i32| {
            let time = delay + span * f64::from(n) / 300.0;
            (MM * FEEDRATE * ramp.remaining(time), MM * FEEDRATE * ramp.integral(time - delay))
        };
        (0..=300).map(point).filter(|(a, b)| *a <= 2.0 && *b <= 1.4).collect()
    };
    for share in [0.8, 1.0, 1.2] {
        let style = if share == 1.0 { BOLD } else { DASHED };
        chart.line(&curve(ramp.duration() - share * found.overlap), style);
    }
    // A² + B² − 2AB cos β = e² in polar coordinates.
    let ring = |n: i32| {
        let (sin, cos) = (f64::from(n) / 200.0 * TAU / 4.0).sin_cos();
        let radius = MM * found.error / (1.0 - 2.0 * sin * cos * angle.cos()).sqrt();
        (radius * cos, radius * sin)
    };
    chart.line(&(0..=200).map(ring).collect::<Vec<_>>(), RED);
    chart.axes("A, mm", "B, mm");
    chart.text((0.02, 0.3), "e = 0.5 mm");
    chart.text((1.05, 0.14), "t_c = 120 ms");
    chart.text((0.02, 0.03), "corner");
    Ok(chart.write(&folder.join("corner.svg"))?)
}

fn main() -> Result<(), Failure> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "docs/figures".to_owned());
    let folder = Path::new(&folder);
    sensitivity(folder)?;
    corner(folder)?;
    println!("wrote sensitivity.svg and corner.svg to {}", folder.display());
    Ok(())
}
