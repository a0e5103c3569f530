//! Root-pass memory: what is kept is what was frozen, and what does not fit is forgotten whole.

use seamline::seam::{
    LaneKey, LaneMemory, LaneRecord, MEMORY_POINTS, MEMORY_WELDS, MemoryFull, Offset, Pass, RecordedWeld,
    SeamTracker, Settings,
};

use crate::paths::line;
use crate::random::Random;
use crate::simulation::{Laser, Sine, World, sensor};

const LENGTH: f64 = 0.3;
const SPEED: f64 = 0.01;
const WELD: RecordedWeld = RecordedWeld { start: 0.0, length: LENGTH, speed: SPEED };

fn key(file: u32, weld: u32) -> LaneKey {
    LaneKey { file, weld }
}

/// Points of a record, other ones for each seed.
fn points(seed: u64, count: usize) -> Vec<Offset> {
    let mut random = Random(seed);
    (0..count).map(|_| Offset::new(random.uniform(-5e-3, 5e-3), random.uniform(-5e-3, 5e-3))).collect()
}

fn record(points: &[Offset]) -> LaneRecord<'_> {
    LaneRecord { spacing: 2e-3, first: -1, weld: WELD, points }
}

/// A tracked weld that is recorded as it freezes, played back it is the lane, bit for bit; and counted from its start.
#[test]
fn a_tracked_weld_is_played_back_as_it_was() {
    let path = line(LENGTH, 0.6, 0.2);
    let seam = Sine::random(&mut Random(5));
    let mut world = World::new(&path, &seam, Laser::USUAL, 5);
    let settings = Settings::new(sensor(&path, &Laser::USUAL), SPEED);
    world.run(&settings, 0.0);
    let mut tracker = SeamTracker::try_new(&settings, 0.0, Offset::zeros()).unwrap();
    let mut memory = LaneMemory::new();
    memory.open(key(1, 0), tracker.lane(), &WELD).unwrap();
    let mut seen = Vec::new();
    for cycle in &world.cycles {
        if let Some(point) = tracker.step(cycle.time, cycle.s, &cycle.measured, LENGTH) {
            memory.keep(&point).unwrap();
        }
        for reading in &cycle.arrived {
            let _ = tracker.take(&path, reading);
        }
        seen.push((cycle.s, tracker.lane().at(cycle.s).unwrap()));
    }
    let record = memory.record(key(1, 0)).unwrap();
    for (s, lane) in &seen {
        assert_eq!(record.at(*s), *lane, "{s}");
    }
    assert!(seen.len() > 1000 && record.points.len() > 100, "{} {}", seen.len(), record.points.len());
    let later = LaneRecord { weld: RecordedWeld { start: 0.1, ..WELD }, ..record };
    assert_eq!(later.at(0.05), record.at(0.1 + 0.05));
}

/// What is forgotten leaves the others as they are; a weld recorded again takes the place of what was.
#[test]
fn others_stay_when_one_is_forgotten() {
    let mut memory = LaneMemory::new();
    let lanes: Vec<Vec<Offset>> = (0..6).map(|k| points(k, 50 + 10 * k as usize)).collect();
    for (k, lane) in (0..).zip(&lanes) {
        memory.insert(key(k % 2, k), &record(lane)).unwrap();
    }
    memory.forget(0);
    let kept: Vec<LaneKey> = memory.records().map(|(key, _)| key).collect();
    assert_eq!(kept, [key(1, 1), key(1, 3), key(1, 5)]);
    let other = points(9, 30);
    memory.insert(key(1, 3), &record(&other)).unwrap();
    assert_eq!(memory.record(key(1, 1)).unwrap().points, lanes[1]);
    assert_eq!(memory.record(key(1, 5)).unwrap().points, lanes[5]);
    assert_eq!(memory.record(key(1, 3)).unwrap().points, other);
    assert_eq!(memory.record(key(0, 0)), None);
}

/// Full of points or of welds: the one too many is not there, the others are.
#[test]
fn what_does_not_fit_is_forgotten_whole() {
    let mut memory = LaneMemory::new();
    let (most, rest) = (points(1, MEMORY_POINTS - 20), points(2, 21));
    memory.insert(key(1, 0), &record(&most)).unwrap();
    assert_eq!(memory.insert(key(1, 1), &record(&rest)), Err(MemoryFull));
    assert_eq!(memory.record(key(1, 1)), None);
    memory.insert(key(1, 1), &record(&rest[1..])).unwrap();
    assert_eq!(memory.record(key(1, 0)).unwrap().points, most);
    assert_eq!(memory.record(key(1, 1)).unwrap().points, &rest[1..]);
    let mut memory = LaneMemory::new();
    let few = points(3, 4);
    for weld in 0..MEMORY_WELDS as u32 {
        memory.insert(key(1, weld), &record(&few)).unwrap();
    }
    assert_eq!(memory.insert(key(2, 0), &record(&few)), Err(MemoryFull));
    assert_eq!(memory.records().count(), MEMORY_WELDS);
}

/// A shift comes in with two continuous derivatives, within the jerk asked for, and is there after its lead; 100 random ones.
#[test]
fn a_shift_comes_in_within_its_jerk() {
    let mut random = Random(11);
    for _ in 0..100 {
        let shift = Offset::new(random.uniform(-8e-3, 8e-3), random.uniform(-8e-3, 8e-3));
        let (speed, jerk) = (random.uniform(2e-3, 0.05), random.uniform(5.0, 50.0));
        let pass = Pass::new(shift, speed, jerk);
        let taught = LaneRecord { spacing: 2e-3, first: 0, weld: WELD, points: &[] };
        let at = |share: f64| taught.of_pass(&pass, share * pass.lead);
        assert_eq!(at(0.0).offset, Offset::zeros());
        assert!((at(1.0).offset - shift).norm() < 1e-15 && at(1.0).derivatives == [Offset::zeros(); 3]);
        let h = 1e-4;
        assert!(pass.lead <= 1.001 * (3.75 * shift.norm()).max(speed * (60.0 * shift.norm() / jerk).cbrt()));
        for k in 1..200 {
            let share = f64::from(k) / 200.0;
            let [before, here, after] = [share - h, share, share + h].map(at);
            let thirds = here.derivatives[2].norm() * speed.powi(3);
            assert!(thirds <= jerk * (1.0 + 1e-9), "{thirds} {jerk}");
            assert!(here.derivatives[0].norm() <= 0.5 * (1.0 + 1e-9), "{here:?}");
            let slope = (after.offset - before.offset) / (2.0 * h * pass.lead);
            assert!((slope - here.derivatives[0]).norm() <= 1e-4 * shift.norm() / pass.lead);
            let slope = (after.derivatives[0] - before.derivatives[0]) / (2.0 * h * pass.lead);
            assert!((slope - here.derivatives[1]).norm() <= 1e-3 * shift.norm() / pass.lead.powi(2));
        }
    }
}
