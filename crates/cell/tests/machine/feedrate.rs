//! Prefilters on the feedrate: the tool stays on its path, and the joints keep their limits.

use seamline::control::Mode;
use seamline_cell::cell::Cell;

use crate::bench::on_feedrate;
use crate::chain::random_runs;
use crate::prefilter::{LINE, NAMES, Run, interrupted, left_ringing};

/// Random runs as in `chain`, with prefilters for slow modes and fast ones: limits, corner errors, and no move faster than programmed.
#[test]
fn runs_keep_limits_errors_and_speeds() {
    for (seed, name, modes) in
        [(31, "zv", &[9.0][..]), (32, "fir-zvd", &[6.34]), (33, "ei", &[14.0]), (34, "fir-zv", &[8.0, 25.0])]
    {
        random_runs(seed, 12, &on_feedrate(name, modes));
    }
}

/// As above, many: `cargo test --release -p seamline-cell --test machine feedrate::many -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn many_runs() {
    for (seed, name) in (41..).zip(NAMES) {
        random_runs(seed, 100, &on_feedrate(name, &[7.0]));
        random_runs(seed + 100, 50, &on_feedrate(name, &[11.0, 30.0]));
    }
}

/// 90 runs with pauses, overrides, stops and emergency stops at random instants: limits hold, and each stop of the line is on it.
#[test]
fn limits_hold_whatever_is_asked_for() {
    interrupted(24, 90, on_feedrate, 1e-9);
}

/// The line at 400 mm/s, in all its acceleration, and with pauses: the tool never leaves it by a nanometre.
#[test]
fn the_tool_stays_on_its_line() {
    for name in NAMES {
        let mut run = Run::start(&on_feedrate(name, &[8.0, 21.0]), 400.0);
        run.until(|output| output.status.mode == Mode::Standstill);
        let line = run.outputs.iter().filter(|output| output.status.line == LINE);
        let off = line.map(|output| run.off_the_line(&output.command.position)).fold(0.0, f64::max);
        println!("{name}: {off:e} m");
        assert!(off < 1e-9, "{name}: {off}");
    }
}

/// A line and pauses on it, judged at the instant at which the controller says that the arm is at rest: what the joints' curvature leaves is
/// little beside what rings without prefilter.
#[test]
fn a_flexible_arm_hardly_rings() {
    for pause in [None, Some(400), Some(900)] {
        let (_, bare) = left_ringing(&Cell::default_cell().unwrap(), &[6.34], pause);
        for name in ["zv", "zvd", "fir-zv", "fir-zvd", "mzv"] {
            let left = left_ringing(&on_feedrate(name, &[6.34]), &[6.34], pause).1 / bare;
            println!("{name} pause {pause:?}: {left:.4}");
            assert!(left < 0.05, "{name}: {left}");
        }
    }
}
