//! Gaps, steps, kinks and tack welds at 20 mm/s, on a line and on an arc with a tilted torch.

use seamline::seam::{Offset, Rejection, Settings, TackMask};

use crate::paths::{LENGTH, arc, line};
use crate::random::Random;
use crate::simulation::{Laser, Seam, Sine, World, sensor};

const MM: f64 = 1e-3;
const SEEDS: u64 = 30;
const SPEED: f64 = 20.0 * MM;
/// Where it happens.
const PLACE: f64 = 150.0 * MM;

#[derive(Clone, Copy, PartialEq, Debug)]
enum Event {
    /// No joint to be seen over this length.
    Gap(f64),
    /// The seam jumps by this much, laterally and in height.
    Step(Offset),
    /// It turns by 5°, laterally and in height.
    Kink(Offset),
    /// A tack weld of 10 mm and 2 mm high, on which the joint's gap is closed and the laser unsure.
    Tack,
}

struct Eventful {
    sine: Sine,
    event: Event,
}

impl Eventful {
    fn on_tack(&self, s: f64) -> Option<f64> {
        let along = (s - PLACE) / (10.0 * MM);
        (self.event == Event::Tack && (0.0..=1.0).contains(&along)).then_some(along)
    }
}

impl Seam for Eventful {
    fn offset(&self, s: f64) -> Offset {
        let beyond = (s - PLACE).max(0.0);
        match self.event {
            Event::Step(step) => self.sine.offset(s) + if beyond > 0.0 { step } else { Offset::zeros() },
            Event::Kink(sides) => sides * (beyond * 5.0_f64.to_radians().tan()),
            Event::Gap(_) | Event::Tack => self.sine.offset(s),
        }
    }

    fn visible(&self, s: f64) -> bool {
        !matches!(self.event, Event::Gap(length) if s > PLACE && s < PLACE + length)
    }

    /// A bead with round ends.
    fn bump(&self, s: f64) -> f64 {
        self.on_tack(s).map_or(0.0, |along| 2.0 * MM * (4.0 * along * (1.0 - along)).min(1.0).sqrt())
    }

    fn looks(&self, s: f64) -> (Option<f64>, f64) {
        if self.on_tack(s).is_some() { (Some(0.0), 0.5) } else { (Some(1.0 * MM), 0.9) }
    }
}

/// Greatest error in millimetres over all seeds, on both paths.
fn worst(event: Event, tacks: Option<TackMask>) -> f64 {
    let mut worst = 0.0_f64;
    for (name, path) in [("line", line(LENGTH, 0.6, 0.2)), ("arc", arc(100.0 * MM, LENGTH, 0.6, 0.2))] {
        let mut of_path = 0.0_f64;
        for seed in 0..SEEDS {
            let seam = Eventful { sine: Sine::random(&mut Random(2000 + seed)), event };
            let mut world = World::new(&path, &seam, Laser::USUAL, 500 + seed);
            let settings = Settings::new(sensor(&path, &Laser::USUAL), SPEED);
            let settings = Settings { curvature: 10.0, bound: 15.0 * MM, tacks, ..settings };
            let (figures, tracker) = world.run(&settings, 45.0 * MM);
            of_path = of_path.max(figures.max_mm());
            assert!(figures.jerk < 20.0, "{event:?} {name} {seed}: jerk {}", figures.jerk);
            assert!(figures.speed < 0.005, "{event:?} {name} {seed}: speed {}", figures.speed);
            assert_eq!(tracker.lost(), None);
            if event == Event::Tack {
                assert_eq!(tracker.counts().of(Rejection::Tack) > 0, tacks.is_some());
            }
        }
        println!("{event:?} {name}: {of_path:.3} mm");
        worst = worst.max(of_path);
    }
    worst
}

#[test]
fn gaps_are_bridged() {
    assert!(worst(Event::Gap(10.0 * MM), None) <= 0.1);
    assert!(worst(Event::Gap(20.0 * MM), None) <= 0.1);
}

#[test]
fn steps_are_met_half_way() {
    assert!(worst(Event::Step(Offset::new(0.5 * MM, 0.0)), None) <= 0.3);
    assert!(worst(Event::Step(Offset::new(0.0, 0.5 * MM)), None) <= 0.3);
}

#[test]
fn kinks_are_rounded() {
    assert!(worst(Event::Kink(Offset::new(1.0, 0.0)), None) <= 0.1);
    assert!(worst(Event::Kink(Offset::new(0.0, -1.0)), None) <= 0.1);
}

/// By its height, its gap or the laser's quality, each alone; and what comes of following it.
#[test]
fn tack_welds_are_not_climbed() {
    let none = TackMask { rise: f64::INFINITY, gap_below: 0.0, quality_below: 0.0, ..TackMask::BY_HEIGHT };
    assert!(worst(Event::Tack, Some(TackMask::BY_HEIGHT)) <= 0.1);
    assert!(worst(Event::Tack, Some(TackMask { gap_below: 0.5 * MM, ..none })) <= 0.1);
    assert!(worst(Event::Tack, Some(TackMask { quality_below: 0.7, ..none })) <= 0.1);
    assert!(worst(Event::Tack, None) > 1.0);
}
