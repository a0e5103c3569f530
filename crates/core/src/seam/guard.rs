//! Control points that keep slope, third derivative and bound, whatever is asked.
//!
//! The last three points fix position d, first difference e and second difference f. A next point is accepted only if its third
//! difference is small enough and a *way to rest* exists from there inside all bounds; that way is kept at hand, and followed where
//! nothing else is accepted. So every point has a successor, by construction.
//!
//! The way to rest has two parts: f goes to zero in n = ⌈|f|/γ⌉ equal steps, then e in a triangle of f, up and down in m = ⌈√(|e|/γ)⌉
//! steps each. In closed form it ends at d + ne + f(n² − 1)/3 + (m − 1)e₁ with e₁ = e + f(n − 1)/2 the first difference in between.

use super::Offset;
use crate::math::float::{ceil, sqrt};

/// Halvings towards what was asked.
const HALVINGS: usize = 5;

/// What the control points keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Greatest offset in each direction.
    pub(super) offset: f64,
    /// Greatest first difference in each direction.
    pub(super) step: f64,
    /// Greatest length of the third difference.
    pub(super) third: f64,
}

/// The last three points, and the way to rest from them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Guard {
    bounds: Bounds,
    /// Newest first.
    points: [Offset; 3],
    rest: [WayToRest; 2],
}

/// Second differences that bring one axis to rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct WayToRest {
    /// Steps until the second difference is zero, and what each adds to it.
    level: f64,
    level_change: f64,
    /// Steps of the triangle's two sides, and what each step of the first adds.
    side: f64,
    change: f64,
    taken: f64,
}

impl WayToRest {
    /// From a state, if it stays inside. `third` is this axis's share.
    fn from(d: f64, e: f64, f: f64, bounds: &Bounds, third: f64) -> Option<Self> {
        let n = ceil(f.abs() / third);
        let (level_change, e1) = if n > 0.0 { (-f / n, e + 0.5 * f * (n - 1.0)) } else { (0.0, e) };
        let level_end = if n > 0.0 { d + n * e + f * (n * n - 1.0) / 3.0 } else { d };
        let m = ceil(sqrt(e1.abs() / third));
        let change = if m > 0.0 { -e1 / (m * m) } else { 0.0 };
        let end = level_end + if m > 0.0 { (m - 1.0) * e1 } else { 0.0 };
        // Where the direction turns on the way, no farther than all steps at the first rate.
        let turn = if e * e1 < 0.0 { d + n * e } else { d };
        let inside = [d, level_end, end, turn].iter().all(|place| place.abs() <= bounds.offset)
            && e.abs() <= bounds.step
            && e1.abs() <= bounds.step;
        inside.then_some(Self { level: n, level_change, side: m, change, taken: 0.0 })
    }

    /// The next position, from the last three (newest first).
    fn next(&mut self, [d0, d1, d2]: [f64; 3]) -> f64 {
        if self.taken >= self.level + 2.0 * self.side {
            return d0;
        }
        let step = self.taken - self.level;
        self.taken += 1.0;
        let change = if step < 0.0 {
            self.level_change
        } else if step < self.side {
            self.change
        } else {
            -self.change
        };
        d0 + (d0 - d1) + (d0 - 2.0 * d1 + d2) + change
    }
}

impl Guard {
    /// At rest at an offset inside the bounds.
    pub(super) fn at_rest(bounds: Bounds, offset: Offset) -> Self {
        Self { bounds, points: [offset; 3], rest: [WayToRest::default(); 2] }
    }

    /// The last points, newest first.
    pub(super) fn points(&self) -> &[Offset; 3] {
        &self.points
    }

    /// The third difference that a next point would make.
    pub(super) fn third(&self, next: &Offset) -> Offset {
        let [d0, d1, d2] = self.points;
        next - d0 * 3.0 + d1 * 3.0 - d2
    }

    /// The next control point: what is asked, or as far towards it from the way to rest as is safe. And whether it is what was asked.
    pub(super) fn next(&mut self, asked: Offset) -> (Offset, bool) {
        let mut ways = self.rest;
        let axis = |axis: usize| self.points.map(|point| point[axis]);
        let safe = Offset::new(ways[0].next(axis(0)), ways[1].next(axis(1)));
        let mut share = 1.0;
        for _ in 0..=HALVINGS {
            let candidate = if share == 1.0 { asked } else { safe + (asked - safe) * share };
            if let Some(rest) = self.accept(&candidate) {
                self.take(candidate, rest);
                return (candidate, share == 1.0);
            }
            share *= 0.5;
        }
        self.take(safe, ways);
        (safe, false)
    }

    fn accept(&self, next: &Offset) -> Option<[WayToRest; 2]> {
        let third = self.third(next).norm();
        if third.is_nan() || third > self.bounds.third {
            return None;
        }
        let [d0, d1, _] = self.points;
        let (e, f) = (next - d0, next - d0 * 2.0 + d1);
        let share = self.bounds.third * core::f64::consts::FRAC_1_SQRT_2;
        let way = |axis: usize| WayToRest::from(next[axis], e[axis], f[axis], &self.bounds, share);
        Some([way(0)?, way(1)?])
    }

    fn take(&mut self, point: Offset, rest: [WayToRest; 2]) {
        let [d0, d1, _] = self.points;
        self.points = [point, d0, d1];
        self.rest = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: Bounds = Bounds { offset: 1.0, step: 0.05, third: 0.004 };

    /// A small generator, so that a seed names a case.
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 33) as f64 / (1_u64 << 30) as f64 - 1.0
    }

    /// Followed by NaN and by wild demands, from 20,000 states: every point keeps all bounds, and NaN ends at rest.
    #[test]
    fn whatever_is_asked_the_bounds_are_kept() {
        let mut state = 3;
        let mut guard = Guard::at_rest(BOUNDS, Offset::new(0.3, -0.9));
        for run in 0..20_000 {
            let level = Offset::new(random(&mut state), random(&mut state)) * 1.5;
            for _ in 0..run % 40 {
                let before = guard;
                let noise = Offset::new(random(&mut state), random(&mut state)) * 0.1;
                let (next, _) = guard.next(level + noise);
                assert_kept(&before, &next);
            }
            if run % 10 == 0 {
                // At most n + 2m steps, of which the bounds leave this many.
                for _ in 0..40 {
                    let before = guard;
                    let (next, as_asked) = guard.next(Offset::new(f64::NAN, 0.0));
                    assert!(!as_asked);
                    assert_kept(&before, &next);
                }
                let [d0, d1, d2] = *guard.points();
                assert!(d0 == d1 && d1 == d2, "{guard:?}");
            }
        }
    }

    fn assert_kept(before: &Guard, next: &Offset) {
        let rounding = 1e-13;
        assert!(next.amax() <= BOUNDS.offset + rounding, "{before:?} {next}");
        assert!((next - before.points()[0]).amax() <= BOUNDS.step + rounding, "{before:?} {next}");
        assert!(before.third(next).norm() <= BOUNDS.third + rounding, "{before:?} {next}");
    }

    #[test]
    fn what_is_smooth_passes_as_it_is() {
        let mut guard = Guard::at_rest(BOUNDS, Offset::zeros());
        for k in 0..500 {
            // Third difference about 0.5·0.1³, step 0.05.
            let asked = Offset::new(0.25 * (1.0 - (0.1 * f64::from(k)).cos()), 0.0);
            assert_eq!(guard.next(asked), (asked, true), "{k}");
        }
    }
}
