//! One axis with limited jerk: how it arrives at a given, possible time. See `docs/otg.md`, section 6.
//!
//! Where both extreme motions pass through zero acceleration, so do all between them, with a cruise: one unknown, its velocity. Otherwise the motion
//! is a weighted mean of the two extreme ones, which keeps every limit that both keep.

use super::extremal::{Problem, Shape};
use super::number::{SIXTH, between, larger, smaller};
use super::profile::{Point, Profile};
use super::third_order::{Arrival, Passage};
use crate::math::float::sqrt;

/// A piece of constant jerk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) duration: f64,
    pub(super) jerk: f64,
    /// Acceleration at the start, exact where it is a limit or zero.
    pub(super) acceleration: f64,
}

impl Piece {
    const NONE: Self = Self::new(0.0, 0.0, 0.0);

    #[inline]
    const fn new(duration: f64, jerk: f64, acceleration: f64) -> Self {
        Self { duration, jerk, acceleration }
    }
}

/// Where a motion is written to: a profile that knows its end.
///
/// Motions are reckoned from the start up to the cruise, or to the middle if there is none, and back from the target from
/// there, so that rounding errors do not grow with the duration.
#[derive(Debug)]
pub(super) struct Draft<'a> {
    pub(super) profile: &'a mut Profile,
    /// State so far, in the user's units.
    pub(super) now: Point,
    /// The jerk limit.
    pub(super) scale: f64,
    /// Of the coordinates.
    pub(super) size: f64,
}

impl Draft<'_> {
    #[inline]
    fn forward(&mut self, duration: f64, jerk: f64, acceleration: f64) {
        self.profile.push_forward(&Piece::new(duration, jerk, acceleration), self.scale, &mut self.now);
    }

    #[inline]
    fn cruise(&mut self, duration: f64, velocity: f64) {
        self.now.v = velocity * self.scale;
        self.forward(duration, 0.0, 0.0);
    }

    /// The rest of the motion. Whether both parts meet.
    #[inline]
    fn backward<const K: usize>(&mut self, pieces: &[Piece; K]) -> bool {
        let start = self.profile.push_backward(pieces, self.scale);
        self.profile.joins(self.now, start, self.size)
    }

    /// The motion of an extreme arrival. False if the numbers have overflowed.
    pub(super) fn arrival(&mut self, a0: f64, af: f64, arrival: &Arrival) -> bool {
        let Arrival { sign, shape, .. } = *arrival;
        let motion = Extreme { shape, sign, a0, af };
        if arrival.from_end {
            return self.backward(&motion.all());
        }
        let [rise, hold, fall, end_of_fall, last_hold, last_rise] = motion.pieces();
        for piece in [rise, hold, fall] {
            self.forward(piece.duration, piece.jerk, piece.acceleration);
        }
        if shape.cruise > 0.0 {
            self.cruise(shape.cruise, sign * shape.velocity);
        }
        self.backward(&[end_of_fall, last_hold, last_rise])
    }

    /// Ramp, cruise and ramp. False if the numbers have overflowed.
    pub(super) fn ramps(&mut self, problem: &Problem, ramps: &Ramps) -> bool {
        let Problem { a0, af, .. } = *problem;
        let Ramps { first: r1, second: r2, rest, w } = *ramps;
        self.forward(r1.x - r1.sign * a0, r1.sign, a0);
        self.forward(r1.hold, 0.0, r1.sign * r1.x);
        self.forward(r1.x, -r1.sign, r1.sign * r1.x);
        self.cruise(rest, w);
        self.backward(&[
            Piece::new(r2.x, -r2.sign, 0.0),
            Piece::new(r2.hold, 0.0, -r2.sign * r2.x),
            Piece::new(r2.x + r2.sign * af, r2.sign, -r2.sign * r2.x),
        ])
    }

    /// A motion of given duration. False if there is none, or the numbers have overflowed.
    pub(super) fn passage(&mut self, problem: &Problem, passage: Option<Passage>) -> bool {
        match passage {
            Some(Passage::Mean(mixture)) => self.mixture(problem, &mixture),
            Some(Passage::Extreme(arrival)) => self.arrival(problem.a0, problem.af, &arrival),
            None => false,
        }
    }

    /// The mean of two extreme motions. False if the numbers have overflowed.
    fn mixture(&mut self, problem: &Problem, mixture: &Mixture) -> bool {
        let Problem { a0, af, .. } = *problem;
        let up = Extreme { shape: mixture.up, sign: 1.0, a0, af };
        let down = Extreme { shape: mixture.down, sign: -1.0, a0, af };
        let (up, down) = (up.all(), down.all());
        // Half from either end: the borders near the end, counted from the start of a long motion, would be rounded.
        let half = 0.5 * up.iter().map(|piece| piece.duration).sum::<f64>();
        for piece in mean(&up, &down, mixture.share, half) {
            self.forward(piece.duration, piece.jerk, piece.acceleration);
        }
        let last = mean(&backwards(&up), &backwards(&down), mixture.share, half);
        self.backward(&backwards(&last))
    }
}

/// The weighted mean of the two extreme motions of a duration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mixture {
    pub(super) up: Shape,
    pub(super) down: Shape,
    /// Weight of `up`, from 0 to 1.
    pub(super) share: f64,
}

/// Rise to the peak, hold, fall, cruise, fall to the valley, hold, rise; all times `sign`.
#[derive(Debug, Clone, Copy)]
struct Extreme {
    shape: Shape,
    sign: f64,
    a0: f64,
    af: f64,
}

impl Extreme {
    /// The pieces without the cruise, which lies between the third and the fourth.
    #[inline]
    fn pieces(&self) -> [Piece; 6] {
        let Self { shape: Shape { peak, peak_hold, cruise, valley, valley_hold, .. }, sign, a0, af } = *self;
        let (until_zero, from_zero) = if cruise > 0.0 { (peak, valley) } else { (peak + valley, 0.0) };
        [
            Piece::new(peak - sign * a0, sign, a0),
            Piece::new(peak_hold, 0.0, sign * peak),
            Piece::new(until_zero, -sign, sign * peak),
            Piece::new(from_zero, -sign, 0.0),
            Piece::new(valley_hold, 0.0, -sign * valley),
            Piece::new(valley + sign * af, sign, -sign * valley),
        ]
    }

    /// All pieces in order.
    fn all(&self) -> [Piece; 7] {
        let [rise, hold, fall, end_of_fall, last_hold, last_rise] = self.pieces();
        [rise, hold, fall, Piece::new(self.shape.cruise, 0.0, 0.0), end_of_fall, last_hold, last_rise]
    }
}

/// A rise and fall of the acceleration, to a cruise or from it.
#[derive(Debug, Clone, Copy)]
struct Peak {
    /// +1: the acceleration rises first, seen from the far end of the ramp.
    sign: f64,
    /// Magnitude.
    x: f64,
    hold: f64,
}

/// Ramp, cruise at w, ramp; the second ramp as seen backwards in time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ramps {
    first: Peak,
    second: Peak,
    rest: f64,
    w: f64,
}

/// From a velocity and acceleration to a cruise in the least time.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    peak: Peak,
    duration: f64,
    displacement: f64,
    /// Its part of P″, the second derivative of the whole displacement: ∓1/x at the limit, ∓3/(4x) below it.
    curvature: f64,
}

/// Where a ramp starts, and what it may do: all that does not depend on the cruise velocity.
#[derive(Debug, Clone, Copy)]
struct RampFrom {
    a: f64,
    v: f64,
    /// The velocity that results if the acceleration just returns to zero.
    straight: f64,
    a_max: f64,
    a_min: f64,
}

impl RampFrom {
    fn new(v: f64, a: f64, a_max: f64, a_min: f64) -> Self {
        Self { a, v, straight: v + 0.5 * a * a.abs(), a_max, a_min }
    }

    #[inline]
    fn to(&self, w: f64) -> Ramp {
        let a = self.a;
        let (sign, limit) = if w >= self.straight { (1.0, self.a_max) } else { (-1.0, -self.a_min) };
        let v = self.v - sign * 0.5 * a * a; // where the first rise, drawn out, has zero acceleration
        let gain = larger(sign * (w - v), 0.0);
        let root = sqrt(gain);
        let (x, hold, curvature) =
            if root <= limit { (root, 0.0, 0.75) } else { (limit, gain / limit - limit, 1.0) };
        let t = 2.0 * x + hold;
        Ramp {
            peak: Peak { sign, x, hold },
            duration: t - sign * a,
            displacement: 0.5 * (v + w) * t - a * (sign * v + a * a * SIXTH),
            curvature: -sign * curvature / x,
        }
    }
}

/// Most steps of the search for the cruise velocity. It mostly takes two or three; a search that takes longer is left to the mixture, which
/// needs none.
const MAX_STEPS: usize = 16;
/// The step after one of size d is about d³ (P″²/(4 P′²) + |P‴|/(6 P′)). With P′ ≥ (x₁ + x₂)/2, |P″| ≤ 1/x₁ + 1/x₂ and |P‴| ≤ 3/8 (1/x₁³ + 1/x₂³)
/// that is rounding, beside the velocities x₁² and x₂² that the ramps gain, where d is this fraction of x₁ x₂.
const LAST_STEP: f64 = 3e-6;
/// A displacement met to this, relative to the ways that make it up, is met.
const ARRIVED: f64 = 1e-12;
/// Displacements that differ by this fraction of their terms are one.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Ramps {
    /// The cruise velocity.
    #[cfg(test)]
    pub(super) fn velocity(&self) -> f64 {
        self.w
    }

    /// The motion by ramp, cruise and ramp that arrives after the time `t`, if Halley's method finds one.
    ///
    /// The displacement grows with the cruise velocity w: dP/dw = t_cruise + (x₁ + x₂)/2. What is found is judged by itself: ramps that
    /// fit into the time, and a velocity within its limits, are a motion, wherever the search came from.
    #[inline]
    pub(super) fn arriving(problem: &Problem, t: f64) -> Option<Self> {
        let Problem { displacement, v0, a0, vf, af, v_max, v_min, a_max, a_min } = *problem;
        let first = RampFrom::new(v0, a0, a_max, a_min);
        // The second ramp, seen backwards in time: limits and the sign of the acceleration change.
        let second = RampFrom::new(vf, -af, -a_min, -a_max);
        let noise = ROUNDING * (displacement.abs() + t * (v0.abs() + vf.abs()));
        let mut w = displacement / t;
        for _ in 0..MAX_STEPS {
            let (r1, r2) = (first.to(w), second.to(w));
            let rest = t - r1.duration - r2.duration;
            let excess = r1.displacement + r2.displacement + rest * w - displacement;
            let slope = rest + 0.5 * (r1.peak.x + r2.peak.x);
            if slope <= 0.0 {
                return None;
            }
            let square = slope * slope;
            let bent = square - 0.5 * excess * (r1.curvature + r2.curvature);
            // Halley's step, within a factor of two of Newton's: the curvature is infinite where x is zero.
            let step = excess * slope / between(bent, 0.5 * square, 2.0 * square);
            w -= step;
            if step.abs() <= LAST_STEP * (r1.peak.x * r2.peak.x) || excess.abs() <= noise {
                let (r1, r2) = (first.to(w), second.to(w));
                let rest = t - r1.duration - r2.duration;
                let excess = r1.displacement + r2.displacement + rest * w - displacement;
                // Across the velocity at which a ramp turns round, the last step need not be one.
                if excess.abs() <= ARRIVED * (displacement.abs() + t * (v0.abs() + vf.abs() + w.abs())) {
                    let good = rest >= 0.0 && v_min <= w && w <= v_max;
                    return good.then_some(Self { first: r1.peak, second: r2.peak, rest, w });
                }
            }
        }
        None
    }
}

/// Most pieces of half a mixture: two motions of seven pieces each have at most twelve inner borders.
const MAX_PIECES: usize = 13;

/// The mean of two motions up to the time `until`.
fn mean(up: &[Piece; 7], down: &[Piece; 7], share: f64, until: f64) -> [Piece; MAX_PIECES] {
    let mean = |u: f64, d: f64| share * u + (1.0 - share) * d;
    let mut pieces = [Piece::NONE; MAX_PIECES];
    let mut left = until;
    let (mut i, mut k) = (0, 0);
    let (mut t_up, mut t_down) = (0.0, 0.0); // spent of the current piece of each
    for place in &mut pieces {
        // Pieces without duration, seven at most of either, give way to the next.
        while up.get(i).is_some_and(|piece| piece.duration <= t_up) {
            (i, t_up) = (i + 1, 0.0);
        }
        while down.get(k).is_some_and(|piece| piece.duration <= t_down) {
            (k, t_down) = (k + 1, 0.0);
        }
        let (Some(u), Some(d)) = (up.get(i), down.get(k)) else { break };
        let (left_up, left_down) = (u.duration - t_up, d.duration - t_down);
        let duration = smaller(smaller(left_up, left_down), left);
        let acceleration = mean(u.acceleration + t_up * u.jerk, d.acceleration + t_down * d.jerk);
        *place = Piece::new(duration, mean(u.jerk, d.jerk), acceleration);
        left -= duration;
        if left <= 0.0 {
            break;
        }
        t_up = if left_up <= left_down { u.duration } else { t_up + duration };
        t_down = if left_down <= left_up { d.duration } else { t_down + duration };
    }
    pieces
}

/// A motion backwards in time.
fn backwards<const K: usize>(pieces: &[Piece; K]) -> [Piece; K] {
    let mut turned = *pieces;
    turned.reverse();
    turned.map(|piece| {
        let end = piece.acceleration + piece.duration * piece.jerk;
        Piece::new(piece.duration, -piece.jerk, end)
    })
}
