//! Random corners, judged by sampling the path that they make.

use std::f64::consts::{PI, TAU};

use nalgebra::{Vector2, Vector3};
use seamline::geometry::Pose;
use seamline::path::Path;
use seamline::vibration::{
    Corner, Kernel, Mode, Prefilter, Ramp, RampPiece, angle_between, reachable_feedrate, trapezoid_overlap,
};

use crate::random::Random;

/// Least distance of the path from the corner, from the feedrates alone: position is their sum over small steps.
fn sampled_error(corner: &Corner<'_>, delay: f64, steps: u32) -> f64 {
    let end = corner.deceleration.duration().max(delay + corner.acceleration.duration());
    let first = Vector2::new(1.0, 0.0);
    let second = Vector2::new(corner.angle.cos(), corner.angle.sin());
    let step = end / f64::from(steps);
    let velocity = |time: f64| {
        first * (corner.first_feedrate * (1.0 - corner.deceleration.value(time)))
            + second * (corner.second_feedrate * corner.acceleration.value(time - delay))
    };
    // The deceleration's whole way leads to the corner.
    let way: f64 =
        (0..steps).map(|n| step * (1.0 - corner.deceleration.value((f64::from(n) + 0.5) * step))).sum();
    let mut at = first * (-corner.first_feedrate * way);
    let mut least = at.norm();
    for n in 0..steps {
        at += velocity((f64::from(n) + 0.5) * step) * step;
        least = least.min(at.norm());
    }
    least
}

/// A prefiltered step, a trapezoid, an S-curve, or a prefiltered S-curve.
fn random_ramp(random: &mut Random) -> Ramp {
    let mode = Mode::try_new(TAU * random.log_uniform(2.0, 40.0), random.uniform(0.0, 0.1)).unwrap();
    let prefilter = Prefilter::ALL[1 + random.bits() as usize % (Prefilter::ALL.len() - 1)];
    let kernel = prefilter.kernel(&mode).unwrap();
    match random.bits() % 6 {
        0 => Ramp::trapezoid(random.log_uniform(1e-3, 1.0)).unwrap(),
        1 => {
            let feedrate = random.log_uniform(0.01, 2.0);
            Ramp::s_curve(feedrate, random.log_uniform(0.5, 20.0), random.log_uniform(5.0, 1000.0)).unwrap()
        }
        2 => {
            let smooth = Kernel::rectangle(random.log_uniform(1e-3, 0.2)).unwrap();
            Ramp::from_kernel(&kernel.convolve(&smooth).unwrap()).unwrap()
        }
        _ => Ramp::from_kernel(&kernel).unwrap(),
    }
}

struct Case {
    deceleration: Ramp,
    acceleration: Ramp,
    feedrates: [f64; 2],
    angle: f64,
    permitted: f64,
}

impl Case {
    fn random(random: &mut Random) -> Self {
        let deceleration = random_ramp(random);
        let acceleration = if random.chance(0.7) { deceleration } else { random_ramp(random) };
        let feedrate = random.log_uniform(1e-2, 2.0);
        let other = if random.chance(0.5) { feedrate } else { random.log_uniform(1e-2, 2.0) };
        let angle = match random.bits() % 20 {
            0 => [0.0, PI][random.bits() as usize % 2],
            1 => random.log_uniform(1e-6, 1.0),
            _ => random.uniform(0.0, PI),
        };
        Self {
            deceleration,
            acceleration,
            feedrates: [feedrate, other],
            angle,
            permitted: random.log_uniform(1e-7, 2e-3),
        }
    }

    fn corner(&self) -> Corner<'_> {
        Corner {
            deceleration: &self.deceleration,
            acceleration: &self.acceleration,
            first_feedrate: self.feedrates[0],
            second_feedrate: self.feedrates[1],
            angle: self.angle,
            longest: f64::INFINITY,
        }
    }

    /// Whether the corner keeps its error, and uses it unless the whole deceleration overlaps.
    fn check(&self) -> bool {
        let corner = self.corner();
        let found = corner.overlap(self.permitted);
        let whole = found.overlap >= self.deceleration.duration();
        assert!(found.error <= self.permitted, "{found:?}");
        assert!(whole || found.error >= 0.999 * self.permitted, "{found:?}, permitted {}", self.permitted);
        assert!(found.nearest >= found.delay && found.nearest <= found.deceleration, "{found:?}");
        assert!(
            (found.delay + found.overlap - found.deceleration).abs() <= 1e-15 + 1e-15 * found.deceleration
        );
        whole
    }
}

#[test]
fn random_corners_keep_and_use_their_error() {
    let mut random = Random(11);
    for case in 0..1500 {
        let case_data = Case::random(&mut random);
        case_data.check();
        if case % 10 == 0 {
            let corner = case_data.corner();
            let found = corner.overlap(case_data.permitted);
            let steps = 40_000;
            let sampled = sampled_error(&corner, found.delay, steps);
            // A step's way is what sampling cannot see.
            let way = (case_data.feedrates[0] + case_data.feedrates[1])
                * (case_data.deceleration.duration() + case_data.acceleration.duration())
                / f64::from(steps);
            assert!((sampled - found.error).abs() < 2.0 * way, "case {case}: {sampled} {found:?}");
        }
    }
}

#[test]
#[ignore = "a million corners: for a release build"]
fn a_million_random_corners() {
    let mut random = Random(2026);
    let whole = (0..1_000_000).filter(|_| Case::random(&mut random).check()).count();
    println!("1,000,000 corners: all keep their error and use it to 0.1 %; {whole} overlap whole");
}

#[test]
fn two_like_trapezoids_have_the_closed_form() {
    let mut random = Random(3);
    for _ in 0..500 {
        let (feedrate, duration) = (random.log_uniform(0.01, 1.0), random.log_uniform(0.01, 1.0));
        let (angle, permitted) = (random.uniform(0.01, PI), random.log_uniform(1e-6, 1e-3));
        let ramp = Ramp::trapezoid(duration).unwrap();
        let corner = Corner {
            deceleration: &ramp,
            acceleration: &ramp,
            first_feedrate: feedrate,
            second_feedrate: feedrate,
            angle,
            longest: f64::INFINITY,
        };
        let found = corner.overlap(permitted);
        let closed = trapezoid_overlap(feedrate, duration, angle, permitted);
        assert!((found.overlap - closed).abs() < 1e-8 * duration, "{found:?} {closed}");
        if closed < duration {
            assert!((found.nearest - found.delay - 0.5 * closed).abs() < 1e-6 * duration, "{found:?}");
        }
    }
    assert_eq!(trapezoid_overlap(0.1, 0.2, 0.0, 1e-3), 0.2);
    assert_eq!(trapezoid_overlap(0.1, 0.2, 1.0, 0.0), 0.0);
}

#[test]
fn a_larger_error_never_shortens_the_overlap() {
    let mut random = Random(8);
    for _ in 0..100 {
        let case = Case::random(&mut random);
        let corner = case.corner();
        let mut last = corner.overlap(0.0);
        assert_eq!(last.overlap, 0.0);
        assert!(last.error < 1e-12);
        for n in 1..30 {
            let next = corner.overlap(case.permitted * f64::from(n) * 0.2);
            assert!(next.overlap >= last.overlap, "{last:?} {next:?}");
            last = next;
        }
    }
}

#[test]
fn the_longest_overlap_is_kept() {
    let ramp = Ramp::trapezoid(0.2).unwrap();
    let corner = Corner {
        deceleration: &ramp,
        acceleration: &ramp,
        first_feedrate: 0.1,
        second_feedrate: 0.1,
        angle: 1.0,
        longest: 0.01,
    };
    assert_eq!(corner.overlap(1.0).overlap, 0.01);
    assert!(corner.overlap(f64::NAN).overlap == 0.0);
}

#[test]
fn a_short_segment_is_lowered_until_its_ramps_just_meet() {
    let mut random = Random(4);
    for _ in 0..200 {
        let (up, down) = (random_ramp(&mut random), random_ramp(&mut random));
        let (length, wanted) = (random.log_uniform(1e-6, 1.0), random.log_uniform(1e-3, 2.0));
        let feedrate = reachable_feedrate(length, &up, &down, wanted);
        assert!(feedrate > 0.0 && feedrate <= wanted);
        // Both ramps, sampled.
        let parts = 2000_u32;
        let mean = |ramp: &Ramp, f: &dyn Fn(f64) -> f64| -> f64 {
            let part = ramp.duration() / f64::from(parts);
            (0..parts).map(|n| part * f(ramp.value((f64::from(n) + 0.5) * part))).sum()
        };
        let way = feedrate * (mean(&up, &|v| v) + mean(&down, &|v| 1.0 - v));
        assert!(way <= length * (1.0 + 2e-3));
        assert!(feedrate == wanted || way >= length * (1.0 - 2e-3));
    }
    let step = Ramp::STEP;
    assert_eq!(reachable_feedrate(1e-9, &step, &step, 1.0), 1.0);
}

#[test]
fn ramps_of_ones_own_serve_as_well() {
    // Half a parabola up, and a jump to 1.
    let pieces = [
        RampPiece { duration: 0.1, coefficients: [0.0, 0.0, 50.0, 0.0] },
        RampPiece { duration: 0.05, coefficients: [1.0, 0.0, 0.0, 0.0] },
    ];
    let ramp = Ramp::from_pieces(&pieces).unwrap();
    assert!((ramp.integral(0.15) - (50.0 * 1e-3 / 3.0 + 0.05)).abs() < 1e-15);
    let corner = Corner {
        deceleration: &ramp,
        acceleration: &ramp,
        first_feedrate: 0.3,
        second_feedrate: 0.1,
        angle: 2.0,
        longest: f64::INFINITY,
    };
    let found = corner.overlap(1e-3);
    assert!((sampled_error(&corner, found.delay, 100_000) - 1e-3).abs() < 1e-5, "{found:?}");
}

/// The document's test path, by its own tangents: an arc, then four lines.
#[test]
fn the_test_path_has_the_documents_angles() {
    let pose = |x: f64, y: f64| Pose::translation(1e-3 * x, 1e-3 * y, 0.0);
    let on_arc = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        pose(180.0 + 40.0 * cos, 40.0 + 40.0 * sin)
    };
    let corners =
        [pose(140.0, 40.0), pose(275.0, 100.0), pose(410.0, 40.0), pose(360.0, 90.0), pose(270.0, 0.0)];
    let mut segments = vec![Path::arc(&on_arc(-90.0), &on_arc(-135.0), &on_arc(180.0)).unwrap()];
    segments.extend(corners.windows(2).map(|pair| Path::line(&pair[0], &pair[1])));
    let printed = [66.038, 47.925, 158.963, 90.0];
    for (pair, printed) in segments.windows(2).zip(printed) {
        let angle = angle_between(&pair[0].jet(pair[0].length()).linear[0], &pair[1].jet(0.0).linear[0]);
        assert!((angle.to_degrees() - printed).abs() < 6e-4, "{} {printed}", angle.to_degrees());
    }
}

#[test]
fn angles_are_exact_near_both_ends() {
    let at = |angle: f64| Vector3::new(angle.cos(), 0.6 * angle.sin(), 0.8 * angle.sin());
    for angle in [0.0, 1e-9, 0.3, 1.5, PI - 1e-9, PI] {
        assert!((angle_between(&at(0.0), &at(angle)) - angle).abs() < 1e-15, "{angle}");
    }
    assert_eq!(angle_between(&Vector3::zeros(), &at(1.0)), 0.0);
}
