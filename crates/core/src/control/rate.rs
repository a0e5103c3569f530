//! The rate at which programme time runs: override, pause and controlled stop.
//!
//! With the joints q(τ) and programme time τ(t), rate r = τ̇ and slope c = ṙ, the joints move with
//!
//! ```text
//! q̇ = q′ r        q̈ = q″ r² + q′ c        q⃛ = q‴ r³ + 3 q″ r c + q′ u,   u = ċ
//! ```
//!
//! and the path coordinate likewise, as one more axis with the cell's limits for the tool. At each instant the limits
//! are thus an interval for c and, with c known, an interval for u.
//!
//! The planned motion keeps every limit at r = 1, so that any *constant* r ≤ 1 keeps them too. The slope is what must
//! be watched. At every instant a recovery is at hand, a way back to a constant rate that is already checked against
//! the motion ahead. In each cycle the strongest change of u is looked for, after which a recovery exists again and
//! ends nearer to the goal; where there is none, the one at hand is followed. So there is always an answer.
//!
//! The recovery is what decides how soon the arm stands: a slope is only taken if it can be taken back. It therefore
//! goes at each step as fast towards zero as the joints permit there, not evenly, since the least u on the way
//! would then set the pace of all of it.

use super::lookahead::Lookahead;
use recovery::{Instant, Recovery};

mod bounds;
mod recovery;

/// Limits of the joints, per axis, all positive. Velocity is kept by the plan, since r ≤ 1; corrections of it are held against it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RateLimits<const N: usize> {
    pub(super) velocity: [f64; N],
    pub(super) acceleration: [f64; N],
    pub(super) jerk: [f64; N],
}

/// Rates closer than this are one.
const SAME_RATE: f64 = 1e-9;
/// Curvatures that are tried in one cycle.
const TRIALS: usize = 7;

/// The rate and its slope, with the way back to a constant rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rate {
    value: f64,
    slope: f64,
    /// What happens unless something better is found.
    recovery: Recovery,
    /// Cycles for which it has been followed.
    followed: usize,
}

/// What a cycle looks at: the motion ahead, the limits on it, and its own length.
struct View<'a, const N: usize> {
    ahead: &'a Lookahead<N>,
    limits: &'a RateLimits<N>,
    period: f64,
}

impl Rate {
    /// A constant rate in [0, 1].
    pub(super) fn constant(value: f64) -> Self {
        Self { value, slope: 0.0, recovery: Recovery::none(value), followed: 0 }
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
    /// Cost: at most `TRIALS` recoveries, each of at most 64 steps but usually of 5 to 25, and none at the goal.
    pub(super) fn advance<const N: usize>(
        &mut self,
        goal: f64,
        now: f64,
        ahead: &Lookahead<N>,
        limits: &RateLimits<N>,
        period: f64,
    ) -> f64 {
        let now = Instant { time: now, r: self.value, c: self.slope };
        let view = View { ahead, limits, period };
        let at_hand = self.at_hand(&view);
        let better = self.search(goal, now, at_hand.unwrap_or(0.0), &view);
        let next = now.after(period, better.map_or(at_hand.unwrap_or(0.0), |(curvature, _)| curvature));
        (self.value, self.slope) = (next.r, next.c);
        self.followed += 1;
        if let Some((_, recovery)) = better {
            (self.recovery, self.followed) = (recovery, 0);
        }
        if self.at_hand(&view).is_none() {
            let reached = if (next.r - goal).abs() < SAME_RATE { goal } else { next.r };
            // Rounding must not leave a constant rate below standstill or above full speed.
            *self = Self::constant(reached.clamp(0.0, 1.0));
        }
        (next.time - now.time).max(0.0)
    }

    /// The curvature that the recovery at hand has for this cycle; `None` where it is over.
    fn at_hand<const N: usize>(&self, view: &View<'_, N>) -> Option<f64> {
        // A step is a whole number of cycles.
        let cycles = (view.ahead.spacing() / view.period + 0.5) as usize;
        self.recovery.curvature(self.followed / cycles.max(1))
    }

    /// The strongest change of the slope towards the goal after which a recovery exists, and that recovery.
    ///
    /// It lies between what is at hand, which recovers short of the goal, and the strongest that the limits permit in
    /// this cycle. That one is tried first. If it does not recover, or only past the goal, the interval is halved, or
    /// divided where the goal should be met.
    fn search<const N: usize>(
        &self,
        goal: f64,
        now: Instant,
        at_hand: f64,
        view: &View<'_, N>,
    ) -> Option<(f64, Recovery)> {
        let missing = goal - self.recovery.end();
        if missing.abs() < SAME_RATE {
            return None;
        }
        let direction = missing.signum();
        let strongest = view.strongest(now, goal, direction)?;
        if (strongest - at_hand) * direction <= 0.0 {
            return None;
        }
        let mut best = None;
        // Curvatures with what is missing to the goal after their recovery, if there is one.
        let (mut near, mut far) = ((at_hand, missing), (strongest, None));
        let mut trial = strongest;
        for _ in 0..TRIALS {
            let recovery = view.recovery_after(now, trial);
            let left = recovery.map(|recovery| goal - recovery.end());
            match (recovery, left) {
                (Some(recovery), Some(left))
                    if left * direction > -SAME_RATE && left.abs() < missing.abs() =>
                {
                    best = Some((trial, recovery));
                    if trial == strongest || left.abs() < SAME_RATE {
                        break;
                    }
                    near = (trial, left);
                }
                _ => far = (trial, left),
            }
            let share = match far.1 {
                Some(past) if past * direction < 0.0 => near.1 / (near.1 - past),
                _ => 0.5,
            };
            trial = near.0 + (far.0 - near.0) * share.clamp(0.02, 0.98);
        }
        best
    }
}

impl<const N: usize> View<'_, N> {
    /// The curvature farthest in a direction that the limits permit in this cycle, and that need not end past the goal.
    fn strongest(&self, now: Instant, goal: f64, direction: f64) -> Option<f64> {
        let permitted = now.bounds(self.ahead, self.limits)?.farthest(direction, now.c, self.period)?;
        // With this one, a recovery in a single step ends at the goal; with more, every recovery ends past it.
        let (period, step) = (self.period, self.ahead.spacing());
        let landing = (goal - now.r - now.c * (period + step / 2.0)) / (period * (period + step) / 2.0);
        Some(direction * (direction * permitted).min(direction * landing))
    }

    /// The recovery after one cycle under a curvature, if that cycle and the recovery keep all limits.
    fn recovery_after(&self, now: Instant, curvature: f64) -> Option<Recovery> {
        let next = now.after(self.period, curvature);
        let bounds = next.bounds(self.ahead, self.limits)?;
        let keeps = bounds.slope.contains(next.c) && bounds.curvature.contains(curvature);
        if keeps { Recovery::from(next, self.ahead, self.limits) } else { None }
    }
}

#[cfg(test)]
mod tests;
