//! Path-true speed: random tool paths of the default arm, and paths made to go wrong.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]

mod common;

use std::collections::HashMap;

use common::planar::Planar;
use common::{ArmPath, Kind, Move, REFERENCE_SEED, Random, joint_limits, random_move, time_alone};
use seamline::kinematics::JointJet;
use seamline_cell::plan::timing::{
    JointPath, Order, PathLimits, Timing, TimingError, TimingKind, TimingLimits,
};

/// Finite differences of joint positions may exceed the limits by this: velocity and acceleration by rounding
/// only.
const DIFFERENCES: [f64; 3] = [1.0 + 1e-6, 1.0 + 1e-6, 1.01];
/// Exact derivatives at dense samples likewise.
const DENSE: f64 = 1.0 + 1e-3;

/// Highest share of each limit, over joints and the path, by exact derivatives: sixteen looks a piece, and
/// two thousand at a long cruise.
fn dense_load<const N: usize, P: JointPath<N>>(
    path: &mut P,
    timing: &Timing,
    joints: &TimingLimits<N>,
    limits: &PathLimits,
) -> [f64; 3]
where
    P::Error: core::fmt::Debug,
{
    let mut most = [0.0f64; 3];
    for piece in timing.pieces() {
        let looks = if piece.duration > 0.1 { 2000 } else { 16 };
        for look in 0..=looks {
            let state = piece.at(piece.duration * f64::from(look) / f64::from(looks));
            let jet = path.jet(state.position.clamp(0.0, path.length())).unwrap();
            let (v, a, j) = (state.velocity, state.acceleration, state.jerk);
            for i in 0..N {
                let (d1, d2, d3) = (jet.velocity[i], jet.acceleration[i], jet.jerk[i]);
                most[0] = most[0].max((d1 * v).abs() / joints.velocity[i]);
                most[1] = most[1].max((d2 * v * v + d1 * a).abs() / joints.acceleration[i]);
                let jerk = d3 * v * v * v + 3.0 * d2 * v * a + d1 * j;
                most[2] = most[2].max(jerk.abs() / joints.jerk[i]);
            }
            most[0] = most[0].max(v / limits.speed);
            most[1] = most[1].max(a.abs() / limits.acceleration);
            most[2] = most[2].max(j.abs() / limits.jerk);
        }
    }
    most
}

/// Highest share of each joint limit by differences of joint positions at even times, which know nothing of
/// derivatives. Long cruises are sampled at their ends.
fn difference_load(path: &ArmPath, timing: &Timing, joints: &TimingLimits<6>, period: f64) -> [f64; 3] {
    let mut most = [0.0f64; 3];
    let mut window: Vec<[f64; 6]> = Vec::new();
    let last = (timing.duration() / period).ceil() as usize + 3;
    let mut index = 0;
    let mut cruises = timing.pieces().iter().scan(0.0, |start, piece| {
        *start += piece.duration;
        Some((*start - piece.duration, *start, piece))
    });
    let mut cruise = cruises.find(|(_, _, piece)| piece.duration > 0.2);
    while index <= last {
        let time = index as f64 * period;
        if let Some((from, to, _)) = cruise
            && time > from + 0.05
        {
            index = ((to - 0.05) / period) as usize;
            window.clear();
            cruise = cruises.find(|(_, _, piece)| piece.duration > 0.2);
            continue;
        }
        window.push(path.joints(timing.at(time).position).unwrap());
        index += 1;
        if window.len() < 4 {
            continue;
        }
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| window[window.len() - 4 + i]);
        for i in 0..6 {
            let velocity = (d[i] - c[i]) / period;
            let acceleration = (d[i] - 2.0 * c[i] + b[i]) / (period * period);
            let jerk = (d[i] - 3.0 * c[i] + 3.0 * b[i] - a[i]) / (period * period * period);
            most[0] = most[0].max(velocity.abs() / joints.velocity[i]);
            most[1] = most[1].max(acceleration.abs() / joints.acceleration[i]);
            most[2] = most[2].max(jerk.abs() / joints.jerk[i]);
        }
    }
    most
}

/// Continuity of position, velocity and acceleration; rest at both ends; never backwards.
fn assert_whole(timing: &Timing, length: f64, limits: &PathLimits, what: &str) {
    let mut state = timing.at(0.0);
    assert!(state.position == 0.0 && state.velocity == 0.0 && state.acceleration == 0.0, "{what}");
    for piece in timing.pieces() {
        let start = piece.at(0.0);
        assert!((start.position - state.position).abs() <= 1e-12 * length, "{what}");
        assert!((start.velocity - state.velocity).abs() <= 1e-9 * limits.speed, "{what}");
        assert!((start.acceleration - state.acceleration).abs() <= 1e-6 * limits.acceleration, "{what}");
        for look in 1..8 {
            let velocity = piece.at(piece.duration * f64::from(look) / 8.0).velocity;
            assert!(velocity > -1e-12 * limits.speed, "{what}: backwards at {velocity}");
        }
        state = piece.end();
    }
    assert!((state.position - length).abs() <= 1e-12 * length, "{what}");
    assert!(state.velocity.abs() <= 1e-9 * limits.speed, "{what}");
    let pieces: f64 = timing.pieces().iter().map(|piece| piece.duration).sum();
    assert!((pieces - timing.duration()).abs() <= 1e-12 * pieces, "{what}");
}

/// 250 random moves, 50 of them beside the wrist's and 50 beside the shoulder's singularity (1 µrad and 1 µm
/// to 20 mrad and 10 mm), 5 to 1000 mm/s: each gets an optimized or plain timing, and every joint keeps its
/// limits by exact derivatives and by differences of positions 1 ms apart, here those that leave room, as jobs are
/// planned. Against TOPP-RA at the full limits, which needs no time to build up acceleration where we need 20 ms, the
/// motions take 1.02 times as long (median), 1.06 (95
/// %), 1.15 (greatest) or less.
#[test]
fn random_moves_keep_every_limit_and_lose_little_time() {
    let joints = joint_limits();
    let reference: HashMap<usize, f64> = include_str!("data/path_timing_toppra.csv")
        .lines()
        .filter_map(|line| line.split_once(','))
        .filter_map(|(index, seconds)| Some((index.parse().ok()?, seconds.parse().ok()?)))
        .collect();
    let mut ratios = Vec::new();
    let mut random = Random(REFERENCE_SEED);
    for index in 0..250 {
        let Move { kind, mut path, limits } = random_move(&mut random, Kind::of(index));
        let what = format!("move {index}, {kind:?}");
        let (joints, limits) = (joints.with_room(), limits.with_room());
        let timing = time_alone(&mut path, &joints, &limits).unwrap();
        assert_ne!(timing.kind(), TimingKind::Stretched, "{what}");
        assert_whole(&timing, path.length(), &limits, &what);
        let dense = dense_load(&mut path, &timing, &joints, &limits);
        assert!(dense.iter().all(|&share| share <= DENSE), "{what}: {dense:?}");
        let differences = difference_load(&path, &timing, &joints, 1e-3);
        for order in 0..3 {
            assert!(differences[order] <= DIFFERENCES[order], "{what}: {differences:?}");
        }
        ratios.extend(reference.get(&index).map(|seconds| timing.duration() / seconds));
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios.len() >= 240);
    let [median, most, greatest] =
        [ratios.len() / 2, ratios.len() * 95 / 100, ratios.len() - 1].map(|i| ratios[i]);
    assert!(median <= 1.02 && most <= 1.06 && greatest <= 1.15, "{median} {most} {greatest}");
}

/// The same for 25 moves each with weak drives, slow build-up of acceleration, ten times the programmed
/// speed, slow joints and a gentle path.
#[test]
fn other_limits_are_kept_too() {
    let scales = [
        ("weak", [1.0, 0.4, 0.4], [1.0, 1.0]),
        ("soft", [1.0, 1.0, 0.1], [1.0, 1.0]),
        ("fast", [1.0, 1.0, 1.0], [10.0, 1.0]),
        ("slow", [0.1, 0.1, 0.1], [1.0, 1.0]),
        ("gentle", [1.0, 1.0, 1.0], [1.0, 0.05]),
    ];
    for (name, [v, a, j], [speed, rise]) in scales {
        let mut joints = joint_limits();
        joints.velocity = joints.velocity.map(|x| x * v);
        joints.acceleration = joints.acceleration.map(|x| x * a);
        joints.jerk = joints.jerk.map(|x| x * j);
        let mut random = Random(11);
        for index in 0..25 {
            let Move { kind, mut path, mut limits } = random_move(&mut random, Kind::of(index));
            limits.speed *= speed;
            limits.acceleration *= rise;
            limits.jerk *= rise;
            let what = format!("{name} move {index}, {kind:?}");
            let timing = time_alone(&mut path, &joints, &limits).unwrap();
            assert_ne!(timing.kind(), TimingKind::Stretched, "{what}");
            assert_whole(&timing, path.length(), &limits, &what);
            let dense = dense_load(&mut path, &timing, &joints, &limits);
            assert!(dense.iter().all(|&share| share <= DENSE), "{what}: {dense:?}");
        }
    }
}

/// 20 moves that pass a singularity at 10 nrad to 1 µrad, or 10 nm to 1 µm.
#[test]
fn the_closest_passes_are_timed() {
    let joints = joint_limits();
    let mut random = Random(5);
    for index in 0..20 {
        let Move { kind, mut path, limits } = random_move(&mut random, Kind::needle(index));
        let what = format!("move {index}, {kind:?}");
        let timing = time_alone(&mut path, &joints, &limits).unwrap();
        assert_eq!(timing.kind(), TimingKind::Optimized, "{what}");
        let dense = dense_load(&mut path, &timing, &joints, &limits);
        assert!(dense.iter().all(|&share| share <= DENSE), "{what}: {dense:?}");
    }
}

const STRONG: TimingLimits<2> =
    TimingLimits { velocity: [3.0, 4.0], acceleration: [20.0, 25.0], jerk: [1000.0, 1250.0] };
const GENTLE: PathLimits = PathLimits { speed: 0.1, acceleration: 2.0, jerk: 50.0 };

/// A line of 0.8 m that passes the shoulder axis at a distance.
fn passing(distance: f64) -> Planar {
    Planar { links: [0.5, 0.45], start: [-0.4, 0.05 + distance], direction: [1.0, 0.0], length: 0.8 }
}

#[test]
fn where_the_joints_can_follow_it_is_the_plain_s_curve() {
    let timing = time_alone(&mut passing(0.4), &STRONG, &GENTLE).unwrap();
    let PathLimits { speed, acceleration, jerk } = GENTLE;
    assert_eq!(timing.kind(), TimingKind::Plain);
    assert!(timing.slowdowns().is_empty());
    let wanted = 0.8 / speed + speed / acceleration + acceleration / jerk;
    assert!((timing.duration() - wanted).abs() < 1e-12 * wanted);
    assert_eq!(timing.at(wanted / 2.0).velocity, speed);
}

/// Beside the axis the motion slows down once, and only there: within 0.13 m of the tightest place.
/// Everywhere else between the ramps it runs at the programmed speed.
#[test]
fn the_programmed_speed_is_held_outside_slowdowns() {
    let mut path = passing(0.0005);
    let limits = PathLimits { speed: 0.5, acceleration: 10.0, jerk: 500.0 };
    let timing = time_alone(&mut path, &STRONG, &limits).unwrap();
    assert_eq!(timing.kind(), TimingKind::Optimized);
    let [slowdown] = timing.slowdowns() else { panic!("{:?}", timing.slowdowns()) };
    let sustainable = |s: f64| {
        let jet = path.clone().jet(s).unwrap();
        let joint = |i: usize| {
            let velocity = STRONG.velocity[i] / jet.velocity[i].abs();
            let acceleration = (STRONG.acceleration[i] / jet.acceleration[i].abs()).sqrt();
            let jerk = (STRONG.jerk[i] / jet.jerk[i].abs()).cbrt();
            velocity.min(acceleration).min(jerk)
        };
        joint(0).min(joint(1))
    };
    let places = (0..=80_000).map(|i| f64::from(i) * 1e-5).map(|s| (s, sustainable(s)));
    let tightest = places.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert!((slowdown.sustainable / tightest.1 - 1.0).abs() < 0.02, "{slowdown:?} {tightest:?}");
    assert!((slowdown.place - tightest.0).abs() < 0.1);
    assert!(slowdown.from < slowdown.place && slowdown.place < slowdown.to);
    assert!(tightest.0 - slowdown.from < 0.1 && slowdown.to - tightest.0 < 0.13, "{slowdown:?}");
    let (mut held, mut steps) = (0, 0);
    while f64::from(steps) * 1e-3 < timing.duration() {
        let state = timing.at(f64::from(steps) * 1e-3);
        steps += 1;
        let ramp = 0.5 / 2.0 * (0.5 / limits.acceleration + limits.acceleration / limits.jerk);
        let between = state.position > ramp && state.position < 0.8 - ramp;
        if between && !(slowdown.from..=slowdown.to).contains(&state.position) {
            assert!((state.velocity / 0.5 - 1.0).abs() <= 0.01, "{state:?}");
            held += 1;
        }
    }
    assert!(held > 500);
}

/// A path in another unit, or run the other way.
struct Changed<P> {
    path: P,
    unit: f64,
    reversed: bool,
}

impl<P: JointPath<N>, const N: usize> JointPath<N> for Changed<P> {
    type Error = P::Error;

    fn length(&self) -> f64 {
        self.path.length() * self.unit
    }

    fn jet(&mut self, s: f64) -> Result<JointJet<N>, P::Error> {
        let sign = if self.reversed { -1.0 } else { 1.0 };
        let place = if self.reversed { self.length() - s } else { s } / self.unit;
        let jet = self.path.jet(place)?;
        let k = sign / self.unit;
        Ok(JointJet {
            position: jet.position,
            velocity: jet.velocity.map(|d| d * k),
            acceleration: jet.acceleration.map(|d| d * k * k),
            jerk: jet.jerk.map(|d| d * k * k * k),
        })
    }
}

/// Ten moves, in millimetres and run backwards: the unit changes nothing, the direction next to nothing.
#[test]
fn neither_unit_nor_direction_matters() {
    let joints = joint_limits();
    let mut random = Random(3);
    for index in 0..10 {
        let Move { kind, mut path, limits } = random_move(&mut random, Kind::of(index));
        let wanted = time_alone(&mut path, &joints, &limits).unwrap().duration();
        let mut in_mm = Changed { path: path.clone(), unit: 1000.0, reversed: false };
        let PathLimits { speed, acceleration, jerk } = limits;
        let limits_mm = PathLimits { speed: 1e3 * speed, acceleration: 1e3 * acceleration, jerk: 1e3 * jerk };
        let found = time_alone(&mut in_mm, &joints, &limits_mm).unwrap().duration();
        assert!((found / wanted - 1.0).abs() < 1e-5, "{index} {kind:?}: {found} {wanted}");
        let mut back = Changed { path, unit: 1.0, reversed: true };
        let found = time_alone(&mut back, &joints, &limits).unwrap().duration();
        assert!((found / wanted - 1.0).abs() < 2e-3, "{index} {kind:?}: {found} {wanted}");
    }
}

/// One joint that is given by its derivatives.
struct Single<F>(f64, F);

impl<F: Fn(f64) -> [f64; 4]> JointPath<1> for Single<F> {
    type Error = ();

    fn length(&self) -> f64 {
        self.0
    }

    fn jet(&mut self, s: f64) -> Result<JointJet<1>, ()> {
        let [position, velocity, acceleration, jerk] = (self.1)(s).map(|x| [x]);
        Ok(JointJet { position, velocity, acceleration, jerk })
    }
}

const ONE: TimingLimits<1> = TimingLimits { velocity: [2.0], acceleration: [10.0], jerk: [500.0] };

/// From a micrometre, where the whole motion takes 4 ms, to a metre and a half with a cruise.
#[test]
fn a_joint_alone_gets_its_own_s_curve() {
    for length in [1e-6, 1e-4, 1e-2, 0.05, 0.4, 1.5] {
        let wide = PathLimits { speed: 20.0, acceleration: 1e3, jerk: 1e6 };
        let own = PathLimits { speed: 2.0, acceleration: 10.0, jerk: 500.0 };
        let mut path = Single(length, |s| [s, 1.0, 0.0, 0.0]);
        let found = time_alone(&mut path, &ONE, &wide).unwrap();
        let best = time_alone(&mut Single(length, |_| [0.0; 4]), &ONE, &own).unwrap();
        assert_eq!((found.kind(), best.kind()), (TimingKind::Optimized, TimingKind::Plain));
        let ratio = found.duration() / best.duration();
        assert!((1.0..1.012).contains(&ratio), "{length}: {ratio}");
    }
}

#[test]
fn what_has_no_timing_is_refused() {
    let limits = PathLimits { speed: 1.0, acceleration: 10.0, jerk: 500.0 };
    let straight = |s: f64| [s, 1.0, 0.0, 0.0];
    let refused = |path: &mut dyn FnMut() -> Result<Timing, TimingError<()>>| path().unwrap_err();
    let nothing = time_alone(&mut Single(0.0, straight), &ONE, &limits).unwrap();
    assert_eq!((nothing.duration(), nothing.pieces().len()), (0.0, 0));
    let error = refused(&mut || time_alone(&mut Single(f64::NAN, straight), &ONE, &limits));
    assert!(matches!(error, TimingError::Length(_)));
    let error =
        refused(&mut || time_alone(&mut Single(1.0, straight), &ONE, &PathLimits { jerk: 0.0, ..limits }));
    assert_eq!(error, TimingError::PathLimit { order: Order::Jerk, value: 0.0 });
    let error = refused(&mut || {
        time_alone(&mut Single(1.0, straight), &TimingLimits { velocity: [-1.0], ..ONE }, &limits)
    });
    assert_eq!(error, TimingError::JointLimit { joint: 0, order: Order::Velocity, value: -1.0 });
    let out_of_reach = time_alone(&mut Planar { length: 2.0, ..passing(0.4) }, &STRONG, &GENTLE);
    assert!(matches!(out_of_reach, Err(TimingError::Path { position, .. }) if position > 0.8));
}

/// A joint whose position, velocity or acceleration jumps along the path cannot follow it at any speed,
/// however small the joint's load is on either side.
#[test]
fn jumps_are_refused_where_they_are() {
    let limits = PathLimits { speed: 0.5, acceleration: 10.0, jerk: 500.0 };
    let at = 0.612_345;
    let jumps: [fn(f64) -> [f64; 4]; 3] = [
        |s| [if s < 0.612_345 { s } else { s + 1e-3 }, 1.0, 0.0, 0.0],
        |s| if s < 0.612_345 { [s, 1.0, 0.0, 0.0] } else { [1.01 * s - 0.006_123_45, 1.01, 0.0, 0.0] },
        |s| {
            let past = (s - 0.612_345).max(0.0);
            [s + past * past / 2.0, 1.0 + past, if past > 0.0 { 1.0 } else { 0.0 }, 0.0]
        },
    ];
    for (which, jump) in jumps.into_iter().enumerate() {
        let found = time_alone(&mut Single(1.0, jump), &ONE, &limits);
        let Err(TimingError::Discontinuous { position, joint: 0 }) = found else {
            panic!("jump {which}: {:?}", found.map(|timing| timing.duration()))
        };
        assert!((position - at).abs() < 1e-6, "jump {which}: {position}");
    }
}
