//! What seam tracking costs a cycle:
//! `cargo build --release --example seam_count --features std`, then
//! `target/release/examples/seam_count` prints microseconds (each cycle's least of 30 equal runs: mean and worst), and
//! `valgrind --tool=callgrind --toggle-collect='*count::welds*' target/release/examples/seam_count 1` counts instructions.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a program")]
#![allow(dead_code, unreachable_pub, reason = "it uses a part of the tests' simulation")]

#[path = "../tests/seam/paths.rs"]
mod paths;
#[path = "../tests/otg_support/random.rs"]
mod random;
#[path = "../tests/seam/simulation.rs"]
mod simulation;

use std::time::Instant;

use random::Random;
use seamline::seam::{Offset, SeamTracker, Settings, TaughtPath};
use simulation::{Cycle, Laser, Seam, Sine, World, sensor};

const MM: f64 = 1e-3;

/// A seam of which 25 mm in every 75 are not seen: each gap asks for the longest fits.
struct Gappy(Sine);

impl Seam for Gappy {
    fn offset(&self, s: f64) -> Offset {
        self.0.offset(s)
    }

    fn visible(&self, s: f64) -> bool {
        s % (75.0 * MM) < 50.0 * MM
    }
}

mod count {
    use super::{Cycle, SeamTracker, TaughtPath};

    /// What is counted, and nothing else: the tracker's calls of one cycle, and the lane where the torch is.
    #[inline(never)]
    pub(super) fn welds(tracker: &mut SeamTracker, path: &impl TaughtPath, end: f64, cycle: &Cycle) -> f64 {
        tracker.step(cycle.time, cycle.s, &cycle.measured, end);
        for reading in &cycle.arrived {
            let _ = tracker.take(path, reading);
        }
        tracker.lane().at(cycle.s).map_or(0.0, |lane| lane.offset.x)
    }
}

fn measure<P: TaughtPath>(name: &str, path: &P, laser: Laser, speed: f64, runs: usize) {
    let seam = Gappy(Sine::random(&mut Random(1)));
    let mut world = World::new(path, &seam, laser, 1);
    let settings = Settings::new(sensor(path, &laser), speed);
    world.run(&settings, 0.0);
    let end = path.span().1;
    let mut least = vec![f64::INFINITY; world.cycles.len()];
    let mut sum = 0.0;
    for _ in 0..runs {
        let mut tracker = SeamTracker::try_new(&settings, 0.0, Offset::zeros()).expect("settings");
        for (least, cycle) in least.iter_mut().zip(&world.cycles) {
            let start = Instant::now();
            sum += count::welds(&mut tracker, path, end, cycle);
            *least = least.min(start.elapsed().as_secs_f64() * 1e6);
        }
    }
    let mean = least.iter().sum::<f64>() / least.len() as f64;
    least.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| least[((least.len() - 1) as f64 * share) as usize];
    println!(
        "{name}, {:.0} mm/s, {:.0} Hz: {} cycles, mean {mean:.3}, p99 {:.2}, worst {:.2} us ({sum:.3})",
        speed / MM,
        laser.rate,
        least.len(),
        at(0.99),
        at(1.0)
    );
}

fn main() {
    let runs = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(30);
    let fast = Laser { rate: 500.0, ..Laser::USUAL };
    let (arc, curve) = (paths::arc(100.0 * MM, paths::LENGTH, 0.6, 0.2), paths::curve());
    for speed in [20.0 * MM, 100.0 * MM] {
        for laser in [Laser::USUAL, fast] {
            measure("arc", &arc, laser, speed, runs);
            measure("curves", &curve, laser, speed, runs);
        }
    }
    println!("a tracker is {} bytes", size_of::<SeamTracker>());
}
