//! The extreme motions: how far an axis can get in a given time. See `docs/otg.md`, sections 2 and 3.
//!
//! Units: jerk limit 1. Of all motions from (v₀, a₀) to (v_f, a_f) within the limits that take the time T, the one that gets
//! farthest raises the acceleration from a₀ to a peak x, lowers it to a valley −n and raises it again to a_f, with holds
//! where x or n meets its limit, and with a cruise in the middle where the velocity meets its limit. That is one family with
//! one parameter. Its mirror image gets least far.

use super::number::{NOISE, SIXTH, between, larger, smaller};
use crate::math::float::{cbrt, sqrt};

/// A problem of third order with jerk limit 1: from (0, v₀, a₀) to (displacement, v_f, a_f).
#[derive(Debug, Clone, Copy)]
pub(super) struct Problem {
    pub(super) displacement: f64,
    pub(super) v0: f64,
    pub(super) a0: f64,
    pub(super) vf: f64,
    pub(super) af: f64,
    pub(super) v_max: f64,
    pub(super) v_min: f64,
    pub(super) a_max: f64,
    pub(super) a_min: f64,
}

impl Problem {
    /// The same problem with the axis turned round.
    pub(super) fn mirror(&self) -> Self {
        Self {
            displacement: -self.displacement,
            v0: -self.v0,
            a0: -self.a0,
            vf: -self.vf,
            af: -self.af,
            v_max: -self.v_min,
            v_min: -self.v_max,
            a_max: -self.a_min,
            a_min: -self.a_max,
        }
    }
}

/// All motions that get farthest in their time, for one problem, with e as the parameter.
///
/// Symbols of docs/otg.md: `v_first` is v* and `v_last` is v⁺, the velocities where the first and the last rise of the acceleration, drawn
/// out, pass through zero acceleration; `drop` is m, the magnitude of the lowest acceleration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Family {
    /// v* = v₀ − a₀²/2.
    v_first: f64,
    /// v⁺ = v_f − a_f²/2.
    v_last: f64,
    /// C = v⁺ − v* ≥ 0.
    c: f64,
    /// K, displacement of the outer rises beyond zero acceleration.
    k: f64,
    /// The start, and the acceleration at the end.
    v0: f64,
    a0: f64,
    af: f64,
    /// Acceleration limits.
    a_max: f64,
    drop: f64,
    v_max: f64,
    /// Parameter at which the main arc starts.
    start: f64,
    /// Parameters between which the island lies, if there is one.
    island: Option<(f64, f64)>,
    /// The problem was reversed in time to have C ≥ 0: peak and valley change places.
    reversed: bool,
}

/// One motion of the family.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extremal {
    /// The parameter: half the time that the valley would take, were it entered and left at zero acceleration.
    pub(super) e: f64,
    /// Peak acceleration.
    pub(super) x: f64,
    /// Valley acceleration, turned round; negative if the acceleration stays above zero.
    pub(super) n: f64,
    /// Duration of the peak from zero to zero acceleration.
    t_peak: f64,
    /// Velocity at the zero of the acceleration between peak and valley, drawn out if there is none.
    pub(super) w: f64,
    /// Duration of the cruise at w.
    pub(super) cruise: f64,
    /// Displacement.
    pub(super) p: f64,
    /// Duration.
    pub(super) t: f64,
    /// dp/dt, as the duration grows.
    pub(super) slope: f64,
}

/// Peak, valley, holds and cruise of an extreme motion as they follow one another in time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    pub(super) peak: f64,
    pub(super) peak_hold: f64,
    pub(super) cruise: f64,
    pub(super) velocity: f64,
    pub(super) valley: f64,
    pub(super) valley_hold: f64,
}

/// Newton's method doubles the number of good digits with each step, so that the step after one this small is exact.
const LAST_STEP: f64 = 1e-8;

/// Rounding of a displacement.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Most steps of the root search; 16 is the most seen. Where the displacement is convex, which is everywhere but on a hump, Newton's method
/// needs no bracket; where a step leaves it, it is halved, and 60 halvings exhaust 64-bit floats.
const MAX_STEPS: usize = 80;

impl Family {
    pub(super) fn new(problem: &Problem) -> Self {
        let Problem { v0, a0, vf, af, v_max, a_max, a_min, .. } = *problem;
        let mut c = (vf - v0) - 0.5 * (af - a0) * (af + a0);
        // On the last stretch of a motion C is zero but for rounding. Either order serves then; the island, if there is one, shows
        // where a₀ > 0.
        if c.abs() <= NOISE * (a0 * a0 + af * af + v0.abs() + vf.abs()) {
            c = 0.0;
        }
        if c < 0.0 || (c == 0.0 && a0 < 0.0) {
            Self::ordered(vf, -af, v0, -a0, -c, -a_min, a_max, v_max, true)
        } else {
            Self::ordered(v0, a0, vf, af, c, a_max, -a_min, v_max, false)
        }
    }

    #[allow(clippy::too_many_arguments)] // One flat list of numbers; a struct would only rename them.
    #[inline]
    fn ordered(
        v0: f64,
        a0: f64,
        vf: f64,
        af: f64,
        c: f64,
        a_max: f64,
        drop: f64,
        v_max: f64,
        reversed: bool,
    ) -> Self {
        let v_first = v0 - 0.5 * a0 * a0;
        let v_last = vf - 0.5 * af * af;
        let k = af * (v_last + af * af * SIXTH) - a0 * (v_first + a0 * a0 * SIXTH);
        let mut family = Self {
            v_first,
            v_last,
            c,
            k,
            v0,
            a0,
            af,
            a_max,
            drop,
            v_max,
            start: -af,
            island: None,
            reversed,
        };
        // The peak must reach a₀: x² = n² + C ≥ a₀².
        let r_squared = a0 * a0 - c;
        if a0 > 0.0 && r_squared > 0.0 {
            let r = sqrt(r_squared);
            let noise = NOISE * (a0 * a0 + af * af + v0.abs() + vf.abs());
            if af > 0.0 && af * af >= r_squared - noise {
                family.island = Some((-af, -smaller(r, af)));
            }
            family.start = larger(family.parameter(r_squared, r), -af);
        }
        // Without C a valley above zero is as high as the peak: all of them are one motion, and what comes next is a real valley.
        if c == 0.0 {
            family.start = larger(family.start, 0.0);
        }
        family
    }

    /// The parameter at which the valley takes away the velocity y = (√y)².
    #[inline]
    fn parameter(&self, y: f64, root: f64) -> f64 {
        if root <= self.drop { root } else { 0.5 * (self.drop + y / self.drop) }
    }

    /// The motion with parameter `e`, without regard to the velocity limit.
    #[inline]
    pub(super) fn at(&self, e: f64) -> Extremal {
        let (n, y) = if e <= self.drop { (e, e * e) } else { (self.drop, self.drop * (2.0 * e - self.drop)) };
        let gain = y + self.c;
        let root = sqrt(gain);
        let (x, t_peak) = if root <= self.a_max {
            (root, 2.0 * root)
        } else {
            (self.a_max, self.a_max + gain / self.a_max)
        };
        let w = self.v_last + y;
        let p = if e < 0.0 {
            self.displacement_of_short(x, n, t_peak - 2.0 * x)
        } else {
            0.5 * (self.v_first + w) * t_peak + (w + self.v_last) * e + self.k
        };
        Extremal {
            e,
            x,
            n,
            t_peak,
            w,
            cruise: 0.0,
            p,
            t: t_peak + 2.0 * e + (self.af - self.a0),
            slope: w + 0.5 * x * n,
        }
    }

    /// The displacement, piece by piece, where the acceleration stays above zero: such a motion may be much shorter than the rises drawn out to
    /// zero acceleration, and would drown in their rounding.
    #[cold]
    #[inline(never)]
    fn displacement_of_short(&self, x: f64, n: f64, hold: f64) -> f64 {
        let Self { v0, a0, af, .. } = *self;
        let (rise, fall, last) = (x - a0, x + n, n + af);
        let v1 = v0 + 0.5 * rise * (a0 + x);
        let v2 = v1 + hold * x;
        let v3 = v2 + 0.5 * fall * (x - n);
        rise * (v0 + rise * (2.0 * a0 + x) * SIXTH)
            + hold * (v1 + 0.5 * hold * x)
            + fall * (v2 + fall * (2.0 * x - n) * SIXTH)
            + last * (v3 + last * (af - 2.0 * n) * SIXTH)
    }

    /// Where the main arc starts: the shortest time from which on every time is possible.
    #[inline]
    pub(super) fn at_start(&self) -> Extremal {
        self.at(self.start)
    }

    /// The start's motion, longer by the time `more`, as it would be if the velocities were others by up to `noise`.
    #[cold]
    pub(super) fn moved_start(&self, start: &Extremal, more: f64, noise: f64) -> Option<Extremal> {
        moved(start, self.start > -self.af, more, noise)
    }

    /// Likewise the motion at that end of the island for which `more` asks for the smaller part of what is allowed.
    #[cold]
    pub(super) fn moved_island(&self, more: impl Fn(&Extremal) -> f64, noise: f64) -> Option<Extremal> {
        let (first, last) = self.island()?;
        moved(&last, true, more(&last), noise).or_else(|| moved(&first, false, more(&first), noise))
    }

    /// First and last motion of the island, an interval of possible times before the main arc.
    pub(super) fn island(&self) -> Option<(Extremal, Extremal)> {
        self.island.map(|(first, last)| (self.at(first), self.at(last)))
    }

    /// The motion whose peak velocity is the limit.
    #[inline]
    pub(super) fn at_velocity_limit(&self) -> Extremal {
        let y = larger(self.v_max - self.v_last, 0.0);
        let limited = self.at(larger(self.parameter(y, sqrt(y)), self.start));
        Extremal { w: self.v_max, ..limited }
    }

    /// The motion that takes the time `t`, which must be possible; within the velocity limit.
    #[inline]
    pub(super) fn at_duration(&self, t: f64, on_island: bool) -> Extremal {
        let e = self.parameter_at_duration(t);
        let extremal = match self.island {
            Some((first, last)) if on_island => return self.at(between(e, first, last)),
            _ => self.at(larger(e, self.start)),
        };
        // Where the acceleration stays above zero the velocity rises throughout, and w is never reached.
        if extremal.e < 0.0 || extremal.w <= self.v_max {
            return extremal;
        }
        let mut limited = self.at_velocity_limit();
        limited.lengthen(larger(t - limited.t, 0.0));
        limited
    }

    /// The closed-form inverse of the duration, piece by piece.
    #[inline]
    fn parameter_at_duration(&self, t: f64) -> f64 {
        let t = t - (self.af - self.a0); // of peak and valley, both drawn out to zero acceleration
        let s = 0.5 * t;
        if s <= 0.0 {
            return 0.0;
        }
        let (mut x, mut n) = (0.5 * (s + self.c / s), 0.5 * (s - self.c / s));
        if x > self.a_max {
            x = self.a_max;
            n = sqrt(larger(x * t - self.c, 0.0)) - x;
        }
        if n <= self.drop {
            return n;
        }
        let m = self.drop;
        x = sqrt(m * t + self.c) - m;
        let gain = if x > self.a_max {
            (t - self.a_max - m + self.c / m) / (1.0 / self.a_max + 1.0 / m)
        } else {
            x * x
        };
        0.5 * (m + (gain - self.c) / m)
    }

    /// The first motion beyond `from` on the main arc that gets as far as `p`; `from` itself gets less far.
    pub(super) fn first_reaching(&self, p: f64, from: &Extremal, resolution: f64) -> Extremal {
        if from.e < 0.0
            && let Some(extremal) = self.first_on_hump(p, from, 0.0, resolution)
        {
            return extremal;
        }
        let mut highest = f64::INFINITY;
        if self.v_max < f64::INFINITY {
            let mut limited = self.at_velocity_limit();
            if p >= limited.p {
                limited.lengthen((p - limited.p) / self.v_max.abs()); // for ever if that is zero, of either sign
                return limited;
            }
            highest = limited.e;
        }
        if let Some(saturated) = self.both_saturated(p, highest) {
            return saturated;
        }
        self.solve(p, from.e, highest, smaller(self.bound(p), highest))
    }

    /// The first motion beyond `from` on the island that gets as far as `p`, if there is one; `from` itself gets less far.
    pub(super) fn first_reaching_on_island(
        &self,
        p: f64,
        from: &Extremal,
        resolution: f64,
    ) -> Option<Extremal> {
        let (_, last) = self.island?;
        if let Some(extremal) = self.first_on_hump(p, from, last, resolution) {
            return Some(extremal);
        }
        let end = self.at(last);
        if end.p >= p {
            Some(self.solve(p, from.e, last, last))
        } else {
            (end.p >= p - resolution).then_some(end)
        }
    }

    /// Before the displacement falls and rises for good it may rise once, with the acceleration above zero throughout.
    /// The first motion that gets as far as `p` on that rise, between `from` and the parameter `last` ≤ 0.
    fn first_on_hump(&self, p: f64, from: &Extremal, last: f64, resolution: f64) -> Option<Extremal> {
        if from.slope <= 0.0 {
            return None;
        }
        let top = self.at(self.hump(from.e, last)?);
        if p >= top.p - resolution {
            // At the top two arrivals merge into one, and rounding must not lose both.
            return (p <= top.p + resolution).then_some(top);
        }
        Some(self.solve(p, from.e, top.e, 0.5 * (from.e + top.e)))
    }

    /// Where between two parameters ≤ 0 the displacement has its first maximum.
    fn hump(&self, first: f64, last: f64) -> Option<f64> {
        // Peak at its limit: slope n² + n a_max/2 + v⁺ = 0, the root from above to below zero.
        let border = -sqrt(larger(self.a_max * self.a_max - self.c, 0.0));
        if first < border {
            let half = self.a_max / 4.0;
            let discriminant = half * half - self.v_last;
            if discriminant > 0.0 {
                let n = -half - sqrt(discriminant);
                if n <= border && n > first && n <= last {
                    return Some(n);
                }
            }
        }
        // Neither at its limit: 3 s⁴ + 4 V s² + C² = 0 with s = x + n, the smaller root.
        let v = self.v_first + self.v_last;
        let discriminant = 4.0 * v * v - 3.0 * self.c * self.c;
        if v >= 0.0 || discriminant <= 0.0 || self.c <= 0.0 {
            return None;
        }
        let s = self.c / sqrt(sqrt(discriminant) - 2.0 * v);
        let n = 0.5 * (s - self.c / s);
        (n > first && n <= last).then_some(n)
    }

    /// Where peak and valley are both at their limits the displacement is quadratic in w: dp/dt = w − a m/2, and
    /// dt/dw = 1/a + 1/m.
    fn both_saturated(&self, p: f64, highest: f64) -> Option<Extremal> {
        let (a, m) = (self.a_max, self.drop);
        let y = larger(m * m, a * a - self.c);
        let e = 0.5 * (m + y / m);
        if !(e < highest && e < f64::INFINITY) {
            return None;
        }
        let node = self.at(e);
        if node.p > p {
            return None;
        }
        let g = node.slope;
        let q = 2.0 * (p - node.p) / (1.0 / a + 1.0 / m);
        let root = sqrt(g * g + q);
        let more = if g > 0.0 { q / (g + root) } else { root - g }; // of w
        Some(self.at(smaller(e + 0.5 * more / m, highest)))
    }

    /// A parameter ≥ 0 beyond which the displacement is above `p`, within a small factor of the least.
    ///
    /// Without acceleration limits p = s³/4 + V s − C²/(4 s) + K with s = x + n ≥ √C; limits only add displacement once
    /// the velocity is forward throughout.
    #[inline]
    fn bound(&self, p: f64) -> f64 {
        let v = self.v_first + self.v_last;
        let root_c = sqrt(self.c);
        let q = p - self.k + 0.25 * self.c * root_c;
        let mut s = if q > 0.0 { cbrt(4.0 * q) } else { 0.0 };
        if v < 0.0 {
            s += 2.0 * sqrt(-v);
        } else if s * v > q {
            s = q / v;
        }
        let mut y = 0.0;
        if s > root_c {
            let n = 0.5 * (s - self.c / s);
            y = n * n;
        }
        let y = larger(y, -self.v_first - self.v_last);
        self.parameter(y, sqrt(y))
    }

    /// The rising root of the displacement between two parameters.
    ///
    /// From the right of the root Newton's method needs no bracket where the displacement is convex; the bracket is
    /// for humps and rounding.
    fn solve(&self, p: f64, mut low: f64, mut high: f64, start: f64) -> Extremal {
        let mut now = self.at(larger(start, low));
        let mut low_is_tried = false;
        for _ in 0..MAX_STEPS {
            let excess = now.p - p;
            if excess.abs() <= ROUNDING * p.abs() {
                break;
            }
            if excess > 0.0 {
                high = now.e;
            } else {
                (low, low_is_tried) = (now.e, true);
            }
            // dp/de = slope · dt/de, and dt/de = 2 (1 + n/x).
            let step = excess * now.x / (2.0 * now.slope * (now.x + now.n));
            // Near the bracket's start rounding may lead before it; the root may be the start itself. Once that is known not to be so, the step
            // has come from where the displacement is not convex.
            let mut next = now.e - step;
            if next < low && now.e > low && !low_is_tried {
                next = low;
            }
            let inside = next >= low && next <= high;
            if !inside {
                next = if high < f64::INFINITY { 0.5 * (low + high) } else { 2.0 * now.e + now.x };
            }
            let moved = (next - now.e).abs();
            now = self.at(next);
            if inside && moved <= LAST_STEP * (now.x + now.n) {
                break;
            }
        }
        now
    }

    /// Peak, valley and holds in the order of time.
    pub(super) fn shape(&self, extremal: &Extremal) -> Shape {
        let Extremal { x, n, .. } = *extremal;
        let hold_x = larger(extremal.t_peak - 2.0 * x, 0.0);
        let hold_n = larger(2.0 * (extremal.e - n), 0.0);
        let (cruise, velocity) = (extremal.cruise, extremal.w);
        if self.reversed {
            Shape { peak: n, peak_hold: hold_n, cruise, velocity, valley: x, valley_hold: hold_x }
        } else {
            Shape { peak: x, peak_hold: hold_x, cruise, velocity, valley: n, valley_hold: hold_n }
        }
    }
}

/// A motion whose first rise, or its last, has no duration, longer by the time `more`, as it would be if the velocities were others by up
/// to `noise`.
///
/// By what is added to the velocities goes 1/n or 1/x of it to the time of the valley, or of the peak; no more than its root where
/// that is zero.
fn moved(motion: &Extremal, first_is_none: bool, more: f64, noise: f64) -> Option<Extremal> {
    let turning = if first_is_none { motion.n.abs() } else { motion.x };
    // Not a number where the slope is zero.
    if more.is_nan() || more.abs() > noise / larger(turning, sqrt(noise)) {
        return None;
    }
    let mut moved = Extremal { p: motion.p + motion.slope * more, t: motion.t + more, ..*motion };
    let half = 0.5 * more;
    if first_is_none {
        moved.e += half;
        moved.n = if motion.e > motion.n { motion.n } else { moved.e };
    } else {
        moved.t_peak += more;
        moved.x = if motion.t_peak > 2.0 * motion.x { motion.x } else { motion.x + half };
    }
    Some(moved)
}

impl Extremal {
    /// Adds time at the peak velocity.
    #[inline]
    fn lengthen(&mut self, time: f64) {
        self.cruise += time;
        self.t += time;
        self.p += self.w * time;
        self.slope = self.w;
    }
}
