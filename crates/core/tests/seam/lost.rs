//! The seam lost and found again: dropouts of any length, and for good.

use seamline::path::Path;
use seamline::seam::{LostLane, Offset, Settings};

use crate::paths::{arc, line};
use crate::random::Random;
use crate::simulation::{Figures, Laser, Seam, Sine, World, sensor};

const MM: f64 = 1e-3;
const LENGTH: f64 = 400.0 * MM;
const SPEED: f64 = 20.0 * MM;
const PLACE: f64 = 130.0 * MM;

/// A seam that is not seen over a length.
struct Hidden {
    sine: Sine,
    length: f64,
}

impl Seam for Hidden {
    fn offset(&self, s: f64) -> Offset {
        self.sine.offset(s)
    }

    fn visible(&self, s: f64) -> bool {
        s < PLACE || s > PLACE + self.length
    }
}

fn settings(path: &Path, speed: f64) -> Settings {
    Settings { curvature: 10.0, ..Settings::new(sensor(path, &Laser::USUAL), speed) }
}

fn assert_limits(figures: &Figures, of: &str) {
    assert!(figures.jerk <= 20.0 && figures.speed <= 0.005, "{of}: {figures}");
}

/// 120 welds: dropouts of 1 to 150 mm at any speed. The limits are kept throughout, long ones are told, and 10 mm after the seam
/// is seen again plus the way that a jerk-limited return takes, the torch is on it.
#[test]
fn dropouts_of_any_length() {
    let mut random = Random(9);
    let paths = [line(LENGTH, 0.6, 0.2), arc(100.0 * MM, LENGTH, 0.6, 0.2)];
    for seed in 0..120 {
        let path = &paths[seed as usize % 2];
        let length = random.log_uniform(1.0, 150.0) * MM;
        let speed = random.log_uniform(10.0, 90.0) * MM;
        let seam = Hidden { sine: Sine::random(&mut random), length };
        let mut world = World::new(path, &seam, Laser::USUAL, seed);
        let settings = settings(path, speed);
        let (figures, _) = world.run(&settings, PLACE + length + 45.0 * MM);
        let of = format!("seed {seed}: {:.0} mm at {:.0} mm/s", length / MM, speed / MM);
        assert_limits(&figures, &of);
        assert!(figures.max_mm() <= 0.2, "{of}: {figures}");
        if length > 32.0 * MM {
            let (torch, lost) = world.lost.expect(&of);
            assert!((lost.seen_to - PLACE).abs() < 5.0 * MM, "{of}: {lost:?}");
            // In time to end the bead on the seam.
            assert!(torch < lost.seen_to, "{of}: at {torch}");
        }
        assert!(length > 20.0 * MM || world.lost.is_none(), "{of}: {:?}", world.lost);
    }
}

/// The laser stays dark. The lane follows its trend for a while and then holds, or goes back to the taught path.
#[test]
fn lost_for_good() {
    let path = line(LENGTH, 0.6, 0.2);
    for seed in 0..10 {
        let seam = Hidden { sine: Sine::random(&mut Random(300 + seed)), length: LENGTH };
        let run = |lost| {
            let mut world = World::new(&path, &seam, Laser::USUAL, seed);
            let (figures, tracker) = world.run(&Settings { lost, ..settings(&path, SPEED) }, LENGTH);
            assert_limits(&figures, &format!("{lost:?} {seed}"));
            assert!(tracker.lost().is_some() && world.lost.is_some_and(|(torch, _)| torch < PLACE));
            let at = |s: f64| tracker.lane().at(s).expect("held");
            (at(PLACE + 30.0 * MM), at(LENGTH - 1.0 * MM))
        };
        let (first, last) = run(LostLane::Hold);
        assert!((first.offset - last.offset).norm() < 0.01 * MM && last.derivatives[0].norm() < 1e-9);
        // The trend of 10 mm and its end: not far from where the seam was.
        assert!((first.offset - seam.offset(PLACE)).norm() < 4.0 * MM);
        let (_, last) = run(LostLane::Taught);
        assert!(last.offset.norm() < 1e-9, "{last:?}");
    }
}
