//! The simulated laser on a straight weld along x, with the wire pointing down.

use seamline::seam::{Instant, Offset, Reading};
use seamline_cell::cell::{Cell, LaserErrors};
use seamline_cell::sensor::{SeamFeature, SimulatedLaser, SimulatedSeam};

use crate::{ask, at};

const LENGTH: f64 = 0.3;
const SPEED: f64 = 0.02;
const NO_ERRORS: LaserErrors =
    LaserErrors { noise: 0.0, spike: 5e-3, spike_probability: 0.0, dropout_probability: 0.0 };

fn seam() -> SimulatedSeam {
    let amplitude = Offset::new(5e-3, -3e-3);
    let features = vec![
        SeamFeature::Sine { amplitude, length: 0.2, at: 0.01 },
        SeamFeature::Gap { at: 0.1, length: 0.02 },
    ];
    SimulatedSeam { features }
}

/// All readings of a weld at 20 mm/s and 1 kHz, each with the time of its cycle.
fn weld(errors: LaserErrors, seed: u32) -> Vec<(f64, Reading)> {
    let mut cell = Cell::default_cell().expect("the default");
    cell.simulation.laser = errors;
    cell.simulation.seed = seed;
    cell.simulation.seam = seam().features;
    let mut laser = SimulatedLaser::from_cell(&cell);
    let mut all = Vec::new();
    for cycle in 0..(LENGTH / SPEED * 1e3) as u32 {
        let time = f64::from(cycle) * 1e-3;
        let torch = Instant { time, s: SPEED * time, base_from_tcp: at(SPEED * time) };
        while let Some(reading) = ask(&mut laser, &torch) {
            all.push((time, reading));
        }
    }
    all
}

/// Every reading is the seam 30 mm ahead of where the torch was, 10 ms later, at 100 Hz; none in the gap and none beyond the end.
#[test]
fn a_good_laser_reads_the_seam_ahead() {
    let readings = weld(NO_ERRORS, 1);
    for (time, reading) in &readings {
        assert!((time - reading.exposure - 10e-3).abs() < 1e-9, "{reading:?} at {time}");
        let ahead = SPEED * reading.exposure + 30e-3;
        let seen = Offset::new(reading.lateral, reading.height);
        assert!((seen - seam().offset(ahead)).norm() < 1e-9, "{reading:?} at {time}");
        assert!(ahead <= LENGTH + 1e-9 && !(ahead > 0.1 && ahead < 0.12), "{ahead}");
    }
    for pair in readings.windows(2) {
        let apart = pair[1].1.exposure - pair[0].1.exposure;
        // Once across the gap, which takes a second.
        assert!((apart - 0.01).abs() < 1.1e-3 || (apart - 1.0).abs() < 0.02, "{apart}");
    }
    // 270 mm at 20 mm/s and 100 Hz, less the gap.
    assert!(readings.len().abs_diff(1350 - 100) <= 2, "{}", readings.len());
}

/// Noise, spikes and dropouts as the cell says, over 20 seeds; the same seed gives the same readings, another one others.
#[test]
fn a_bad_laser_errs_as_it_is_told() {
    let errors =
        LaserErrors { noise: 0.05e-3, spike: 5e-3, spike_probability: 0.01, dropout_probability: 0.02 };
    assert_eq!(weld(errors, 7), weld(errors, 7));
    assert_ne!(weld(errors, 7), weld(errors, 8));
    let (mut all, mut spikes, mut squares, mut whole) = (0_u32, 0_u32, 0.0, 0);
    for seed in 0..20 {
        whole += weld(NO_ERRORS, seed).len() as u32;
        for (_, reading) in weld(errors, seed) {
            let seen = Offset::new(reading.lateral, reading.height);
            let error = seen - seam().offset(SPEED * reading.exposure + 30e-3);
            all += 1;
            if error.amax() > 2.5e-3 {
                spikes += 1;
                assert!((error.abs() - Offset::repeat(5e-3)).amax() < 0.5e-3, "{error}");
            } else {
                squares += 0.5 * error.norm_squared();
            }
        }
    }
    let sigma = (squares / f64::from(all - spikes)).sqrt();
    assert!((sigma - 0.05e-3).abs() < 0.001e-3, "{sigma}");
    let share = |part: u32, of: u32| f64::from(part) / f64::from(of);
    assert!((share(spikes, all) - 0.01).abs() < 0.003, "{spikes} of {all}");
    assert!((share(whole - all, whole) - 0.02).abs() < 0.004, "{all} of {whole}");
}
