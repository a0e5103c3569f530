//! One axis with limited jerk: how it arrives at a given, possible time. See `docs/otg.md`, section 6.
//!
//! Where both extreme motions pass through zero acceleration, so do all between them, with a cruise: one unknown, its velocity. Otherwise the motion
//! is a weighted mean of the two extreme ones, which keeps every limit that both keep.

use super::extremal::{Family, Problem, Shape};
use super::third_order::{Arrival, Direction, Span, ThirdOrder};
use crate::math::float::sqrt;

/// Most pieces of a motion: two extreme motions of seven pieces each have at most twelve inner borders.
pub(super) const MAX_PIECES: usize = 13;

/// A piece of constant jerk.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Piece {
    pub(super) duration: f64,
    pub(super) jerk: f64,
    /// Acceleration at the start, exact where it is a limit or zero.
    pub(super) acceleration: f64,
}

/// A motion as pieces of constant jerk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pieces {
    list: [Piece; MAX_PIECES],
    len: usize,
    /// The piece at constant velocity, and the velocity.
    cruise: Option<(usize, f64)>,
}

impl Pieces {
    fn new() -> Self {
        Self { list: [Piece::default(); MAX_PIECES], len: 0, cruise: None }
    }

    #[inline]
    fn push(&mut self, duration: f64, jerk: f64, acceleration: f64) {
        if duration > 0.0 && self.len < MAX_PIECES {
            self.list[self.len] = Piece { duration, jerk, acceleration };
            self.len += 1;
        }
    }

    #[inline]
    fn push_cruise(&mut self, duration: f64, velocity: f64) {
        self.cruise = Some((self.len, velocity));
        self.push(duration, 0.0, 0.0);
    }

    /// The piece at constant velocity, if there is one, and the velocity.
    #[inline]
    pub(super) fn cruise(&self) -> Option<(usize, f64)> {
        self.cruise
    }

    #[inline]
    pub(super) fn as_slice(&self) -> &[Piece] {
        &self.list[..self.len]
    }
}

/// The motion of an extreme arrival.
pub(super) fn of_arrival(axis: &ThirdOrder, arrival: &Arrival) -> Pieces {
    let Problem { a0, af, .. } = axis.problem;
    match arrival.direction {
        Direction::Up => extreme(&axis.up.shape(&arrival.extremal), 1.0, a0, af),
        Direction::Down => extreme(&axis.down.shape(&arrival.extremal), -1.0, a0, af),
    }
}

/// Rise to the peak, hold, fall, cruise, fall to the valley, hold, rise; all times `sign`.
fn extreme(shape: &Shape, sign: f64, a0: f64, af: f64) -> Pieces {
    let Shape { peak, peak_hold, cruise, velocity, valley, valley_hold } = *shape;
    let mut pieces = Pieces::new();
    pieces.push(peak - sign * a0, sign, a0);
    pieces.push(peak_hold, 0.0, sign * peak);
    if cruise > 0.0 {
        pieces.push(peak, -sign, sign * peak);
        pieces.push_cruise(cruise, sign * velocity);
        pieces.push(valley, -sign, 0.0);
    } else {
        pieces.push(peak + valley, -sign, sign * peak);
    }
    pieces.push(valley_hold, 0.0, -sign * valley);
    pieces.push(valley + sign * af, sign, -sign * valley);
    pieces
}

/// The motion that arrives after the time `t`, given the extreme motions of that duration.
pub(super) fn between(axis: &ThirdOrder, t: f64, span: &Span) -> Pieces {
    let cruises = span.up.cruises() && span.down.cruises();
    let pieces = if cruises { cruise(&axis.problem, t, span) } else { None };
    pieces.unwrap_or_else(|| mixture(axis, span))
}

/// From a velocity and acceleration to a cruise in the least time.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    /// +1: first the acceleration rises.
    sign: f64,
    /// Magnitude of the peak acceleration.
    x: f64,
    hold: f64,
    duration: f64,
    displacement: f64,
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
        let gain = (sign * (w - v)).max(0.0);
        let root = sqrt(gain);
        let (x, t) = if root <= limit { (root, 2.0 * root) } else { (limit, limit + gain / limit) };
        Ramp {
            sign,
            x,
            hold: t - 2.0 * x,
            duration: t - sign * a,
            displacement: 0.5 * (v + w) * t - a * (sign * v + a * a / 6.0),
        }
    }
}

/// Most steps of the search for the cruise velocity; the bracket is halved where Newton's method leaves it.
const MAX_STEPS: usize = 80;
/// As in the search for the extreme motions: the step after one this small is exact.
const LAST_STEP: f64 = 1e-9;

/// Ramp, cruise, ramp. The displacement grows with the cruise velocity w: dP/dw = t_cruise + (x₁ + x₂)/2.
///
/// None if the two ramps alone take longer than `t`: between the velocities of start and target two ramps may take longer
/// than one.
fn cruise(problem: &Problem, t: f64, span: &Span) -> Option<Pieces> {
    let Problem { displacement, v0, a0, vf, af, a_max, a_min, .. } = *problem;
    let first = RampFrom::new(v0, a0, a_max, a_min);
    // The second ramp, seen backwards in time: limits and the sign of the acceleration change.
    let second = RampFrom::new(vf, -af, -a_min, -a_max);
    let (mut low, mut high) = (-span.down.w, span.up.w);
    let reach = span.up.p + span.down.p;
    let share = if reach > 0.0 { (displacement + span.down.p) / reach } else { 0.5 };
    let mut w = low + (high - low) * share;
    let (mut r1, mut r2) = (first.to(w), second.to(w));
    for _ in 0..MAX_STEPS {
        let rest = t - r1.duration - r2.duration;
        let excess = r1.displacement + r2.displacement + rest * w - displacement;
        if excess > 0.0 {
            high = w;
        } else {
            low = w;
        }
        let slope = rest + 0.5 * (r1.x + r2.x);
        let mut next = w - excess / slope;
        if !(next >= low && next <= high) {
            next = 0.5 * (low + high);
        }
        let moved = (next - w).abs();
        w = next;
        r1 = first.to(w);
        r2 = second.to(w);
        if moved <= (LAST_STEP * (r1.x * r1.x).max(r2.x * r2.x)).max(2.0 * f64::EPSILON * w.abs()) {
            break;
        }
    }
    let rest = t - r1.duration - r2.duration;
    if rest < 0.0 {
        return None;
    }
    let mut pieces = Pieces::new();
    pieces.push(r1.x - r1.sign * a0, r1.sign, a0);
    pieces.push(r1.hold, 0.0, r1.sign * r1.x);
    pieces.push(r1.x, -r1.sign, r1.sign * r1.x);
    if rest > 0.0 {
        pieces.push_cruise(rest, w);
    }
    pieces.push(r2.x, -r2.sign, 0.0);
    pieces.push(r2.hold, 0.0, -r2.sign * r2.x);
    pieces.push(r2.x + r2.sign * af, r2.sign, -r2.sign * r2.x);
    Some(pieces)
}

/// The weighted mean of the two extreme motions that gets exactly as far as asked.
fn mixture(axis: &ThirdOrder, span: &Span) -> Pieces {
    let Problem { displacement, a0, af, .. } = axis.problem;
    let motion = |family: &Family, extremal, sign| extreme(&family.shape(extremal), sign, a0, af);
    let up = motion(&axis.up, &span.up, 1.0);
    let down = motion(&axis.down, &span.down, -1.0);
    let reach = span.up.p + span.down.p;
    let share = if reach > 0.0 { ((displacement + span.down.p) / reach).clamp(0.0, 1.0) } else { 1.0 };
    let mean = |u: f64, d: f64| share * u + (1.0 - share) * d;

    let (ups, downs) = (up.as_slice(), down.as_slice());
    let mut pieces = Pieces::new();
    let (mut i, mut k) = (0, 0);
    let (mut t_up, mut t_down) = (0.0, 0.0); // spent of the current piece of each
    for _ in 0..MAX_PIECES {
        let (Some(u), Some(d)) = (ups.get(i), downs.get(k)) else { break };
        let (left_up, left_down) = (u.duration - t_up, d.duration - t_down);
        let duration = left_up.min(left_down);
        let acceleration = mean(u.acceleration + t_up * u.jerk, d.acceleration + t_down * d.jerk);
        pieces.push(duration, mean(u.jerk, d.jerk), acceleration);
        t_up += duration;
        t_down += duration;
        if left_up <= left_down {
            (i, t_up) = (i + 1, 0.0);
        }
        if left_down <= left_up {
            (k, t_down) = (k + 1, 0.0);
        }
    }
    pieces
}
