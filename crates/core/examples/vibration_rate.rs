//! Times of the prefilter stage and the corner search: `cargo run --release --features std --example vibration_rate`.
#![allow(clippy::print_stdout, reason = "a program")]

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use seamline::vibration::{Corner, Mode, Prefilter, PrefilterStage, Ramp, StageEntry};

/// The least mean of several rounds, in nanoseconds a call: other work on the machine only adds.
fn nanoseconds(mut call: impl FnMut(u32)) -> f64 {
    const ROUNDS: u32 = 200;
    const CALLS: u32 = 2000;
    let mut least = f64::INFINITY;
    for round in 0..ROUNDS {
        let start = Instant::now();
        for n in 0..CALLS {
            call(round * CALLS + n);
        }
        least = least.min(start.elapsed().as_secs_f64() * 1e9 / f64::from(CALLS));
    }
    least
}

/// A stage on `N` numbers that move, in nanoseconds a cycle.
fn stage<const N: usize>(prefilter: Prefilter, mode: &Mode) -> Result<f64, Box<dyn std::error::Error>> {
    let ring = [StageEntry::ZERO; 512];
    let mut stage = PrefilterStage::try_new(ring, &prefilter.kernel(mode)?, 1e-3, &[0.0; N])?;
    Ok(nanoseconds(|n| {
        black_box(stage.update(&[f64::from(n) * 1e-6; N]));
    }))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mode = Mode::try_new(TAU * 6.34, 0.022)?;
    println!(
        "stage, 1 kHz, moving: 6 axes; and 20 numbers, as the controller has for 6 axes with velocity and acceleration"
    );
    for prefilter in Prefilter::ALL {
        let (axes, all) = (stage::<6>(prefilter, &mode)?, stage::<20>(prefilter, &mode)?);
        println!("  {:<9} {axes:7.1} {all:7.1} ns a cycle", prefilter.name());
    }
    println!("corner, 160 mm/s, 0.5 mm, angles 5 to 175 degrees:");
    for prefilter in &Prefilter::ALL[1..] {
        let ramp = Ramp::from_kernel(&prefilter.kernel(&mode)?)?;
        let time = nanoseconds(|n| {
            let angle = f64::from(5 + n % 171).to_radians();
            let corner = Corner {
                deceleration: &ramp,
                acceleration: &ramp,
                first_feedrate: 0.16,
                second_feedrate: 0.16,
                angle,
                longest: f64::INFINITY,
            };
            black_box(corner.overlap(5e-4));
        });
        println!("  {:<9} {:7.2} µs a corner", prefilter.name(), time * 1e-3);
    }
    Ok(())
}
