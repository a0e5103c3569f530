//! The way back to a constant rate: the slope goes to zero as fast as the limits permit at each instant.

use super::super::lookahead::Lookahead;
use super::RateLimits;
use super::bounds::Bounds;

/// Steps of a recovery at most, one sample spacing each.
const STEPS: usize = 64;
/// How often a step's curvature is fitted to what is permitted at the step's end.
const CORRECTIONS: usize = 3;

/// Programme time with its rate r and slope c at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Instant {
    pub(super) time: f64,
    pub(super) r: f64,
    pub(super) c: f64,
}

impl Instant {
    /// A `time` later under a constant curvature.
    pub(super) fn after(&self, time: f64, curvature: f64) -> Self {
        Self {
            time: self.time + time * (self.r + time * (self.c / 2.0 + time * curvature / 6.0)),
            r: self.r + time * (self.c + time * curvature / 2.0),
            c: self.c + time * curvature,
        }
    }

    /// What the limits permit here; `None` beyond the samples.
    pub(super) fn bounds<const N: usize>(
        &self,
        ahead: &Lookahead<N>,
        limits: &RateLimits<N>,
    ) -> Option<Bounds> {
        Some(Bounds::at(&ahead.around(self.time)?, self.r, self.c, limits))
    }

    /// One step with the slope towards zero: the curvature, the instant after it, and what is permitted there.
    fn towards_zero<const N: usize>(
        &self,
        direction: f64,
        here: &Bounds,
        ahead: &Lookahead<N>,
        limits: &RateLimits<N>,
    ) -> Option<(f64, Self, Bounds)> {
        let step = ahead.spacing();
        let to_zero = -self.c / step;
        let farthest = here.farthest(direction, self.c, step)?;
        let farthest = if direction > 0.0 { to_zero.min(farthest) } else { to_zero.max(farthest) };
        let mut u = here.curvature.nearest(farthest);
        for _ in 0..=CORRECTIONS {
            let mut next = self.after(step, u);
            let there = next.bounds(ahead, limits)?;
            if there.curvature.nearly_contains(u) {
                if u == to_zero {
                    next.c = 0.0;
                }
                return here.curvature.contains(u).then_some((u, next, there));
            }
            // What is permitted at the end depends on where that is, but only weakly.
            u = there.curvature.nearest(u);
        }
        None
    }
}

/// Curvatures, one a step, after which the slope is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Recovery {
    curvature: [f64; STEPS],
    steps: usize,
    /// The constant rate at its end.
    end: f64,
}

impl Recovery {
    /// Nothing to recover from: the rate is constant.
    pub(super) fn none(rate: f64) -> Self {
        Self { curvature: [0.0; STEPS], steps: 0, end: rate }
    }

    /// From an instant, if a recovery within all limits exists on the samples ahead.
    ///
    /// In each step the slope goes towards zero as fast as the jerks at both its ends permit, but no farther than the
    /// accelerations do. It never changes its sign, so that the rate stays between those at both ends.
    /// Cost: at most 64 steps of four looks at all axes, mostly one or two.
    pub(super) fn from<const N: usize>(
        mut now: Instant,
        ahead: &Lookahead<N>,
        limits: &RateLimits<N>,
    ) -> Option<Self> {
        let mut way = Self::none(now.r);
        let direction = -now.c.signum();
        let mut here = now.bounds(ahead, limits)?;
        for curvature in &mut way.curvature {
            if now.c == 0.0 {
                break;
            }
            let (u, next, there) = now.towards_zero(direction, &here, ahead, limits)?;
            if next.c * direction > 0.0 || !there.slope.contains(next.c) {
                return None;
            }
            *curvature = u;
            way.steps += 1;
            (now, here) = (next, there);
        }
        way.end = now.r;
        (now.c == 0.0).then_some(way)
    }

    /// The constant rate at its end.
    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// The curvature of a step; `None` after the last.
    pub(super) fn curvature(&self, step: usize) -> Option<f64> {
        self.curvature.get(..self.steps)?.get(step).copied()
    }
}
