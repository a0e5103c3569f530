//! All axes together: the instant at which they arrive. See `docs/otg.md`, section 9.

use super::axis::{Axis, Reach, Solution};
use super::error::Error;
use super::profile::Profile;
use crate::math::float::ceil;

/// When an axis arrives, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan {
    /// The least time at which it can arrive, not before the last instant it was asked for.
    pub(super) earliest: f64,
    solution: Solution,
    /// Set where it has to arrive later than that.
    reach: Option<Reach>,
}

/// What is asked of the common duration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demand {
    pub(super) min: f64,
    /// Zero if any duration will do.
    pub(super) step: f64,
}

/// Durations that differ by this fraction are one.
const SAME: f64 = 1e-15;

impl Demand {
    /// The first duration from `t` on that meets the demand.
    fn next(&self, t: f64) -> f64 {
        let t = t.max(self.min);
        if self.step > 0.0 { self.step * ceil(t / self.step * (1.0 - SAME)) } else { t }
    }
}

impl Plan {
    pub(super) fn new(axis: &Axis) -> Self {
        let (earliest, solution) = axis.earliest(0.0);
        Self { earliest, solution, reach: None }
    }

    /// Has the axis arrive at `t` or, where it cannot, says when it can next.
    fn arrive(&mut self, axis: &Axis, t: f64) -> Result<(), f64> {
        self.reach = None;
        if self.earliest >= t * (1.0 - SAME) {
            return if self.earliest <= t { Ok(()) } else { Err(self.earliest) };
        }
        self.reach = axis.reachable(t);
        if self.reach.is_none() {
            (self.earliest, self.solution) = axis.earliest(t);
            if self.earliest > t {
                return Err(self.earliest);
            }
        }
        Ok(())
    }

    /// The axis' motion for the common duration `t`.
    pub(super) fn profile(&self, axis: &Axis, t: f64) -> Profile {
        match &self.reach {
            Some(reach) => axis.profile_at(t, reach),
            None => axis.profile(&self.solution),
        }
    }
}

/// The first duration at which every axis of `together` can arrive and those of `early` have arrived.
///
/// Each round moves the duration to the end of an interval in which some axis cannot arrive. An axis has two of these at most
/// after its least duration, so that `3 N + 3` rounds are enough; with a step each round passes one too.
pub(super) fn common_duration<const N: usize>(
    axes: &[Axis; N],
    plans: &mut [Plan; N],
    together: &[bool; N],
    early: &[bool; N],
    demand: &Demand,
) -> Result<f64, Error> {
    let mut t = 0.0_f64;
    let mut last = 0;
    for axis in (0..N).filter(|&axis| together[axis] || early[axis]) {
        if plans[axis].earliest.is_nan() {
            return Err(Error::OutOfRange { axis });
        }
        if plans[axis].earliest > t {
            (t, last) = (plans[axis].earliest, axis);
        }
    }
    for _ in 0..3 * N + 3 {
        t = demand.next(t);
        if !t.is_finite() {
            break;
        }
        let mut settled = true;
        for axis in (0..N).filter(|&axis| together[axis]) {
            if let Err(later) = plans[axis].arrive(&axes[axis], t) {
                (t, last, settled) = (later, axis, false);
                break;
            }
        }
        if settled {
            return Ok(t);
        }
    }
    Err(if t.is_nan() { Error::OutOfRange { axis: last } } else { Error::Unreachable { axis: last } })
}
