//! The SCARA experiment in simulation, against the figures of its source.

#![allow(clippy::unwrap_used, reason = "a failing test says where")]

use std::f64::consts::TAU;

use seamline::path::Path;
use seamline::vibration::{Mode, Prefilter};
use seamline_cell::experiment::{ExperimentError, PREFILTERS, Run, Setup, run, scara, test_path};
use seamline_cell::identify::identify;

const G: f64 = 9.80665;
fn mode(frequency: f64) -> Mode {
    Mode::try_new(TAU * frequency, 0.022).unwrap()
}

fn setup(frequency: f64) -> Setup {
    Setup { plant: mode(frequency), feedrate: 0.16, period: 1e-3, watched: 3.0 }
}

fn runs(frequency: f64, path: &[Path], permitted: f64) -> Vec<Run> {
    PREFILTERS
        .map(|prefilter| run(&setup(frequency), path, prefilter, &mode(6.34), permitted).unwrap())
        .to_vec()
}

#[test]
fn every_corner_keeps_its_error_on_the_curved_path_too() {
    let path = test_path().unwrap();
    for run in runs(6.34, &path, 500e-6).iter().skip(1) {
        assert_eq!(run.corners.len(), 4);
        for corner in &run.corners {
            assert!((495e-6..=500e-6).contains(&corner.error), "{corner:?}");
        }
    }
    for run in runs(6.34, &path, 0.0) {
        assert!(run.corners.iter().all(|corner| corner.error <= 1e-6));
    }
}

#[test]
fn the_figures_of_the_exact_model() {
    let path = test_path().unwrap();
    let expected =
        [[1.26, 0.345, 0.194, f64::NAN, 0.128, 0.108], [1.26, 0.337, 0.194, f64::NAN, 0.128, 0.108]];
    for (permitted, expected) in [0.0, 500e-6].into_iter().zip(expected) {
        let runs = runs(6.34, &path, permitted);
        for ((run, prefilter), expected) in runs.iter().zip(PREFILTERS).zip(expected) {
            let max = run.acceleration_max / G;
            println!(
                "{permitted} {prefilter}: max {max:.4} g, rms {:.4} g, residual {:.5}, time {:.3} s",
                run.acceleration_rms / G,
                run.residual_max / runs[0].residual_max,
                run.path_time
            );
            assert!(expected.is_nan() || (max - expected).abs() < 0.006, "{prefilter}: {max} {expected}");
        }
        let (bare, best) = (&runs[0], &runs[5]);
        assert!(1.0 - best.acceleration_max / bare.acceleration_max >= 0.8569);
        assert!(1.0 - best.acceleration_rms / bare.acceleration_rms >= 0.8512);
        assert!(best.residual_max / bare.residual_max <= 0.005);
        assert!((bare.path_time - 3.48).abs() < 0.005);
    }
}

#[test]
fn a_plant_that_has_drifted_still_keeps_quiet() {
    let path = test_path().unwrap();
    for drift in [0.85, 1.15] {
        for permitted in [0.0, 500e-6] {
            let runs = runs(6.34 * drift, &path, permitted);
            let (bare, best) = (&runs[0], &runs[5]);
            let reduction = 1.0 - best.acceleration_max / bare.acceleration_max;
            let residual = best.residual_max / bare.residual_max;
            println!("{drift} {permitted}: reduction {reduction:.4}, residual {residual:.4}");
            assert!(reduction >= 0.85 && residual <= 0.015, "{reduction} {residual}");
        }
    }
}

#[test]
fn the_bare_run_tells_the_mode() {
    let run = run(&setup(6.34), &test_path().unwrap(), Prefilter::None, &mode(6.34), 0.0).unwrap();
    let found = identify(&run.residual()).unwrap().modes[0];
    assert!(
        (found.frequency_hz / 6.34 - 1.0).abs() < 1e-4 && (found.damping / 0.022 - 1.0).abs() < 1e-3,
        "{found:?}"
    );
}

#[test]
fn the_experiment_whole() {
    let outcome = scara(0.0).unwrap();
    let found = outcome.identified;
    assert!(
        (found.frequency_hz / 6.34 - 1.0).abs() < 2e-3 && (found.damping / 0.022 - 1.0).abs() < 0.05,
        "{found:?}"
    );
    assert_eq!(outcome.runs.len(), 12);
    for scara_run in outcome.runs.iter().filter(|scara_run| scara_run.prefilter == Prefilter::FirZvd) {
        let (best, bare) = (&scara_run.run, outcome.bare(scara_run.permitted).unwrap());
        assert!(1.0 - best.acceleration_max / bare.acceleration_max >= 0.8569);
        assert!(1.0 - best.acceleration_rms / bare.acceleration_rms >= 0.8512);
        assert!(best.residual_max / bare.residual_max <= 0.005);
    }
    assert_eq!(scara(0.0).unwrap(), outcome);
    assert!(matches!(scara(-1.0), Err(ExperimentError::Mode(_))));
}
