//! What the joints' limits permit the rate at one instant: an interval for its slope and one for its curvature.

use super::super::lookahead::{Between, JointMotion};
use super::RateLimits;

/// Share of a limit that changes of the rate may use: interpolating between samples adds up to 0.4 % to an acceleration where the plan
/// itself does not use the whole limit, and 0.6 % to a jerk, of which the envelope grants 1 %.
const ACCELERATION_SHARE: f64 = 0.996;
const JERK_SHARE: f64 = 0.998;
/// Bound on the curvature: where nothing moves, a full change of the rate still takes about 4 ms.
const CURVATURE_MAX: f64 = 2.5e5;

/// The numbers from `low` to `high`; none where `low` > `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Interval {
    const ALL: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
    const NONE: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    /// All x with |fixed + factor·x| ≤ bound, from the factor's inverse.
    fn within(fixed: f64, inverse: f64, bound: f64) -> Self {
        if !inverse.is_finite() {
            return if fixed.abs() <= bound { Self::ALL } else { Self::NONE };
        }
        let (a, b) = ((-bound - fixed) * inverse, (bound - fixed) * inverse);
        Self { low: a.min(b), high: a.max(b) }
    }

    fn and(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    pub(super) fn contains(&self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// Whether x is in it, or beside it by less than a 500th of its width.
    pub(super) fn nearly_contains(&self, x: f64) -> bool {
        let slack = 0.002 * (self.high - self.low);
        self.low - slack <= x && x <= self.high + slack
    }

    /// The number nearest to x in it; one of its ends where it is empty.
    pub(super) fn nearest(&self, x: f64) -> f64 {
        x.max(self.low).min(self.high)
    }

    /// The end in a direction (positive or negative).
    pub(super) fn end(&self, direction: f64) -> f64 {
        if direction > 0.0 { self.high } else { self.low }
    }
}

/// Slopes that keep all accelerations, and curvatures that keep all jerks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub(super) slope: Interval,
    pub(super) curvature: Interval,
}

impl Bounds {
    /// At rate r with slope c. A constant rate (c = 0, u = 0) is always within: what the plan itself uses is allowed.
    pub(super) fn at<const N: usize>(
        between: &Between<'_, N>,
        r: f64,
        c: f64,
        limits: &RateLimits<N>,
    ) -> Self {
        let mut slope = Interval::ALL;
        let mut curvature = Interval { low: -CURVATURE_MAX, high: CURVATURE_MAX };
        for k in 0..=N {
            let axis = between.axis(k, limits);
            let inverse = 1.0 / axis.velocity;
            let planned = axis.acceleration * r * r;
            let bound = (ACCELERATION_SHARE * axis.acceleration_limit).max(planned.abs());
            slope = slope.and(Interval::within(planned, inverse, bound));
            for jerk in axis.jerk {
                let planned = jerk * r * r * r;
                let bound = (JERK_SHARE * axis.jerk_limit).max(planned.abs());
                let fixed = planned + 3.0 * axis.acceleration * r * c;
                curvature = curvature.and(Interval::within(fixed, inverse, bound));
            }
        }
        Self { slope, curvature }
    }

    /// The curvature farthest in a direction that keeps the jerks now, and the accelerations a `time` later, judged by
    /// the motion here; `None` where there is none.
    pub(super) fn farthest(&self, direction: f64, c: f64, time: f64) -> Option<f64> {
        let jerks = direction * self.curvature.end(direction);
        let accelerations = direction * (self.slope.end(direction) - c) / time;
        let farthest = direction * jerks.min(accelerations);
        self.curvature.contains(farthest).then_some(farthest)
    }
}

/// One axis between two samples: a joint, or the path coordinate.
#[derive(Debug, Clone, Copy)]
struct Axis {
    velocity: f64,
    acceleration: f64,
    /// Of both samples: between them it may switch.
    jerk: [f64; 2],
    acceleration_limit: f64,
    jerk_limit: f64,
}

impl<const N: usize> Between<'_, N> {
    /// Joint `k`, or with k = N the path coordinate.
    fn axis(&self, k: usize, limits: &RateLimits<N>) -> Axis {
        let pick = |sample: &JointMotion<N>| {
            if k < N {
                (sample.velocity[k], sample.acceleration[k], sample.jerk[k])
            } else {
                (sample.path.velocity, sample.path.acceleration, sample.path.jerk)
            }
        };
        let (left, right) = (pick(self.left), pick(self.right));
        let (acceleration_limit, jerk_limit) = if k < N {
            (limits.acceleration[k], limits.jerk[k])
        } else {
            let (left, right) = (&self.left.path, &self.right.path);
            (left.acceleration_limit.min(right.acceleration_limit), left.jerk_limit.min(right.jerk_limit))
        };
        Axis {
            velocity: left.0 + (right.0 - left.0) * self.fraction,
            acceleration: self.acceleration((left.1, left.2), (right.1, right.2)),
            jerk: [left.2, right.2],
            acceleration_limit,
            jerk_limit,
        }
    }

    /// From acceleration and jerk of both samples; exact where the jerk is constant but for one switch between them.
    fn acceleration(&self, left: (f64, f64), right: (f64, f64)) -> f64 {
        let from_left = left.0 + left.1 * self.fraction * self.spacing;
        let from_right = right.0 - right.1 * (1.0 - self.fraction) * self.spacing;
        if left.1 > right.1 { from_left.min(from_right) } else { from_left.max(from_right) }
    }
}
