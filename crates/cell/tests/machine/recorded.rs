//! The example jobs, judged from their recordings alone, by an arm model that is not ours.

use std::path::Path;

use nalgebra::{Isometry3, Vector3};
use seamline_cell::cell::Cell;
use seamline_cell::plan::Arm;
use seamline_cell::record::{Recording, Sample, SegmentKind, Verdict};
use seamline_cell::run::{Program, RunOptions, RunReport, run};

use crate::bench::{Ar2010, flexible, independent_forward, independent_torch, worst_shares};

fn recorded(job: &str) -> (Vec<Sample>, Cell, Ar2010) {
    let cell = Cell::default_cell().unwrap();
    let (_, samples, arm) = recorded_in(&cell, job, job);
    (samples, cell, arm)
}

fn recorded_in(cell: &Cell, job: &str, folder: &str) -> (RunReport, Vec<Sample>, Ar2010) {
    let arm = Arm::from_cell(cell).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let jobs = Program::load(&root.join("examples/jobs").join(job)).unwrap();
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    let options = RunOptions { out: out.clone(), speed_override: 1.0, realtime: false };
    let report = run(&jobs, cell, &arm, &options, |_| {}).unwrap();
    let recording = Recording::read(&out.join("recording.csv")).unwrap();
    (report, recording.samples, arm)
}

fn joints(sample: &Sample) -> [f64; 6] {
    std::array::from_fn(|joint| sample.command[joint])
}

fn tcp(sample: &Sample) -> Isometry3<f64> {
    independent_forward(&joints(sample)) * independent_torch()
}

/// The poses of a line of the job, and the greatest distance from the straight line and from the geodesic.
fn straightness(samples: &[Sample], line: u32) -> (Vec<Isometry3<f64>>, f64, f64) {
    let poses: Vec<_> = samples.iter().filter(|sample| sample.line == line).map(tcp).collect();
    let (first, last) = (poses[0], poses[poses.len() - 1]);
    let way: Vector3<f64> = last.translation.vector - first.translation.vector;
    let whole = first.rotation.angle_to(&last.rotation);
    let (mut off, mut turned_off) = (0.0_f64, 0.0_f64);
    for pose in &poses {
        let offset = pose.translation.vector - first.translation.vector;
        let share = offset.dot(&way) / way.norm_squared();
        off = off.max((offset - way * share).norm());
        let programmed = first.rotation.slerp(&last.rotation, share.clamp(0.0, 1.0));
        turned_off = turned_off.max(if whole > 0.0 { pose.rotation.angle_to(&programmed) } else { 0.0 });
    }
    (poses, off, turned_off)
}

/// Tool speed between samples, in the middle of a line's time.
fn speeds(poses: &[Isometry3<f64>], period: f64) -> impl Iterator<Item = f64> {
    let ramp = 60;
    let middle = &poses[ramp..poses.len() - ramp];
    middle
        .windows(2)
        .map(move |pair| (pair[1].translation.vector - pair[0].translation.vector).norm() / period)
}

#[test]
fn the_fillet_is_straight_and_at_its_speed() {
    let (samples, cell, arm) = recorded("fillet.JBI");
    for (line, mm_s) in [(28, 50.0), (33, 9.0), (34, 9.0), (37, 9.0), (42, 10.0), (48, 100.0)] {
        let (poses, off, turned_off) = straightness(&samples, line);
        assert!(off < 1e-6 && turned_off < 1e-6, "line {line}: {off} m, {turned_off} rad");
        for speed in speeds(&poses, cell.cycle.period) {
            assert!((speed * 1000.0 - mm_s).abs() < 0.01 * mm_s, "line {line}: {speed} m/s");
        }
    }
    let commands: Vec<_> = samples.iter().map(joints).collect();
    let [velocity, acceleration, jerk] = worst_shares(&commands, &arm, cell.cycle.period);
    assert!(
        velocity <= 1.0 && acceleration <= 1.0 + 1e-6 && jerk <= 1.01,
        "{velocity} {acceleration} {jerk}"
    );
    // The arc burns over the weld and nowhere else.
    let lit = |line: u32| samples.iter().filter(|s| s.line == line).all(|s| s.arc);
    assert!([33, 34, 37, 40, 42, 44].into_iter().all(lit));
    assert!(samples.iter().filter(|s| s.line < 32 || s.line > 45).all(|s| !s.arc));
}

#[test]
fn the_line_past_the_wrist_pole_stays_straight() {
    let (samples, cell, arm) = recorded("near_wrist.JBI");
    let (_, off, turned_off) = straightness(&samples, 23);
    assert!(off < 1e-6 && turned_off < 1e-6, "{off} m, {turned_off} rad");
    let commands: Vec<_> = samples.iter().map(joints).collect();
    let [velocity, acceleration, jerk] = worst_shares(&commands, &arm, cell.cycle.period);
    println!(
        "near the pole: velocity {velocity:.5}, acceleration {acceleration:.5}, jerk {jerk:.5}; off the line {off:.1e} m"
    );
    assert!(
        velocity <= 1.0 + 1e-6 && acceleration <= 1.0 + 1e-4 && jerk <= 1.01,
        "{velocity} {acceleration} {jerk}"
    );
}

/// A job with corners, an arc and a spline behind a prefilter, at a weld's speed: every figure is within its bounds, samples stand in the
/// segment that the arm is in, and the weld is left by micrometres only.
#[test]
fn the_figures_are_right_behind_a_prefilter() {
    let (report, samples, _) = recorded_in(&flexible("fir-zvd", &[10.0]), "contour.JBI", "prefiltered");
    assert_eq!(report.summary.verdict, Verdict::Ok, "{}", report.summary);
    let findings = &report.findings;
    let mut corners = 0;
    for (segment, figures) in findings.segments.iter().zip(&findings.moves) {
        if let SegmentKind::Corner { corner, permitted, .. } = segment.kind {
            let distance = |sample: &Sample| (tcp(sample).translation.vector - corner).norm();
            let (nearest, least) = samples
                .iter()
                .map(|sample| (sample.segment, distance(sample)))
                .fold((0, f64::INFINITY), |least, here| if here.1 < least.1 { here } else { least });
            // The figure looks between the samples as well, which are 12 µm apart.
            let found = figures.corner_error_mm.unwrap() / 1e3;
            assert_eq!(nearest, segment.segment);
            assert!(found <= least && least - found < 6e-6 && found <= permitted, "{found} {least}");
            corners += 1;
        }
    }
    assert_eq!(corners, 6);
    let lines: Vec<_> = findings.moves.iter().filter(|of| of.kind == "MOVL" && of.arc).collect();
    assert!(lines.len() == 5 && lines.iter().all(|of| of.straightness_max_mm.unwrap() < 1e-3), "{lines:?}");
    assert!(findings.moves.iter().filter(|of| of.arc).all(|of| of.speed_error_max.is_none_or(|e| e < 1e-3)));
}

/// The example that tracks a seam, twice: equal recordings to the last byte, all figures within their bounds, and the seam kept but for half of its
/// step of 0.5 mm.
#[test]
fn a_tracked_seam_is_recorded_the_same_twice() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let cell = Cell::load(&root.join("examples/cells/seam.toml")).unwrap();
    let recording = |folder: &str| {
        let (report, ..) = recorded_in(&cell, "seam.JBI", folder);
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder).join("recording.csv");
        (report, std::fs::read(file).unwrap())
    };
    let ((report, first), (_, second)) = (recording("seam-1"), recording("seam-2"));
    assert!(first == second, "two runs with one seed differ");
    assert_eq!(report.summary.verdict, Verdict::Ok, "{}", report.summary);
    let seam = report.summary.seam.unwrap();
    assert!(seam.lateral_max_mm > 4.0 && seam.height_max_mm > 1.9, "{seam:?}");
    assert!(seam.error_rms_mm.unwrap() < 0.03 && seam.error_max_mm.unwrap() < 0.3, "{seam:?}");
}
