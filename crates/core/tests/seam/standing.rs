//! Override, pause and backing up: the lane is a function of the way, and what is frozen stays.

use seamline::seam::{
    LaneRecord, Offset, Pass, RecordedWeld, SeamTracker, Settings, TaughtPath, corrected, foot,
};

use crate::paths::{LENGTH, curve, line};
use crate::random::Random;
use crate::simulation::{Figures, Laser, PERIOD, Seam, Sine, World, sensor};

const MM: f64 = 1e-3;
const SPEED: f64 = 20.0 * MM;

/// A smaller wave, for a path that bends by itself.
struct Gentle(Sine);

impl Seam for Gentle {
    fn offset(&self, s: f64) -> Offset {
        self.0.offset(s) * 0.6
    }
}

/// The rate of the way at a time: full, crawling, standing, backwards, full again.
fn rate(time: f64) -> f64 {
    match time {
        t if t < 4.0 => 1.0,
        t if t < 8.0 => 0.1,
        t if t < 13.0 => 0.0,
        t if t < 14.0 => -1.0,
        _ => 1.0,
    }
}

#[test]
fn a_paused_weld_is_as_near_as_any() {
    let path = line(LENGTH, 0.6, 0.2);
    for seed in 0..10 {
        let seam = Sine::random(&mut Random(40 + seed));
        let mut world = World::new(&path, &seam, Laser::USUAL, seed);
        let settings = Settings::new(sensor(&path, &Laser::USUAL), SPEED);
        let mut tracker = SeamTracker::try_new(&settings, 0.0, Offset::zeros()).unwrap();
        let mut points = Vec::new();
        let (mut s, mut cycle, mut worst) = (0.0, 0, 0.0_f64);
        while s < LENGTH {
            let time = f64::from(cycle) * PERIOD;
            let lane = tracker.lane().at(s).unwrap();
            let pose = corrected(&path.jet(s), &lane).unwrap().pose;
            points.extend(tracker.step(time, s, &pose, LENGTH));
            for reading in world.readings(time, s, &pose) {
                let _ = tracker.take(&path, &reading);
            }
            if s > 45.0 * MM {
                worst = worst.max((lane.offset - seam.offset(s)).amax());
            }
            s += SPEED * PERIOD * rate(time);
            cycle += 1;
        }
        assert!(worst <= 0.08 * MM, "seed {seed}: {} mm", worst / MM);
        // Each point froze once, one after the other.
        assert!(points.windows(2).all(|pair| pair[1].number == pair[0].number + 1));
        assert_recorded(&tracker, &points);
    }
}

/// The points as they froze, replayed: the lane itself, and beside it where a second pass belongs.
fn assert_recorded(tracker: &SeamTracker, points: &[seamline::seam::ControlPoint]) {
    let offsets: Vec<Offset> = points.iter().map(|point| point.offset).collect();
    let lane = tracker.lane();
    let (spacing, first) = (lane.spacing(), points[0].number);
    let record = LaneRecord { spacing, first, weld: RecordedWeld::default(), points: &offsets };
    let pass = Pass::new(Offset::new(2.0 * MM, 3.0 * MM), SPEED, 20.0);
    assert!((10.0 * MM..15.0 * MM).contains(&pass.lead), "{}", pass.lead);
    let mut s = (first + 1) as f64 * spacing;
    while s < lane.known_to() {
        if let Some(jet) = lane.at(s) {
            assert_eq!(record.at(s), jet, "{s}");
            let shifted = record.of_pass(&pass, s);
            assert!(s < pass.lead || (shifted.offset - jet.offset - pass.shift).norm() < 1e-15, "{s}");
            assert!(s < pass.lead || (shifted.derivatives[0] - jet.derivatives[0]).norm() < 1e-12, "{s}");
        }
        s += 0.7 * MM;
    }
    assert_eq!(record.at(lane.known_to() + 1.0).derivatives, [Offset::zeros(); 3]);
    let peaks = record.peaks();
    let jerk = peaks.third * SPEED * SPEED * SPEED;
    assert!(peaks.offset < 10.0 * MM && jerk < 20.0, "{peaks:?}");
}

/// Told the same again, a tracker freezes the same lane, bit for bit.
#[test]
fn the_same_readings_make_the_same_lane() {
    let path = line(LENGTH, 0.6, 0.2);
    let seam = Sine::random(&mut Random(3));
    let mut world = World::new(&path, &seam, Laser::USUAL, 3);
    let settings = Settings::new(sensor(&path, &Laser::USUAL), SPEED);
    let (_, first) = world.run(&settings, 0.0);
    let mut again = SeamTracker::try_new(&settings, 0.0, Offset::zeros()).unwrap();
    for cycle in &world.cycles {
        again.step(cycle.time, cycle.s, &cycle.measured, LENGTH);
        for reading in &cycle.arrived {
            let _ = again.take(&path, reading);
        }
    }
    let all = first.lane().next();
    assert_eq!(all, again.lane().next());
    assert!(all > 140 && (0..all).all(|k| first.lane().point(k) == again.lane().point(k)));
    assert_eq!(first.counts(), again.counts());
}

/// Several moves in one weld, in space, with a torch that turns.
#[test]
fn a_chain_of_curves_is_tracked() {
    let chain = curve();
    let mut worst = Figures::default();
    for seed in 0..30 {
        let seam = Gentle(Sine::random(&mut Random(60 + seed)));
        let mut world = World::new(&chain, &seam, Laser::USUAL, seed);
        let settings = Settings::new(sensor(&chain, &Laser::USUAL), SPEED);
        worst.keep_worst(&world.run(&settings, 45.0 * MM).0);
    }
    println!("chain of curves, 20 mm/s: {worst}");
    assert!(worst.rms_mm() <= 0.015 && worst.max_mm() <= 0.08, "{worst}");
    assert!(worst.speed <= 0.005 && worst.jerk <= 20.0, "{worst}");
}

/// The foot of random points against a search of the whole path.
#[test]
fn the_foot_is_the_nearest_point() {
    let chain = curve();
    let (first, last) = chain.span();
    let mut random = Random(8);
    for _ in 0..300 {
        let s = random.uniform(first + 0.02, last - 0.02);
        let jet = chain.jet(s);
        let aside = nalgebra::Vector3::from_fn(|_, _| random.uniform(-8.0, 8.0) * MM);
        let point = jet.pose.translation.vector + aside;
        let near = s + random.uniform(-10.0, 10.0) * MM;
        let found = foot(&chain, &point, near).expect("inside");
        let distance = |s: f64| (chain.jet(s).pose.translation.vector - point).norm();
        let nearest = (0..2000)
            .map(|k| distance(s + 0.02 * MM * (f64::from(k) - 1000.0)))
            .fold(f64::INFINITY, f64::min);
        assert!(found.offset.norm() <= nearest + 1e-9 && found.along.abs() < 1e-9, "{found:?} {nearest}");
    }
}
