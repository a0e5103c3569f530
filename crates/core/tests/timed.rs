//! The timed profile and its state chart, judged by integration of constant jerk and by differences.
#![allow(clippy::panic, clippy::print_stdout, clippy::unwrap_used)] // what its tests share is test code too

mod otg_support;

use otg_support::random::Random;
use seamline::otg::{Limits, Sample};
use seamline::timed::{Activity, Command, Error, Quantity, Takeover, TimedMotion, TimedProfile};

/// Position, velocity, acceleration and jerk after a time: the seven phases one after the other, each by the definition
/// of constant jerk. Nothing comes from the code under test.
fn integrated(start: f64, way: f64, duration: f64, n: f64, time: f64) -> [f64; 4] {
    let v_max = way / (duration * (1.0 - n));
    let a_max = v_max / (duration * (n - n * n));
    let j_max = a_max / (duration * n * n);
    let (jerk_phase, hold) = (n * n * duration, (n - 2.0 * n * n) * duration);
    let phases = [
        (jerk_phase, 1.0),
        (hold, 0.0),
        (jerk_phase, -1.0),
        ((1.0 - 2.0 * n) * duration, 0.0),
        (jerk_phase, -1.0),
        (hold, 0.0),
        (jerk_phase, 1.0),
    ];
    let (mut p, mut v, mut a, mut left) = (start, 0.0, 0.0, time);
    for (length, sign) in phases {
        let (t, j) = (length.min(left), sign * j_max);
        p += v * t + a * t * t / 2.0 + j * t * t * t / 6.0;
        v += a * t + j * t * t / 2.0;
        a += j * t;
        left -= length;
        if left < 0.0 {
            return [p, v, a, j];
        }
    }
    [p, v, a, 0.0]
}

fn profile(random: &mut Random) -> (f64, f64, f64, f64) {
    let start = random.sign() * random.log_uniform(1e-3, 1e3);
    let way = random.sign() * random.log_uniform(1e-3, 1e3);
    let n = if random.chance(0.1) { 0.5 } else { random.uniform(0.01, 0.5) };
    (start, start + way, random.log_uniform(1e-2, 1e3), n)
}

#[test]
fn the_papers_example() {
    let profile = TimedProfile::new([0.0], [100.0], 3.0, 1.0 / 3.0).unwrap();
    let near = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-12 * expected, "{value}");
    near(profile.velocity()[0], 50.0);
    near(profile.acceleration()[0], 75.0);
    near(profile.jerk()[0], 225.0);
    let expected = [1.0 / 3.0, 2.0 / 3.0, 1.0, 2.0, 7.0 / 3.0, 8.0 / 3.0, 3.0];
    for (time, expected) in profile.switch_times().into_iter().zip(expected) {
        near(time, expected);
    }
    near(profile.at_time(1.5).position[0], 50.0);
    near(profile.at_time(1.5).velocity[0], 50.0);
    near(profile.at_time(0.5).acceleration[0], 75.0);
}

#[test]
fn profiles_agree_with_the_integrated_jerk() {
    let mut random = Random(2);
    for case in 0..2_000 {
        let (start, target, duration, n) = profile(&mut random);
        let profile = TimedProfile::new([start], [target], duration, n).unwrap();
        let (v, a, j) =
            (profile.velocity()[0].abs(), profile.acceleration()[0].abs(), profile.jerk()[0].abs());
        for step in 0..=50 {
            let time = duration * (f64::from(step) + 0.01 * random.unit()) / 50.5;
            let sample = profile.at_time(time);
            let [p, velocity, acceleration, jerk] = integrated(start, target - start, duration, n, time);
            let off = |value: f64, expected: f64, scale: f64| {
                assert!(
                    (value - expected).abs() <= 1e-11 * scale,
                    "case {case}: {value}, {expected} at {time}"
                );
            };
            off(sample.position[0], p, start.abs() + (target - start).abs());
            off(sample.velocity[0], velocity, v);
            off(sample.acceleration[0], acceleration, a);
            off(sample.jerk[0], jerk, j);
        }
    }
}

#[test]
fn profiles_start_and_end_exactly() {
    let mut random = Random(3);
    for _ in 0..2_000 {
        let (start, target, duration, n) = profile(&mut random);
        let profile = TimedProfile::new([start], [target], duration, n).unwrap();
        for time in [-1.0, 0.0, f64::NAN] {
            let Sample { position, velocity, acceleration, .. } = profile.at_time(time);
            assert_eq!([position, velocity, acceleration], [[start], [0.0], [0.0]]);
        }
        for time in [duration, 2.0 * duration, f64::INFINITY] {
            let Sample { position, velocity, acceleration, jerk } = profile.at_time(time);
            assert_eq!([position, velocity, acceleration, jerk], [[target], [0.0], [0.0], [0.0]]);
        }
    }
}

#[test]
fn a_profile_of_three_axes_is_a_straight_line() {
    let (start, target) = ([1.0, -2.0, 0.5], [4.0, 2.0, 0.5]);
    let profile = TimedProfile::new(start, target, 2.0, 0.2).unwrap();
    for step in 0..=100 {
        let p = profile.at_time(0.02 * f64::from(step)).position;
        let share = (p[0] - start[0]) / 3.0;
        assert!((p[1] - (start[1] + 4.0 * share)).abs() < 1e-14);
        assert_eq!(p[2], 0.5);
    }
}

#[test]
fn bad_input_is_a_named_error() {
    let new = |start, target, duration, n| TimedProfile::new([0.0, start], [1.0, target], duration, n).err();
    for value in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(new(0.0, 1.0, value, 0.3), Some(Error::BadDuration { value }));
    }
    for value in [0.0, -0.1, 0.500_001, f64::INFINITY] {
        assert_eq!(new(0.0, 1.0, 1.0, value), Some(Error::BadTimeScale { value }));
    }
    assert!(matches!(new(0.0, 1.0, f64::NAN, 0.3), Some(Error::BadDuration { .. })));
    assert!(matches!(new(0.0, 1.0, 1.0, f64::NAN), Some(Error::BadTimeScale { .. })));
    let infinite = |quantity| Some(Error::NotFinite { axis: 1, quantity, value: f64::INFINITY });
    assert_eq!(new(f64::INFINITY, 1.0, 1.0, 0.3), infinite(Quantity::Start));
    assert_eq!(new(0.0, f64::INFINITY, 1.0, 0.3), infinite(Quantity::Target));
    assert_eq!(new(-1e308, 1e308, 1.0, 0.3), Some(Error::OutOfRange { axis: 1 }));
    assert_eq!(new(0.0, 1.0, 1e-110, 0.3), Some(Error::OutOfRange { axis: 0 }));
    assert!(new(0.0, 1.0, 1.0, 0.5).is_none());
    let texts = [
        (
            Error::BadTimeScale { value: 0.7 },
            "the time-scale factor n is 0.7, expected a number above 0, at most 0.5",
        ),
        (
            Error::BadDuration { value: -1.0 },
            "a duration of -1 s was asked for, expected a positive finite one",
        ),
    ];
    for (error, text) in texts {
        assert_eq!(error.to_string(), text);
    }
}

#[test]
fn a_refused_target_leaves_the_motion_alone() {
    let mut motion = TimedMotion::new([0.0], Takeover::Continuous).unwrap();
    let good = Command { target: [1.0], duration: 1.0, n: 0.3 };
    motion.set_target(0.0, &good).unwrap();
    let before = motion.at(0.4);
    for bad in [
        Command { target: [f64::NAN], ..good },
        Command { duration: 0.0, ..good },
        Command { n: 0.6, ..good },
        Command { target: [1e308], duration: 1e-3, ..good },
    ] {
        assert!(motion.set_target(0.4, &bad).is_err(), "{bad:?}");
        assert_eq!(motion.at(0.4), before);
    }
    let error = motion.set_target(f64::INFINITY, &good).unwrap_err();
    assert_eq!(error, Error::BadInstant { value: f64::INFINITY });
    assert_eq!(motion.at(1.0).position, [1.0]);
    assert!(TimedMotion::new([f64::NAN], Takeover::Continuous).is_err());
}

/// Walks a motion through every pair of activity and event, as a user meets them.
#[test]
fn every_activity_meets_every_event() {
    for takeover in [Takeover::Continuous, Takeover::RestartFromRest] {
        let to = |target| Command { target: [target], duration: 2.0, n: 0.25 };
        let mut motion = TimedMotion::new([3.0], takeover).unwrap();
        // Start, and nothing comes: the first position is held.
        assert_eq!((motion.at(50.0).position, motion.activity()), ([3.0], Activity::Start));
        // Start, a target.
        motion.set_target(100.0, &to(5.0)).unwrap();
        assert_eq!(motion.activity(), Activity::Moving);
        assert_eq!(motion.at(101.0).position, [4.0]);
        // Moving, a target.
        motion.set_target(101.0, &to(1.0)).unwrap();
        assert_eq!(motion.activity(), Activity::Moving);
        // Moving, arrived.
        assert_eq!((motion.at(103.01).position, motion.activity()), ([1.0], Activity::Holding));
        // Holding, and nothing comes, for ever.
        assert_eq!((motion.at(f64::INFINITY).position, motion.activity()), ([1.0], Activity::Holding));
        // Holding, a target.
        let planned = motion.set_target(1e6, &to(2.0)).unwrap();
        assert_eq!((motion.activity(), planned.velocity_jump), (Activity::Moving, [0.0]));
        assert_eq!((motion.at(1e6 + 2.0).position, motion.activity()), ([2.0], Activity::Holding));
    }
}

#[test]
fn restart_from_rest_reports_its_jump() {
    let mut motion = TimedMotion::new([0.0, 1.0], Takeover::RestartFromRest).unwrap();
    motion.set_target(0.0, &Command { target: [100.0, 1.0], duration: 3.0, n: 1.0 / 3.0 }).unwrap();
    let before = motion.at(0.5);
    let planned = motion.set_target(0.5, &Command { target: [40.0, 2.0], duration: 2.0, n: 0.25 }).unwrap();
    // v = 75 (0.5 − 1/6), a = 75.
    assert!((planned.velocity_jump[0] + 25.0).abs() < 1e-12);
    assert!((planned.acceleration_jump[0] + 75.0).abs() < 1e-12);
    assert_eq!([planned.velocity_jump[1], planned.acceleration_jump[1]], [0.0, 0.0]);
    let after = motion.at(0.5);
    assert_eq!((after.position, after.velocity, after.acceleration), (before.position, [0.0; 2], [0.0; 2]));
    for step in 0..=20 {
        let time = 0.1 * f64::from(step);
        let p = integrated(before.position[0], 40.0 - before.position[0], 2.0, 0.25, time)[0];
        assert!((motion.at(0.5 + time).position[0] - p).abs() < 1e-12);
    }
}

/// The worst of a motion seen cycle by cycle, as fractions of its limits: what position, velocity and acceleration
/// change by in one cycle, over what the limits permit; the same of the values themselves.
#[derive(Default)]
struct Seen {
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

impl Seen {
    fn step<const N: usize>(&mut self, one: &Sample<N>, next: &Sample<N>, limits: &Limits<N>, period: f64) {
        let worst = |seen: &mut f64, change: f64, limit: f64, rounding: f64| {
            // An axis without limits does not move at all.
            let share = if change.abs() <= rounding { 0.0 } else { (change.abs() - rounding) / limit };
            assert!(share.is_finite());
            *seen = seen.max(share);
        };
        for axis in 0..N {
            let (v, a, j) = (limits.velocity_max[axis], limits.acceleration_max[axis], limits.jerk_max[axis]);
            let size = one.position[axis].abs() + next.position[axis].abs();
            let change = |of: fn(&Sample<N>) -> &[f64; N]| of(next)[axis] - of(one)[axis];
            worst(
                &mut self.velocity,
                change(|s| &s.position) / period,
                v,
                4.0 * f64::EPSILON * size / period,
            );
            worst(&mut self.velocity, next.velocity[axis], v, 0.0);
            worst(
                &mut self.acceleration,
                change(|s| &s.velocity) / period,
                a,
                4.0 * f64::EPSILON * v / period,
            );
            worst(&mut self.acceleration, next.acceleration[axis], a, 0.0);
            worst(&mut self.jerk, change(|s| &s.acceleration) / period, j, 4.0 * f64::EPSILON * a / period);
        }
    }
}

fn command<const N: usize>(random: &mut Random, from: &[f64; N]) -> Command<N> {
    let size = random.log_uniform(1e-3, 10.0);
    let target = from.map(|p| if random.chance(0.2) { p } else { p + random.normal(size) });
    let n = if random.chance(0.1) { 0.5 } else { random.uniform(0.02, 0.5) };
    Command { target, duration: random.log_uniform(0.1, 10.0), n }
}

/// New targets at random instants, most of them in motion. Between two targets the motion is looked at 200 times.
fn follow_random_targets<const N: usize>(seed: u64, targets: usize) {
    const LOOKS: u32 = 200;
    let mut random = Random(seed);
    let mut motion = TimedMotion::new([0.0; N], Takeover::Continuous).unwrap();
    let (mut now, mut seen, mut in_motion) = (0.0, Seen::default(), 0);
    let mut latest = 0.0_f64;
    for case in 0..targets {
        let before = motion.at(now);
        in_motion += usize::from(before.velocity.iter().any(|&v| v != 0.0));
        let command = command(&mut random, &before.position);
        let planned = motion.set_target(now, &command).unwrap_or_else(|error| panic!("case {case}: {error}"));
        let taken = motion.at(now);
        assert_eq!(taken.position, before.position, "case {case}");
        let Limits { velocity_max, acceleration_max, .. } = &planned.limits;
        for axis in 0..N {
            for (one, other, limit) in [
                (taken.velocity[axis], before.velocity[axis], velocity_max[axis]),
                (taken.acceleration[axis], before.acceleration[axis], acceleration_max[axis]),
            ] {
                assert!((one - other).abs() <= 1e-12 * limit, "case {case}: {other} becomes {one}");
            }
        }
        latest = latest.max((planned.duration - command.duration).abs() / command.duration);
        let to_the_end = random.chance(0.2);
        let way = if to_the_end { 1.0 + 1e-9 } else { random.uniform(0.01, 1.0) };
        let period = planned.duration * way / f64::from(LOOKS);
        let (start, mut last) = (now, before);
        for look in 1..=LOOKS {
            let instant = start + f64::from(look) * period;
            let next = motion.at(instant);
            // The clock rounds; its own difference is exact.
            seen.step(&last, &next, &planned.limits, instant - now);
            (now, last) = (instant, next);
        }
        if to_the_end {
            let expected = Sample {
                position: command.target,
                velocity: [0.0; N],
                acceleration: [0.0; N],
                jerk: [0.0; N],
            };
            assert_eq!((last, motion.activity()), (expected, Activity::Holding), "case {case}");
        }
        // One clock for long would cost the digits that the differences need.
        if now > 100.0 && to_the_end {
            (now, motion) = (0.0, TimedMotion::new(last.position, Takeover::Continuous).unwrap());
        }
    }
    let Seen { velocity, acceleration, jerk } = seen;
    println!("{N} axes: {velocity}, {acceleration}, {jerk} of the limits, duration off by {latest}");
    assert!(in_motion > targets / 2);
    for (of, share) in [("velocity", velocity), ("acceleration", acceleration), ("jerk", jerk)] {
        assert!(share <= 1.0 + 1e-12, "{of}: {share} of the limit");
    }
    assert!(latest <= 1e-12, "{latest}");
}

#[test]
fn continuous_motion_keeps_its_limits_and_its_time() {
    follow_random_targets::<1>(4, 20_000);
    follow_random_targets::<3>(5, 5_000);
}

/// Fifteen times as many, and six axes.
#[test]
#[ignore = "half a minute"]
fn continuous_motion_keeps_its_limits_and_its_time_for_long() {
    follow_random_targets::<1>(6, 300_000);
    follow_random_targets::<6>(7, 100_000);
}

/// The example with a new target: the figures of the takeover by hand. At 1.2 s the axis is at 35 mm with 50 mm/s, and
/// its own ramp would take it 25 mm on; so |V′| = 20 / 2 and V = 10 + 50.
#[test]
fn the_limits_of_the_example() {
    let mut motion = TimedMotion::new([0.0], Takeover::Continuous).unwrap();
    motion.set_target(0.0, &Command { target: [100.0], duration: 3.0, n: 1.0 / 3.0 }).unwrap();
    let Limits { velocity_max, acceleration_max, jerk_max, .. } =
        motion.set_target(1.2, &Command { target: [40.0], duration: 3.0, n: 1.0 / 3.0 }).unwrap().limits;
    for (value, expected) in [(velocity_max[0], 60.0), (acceleration_max[0], 90.0), (jerk_max[0], 270.0)] {
        assert!((value - expected).abs() < 1e-11 * expected, "{value}");
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let follow = |unit: f64| {
        let mut motion = TimedMotion::new([0.0, 0.0], Takeover::Continuous).unwrap();
        let to = |x: f64, y: f64| Command { target: [x * unit, y * unit], duration: 2.0, n: 0.3 };
        motion.set_target(0.0, &to(0.1, -0.2)).unwrap();
        let _ = motion.set_target(0.7, &to(-0.1, 0.3)).unwrap();
        (0..=200)
            .map(|step| motion.at(0.7 + 0.01 * f64::from(step)).position.map(|p| p / unit))
            .collect::<Vec<_>>()
    };
    for (metres, other) in follow(1.0).into_iter().zip(follow(1e3)) {
        for axis in 0..2 {
            assert!((metres[axis] - other[axis]).abs() < 1e-12, "{metres:?} {other:?}");
        }
    }
}
