//! Times random tool paths of the default arm and prints, for each, how long the planning took against the
//! motion. Planned is as in jobs, with room for override and pause.
//!
//! `path_timing [COUNT [FOLDER]]`: with a folder, each move is also written there for
//! `tests/path_timing_reference.py`.

#![allow(clippy::print_stdout, reason = "printing is what it is for")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use common::{Kind, Move, REFERENCE_SEED, Random, joint_limits, random_move, time_alone};
use seamline_cell::plan::timing::{JointPath, Timing, TimingKind};

const REPEATS: usize = 3;

fn main() -> std::io::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next().and_then(|n| n.parse().ok()).unwrap_or(250);
    let folder = arguments.next();
    let mut random = Random(REFERENCE_SEED);
    let mut speeds = Vec::new();
    for index in 0..count {
        let mut job = random_move(&mut random, Kind::of(index));
        let (timing, took) = planned(&mut job);
        print!("{index:3} {:?} {:.3} m at {:.3} m/s: ", job.kind, job.path.length(), job.limits.speed);
        let Some(timing) = timing else { continue };
        let (kind, duration, pieces) = (timing.kind(), timing.duration(), timing.pieces().len());
        println!("{kind:?} {duration:.4} s, {pieces} pieces, planned {:.0} times faster", duration / took);
        for slowdown in timing.slowdowns() {
            println!("      {slowdown:.4?}");
        }
        if kind != TimingKind::Plain {
            speeds.push(duration / took);
        }
        if let Some(folder) = &folder {
            dump(&mut job, &timing, &Path::new(folder).join(format!("{index:04}.bin")))?;
        }
    }
    speeds.sort_by(f64::total_cmp);
    let at = |share: f64| speeds.get((share * speeds.len() as f64) as usize).copied().unwrap_or(f64::NAN);
    println!(
        "motion / planning of {} optimized moves: least {:.0}, 5 % {:.0}, median {:.0}",
        speeds.len(),
        at(0.0),
        at(0.05),
        at(0.5)
    );
    Ok(())
}

/// The timing, and the least time in which it was found.
fn planned(job: &mut Move) -> (Option<Timing>, f64) {
    let (joints, limits) = (joint_limits().with_room(), job.limits.with_room());
    let mut least = f64::INFINITY;
    let mut found = None;
    for _ in 0..REPEATS {
        let begun = Instant::now();
        match time_alone(&mut job.path, &joints, &limits) {
            Ok(timing) => found = Some(timing),
            Err(error) => println!("{error:?}"),
        }
        least = least.min(begun.elapsed().as_secs_f64());
    }
    (found, least)
}

/// Little-endian numbers: our duration, 1 if it was optimized, path length, speed and acceleration limit,
/// then place, q′ and q″ on a grid.
fn dump(job: &mut Move, timing: &Timing, file: &Path) -> std::io::Result<()> {
    let length = job.path.length();
    let steps = (timing.duration() / 0.5e-3).ceil().clamp(200.0, 8000.0) as usize;
    let mut places: Vec<f64> =
        (0..=steps).map(|i| timing.at(timing.duration() * i as f64 / steps as f64).position).collect();
    places.extend((0..=200).map(|i| length * f64::from(i) / 200.0));
    places.sort_by(f64::total_cmp);
    places.dedup_by(|next, before| *next - *before < 1e-8 * length);
    if let Some(last) = places.last_mut() {
        *last = length;
    }
    let mut out = std::io::BufWriter::new(std::fs::File::create(file)?);
    let mut put = |value: f64| out.write_all(&value.to_le_bytes());
    let optimized = f64::from(u8::from(timing.kind() == TimingKind::Optimized));
    for value in [timing.duration(), optimized, length, job.limits.speed, job.limits.acceleration] {
        put(value)?;
    }
    for place in places {
        let Ok(jet) = job.path.jet(place) else { continue };
        put(place)?;
        for value in jet.velocity.into_iter().chain(jet.acceleration) {
            put(value)?;
        }
    }
    Ok(())
}
