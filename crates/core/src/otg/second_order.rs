//! One axis whose velocity has limited slope: position control without a jerk limit, and, one derivative up, velocity
//! control with one. See `docs/otg.md`, section 7.
//!
//! The same principle as with limited jerk, in closed form throughout. Words are those of position control: in velocity control read
//! velocity for position, acceleration for velocity, jerk for acceleration.

use super::number::{between, larger, smaller};
use crate::math::float::sqrt;

/// From (0, v₀) to (displacement, v_f).
#[derive(Debug, Clone, Copy)]
pub(super) struct SecondOrder {
    pub(super) displacement: f64,
    pub(super) v0: f64,
    pub(super) vf: f64,
    pub(super) v_max: f64,
    pub(super) v_min: f64,
    /// Time per velocity gained: the reciprocal of the highest acceleration. Zero if that is infinite.
    pub(super) rise: f64,
    /// Time per velocity lost.
    pub(super) fall: f64,
}

/// To the velocity w, on at w, to the final velocity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cruise {
    pub(super) w: f64,
    pub(super) first: f64,
    pub(super) cruise: f64,
    pub(super) last: f64,
}

impl Cruise {
    pub(super) fn duration(&self) -> f64 {
        self.first + self.cruise + self.last
    }
}

impl SecondOrder {
    fn mirror(&self) -> Self {
        Self {
            displacement: -self.displacement,
            v0: -self.v0,
            vf: -self.vf,
            v_max: -self.v_min,
            v_min: -self.v_max,
            rise: self.fall,
            fall: self.rise,
        }
    }

    /// The first arrival at or after `from`, at which the axis cannot arrive (or `from` is 0).
    pub(super) fn earliest(&self, from: f64) -> Cruise {
        let start = self.start();
        let reached = if from > start { self.farthest(from) } else { self.ramp(start) };
        if self.displacement >= reached {
            self.first_reaching()
        } else {
            self.mirror().first_reaching().mirror()
        }
    }

    /// The motion that arrives after the time `t`, if there is one.
    pub(super) fn at(&self, t: f64) -> Option<Cruise> {
        let start = self.start();
        let rest = t - start;
        if rest < 0.0 {
            return None;
        }
        let (low, high) = (smaller(self.v0, self.vf), larger(self.v0, self.vf));
        let ramp = self.ramp(start);
        if self.displacement > ramp + high * rest {
            self.above(t)
        } else if self.displacement < ramp + low * rest {
            self.mirror().above(t).map(Cruise::mirror)
        } else {
            let w = if rest > 0.0 { (self.displacement - ramp) / rest } else { high };
            Some(self.via(between(w, low, high), larger(rest, 0.0)))
        }
    }

    /// The shortest time in which the velocity can change.
    fn start(&self) -> f64 {
        let change = self.vf - self.v0;
        if change >= 0.0 { change * self.rise } else { -change * self.fall }
    }

    /// Displacement of that change.
    fn ramp(&self, start: f64) -> f64 {
        0.5 * (self.v0 + self.vf) * start
    }

    /// Displacement of ramps up to w and down again, plus that of both down to zero velocity.
    fn offset(&self) -> f64 {
        0.5 * (self.v0 * self.v0 * self.rise + self.vf * self.vf * self.fall)
    }

    /// The largest displacement of duration `t`.
    fn farthest(&self, t: f64) -> f64 {
        let slope = self.rise + self.fall;
        let w = smaller((t + self.v0 * self.rise + self.vf * self.fall) / slope, self.v_max);
        let w = larger(w, larger(self.v0, self.vf));
        let cruise = larger(t - (w - self.v0) * self.rise - (w - self.vf) * self.fall, 0.0);
        0.5 * w * w * slope - self.offset() + cruise * w
    }

    /// The least time up, to a peak velocity or the limit.
    fn first_reaching(&self) -> Cruise {
        let slope = self.rise + self.fall;
        let peak = sqrt(larger(2.0 * (self.displacement + self.offset()) / slope, 0.0));
        let w = larger(smaller(peak, self.v_max), larger(self.v0, self.vf));
        if w == f64::INFINITY {
            return Cruise { w: 0.0, first: 0.0, cruise: 0.0, last: 0.0 }; // nothing takes any time
        }
        let mut cruise =
            Cruise { w, first: (w - self.v0) * self.rise, cruise: 0.0, last: (w - self.vf) * self.fall };
        if peak > self.v_max || slope == 0.0 {
            let excess = self.displacement + self.offset() - 0.5 * w * w * slope;
            if excess > 0.0 {
                cruise.cruise = excess / w;
            }
        }
        cruise
    }

    /// Arrival after the time `t` with a cruise faster than both ends: the smaller root of a quadratic.
    fn above(&self, t: f64) -> Option<Cruise> {
        let slope = self.rise + self.fall;
        let linear = t + self.v0 * self.rise + self.vf * self.fall;
        let constant = self.displacement + self.offset();
        let discriminant = linear * linear - 2.0 * slope * constant;
        if discriminant < 0.0 {
            return None;
        }
        let root = sqrt(discriminant);
        let w = if linear > 0.0 { 2.0 * constant / (linear + root) } else { (linear - root) / slope };
        let w = larger(w, larger(self.v0, self.vf));
        let rest = linear - slope * w;
        (rest >= 0.0 && w <= self.v_max).then(|| self.via(w, rest))
    }

    fn via(&self, w: f64, rest: f64) -> Cruise {
        let first = if w >= self.v0 { (w - self.v0) * self.rise } else { (self.v0 - w) * self.fall };
        let last = if w >= self.vf { (w - self.vf) * self.fall } else { (self.vf - w) * self.rise };
        Cruise { w, first, cruise: rest, last }
    }
}

impl Cruise {
    fn mirror(self) -> Self {
        Self { w: -self.w, ..self }
    }
}
