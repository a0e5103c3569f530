//! Prints the table of docs/seam.md and draws its figure:
//! `cargo run --release -p seamline --features std --example seam_figures -- docs/figures`.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a program")]
#![allow(dead_code, unreachable_pub, reason = "it uses a part of the tests' simulation")]

mod chart;
#[path = "../tests/seam/naive.rs"]
mod naive;
#[path = "../tests/seam/paths.rs"]
mod paths;
#[path = "../tests/otg_support/random.rs"]
mod random;
#[path = "../tests/seam/simulation.rs"]
mod simulation;

use chart::{BOLD, Chart, DASHED, GREY, RED};
use random::Random;
use seamline::path::Path;
use seamline::seam::{Filter, Offset, Settings};
use simulation::{Figures, Laser, Seam, Sine, World, sensor};

const MM: f64 = 1e-3;
const SEEDS: u64 = 30;
const RUN_IN: f64 = 45.0 * MM;
const GAP: (f64, f64) = (150.0 * MM, 170.0 * MM);

/// A way to follow the seam: its name, and one weld at a speed.
type Way = (&'static str, fn(&mut World<'_, Path, Sine>, f64) -> Figures);

const WAYS: [Way; 3] = [
    ("lane, local regression", |world, speed| tracked(world, speed, Filter::Regression)),
    ("lane, mean of 15", |world, speed| tracked(world, speed, Filter::Mean { readings: 15 })),
    ("naive", |world, speed| naive::run(world, speed, RUN_IN)),
];

fn tracked<S: Seam>(world: &mut World<'_, Path, S>, speed: f64, filter: Filter) -> Figures {
    let settings =
        Settings { filter, curvature: 10.0, ..Settings::new(sensor(world.path, &Laser::USUAL), speed) };
    world.run(&settings, RUN_IN).0
}

fn table() {
    let paths =
        [("line", paths::line(paths::LENGTH, 0.6, 0.2)), ("arc", paths::arc(0.1, paths::LENGTH, 0.6, 0.2))];
    println!("| path, speed | way | RMS mm | max mm | speed off % | jerk mm/s3 |\n|---|---|---|---|---|---|");
    for (name, path) in &paths {
        for speed in [10.0, 20.0, 50.0, 100.0] {
            for (way, weld) in WAYS {
                let mut worst = Figures::default();
                for seed in 0..SEEDS {
                    let seam = Sine::random(&mut Random(1000 + seed));
                    worst.keep_worst(&weld(&mut World::new(path, &seam, Laser::USUAL, seed), speed * MM));
                }
                println!(
                    "| {name}, {speed} mm/s | {way} | {:.3} | {:.3} | {:.4} | {:.0} |",
                    worst.rms_mm(),
                    worst.max_mm(),
                    100.0 * worst.speed,
                    worst.jerk / MM
                );
            }
        }
    }
}

/// What a sensor costs that sits 0.5 mm farther ahead than its calibration says.
fn calibration() {
    let path = paths::line(paths::LENGTH, 0.6, 0.2);
    let laser = Laser { look_ahead: Laser::USUAL.look_ahead + 0.5 * MM, ..Laser::USUAL };
    for speed in [10.0, 100.0] {
        let mut worst = Figures::default();
        for seed in 0..SEEDS {
            let seam = Sine::random(&mut Random(1000 + seed));
            worst.keep_worst(&tracked(
                &mut World::new(&path, &seam, laser, seed),
                speed * MM,
                Filter::Regression,
            ));
        }
        println!("0.5 mm farther ahead than calibrated, line, {speed} mm/s: {worst}");
    }
}

/// A wandering seam with 20 mm of it not to be seen.
struct Gapped(Sine);

impl Seam for Gapped {
    fn offset(&self, s: f64) -> Offset {
        self.0.offset(s)
    }

    fn visible(&self, s: f64) -> bool {
        s < GAP.0 || s > GAP.1
    }
}

fn figure(folder: &std::path::Path) -> std::io::Result<()> {
    let path = paths::line(paths::LENGTH, 0.6, 0.2);
    let seam = Gapped(Sine { phase: [1.0, 0.0] });
    let lateral = |track: &[(f64, Offset)]| -> Vec<(f64, f64)> {
        track.iter().step_by(20).map(|(s, offset)| (s / MM, offset.x / MM)).collect()
    };
    let mut with_lane = World::new(&path, &seam, Laser::USUAL, 1);
    tracked(&mut with_lane, 20.0 * MM, Filter::Regression);
    let mut without = World::new(&path, &seam, Laser::USUAL, 1);
    naive::run(&mut without, 20.0 * MM, RUN_IN);

    let mut chart = Chart::new((0.0, 300.0), (-8.0, 8.0));
    let (from, to) = (GAP.0 / MM, GAP.1 / MM);
    chart.area(&[(from, -8.0), (to, -8.0), (to, 8.0), (from, 8.0)], GREY);
    chart.line(&lateral(&without.track), RED);
    let course = (0..=300).map(|s| (f64::from(s), seam.offset(f64::from(s) * MM).x / MM));
    chart.line(&course.collect::<Vec<_>>(), DASHED);
    chart.line(&lateral(&with_lane.track), BOLD);
    chart.axes("s, mm", "lateral, mm");
    chart.text((from - 2.0, -7.5), "gap");
    chart.text((6.0, 5.6), "seam");
    chart.text((12.0, 0.8), "run-in");
    chart.text((60.0, -5.6), "naive");
    chart.text((232.0, 5.8), "torch on its lane");
    chart.write(&folder.join("seam.svg"))
}

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "docs/figures".to_owned());
    figure(std::path::Path::new(&folder))?;
    table();
    calibration();
    Ok(())
}
