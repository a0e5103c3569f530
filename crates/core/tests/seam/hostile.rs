//! Whatever a sensor says: no panic, a finite lane, and its bounds kept.

use seamline::geometry::Pose;
use seamline::path::Path;
use seamline::seam::{Filter, Lane, LostLane, Offset, Reading, SeamTracker, Settings, TackMask, TaughtPath};

use crate::paths::{arc, line};
use crate::random::Random;
use crate::simulation::{Laser, PERIOD, sensor};

const MM: f64 = 1e-3;
const READINGS: u64 = 1_000_000;
/// A weld each, with about ten readings a cycle.
const WELDS: u64 = 40;
const LENGTH: f64 = 250.0 * MM;

fn settings(path: &Path, random: &mut Random) -> Settings {
    let speed = random.uniform(5.0, 100.0) * MM;
    let filter = if random.chance(0.7) { Filter::Regression } else { Filter::Mean { readings: 5 } };
    Settings {
        filter,
        curvature: 10.0,
        bound: random.uniform(2.0, 15.0) * MM,
        saturation: random.log_uniform(0.001, 0.1) * MM,
        jerk: random.log_uniform(1.0, 20.0),
        lost: if random.chance(0.5) { LostLane::Hold } else { LostLane::Taught },
        tacks: random.chance(0.5).then_some(TackMask::BY_HEIGHT),
        ..Settings::new(sensor(path, &Laser::USUAL), speed)
    }
}

/// A number that may be anything, mostly of the size that readings have.
fn number(random: &mut Random, size: f64) -> f64 {
    match random.bits() % 40 {
        0 => f64::NAN,
        1 => f64::INFINITY * random.sign(),
        2 => random.sign() * random.log_uniform(1e-300, 1e300),
        3 => f64::from_bits(random.bits()),
        4 => 0.0,
        _ => random.uniform(-size, size),
    }
}

fn reading(random: &mut Random, time: f64, level: &Offset) -> Reading {
    let near = random.chance(0.7);
    let noise = if near { 0.5 * MM } else { 20.0 * MM };
    Reading {
        lateral: level.x + number(random, noise),
        height: level.y + number(random, noise),
        gap: random.chance(0.3).then(|| number(random, 2.0 * MM)),
        exposure: if random.chance(0.8) {
            time - random.uniform(0.0, 0.02)
        } else {
            time + number(random, 0.3)
        },
        quality: if random.chance(0.9) { random.unit() } else { number(random, 1.0) },
    }
}

fn assert_bounds(lane: &Lane, settings: &Settings) {
    let spacing = lane.spacing();
    let fastest = settings.speed / (1.0 - settings.curvature * settings.bound);
    let (slope, third) = (settings.saturation / settings.period / fastest, settings.jerk / fastest.powi(3));
    let exact = 1.0 + 1e-9;
    let mut s = lane.known_from();
    while s < lane.known_to() {
        let jet = lane.at(s).expect("known");
        assert!(jet.offset.amax() <= settings.bound * exact, "{s}: {jet:?}");
        assert!(jet.derivatives[0].amax() <= slope * exact, "{s}: {jet:?}");
        assert!(jet.derivatives[2].norm() <= third * exact + 1e-6, "{s}: {jet:?}");
        s += 0.5 * spacing;
    }
}

fn weld(path: &Path, random: &mut Random) {
    let settings = settings(path, random);
    let mut tracker = SeamTracker::try_new(&settings, 0.0, Offset::zeros()).expect("settings");
    let cycles = (LENGTH / settings.speed / PERIOD) as u64;
    let each = READINGS / WELDS / cycles + 1;
    let mut level = Offset::zeros();
    for cycle in 0..cycles {
        let s = LENGTH * cycle as f64 / cycles as f64;
        let jump = if random.chance(0.001) { number(random, 1.0) } else { 0.0 };
        let time = cycle as f64 * PERIOD + jump;
        let pose = if random.chance(0.001) { Pose::translation(f64::NAN, 0.0, 0.0) } else { path.pose(s) };
        if random.chance(0.002) {
            level = Offset::new(random.uniform(-15.0, 15.0), random.uniform(-15.0, 15.0)) * MM;
        }
        tracker.step(time, s, &pose, path.span().1);
        for _ in 0..each {
            let _ = tracker.take(path, &reading(random, time, &level));
        }
        if !jump.is_nan() && pose.translation.x.is_finite() && time.is_finite() {
            assert!(tracker.lane().at(s).is_some_and(|jet| jet.offset.norm().is_finite()));
        }
    }
    assert_bounds(tracker.lane(), &settings);
    assert!(tracker.counts().taken >= READINGS / WELDS && tracker.counts().dropped() > 0);
}

/// A million readings with every kind of fault, on lines and arcs, with both filters.
#[test]
fn a_million_hostile_readings() {
    let mut random = Random(77);
    let paths = [line(LENGTH, 0.6, 0.2), arc(100.0 * MM, LENGTH, 0.6, 0.2)];
    for weld_number in 0..WELDS {
        weld(&paths[weld_number as usize % 2], &mut random);
    }
}
