//! All axes together: the instant at which they arrive. See `docs/otg.md`, section 9.

use super::Role;
use super::axis::{Axis, Solution};
use super::error::Error;
use super::number::larger;
use crate::math::float::ceil;

/// When an axis arrives, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan {
    /// The least time at which it can arrive, not before the last instant it was asked for.
    pub(super) earliest: f64,
    pub(super) solution: Solution,
}

/// What is asked of the common duration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demand {
    pub(super) min: f64,
    /// Zero if any duration will do.
    pub(super) step: f64,
}

/// Durations that differ by this fraction are the same number of steps: a few roundings.
const SAME: f64 = 1e-15;

/// An axis that cannot arrive at the common time, but could earlier by this fraction of it, does so: on the last stretch of a motion that is
/// planned anew on every cycle, all axes have this one time but for rounding, and any other one is far later.
const ALMOST: f64 = 1e-9;

impl Demand {
    /// The first duration from `t` on that meets the demand.
    fn next(&self, t: f64) -> f64 {
        let t = larger(t, self.min);
        if self.step > 0.0 { self.step * ceil(t / self.step * (1.0 - SAME)) } else { t }
    }
}

impl Plan {
    /// The plan of an axis that is where it is to be.
    pub(super) const AT_ONCE: Self = Self { earliest: 0.0, solution: Solution::AtOnce };

    /// Has the axis arrive as early as it can.
    pub(super) fn find_earliest(&mut self, axis: &Axis) {
        self.earliest = axis.earliest(0.0, &mut self.solution);
    }

    /// Has the axis arrive at `t`, where it can; otherwise as soon after it as it can. Says when.
    ///
    /// The solution for the earliest time is kept as long as it serves, so that the axis that sets the duration keeps its own.
    fn arrive(&mut self, axis: &Axis, t: f64) -> f64 {
        if (self.earliest - t).abs() <= 2.0 * SAME * t {
            return t;
        }
        if self.earliest > t {
            return self.earliest;
        }
        match axis.at(t) {
            Some(solution) => self.solution = solution,
            None if t - self.earliest <= ALMOST * t => {}
            None => self.earliest = axis.earliest(t, &mut self.solution),
        }
        larger(self.earliest, t)
    }
}

/// The first duration at which all axes that arrive together can, and those that may arrive early have arrived.
///
/// Each round moves the duration to the end of an interval in which some axis cannot arrive. An axis has two of these at most
/// after its least duration, so that `3 N + 3` rounds are enough; with a step each round passes one too.
pub(super) fn common_duration<const N: usize>(
    axes: &[Axis; N],
    plans: &mut [Plan; N],
    roles: &[Role; N],
    demand: &Demand,
) -> Result<f64, Error> {
    let mut t = 0.0_f64;
    let mut last = 0;
    for axis in 0..N {
        let counts = matches!(roles[axis], Role::Together | Role::Early);
        if counts && (plans[axis].earliest > t || plans[axis].earliest.is_nan()) {
            (t, last) = (plans[axis].earliest, axis);
        }
    }
    for _ in 0..3 * N + 3 {
        t = demand.next(t);
        if !t.is_finite() {
            break;
        }
        let mut settled = true;
        for axis in (0..N).filter(|&axis| roles[axis] == Role::Together) {
            let arrival = plans[axis].arrive(&axes[axis], t);
            if arrival > t {
                (t, last, settled) = (arrival, axis, false);
                break;
            }
        }
        if settled {
            return Ok(t);
        }
    }
    Err(if t.is_nan() { Error::OutOfRange { axis: last } } else { Error::Unreachable { axis: last } })
}
