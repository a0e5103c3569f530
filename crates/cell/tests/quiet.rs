//! The motion of least time for a vibration bound and a corner error.

#![allow(clippy::unwrap_used, reason = "a failing test says where")]

use std::f64::consts::TAU;

use nalgebra::Vector3;
use seamline::geometry::Pose;
use seamline::kinematics::{Kinematics, models};
use seamline::path::Path;
use seamline::vibration::{Mode, Prefilter};
use seamline_cell::cell::Cell;
use seamline_cell::experiment::{
    AutoOptions, CORNER_ERRORS, Compared, ExperimentError, Quiet, QuietMotion, Run, Setup, follow, run,
    scara_auto, test_path, trade_off,
};

const FEEDRATE: f64 = 0.16;
/// What the arm's axes can do, in m/s².
const COMMAND: f64 = 5.5;
const OPEN: f64 = f64::INFINITY;

fn mode(frequency: f64) -> Mode {
    Mode::try_new(TAU * frequency, 0.022).unwrap()
}

fn setup(plant: Mode) -> Setup {
    Setup { plant, feedrate: FEEDRATE, period: 1e-3, watched: 3.0 }
}

fn followed(motion: &QuietMotion<'_>, plant: Mode) -> Run {
    follow(&setup(plant), motion.duration(), &|time| motion.position(time), motion.corners()).unwrap()
}

/// Distance of a place from a path, by its chords of a thousandth.
fn distance(path: &[Path], place: &Vector3<f64>) -> f64 {
    const CHORDS: u32 = 1000;
    let mut least = f64::INFINITY;
    for piece in path {
        let at = |n: u32| piece.pose(piece.length() * f64::from(n) / f64::from(CHORDS)).translation.vector;
        for n in 0..CHORDS {
            let (from, chord) = (at(n), at(n + 1) - at(n));
            let along = ((place - from).dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
            least = least.min((place - from - along * chord).norm());
        }
    }
    least
}

fn options(plant_drift: f64) -> AutoOptions {
    AutoOptions {
        plant_drift,
        corner_errors: CORNER_ERRORS.into(),
        acceleration: None,
        acceleration_rms: None,
        jerk: None,
        safe_drift: 0.15,
    }
}

/// Against FIR-ZVD: neither its greatest acceleration nor its residual is passed, in 0.92 of its time.
#[test]
fn quicker_than_fir_zvd_and_no_louder() {
    let outcome = scara_auto(&options(0.0)).unwrap();
    assert_eq!(outcome.compared.len(), 2);
    for Compared { permitted, bound, bare, fir_zvd, auto } in &outcome.compared {
        assert!(auto.path_time <= 0.92 * fir_zvd.path_time, "{} {}", auto.path_time, fir_zvd.path_time);
        assert!(auto.acceleration_max <= fir_zvd.acceleration_max && auto.acceleration_max <= 1.001 * bound);
        assert!(auto.residual_max <= fir_zvd.residual_max, "{} {}", auto.residual_max, fir_zvd.residual_max);
        assert!(1.0 - auto.acceleration_rms / bare.acceleration_rms >= 0.8512);
        let errors = if *permitted > 0.0 { 495e-6..=500e-6 } else { 0.0..=1e-6 };
        assert!(auto.corners.len() == 4 && auto.corners.iter().all(|corner| errors.contains(&corner.error)));
        as_measured(auto);
        within_the_arm(auto);
    }
    assert_eq!(scara_auto(&options(0.0)).unwrap(), outcome);
}

/// The command itself comes as near to each corner as the plan says, but for the way of half a cycle.
fn as_measured(run: &Run) {
    let path = test_path().unwrap();
    for (piece, corner) in path.iter().zip(&run.corners) {
        let at = piece.pose(piece.length()).translation.vector;
        let nearest = run.trace.iter().map(|s| (s.command - at).norm()).fold(f64::INFINITY, f64::min);
        assert!((corner.error - 1e-9..=corner.error + 1e-5).contains(&nearest), "{nearest} {corner:?}");
    }
}

/// Velocity and acceleration of joints 1 and 2, by differences of a cycle, are below those of the SCARA cell.
fn within_the_arm(run: &Run) {
    let cell = Cell::built_in("scara").unwrap().unwrap();
    let arm = models::scara600();
    let mut joints = [0.0; 4];
    let down = arm.forward(&joints).rotation;
    let mut places = Vec::new();
    for sample in &run.trace {
        joints = arm.inverse_nearest(&Pose::from_parts(sample.command.into(), down), &joints).unwrap();
        places.push(joints);
    }
    for (axis, joint) in cell.robot.joints.iter().enumerate().take(2) {
        let at = |n: usize| places[n][axis];
        for n in 2..places.len() {
            let (velocity, before) = ((at(n) - at(n - 1)) / 1e-3, (at(n - 1) - at(n - 2)) / 1e-3);
            assert!(velocity.abs() <= joint.velocity, "{axis} {velocity}");
            assert!((velocity - before).abs() / 1e-3 <= joint.acceleration, "{axis} {velocity} {before}");
        }
    }
}

/// What is required of FIR-ZVD where the plant has drifted holds for it too.
#[test]
fn quiet_where_the_frequency_has_drifted() {
    for drift in [-0.15, 0.15] {
        for Compared { permitted, bare, auto, .. } in &scara_auto(&options(drift)).unwrap().compared {
            let left = auto.residual_max / bare.residual_max;
            let reduced = 1.0 - auto.acceleration_max / bare.acceleration_max;
            assert!(left <= 0.015 && reduced >= 0.85, "{drift} {permitted}: {left} {reduced}");
        }
    }
    assert!(matches!(scara_auto(&options(-1.0)), Err(ExperimentError::Mode(_))));
}

/// With FIR-ZVD's root mean square as a bound besides, it is still quicker.
#[test]
fn no_louder_in_the_mean_either() {
    let rms = run(&setup(mode(6.34)), &test_path().unwrap(), Prefilter::FirZvd, &mode(6.34), 500e-6)
        .unwrap()
        .acceleration_rms;
    let bounded =
        AutoOptions { corner_errors: vec![500e-6], acceleration_rms: Some(0.999 * rms), ..options(0.0) };
    let outcome = scara_auto(&bounded).unwrap();
    let Compared { fir_zvd, auto, .. } = &outcome.compared[0];
    assert!(auto.acceleration_rms <= fir_zvd.acceleration_rms);
    assert!(auto.acceleration_max <= fir_zvd.acceleration_max && auto.residual_max <= fir_zvd.residual_max);
    assert!(auto.path_time <= 0.96 * fir_zvd.path_time, "{} {}", auto.path_time, fir_zvd.path_time);
}

/// With a bound of the command's jerk, its acceleration changes slowly over any 5 ms, and little time is lost.
#[test]
fn smooth_where_the_jerk_is_bounded() {
    const JERK: f64 = 300.0;
    let smooth = AutoOptions { corner_errors: vec![500e-6], jerk: Some(JERK), ..options(0.0) };
    let outcome = scara_auto(&smooth).unwrap();
    let Compared { fir_zvd, auto, .. } = &outcome.compared[0];
    assert!(auto.path_time <= 0.93 * fir_zvd.path_time, "{} {}", auto.path_time, fir_zvd.path_time);
    assert!(auto.acceleration_max <= fir_zvd.acceleration_max && auto.residual_max <= fir_zvd.residual_max);
    // A step is 4.93 ms: what two second differences 4 ms apart see lies at most two steps apart.
    let acceleration = |n: usize| {
        let at = |k: usize| auto.trace[k].command;
        (at(n + 1) - 2.0 * at(n) + at(n - 1)) / 1e-6
    };
    for n in 1..auto.trace.len() - 6 {
        let change = (acceleration(n + 4) - acceleration(n)).norm();
        assert!(change <= 2.0 * JERK * 5e-3 + 0.05, "{change} at {n}");
    }
}

/// Along the test path it starts and ends on it, leaves it by no more than the corner error, and is never faster than asked.
#[test]
fn it_keeps_the_path() {
    let path = test_path().unwrap();
    let quiet = Quiet {
        acceleration: 1.06,
        acceleration_rms: OPEN,
        command: COMMAND,
        jerk: OPEN,
        corner_error: 500e-6,
        drift: 0.15,
    };
    let motion = QuietMotion::plan(&path, &mode(6.34), FEEDRATE, &quiet).unwrap();
    keeps_the_path(&path, &motion, FEEDRATE, 500e-6);
}

/// Starts and ends on the path, is never off it by more than the corner error, and never faster than the feedrate.
fn keeps_the_path(path: &[Path], motion: &QuietMotion<'_>, feedrate: f64, error: f64) {
    let (first, last) = (path.first().unwrap(), path.last().unwrap());
    let ends = [first.pose(0.0), last.pose(last.length())].map(|pose| pose.translation.vector);
    for (time, end) in [0.0, motion.duration()].into_iter().zip(ends) {
        assert!((motion.position(time) - end).norm() < 1e-9);
    }
    let step = 1e-3;
    let mut time = 0.0;
    while time < motion.duration() {
        let (from, to) = (motion.position(time), motion.position(time + step));
        let speed = (to - from).norm() / step;
        assert!(speed <= feedrate * (1.0 + 1e-6), "{speed} at {time}");
        if ((time / step).round() as u32).is_multiple_of(20) {
            let off = distance(path, &from);
            assert!(off <= error + 1e-6, "{off} off the path at {time}");
        }
        time += step;
    }
}

#[test]
fn without_a_corner_error_it_stops_in_each_corner() {
    let path = test_path().unwrap();
    let quiet = Quiet {
        acceleration: 1.2,
        acceleration_rms: OPEN,
        command: COMMAND,
        jerk: OPEN,
        corner_error: 0.0,
        drift: 0.0,
    };
    let motion = QuietMotion::plan(&path, &mode(6.34), FEEDRATE, &quiet).unwrap();
    assert!(motion.corners().iter().all(|corner| corner.error <= 1e-6), "{:?}", motion.corners());
    assert!(followed(&motion, mode(6.34)).acceleration_max <= 1.2);
    keeps_the_path(&path, &motion, FEEDRATE, 0.0);
}

#[test]
fn a_bound_of_the_root_mean_square_is_kept_and_costs_time() {
    let path = test_path().unwrap();
    let open = Quiet {
        acceleration: 1.2,
        acceleration_rms: OPEN,
        command: COMMAND,
        jerk: OPEN,
        corner_error: 500e-6,
        drift: 0.0,
    };
    let [bounded, strictly] = [0.55, 0.25].map(|rms| Quiet { acceleration_rms: rms, ..open });
    let [quick, calm, calmest] = [open, bounded, strictly]
        .map(|quiet| QuietMotion::plan(&path, &mode(6.34), FEEDRATE, &quiet).unwrap());
    let rms = |motion: &QuietMotion<'_>| followed(motion, mode(6.34)).acceleration_rms;
    assert!(rms(&quick) > 0.6 && rms(&calm) <= 0.551, "{} {}", rms(&quick), rms(&calm));
    assert!(rms(&calmest) <= 0.251 && calmest.duration() > calm.duration());
    assert!(calm.duration() > quick.duration());
}

#[test]
fn more_vibration_or_more_error_takes_no_longer() {
    let path = test_path().unwrap();
    let curve = |corner_error: f64| {
        let quiet = Quiet {
            acceleration: 1.0,
            acceleration_rms: OPEN,
            command: COMMAND,
            jerk: OPEN,
            corner_error,
            drift: 0.0,
        };
        trade_off(&path, &mode(6.34), FEEDRATE, &quiet, &[0.8, 1.2, 2.0])
    };
    let (sharp, round) = (curve(100e-6), curve(500e-6));
    for points in [&sharp, &round] {
        assert_eq!(points.len(), 3);
        assert!(points.windows(2).all(|pair| pair[1][1] < pair[0][1]), "{points:?}");
    }
    assert!(sharp.iter().zip(&round).all(|(sharp, round)| round[1] < sharp[1]));
}

/// Lines of 2 to 40 mm in random directions: 12 paths of six lines. None is without a motion; each keeps its bound and its corner errors.
#[test]
fn short_segments_are_taken_slower() {
    let mut state = 7_u64;
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for case in 0..12 {
        let mut at = Vector3::new(0.3, 0.0, 0.0);
        let path: Vec<Path> = (0..6)
            .map(|_| {
                let (length, turn) = (2e-3 * 20.0_f64.powf(unit()), TAU * unit());
                let from = at;
                at += length * Vector3::new(turn.cos(), turn.sin(), 0.0);
                let pose = |p: Vector3<f64>| Pose::translation(p.x, p.y, p.z);
                Path::line(&pose(from), &pose(at))
            })
            .collect();
        let (bound, error) = (0.8 + unit(), 2e-5 + 4e-4 * unit());
        let quiet = Quiet {
            acceleration: bound,
            acceleration_rms: OPEN,
            command: COMMAND,
            jerk: OPEN,
            corner_error: error,
            drift: if case % 2 == 0 { 0.0 } else { 0.15 },
        };
        let motion = QuietMotion::plan(&path, &mode(6.34), FEEDRATE, &quiet)
            .unwrap_or_else(|e| panic!("case {case}: {e}"));
        assert!(motion.corners().iter().all(|corner| corner.error <= error), "case {case}");
        assert!(followed(&motion, mode(6.34)).acceleration_max <= 1.001 * bound, "case {case}");
        keeps_the_path(&path, &motion, FEEDRATE, error);
    }
}

#[test]
fn a_bound_below_all_motion_is_an_error() {
    let path = test_path().unwrap();
    let quiet = Quiet {
        acceleration: 1e-7,
        acceleration_rms: OPEN,
        command: COMMAND,
        jerk: OPEN,
        corner_error: 0.0,
        drift: 0.0,
    };
    let found = QuietMotion::plan(&path, &mode(6.34), FEEDRATE, &quiet).err();
    assert_eq!(found, Some(ExperimentError::Bound { bound: 1e-7, rms: OPEN }));
}
