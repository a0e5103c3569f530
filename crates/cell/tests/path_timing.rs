//! Path-true speed: random tool paths of the default arm, and paths made to go wrong.

mod common;

use common::{ArmPath, Kind, Move, Random, joint_limits, random_move};
use seamline_cell::plan::timing::{JointPath, PathLimits, Timing, TimingKind, TimingLimits, time_path};

/// Finite differences of joint positions may exceed the limits by this: velocity and acceleration by rounding only.
const DIFFERENCES: [f64; 3] = [1.0 + 1e-6, 1.0 + 1e-6, 1.01];
/// Exact derivatives at dense samples likewise.
const DENSE: f64 = 1.0 + 1e-3;

/// Highest share of each limit, over joints and the path, by exact derivatives: sixteen looks a piece, and two
/// thousand at a long cruise.
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

/// 250 random moves, 50 of them beside the wrist's and 50 beside the shoulder's singularity (1 µrad and 1 µm to 20 mrad
/// and 10 mm), 5 to 1000 mm/s: each gets an optimized or plain timing, and every joint keeps its limits by exact
/// derivatives and by differences of positions 1 ms apart.
#[test]
fn random_moves_keep_every_limit() {
    let joints = joint_limits();
    let mut random = Random(7);
    for index in 0..250 {
        let Move { kind, mut path, limits } = random_move(&mut random, Kind::of(index));
        let what = format!("move {index}, {kind:?}");
        let timing = time_path(&mut path, &joints, &limits).unwrap();
        assert_ne!(timing.kind(), TimingKind::Stretched, "{what}");
        assert_whole(&timing, path.length(), &limits, &what);
        let dense = dense_load(&mut path, &timing, &joints, &limits);
        assert!(dense.iter().all(|&share| share <= DENSE), "{what}: {dense:?}");
        let differences = difference_load(&path, &timing, &joints, 1e-3);
        for order in 0..3 {
            assert!(differences[order] <= DIFFERENCES[order], "{what}: {differences:?}");
        }
    }
}
