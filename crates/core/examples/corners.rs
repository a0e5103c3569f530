//! How long a corner, a blend's jet and a spline's piece take:
//! `cargo run --release -p seamline --features std --example corners`.
//!
//! Each figure is the least mean of many short rounds, in nanoseconds, so that other load on the machine hardly counts.
#![allow(clippy::print_stdout, clippy::expect_used, clippy::panic, reason = "a program, not a controller")]

use std::hint::black_box;
use std::time::Instant;

use seamline::geometry::{Pose, Vector3};
use seamline::path::corner::{Corner, CornerZone};
use seamline::path::{Path, spline};

const ROUNDS: u32 = 200;
const CALLS: u32 = 100;

fn pose(x: f64, y: f64, turn: f64) -> Pose {
    Pose::new(Vector3::new(x, y, 0.0), Vector3::new(0.0, turn, 0.0))
}

fn nanoseconds(mut call: impl FnMut(u32) -> f64) -> f64 {
    let round = |_| {
        let start = Instant::now();
        black_box((0..CALLS).map(&mut call).sum::<f64>());
        start.elapsed().as_nanos() as f64 / f64::from(CALLS)
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}

fn solved(before: &Path, after: &Path) -> f64 {
    let zone = CornerZone { position: 5e-4, orientation: None, room: [0.05; 2] };
    let Corner::Blend(blend) = Corner::between(black_box(before), after, &zone) else {
        panic!("these corners have blends");
    };
    blend.error
}

fn main() {
    let corner = pose(0.0, 0.0, 0.3);
    let line = Path::line(&pose(-0.1, 0.0, 0.0), &corner);
    println!("{:>6} {:>12} {:>12} {:>12}", "angle", "line-line ns", "line-arc ns", "jet ns");
    for degrees in [0.0_f64, 5.0, 30.0, 90.0, 150.0, 175.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let onward = |x: f64, y: f64, turn: f64| pose(cos * x - sin * y, sin * x + cos * y, turn);
        let straight = Path::line(&corner, &onward(0.1, 0.0, 0.4));
        let arc = Path::arc(&corner, &onward(0.05, 0.05, 0.5), &onward(0.0, 0.1, 0.9)).expect("a circle");
        let zone = CornerZone { position: 5e-4, orientation: None, room: [0.05; 2] };
        let Corner::Blend(blend) = Corner::between(&line, &straight, &zone) else {
            panic!("these corners have blends");
        };
        let step = blend.path.length() / f64::from(CALLS);
        println!(
            "{degrees:>6} {:>12.0} {:>12.0} {:>12.0}",
            nanoseconds(|_| solved(&line, &straight)),
            nanoseconds(|_| solved(&line, &arc)),
            nanoseconds(|k| blend.path.jet(step * f64::from(k)).linear[1].x),
        );
    }
    let poses: Vec<Pose> =
        (0..9).map(|k| pose(0.1 * f64::from(k), 0.05 * f64::from(k * k % 5), 0.1)).collect();
    let mut pieces = [line; 8];
    let whole = nanoseconds(|_| {
        spline(black_box(&poses), None, None, &mut pieces).expect("a free curve");
        pieces[0].length()
    });
    println!("a piece of a spline: {:.0} ns", whole / 8.0);
}
