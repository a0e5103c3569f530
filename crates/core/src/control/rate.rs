//! The rate at which programme time runs: override, pause and controlled stop.
//!
//! With the joints q(τ) and programme time τ(t), rate r = τ̇ and slope c = ṙ, the joints move with
//!
//! ```text
//! q̇ = q′ r        q̈ = q″ r² + q′ c        q⃛ = q‴ r³ + 3 q″ r c + q′ u,   u = ċ
//! ```
//!
//! and the path coordinate likewise, as one more axis with the cell's limits for the tool.
//!
//! The planned motion keeps every limit at r = 1, so that any *constant* r ≤ 1 keeps them too. The slope is what must
//! be watched. At every instant a way back to a constant rate is at hand, already checked against the motion ahead:
//! the slope goes linearly to zero within `recovery`. In each cycle the strongest change of u is looked for, for which
//! such a way exists again; where none is found, the way at hand is followed. So there is always an answer.

use super::lookahead::{Between, JointMotion, Lookahead};

/// Limits of the joints, per axis, all positive: velocity is kept by the plan, since r ≤ 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RateLimits<const N: usize> {
    pub(super) acceleration: [f64; N],
    pub(super) jerk: [f64; N],
}

/// Share of a limit that changes of the rate may use, so that interpolating between samples cannot pass the limit.
const ACCELERATION_SHARE: f64 = 0.99;
const JERK_SHARE: f64 = 0.98;
/// Bound on u: where nothing moves, a full change of the rate still takes about 4 ms.
const CURVATURE_MAX: f64 = 2.5e5;
/// Rates closer than this are one.
const SAME_RATE: f64 = 1e-9;
/// Recoveries that are tried, shortest first, in samples of the look-ahead.
const RECOVERIES: [u8; 13] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 40, 52, 64];
/// Shares of the strongest change that are tried, in this order.
const SHARES: [f64; 5] = [1.0, 0.7, 0.4, 0.2, 0.05];

/// The rate and its slope, with the way back to a constant rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rate {
    value: f64,
    slope: f64,
    /// Time in which the slope goes linearly to zero, unless something better is found.
    recovery: f64,
}

impl Rate {
    /// A constant rate in [0, 1].
    pub(super) fn constant(value: f64) -> Self {
        Self { value, slope: 0.0, recovery: 0.0 }
    }

    /// τ̇, 0 … 1.
    pub(super) fn value(&self) -> f64 {
        self.value
    }

    /// τ̈ in 1/s.
    pub(super) fn slope(&self) -> f64 {
        self.slope
    }

    /// Programme time stands still.
    pub(super) fn is_stopped(&self) -> bool {
        self.value == 0.0 && self.slope == 0.0
    }

    /// One cycle on towards `goal` (0 … 1), from programme time `now`; returns by how much programme time advances.
    ///
    /// Cost: at most `RECOVERIES × SHARES` checks of at most 64 samples, usually one or two, and none at the goal.
    pub(super) fn advance<const N: usize>(
        &mut self,
        goal: f64,
        now: f64,
        ahead: &Lookahead<N>,
        limits: &RateLimits<N>,
        period: f64,
    ) -> f64 {
        let better = self.search(goal, now, ahead, limits, period);
        let (curvature, recovery) = better.unwrap_or_else(|| {
            let curvature = if self.recovery > 0.0 { -self.slope / self.recovery } else { 0.0 };
            (curvature, self.recovery - period)
        });
        let advance = self.integral(curvature, period);
        self.value += self.slope * period + curvature * period * period / 2.0;
        self.slope += curvature * period;
        self.recovery = recovery;
        if recovery < period * 0.5 {
            (self.slope, self.recovery) = (0.0, 0.0);
        }
        if self.slope == 0.0 && (self.value - goal).abs() < SAME_RATE {
            self.value = goal;
        }
        // Rounding must not run time backwards or above full speed.
        self.value = self.value.clamp(0.0, 1.0);
        advance.max(0.0)
    }

    /// The strongest change of the slope towards the goal from which a recovery exists: (curvature, recovery).
    fn search<const N: usize>(
        &self,
        goal: f64,
        now: f64,
        ahead: &Lookahead<N>,
        limits: &RateLimits<N>,
        period: f64,
    ) -> Option<(f64, f64)> {
        let missing = goal - (self.value + self.slope * self.recovery / 2.0);
        if missing.abs() < SAME_RATE {
            return None;
        }
        let here = ahead.around(now)?;
        let strongest = self.strongest(missing.signum(), &here, limits, period);
        if strongest * missing <= 0.0 {
            return None;
        }
        for share in SHARES {
            for samples in RECOVERIES {
                let recovery = f64::from(samples) * ahead.spacing();
                // The curvature with which this recovery ends exactly at the goal.
                let landing = (goal - self.value - self.slope * (period + recovery / 2.0))
                    / (period * (period + recovery) / 2.0);
                let most = share * strongest;
                let curvature = if most > 0.0 { landing.min(most) } else { landing.max(most) };
                let overshoots = landing * missing < 0.0;
                if !overshoots && self.recovers(curvature, samples, now, ahead, limits, period) {
                    return Some((curvature, recovery));
                }
            }
        }
        None
    }

    /// The largest u in a direction (+1, −1) that the jerk limits now and the acceleration limits one cycle on allow.
    fn strongest<const N: usize>(
        &self,
        direction: f64,
        here: &Between<'_, N>,
        limits: &RateLimits<N>,
        period: f64,
    ) -> f64 {
        let r = self.value;
        let mut strongest = CURVATURE_MAX;
        for axis in 0..=N {
            let motion = here.axis(axis, limits);
            let velocity = direction * motion.velocity;
            if velocity == 0.0 {
                continue;
            }
            // Both limits read |fixed + velocity·x| ≤ bound for x = direction·u ≥ 0: the nearer end counts.
            let most = |fixed: f64, bound: f64| (bound - fixed * velocity.signum()) / velocity.abs();
            let acceleration = motion.acceleration * r * r;
            let bound = (ACCELERATION_SHARE * motion.acceleration_limit).max(acceleration.abs());
            let slope = direction * self.slope;
            strongest = strongest.min((most(acceleration, bound) - slope) / period);
            for planned in motion.jerk {
                let planned = planned * r * r * r;
                let bound = (JERK_SHARE * motion.jerk_limit).max(planned.abs());
                let fixed = planned + 3.0 * motion.acceleration * r * self.slope;
                strongest = strongest.min(most(fixed, bound));
            }
        }
        direction * strongest
    }

    /// Programme time that passes in `time` under constant curvature.
    fn integral(&self, curvature: f64, time: f64) -> f64 {
        time * (self.value + time * (self.slope / 2.0 + time * curvature / 6.0))
    }

    /// Whether all limits hold if `curvature` acts for one period and the slope then goes linearly to zero.
    fn recovers<const N: usize>(
        &self,
        curvature: f64,
        samples: u8,
        now: f64,
        ahead: &Lookahead<N>,
        limits: &RateLimits<N>,
        period: f64,
    ) -> bool {
        let within = |time: f64, r: f64, c: f64, u: f64| {
            ahead.around(time).is_some_and(|between| between.keeps(r, c, u, limits))
        };
        let start = now + self.integral(curvature, period);
        let r = self.value + self.slope * period + curvature * period * period / 2.0;
        let c = self.slope + curvature * period;
        let recovery = f64::from(samples) * ahead.spacing();
        let back = -c / recovery;
        let end = r + c * recovery / 2.0;
        if !(-SAME_RATE..=1.0 + SAME_RATE).contains(&end) || !within(start, r, c, curvature) {
            return false;
        }
        (0..=samples).all(|k| {
            let t = f64::from(k) * ahead.spacing();
            let time = start + r * t + c * t * t / 2.0 + back * t * t * t / 6.0;
            within(time, r + c * t + back * t * t / 2.0, c + back * t, back)
        })
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

    /// Whether rate r with slope c and curvature u keeps acceleration and jerk of every axis here. What the plan itself
    /// uses is always allowed: a constant rate below 1 is.
    fn keeps(&self, r: f64, c: f64, u: f64, limits: &RateLimits<N>) -> bool {
        (0..=N).all(|k| {
            let axis = self.axis(k, limits);
            let planned = axis.acceleration * r * r;
            let bound = (ACCELERATION_SHARE * axis.acceleration_limit).max(planned.abs());
            (planned + axis.velocity * c).abs() <= bound
                && axis.jerk.into_iter().all(|jerk| {
                    let planned = jerk * r * r * r;
                    let bound = (JERK_SHARE * axis.jerk_limit).max(planned.abs());
                    (planned + 3.0 * axis.acceleration * r * c + axis.velocity * u).abs() <= bound
                })
        })
    }
}

#[cfg(test)]
mod tests;
