//! Every reason not to believe a reading, and readings that come in another order.

use seamline::geometry::Pose;
use seamline::path::Path;
use seamline::seam::{ControlPoint, Offset, Reading, Rejection, SeamTracker, Settings, TaughtPath};

use crate::paths::line;
use crate::random::Random;
use crate::simulation::{Laser, PERIOD, sensor};

const MM: f64 = 1e-3;
const SPEED: f64 = 20.0 * MM;
const GOOD: Reading = Reading { lateral: 1.0 * MM, height: 0.0, gap: None, exposure: 0.995, quality: 1.0 };

fn path() -> Path {
    line(300.0 * MM, 0.6, 0.2)
}

/// A tracker one second into its weld.
fn under_way(path: &Path) -> SeamTracker {
    let settings = Settings::new(sensor(path, &Laser::USUAL), SPEED);
    let mut tracker = SeamTracker::try_new(&settings, 0.0, Offset::zeros()).unwrap();
    for cycle in 0..=1000 {
        let time = f64::from(cycle) * PERIOD;
        tracker.step(time, SPEED * time, &path.pose(SPEED * time), path.span().1);
    }
    tracker
}

#[test]
fn each_bad_reading_is_named_and_counted() {
    let path = path();
    let mut tracker = under_way(&path);
    assert_eq!(tracker.take(&path, &GOOD), Ok(()));
    let cases = [
        (Rejection::Repeated, GOOD),
        (Rejection::NotFinite, Reading { height: f64::NAN, ..GOOD }),
        (Rejection::NotFinite, Reading { gap: Some(f64::INFINITY), ..GOOD }),
        (Rejection::OutOfRange, Reading { lateral: -21.0 * MM, ..GOOD }),
        (Rejection::LowQuality, Reading { quality: 0.2, ..GOOD }),
        (Rejection::TooOld, Reading { exposure: 0.85, ..GOOD }),
        (Rejection::InFuture, Reading { exposure: 1.01, ..GOOD }),
        (Rejection::BeyondBound, Reading { lateral: 11.0 * MM, ..GOOD }),
    ];
    for (expected, reading) in cases {
        let before = tracker.counts().of(expected);
        assert_eq!(tracker.take(&path, &reading), Err(expected), "{reading:?}");
        assert_eq!(tracker.counts().of(expected), before + 1, "{reading:?}");
    }
    assert_eq!(tracker.counts().taken, 1 + cases.len() as u64);
    assert_eq!(tracker.counts().dropped(), cases.len() as u64);

    // Seven more readings: the first ones are judged, and what is older than those comes too late.
    for k in 1..8 {
        assert_eq!(tracker.take(&path, &Reading { exposure: 0.995 + 5e-4 * f64::from(k), ..GOOD }), Ok(()));
    }
    let late = Reading { exposure: 0.99, ..GOOD };
    assert_eq!(tracker.take(&path, &late), Err(Rejection::OutOfOrder));

    // At the path's end the laser looks beyond it.
    tracker.step(1.001, path.length(), &path.pose(path.length()), path.length());
    assert_eq!(tracker.take(&path, &Reading { exposure: 1.001, ..GOOD }), Err(Rejection::OffPath));
}

/// A spike among good neighbours is counted once they are there.
#[test]
fn a_spike_is_found_among_its_neighbours() {
    let path = path();
    let mut tracker = under_way(&path);
    for k in 0..20 {
        let lateral = if k == 9 { 3.0 * MM } else { 1.0 * MM };
        let reading = Reading { lateral, exposure: 0.95 + 2e-3 * f64::from(k), ..GOOD };
        assert_eq!(tracker.take(&path, &reading), Ok(()));
    }
    assert_eq!(tracker.counts().of(Rejection::Spike), 1);
    assert_eq!(tracker.counts().dropped(), 1);
}

/// Time that jumps, forwards or back, makes the poses before worthless; tracking goes on with the next ones.
#[test]
fn time_may_jump() {
    let path = path();
    for jump in [-0.5, 10.0, 1e9] {
        let mut tracker = under_way(&path);
        let now = 1.0 + jump;
        let s = 1.001 * SPEED;
        tracker.step(now, s, &path.pose(s), path.span().1);
        assert_eq!(tracker.take(&path, &Reading { exposure: now - 5e-3, ..GOOD }), Err(Rejection::TooOld));
        tracker.step(now + PERIOD, s + SPEED * PERIOD, &path.pose(s), path.span().1);
        assert_eq!(tracker.take(&path, &Reading { exposure: now, ..GOOD }), Ok(()));
    }
}

/// The lane of a weld whose readings arrive in the order that `arrange` makes of them.
fn lane(arrange: impl Fn(&mut Vec<Reading>)) -> Vec<ControlPoint> {
    let path = path();
    let settings = Settings::new(sensor(&path, &Laser::USUAL), SPEED);
    let mut tracker = SeamTracker::try_new(&settings, 0.0, Offset::zeros()).unwrap();
    let mut random = Random(5);
    let mut points = Vec::new();
    let mut held = Vec::new();
    for cycle in 0..10_000 {
        let time = f64::from(cycle) * PERIOD;
        let pose: Pose = path.pose(SPEED * time);
        points.extend(tracker.step(time, SPEED * time, &pose, path.span().1));
        if cycle % 10 == 0 {
            held.push(Reading { lateral: 1.0 * MM + random.normal(0.05 * MM), exposure: time, ..GOOD });
        }
        if cycle % 40 == 39 {
            arrange(&mut held);
            for reading in held.drain(..) {
                assert_eq!(tracker.take(&path, &reading), Ok(()));
            }
        }
    }
    points
}

/// Four readings at a time, in order and in reverse: the lane is the same to the last bit.
#[test]
fn the_order_of_arrival_does_not_matter() {
    let in_order = lane(|_| ());
    assert!(in_order.len() > 90);
    assert_eq!(in_order, lane(|held| held.reverse()));
    assert_eq!(in_order, lane(|held| held.rotate_left(2)));
}
