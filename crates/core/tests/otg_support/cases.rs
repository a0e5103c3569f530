//! Random problems from the distributions that the generator is held against.

use super::random::Random;
use seamline::otg::{Input, Limits, State};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distribution {
    /// The peer's own test: positions N(0, 4), velocities and accelerations N(0, 0.8) with zeros, limits U(0.1, 12) above the target's.
    PeerTest,
    /// Joints of a robot in rad.
    Robot,
    /// Cartesian axes in mm.
    Millimetres,
    /// Every limit from 1e-3 to 1e4.
    LogUniform,
    /// Moves of 1e-10 to 1e-2.
    Tiny,
    /// Starts outside the limits.
    Brake,
    /// Small whole numbers: many ties and zeros.
    Whole,
    /// Limits of 10 to 1e6.
    HighLimits,
    /// Current and target acceleration of the same sign: isolated intervals of possible durations.
    Islands,
}

pub const ALL: [Distribution; 9] = [
    Distribution::PeerTest,
    Distribution::Robot,
    Distribution::Millimetres,
    Distribution::LogUniform,
    Distribution::Tiny,
    Distribution::Brake,
    Distribution::Whole,
    Distribution::HighLimits,
    Distribution::Islands,
];

/// One axis of a problem.
#[derive(Debug, Clone, Copy, Default)]
struct Scalar {
    p0: f64,
    v0: f64,
    a0: f64,
    pf: f64,
    vf: f64,
    af: f64,
    v_max: f64,
    v_min: f64,
    a_max: f64,
    a_min: f64,
    jerk: f64,
}

/// A random problem; the target is always one that the limits allow.
pub fn random_input<const N: usize>(random: &mut Random, distribution: Distribution) -> Input<N> {
    let asymmetric = random.chance(0.5);
    let mut state = [State::at_rest([0.0; N]); 2];
    let zero = [0.0; N];
    let mut limits = Limits::symmetric(zero, zero, zero);
    for axis in 0..N {
        let s = scalar(random, distribution, asymmetric);
        state[0].position[axis] = s.p0;
        state[0].velocity[axis] = s.v0;
        state[0].acceleration[axis] = s.a0;
        state[1].position[axis] = s.pf;
        state[1].velocity[axis] = s.vf;
        state[1].acceleration[axis] = s.af;
        limits.velocity_max[axis] = s.v_max;
        limits.velocity_min[axis] = s.v_min;
        limits.acceleration_max[axis] = s.a_max;
        limits.acceleration_min[axis] = s.a_min;
        limits.jerk_max[axis] = s.jerk;
    }
    Input::new(state[0], state[1], limits)
}

fn scalar(random: &mut Random, distribution: Distribution, asymmetric: bool) -> Scalar {
    use Distribution::*;
    let mut s = Scalar::default();
    let some = |random: &mut Random, sigma: f64| if random.chance(0.7) { random.normal(sigma) } else { 0.0 };
    match distribution {
        PeerTest => {
            (s.p0, s.pf) = (random.normal(4.0), random.normal(4.0));
            (s.v0, s.vf) = (some(random, 0.8), some(random, 0.8));
            (s.a0, s.af) = (some(random, 0.8), some(random, 0.8));
            set_limits(random, &mut s, asymmetric, [(0.1, 12.0); 3], false);
            (s.v_max, s.v_min) = (s.v_max + s.vf.abs(), s.v_min - s.vf.abs());
            (s.a_max, s.a_min) = (s.a_max + s.af.abs(), s.a_min - s.af.abs());
            widen(&mut s);
        }
        Robot => {
            (s.p0, s.pf) = (random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
            set_limits(random, &mut s, asymmetric, [(1.0, 8.0), (4.0, 30.0), (40.0, 300.0)], false);
            moving(random, &mut s, 0.6);
        }
        Millimetres => {
            (s.p0, s.pf) = (random.uniform(-1000.0, 1000.0), random.uniform(-1000.0, 1000.0));
            set_limits(random, &mut s, asymmetric, [(100.0, 3000.0), (1e3, 3e4), (1e4, 1e6)], true);
            moving(random, &mut s, 0.9);
        }
        LogUniform => {
            (s.p0, s.pf) = (random.normal(4.0), random.normal(4.0));
            set_limits(random, &mut s, asymmetric, [(1e-3, 1e4); 3], true);
            moving(random, &mut s, 0.9);
        }
        Tiny => {
            s.p0 = random.normal(1.0);
            s.pf = s.p0 + random.sign() * random.log_uniform(1e-10, 1e-2);
            set_limits(random, &mut s, asymmetric, [(0.1, 12.0); 3], false);
            if random.chance(0.5) {
                let size = random.log_uniform(1e-8, 1e-2);
                moving(random, &mut s, size);
            }
        }
        Brake => {
            (s.p0, s.pf) = (random.normal(4.0), random.normal(4.0));
            set_limits(random, &mut s, asymmetric, [(0.1, 12.0); 3], true);
            moving(random, &mut s, 0.9);
            s.v0 = random.normal(1.0) * s.v_max;
            s.a0 = random.normal(1.0) * s.a_max;
        }
        Whole => {
            (s.p0, s.pf) = (random.whole(-4, 4), random.whole(-4, 4));
            (s.v0, s.vf) = (random.whole(-2, 2), random.whole(-2, 2));
            (s.a0, s.af) = (random.whole(-2, 2), random.whole(-2, 2));
            s.v_max = random.whole(1, 4);
            s.a_max = random.whole(1, 4);
            (s.v_min, s.a_min) = (-s.v_max, -s.a_max);
            s.jerk = random.whole(1, 4);
            widen(&mut s);
        }
        HighLimits => {
            (s.p0, s.pf) = (random.normal(4.0), random.normal(4.0));
            (s.v0, s.vf) = (some(random, 0.8), some(random, 0.8));
            (s.a0, s.af) = (some(random, 0.8), some(random, 0.8));
            set_limits(random, &mut s, asymmetric, [(10.0, 1e6); 3], true);
            widen(&mut s);
        }
        Islands => {
            set_limits(random, &mut s, asymmetric, [(0.5, 6.0); 3], false);
            moving(random, &mut s, 0.95);
            s.af = s.af.abs().copysign(s.a0).clamp(s.a_min, s.a_max);
            admit(&mut s);
            let t = random.uniform(0.0, 3.0);
            (s.p0, s.pf) = (0.0, 0.5 * (s.v0 + s.vf) * t + random.normal(0.3));
        }
    }
    s
}

fn set_limits(random: &mut Random, s: &mut Scalar, asymmetric: bool, ranges: [(f64, f64); 3], log: bool) {
    let mut draw = |(low, high): (f64, f64)| {
        if log { random.log_uniform(low, high) } else { random.uniform(low, high) }
    };
    (s.v_max, s.a_max, s.jerk) = (draw(ranges[0]), draw(ranges[1]), draw(ranges[2]));
    (s.v_min, s.a_min) = if asymmetric { (-draw(ranges[0]), -draw(ranges[1])) } else { (-s.v_max, -s.a_max) };
}

/// Current and target velocity and acceleration as fractions of the limits, up to `share`.
fn moving(random: &mut Random, s: &mut Scalar, share: f64) {
    let mut within = |min: f64, max: f64| {
        if random.chance(0.3) { 0.0 } else { share * random.uniform(min, max) }
    };
    (s.v0, s.vf) = (within(s.v_min, s.v_max), within(s.v_min, s.v_max));
    (s.a0, s.af) = (within(s.a_min, s.a_max), within(s.a_min, s.a_max));
    admit(s);
}

/// Lowers the accelerations where they would lead beyond the velocity limits.
fn admit(s: &mut Scalar) {
    let lower =
        |a: f64, room: f64, jerk: f64| a.abs().min(0.999 * (2.0 * jerk * room.max(0.0)).sqrt()).copysign(a);
    s.a0 = lower(s.a0, if s.a0 > 0.0 { s.v_max - s.v0 } else { s.v0 - s.v_min }, s.jerk);
    s.af = lower(s.af, if s.af < 0.0 { s.v_max - s.vf } else { s.vf - s.v_min }, s.jerk);
}

/// Raises the limits where the target needs it.
fn widen(s: &mut Scalar) {
    s.a_max = s.a_max.max(s.af);
    s.a_min = s.a_min.min(s.af);
    let reserve = s.af * s.af / (2.0 * s.jerk);
    s.v_max = s.v_max.max(s.vf + if s.af < 0.0 { reserve } else { 0.0 });
    s.v_min = s.v_min.min(s.vf - if s.af > 0.0 { reserve } else { 0.0 });
}
