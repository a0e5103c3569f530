//! One axis with limited jerk that starts and ends at rest: when it can arrive, and how. See `docs/otg.md`, section 6.
//!
//! Units: jerk limit 1. Up to a cruise velocity w and down again: the only unknown is w, for the least time and for any later one. Every
//! time from the least on is possible.

use super::extremal::{Problem, Shape};
use super::number::{larger, smaller};
use super::third_order::Arrival;
use crate::math::float::{cbrt, sqrt};

/// From rest to rest, forward.
#[derive(Debug, Clone, Copy)]
pub(super) struct RestToRest {
    /// ≥ 0.
    distance: f64,
    v_max: f64,
    /// Highest acceleration, > 0.
    rise: f64,
    /// Highest deceleration, > 0.
    fall: f64,
}

/// To a velocity from rest, or back.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    /// Peak acceleration.
    peak: f64,
    /// How long it is held.
    hold: f64,
}

impl Ramp {
    /// The ramp to the velocity (√w)², at an acceleration up to `limit`.
    #[inline]
    fn to(w: f64, root: f64, limit: f64) -> Self {
        if root <= limit {
            Self { peak: root, hold: 0.0 }
        } else {
            Self { peak: limit, hold: w / limit - limit }
        }
    }

    #[inline]
    fn duration(&self) -> f64 {
        2.0 * self.peak + self.hold
    }
}

/// Most steps of the search with one acceleration limit met; 5 is the most seen.
const MAX_STEPS: usize = 12;
/// The search gets three times as many good digits with each step, so that the step after one this small, relative to the velocity, is
/// exact.
const LAST_STEP: f64 = 1e-6;

impl RestToRest {
    /// Of a problem whose displacement is forward, the displacement and the limits.
    pub(super) fn new(problem: &Problem) -> Self {
        let Problem { displacement, v_max, a_max, a_min, .. } = *problem;
        let v_max = v_max.abs(); // a limit of zero may have either sign
        Self { distance: displacement, v_max, rise: a_max, fall: -a_min }
    }

    /// The same with a shorter way.
    pub(super) fn nearer(&self, by: f64) -> Self {
        Self { distance: larger(self.distance - by, 0.0), ..*self }
    }

    /// The first arrival.
    pub(super) fn earliest(&self) -> Arrival {
        let (w, p) = (self.v_max, self.distance);
        let limited = self.via(w);
        let ramps = 0.5 * w * limited.t;
        if ramps <= p {
            let cruise = (p - ramps) / w; // for ever if that is zero
            Arrival { t: limited.t + cruise, shape: Shape { cruise, ..limited.shape }, ..limited }
        } else {
            self.via(self.peak_velocity())
        }
    }

    /// The arrival after the time `t`, which is not before the first.
    pub(super) fn at(&self, t: f64) -> Arrival {
        let w = smaller(self.cruise_velocity(t), self.v_max);
        let mut arrival = self.via(w);
        // Negative by rounding only.
        arrival.shape.cruise = larger(t - arrival.t, 0.0);
        arrival.t = t;
        arrival
    }

    /// Up to the velocity w and down again at once.
    #[inline]
    fn via(&self, w: f64) -> Arrival {
        let root = sqrt(w);
        let (up, down) = (Ramp::to(w, root, self.rise), Ramp::to(w, root, self.fall));
        let shape = Shape {
            peak: up.peak,
            peak_hold: up.hold,
            cruise: 0.0,
            velocity: w,
            valley: down.peak,
            valley_hold: down.hold,
        };
        Arrival { t: up.duration() + down.duration(), sign: 1.0, shape, from_end: false }
    }

    /// The highest velocity of the shortest motion without a velocity limit: p = w/2 · (both ramps' durations).
    fn peak_velocity(&self) -> f64 {
        let p = self.distance;
        let (low, high) = (smaller(self.rise, self.fall), larger(self.rise, self.fall));
        if p <= 2.0 * low * low * low {
            // Neither limit met: p = 2x³.
            let x = cbrt(0.5 * p);
            return x * x;
        }
        // The lower limit met: x²(x + m)² = 2mp.
        let s = sqrt(2.0 * low * p);
        if s <= high * (high + low) {
            let x = 2.0 * s / (low + sqrt(low * low + 4.0 * s));
            return x * x;
        }
        // Both met: k w² + h w = 2p.
        let (h, k) = (low + high, 1.0 / low + 1.0 / high);
        4.0 * p / (h + sqrt(h * h + 8.0 * k * p))
    }

    /// The cruise velocity of the motion of duration `t`: p = w (t − half of both ramps' durations).
    ///
    /// m is the lower of the two acceleration limits, h their sum and k the sum of their reciprocals.
    fn cruise_velocity(&self, t: f64) -> f64 {
        let p = self.distance;
        let (low, high) = (smaller(self.rise, self.fall), larger(self.rise, self.fall));
        // Does it get far enough with the lower limit just met?
        if t <= 4.0 * low || p <= low * low * (t - 2.0 * low) {
            return neither_met(p, t);
        }
        let (h, k) = (low + high, 1.0 / low + 1.0 / high);
        let ramps = h + k * high * high; // with the other limit just met too
        if t > ramps && p >= high * high * (t - 0.5 * ramps) {
            both_met(p, t, h, k)
        } else {
            one_met(p, t, low)
        }
    }
}

/// Neither limit met: p = x² (t − 2x) with w = x².
///
/// With x = r p^½ t^−½ this is r² (1 − 2ur) = 1, where u ≤ 1/√32 and 1 ≤ r ≤ √2, as the ramps take no more than the time there is. The first guess
/// is right at both ends and off by 1 % at most between them, and two of Halley's steps leave the rounding only.
fn neither_met(p: f64, t: f64) -> f64 {
    let mean = p / t;
    let u = sqrt(mean) / t;
    let mut r = (1.0 - 2.2427 * u) / (1.0 - 3.2427 * u);
    for _ in 0..2 {
        let excess = r * r * (1.0 - 2.0 * u * r) - 1.0;
        let slope = 2.0 * r * (1.0 - 3.0 * u * r);
        let bend = 2.0 - 12.0 * u * r;
        r -= 2.0 * excess * slope / (2.0 * slope * slope - excess * bend);
    }
    r * r * mean
}

/// Both limits met: the ramps take h + k w, so that the cruise c has 2kp = (t − h − c)(t + c), and 2p = w (t + c).
fn both_met(p: f64, t: f64, h: f64, k: f64) -> f64 {
    let spare = larger(t * (t - h) - 2.0 * k * p, 0.0);
    let cruise = 2.0 * spare / (h + sqrt(h * h + 4.0 * spare));
    2.0 * p / (t + cruise)
}

/// The lower limit m met, the other not: p = w (t − m/2 − w/(2m) − √w).
///
/// Each step takes the displacement for the parabola that has its value and its first two derivatives (Euler's method). Where the
/// parabola stays below p, its top is the next guess.
fn one_met(p: f64, t: f64, m: f64) -> f64 {
    let lowest = m * m;
    let mut w = lowest;
    for _ in 0..MAX_STEPS {
        let x = sqrt(w);
        let missing = p - w * (t - 0.5 * (m + w / m) - x);
        let slope = t - 0.5 * m - w / m - 1.5 * x;
        let bend = 1.0 / m + 0.75 / x;
        let root = sqrt(larger(slope * slope - 2.0 * bend * missing, 0.0));
        let step = smaller(2.0 * missing / (slope + root), slope / bend);
        w = larger(w + step, lowest);
        if step.abs() <= LAST_STEP * w {
            break;
        }
    }
    w
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::otg::fixed_duration::Ramps;
    use crate::otg::third_order::ThirdOrder;

    /// Random numbers in [0, 1) (SplitMix64).
    struct Random(u64);

    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }

        /// A limit between 1e-3 and 1e3 times `size`; one in ten is infinite.
        fn limit(&mut self, size: f64) -> f64 {
            if self.unit() < 0.1 { f64::INFINITY } else { size * (13.8 * (self.unit() - 0.5)).exp() }
        }
    }

    /// A problem whose sizes are those of a motion of one second, in a unit of time up to 1e±6 seconds; half of them symmetric.
    fn problem(random: &mut Random) -> Problem {
        let time = (27.6 * (random.unit() - 0.5)).exp();
        let (p, v, a) = (time * time * time, time * time, time);
        let (v_max, a_max) = (random.limit(v), random.limit(a));
        let symmetric = random.unit() < 0.5;
        let (v_min, a_min) = if symmetric { (-v_max, -a_max) } else { (-random.limit(v), -random.limit(a)) };
        let displacement = p * (13.8 * (random.unit() - 0.5)).exp();
        Problem { displacement, v0: 0.0, a0: 0.0, vf: 0.0, af: 0.0, v_max, v_min, a_max, a_min }
    }

    /// 300,000 problems: the room for any two states finds the same least time, and at a later one the same cruise.
    #[test]
    fn agrees_with_the_general_room() {
        let mut random = Random(31);
        let mut compared = 0;
        for _ in 0..300_000 {
            let problem = problem(&mut random);
            let (own, general) = (RestToRest::new(&problem), ThirdOrder::new(problem, 0.0));
            let (first, expected) = (own.earliest(), general.earliest(0.0));
            assert!((first.t - expected.t).abs() <= 1e-12 * expected.t, "{first:?} {expected:?} {problem:?}");
            assert_eq!(first.sign, expected.sign);
            let t = first.t * (1.0 + (27.6 * (random.unit() - 0.75)).exp());
            let Some(ramps) = Ramps::arriving(&problem, t) else { continue };
            let (later, w) = (own.at(t), ramps.velocity());
            // The displacement says how exact the velocity can be: its slope is cruise + (x₁ + x₂)/2.
            let slope = later.shape.cruise + 0.5 * (later.shape.peak + later.shape.valley);
            let exact = 1e-12 * (problem.displacement / slope + w);
            assert!((later.shape.velocity - w).abs() <= exact, "{later:?} {ramps:?} {problem:?}");
            compared += 1;
        }
        assert!(compared > 250_000, "{compared}");
    }

    /// 300,000 problems: the motion of a later time covers the displacement in that time within the limits, by the ramps' own durations.
    #[test]
    fn later_motions_are_motions() {
        let mut random = Random(32);
        for _ in 0..300_000 {
            let problem = problem(&mut random);
            let own = RestToRest::new(&problem);
            let t = own.earliest().t * (1.0 + (41.4 * (random.unit() - 0.75)).exp());
            let Shape { peak, peak_hold, cruise, velocity, valley, valley_hold } = own.at(t).shape;
            let (up, down) = (2.0 * peak + peak_hold, 2.0 * valley + valley_hold);
            let (way, asked) = (velocity * (cruise + 0.5 * (up + down)), problem.displacement);
            assert!((way - asked).abs() <= 1e-11 * asked, "{way} {asked} {t} {problem:?}");
            assert!((up + cruise + down - t).abs() <= 1e-11 * t, "{up} {cruise} {down} {t} {problem:?}");
            let within = peak <= problem.a_max && valley <= -problem.a_min && velocity <= problem.v_max;
            assert!(within, "{problem:?}");
            let gained = |peak: f64, hold: f64| peak * (peak + hold);
            assert!((gained(peak, peak_hold) - velocity).abs() <= 1e-12 * velocity);
            assert!((gained(valley, valley_hold) - velocity).abs() <= 1e-12 * velocity);
        }
    }
}
