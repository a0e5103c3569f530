//! All axes together: the instant at which they arrive. See `docs/otg.md`, section 9.

use super::Role;
use super::axis::{Axis, Solution};
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

/// There is no common duration: this axis does not arrive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Never {
    pub(super) axis: usize,
}

/// Durations that differ by this fraction are the same number of steps: a few roundings.
const SAME: f64 = 1e-15;
/// Least durations this near, relative to the common time, are one but for what rounding adds up to beside a moving target.
const ONE_TIME: f64 = 1e-6;

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

    /// The same once more, at the least time but for rounding if the axis is to hurry.
    #[cold]
    fn find_again(&mut self, axis: &Axis, hurried: bool) {
        self.find_earliest(axis);
        if hurried && let Some(earliest) = axis.earliest_but_for_rounding(&mut self.solution) {
            self.earliest = earliest;
        }
    }

    /// Has the axis arrive at `t`, if it can.
    ///
    /// The solution for the earliest time is kept as long as it serves, so that the axis that sets the duration keeps its own.
    fn arrive(&mut self, axis: &Axis, t: f64) -> bool {
        if (self.earliest - t).abs() <= 2.0 * SAME * t {
            return true;
        }
        if self.earliest > t {
            return false;
        }
        let solution = axis.at(t);
        if let Some(solution) = solution {
            self.solution = solution;
        }
        solution.is_some()
    }

    /// Has the axis arrive as soon after `t` as it can; that is `t` where it differs by rounding from the only time there is. Says when.
    fn arrive_after(&mut self, axis: &Axis, t: f64) -> f64 {
        if self.earliest <= t {
            self.earliest = larger(axis.earliest(t, &mut self.solution), t);
        }
        self.earliest
    }
}

/// The first duration at which all axes that arrive together can, and those that may arrive early have arrived.
///
/// Each round moves the duration to the end of an interval in which some axis cannot arrive. An axis has two of these at most
/// after its least duration, so that `3 N + 3` rounds are enough; with a step each round passes one too. Another N are those in which an
/// axis hurries.
pub(super) fn common_duration<const N: usize>(
    axes: &[Axis; N],
    plans: &mut [Plan; N],
    roles: &[Role; N],
    demand: &Demand,
) -> Result<f64, Never> {
    let (mut t, mut last) = latest(plans, roles);
    let mut hurried = [false; N];
    for _ in 0..4 * N + 3 {
        t = demand.next(t);
        if !t.is_finite() {
            break;
        }
        let together = |axis: &usize| roles[*axis] == Role::Together;
        let Some(late) = (0..N).filter(together).find(|&axis| !plans[axis].arrive(&axes[axis], t)) else {
            return Ok(t);
        };
        let before = (1.0 - ONE_TIME) * t;
        let one_time = || plans[late].earliest >= before || axes[late].at(before).is_some();
        if late != last && !hurried[last] && plans[last].earliest == t && one_time() {
            let waiting = (&axes[late], plans[late].earliest);
            if hurry(&axes[last], waiting, t) {
                hurried[last] = true;
                for axis in (0..N).filter(together) {
                    plans[axis].find_again(&axes[axis], hurried[axis]);
                }
                (t, last) = latest(plans, roles);
                continue;
            }
        }
        (t, last) = (plans[late].arrive_after(&axes[late], t), late);
    }
    Err(Never { axis: last })
}

/// The largest of the least durations, and whose it is.
fn latest<const N: usize>(plans: &[Plan; N], roles: &[Role; N]) -> (f64, usize) {
    let (mut t, mut last) = (0.0_f64, 0);
    for axis in 0..N {
        let counts = matches!(roles[axis], Role::Together | Role::Early);
        if counts && (plans[axis].earliest > t || plans[axis].earliest.is_nan()) {
            (t, last) = (plans[axis].earliest, axis);
        }
    }
    (t, last)
}

/// On the last stretch of a motion that is planned anew on every cycle all axes have one time but for rounding, and an axis that cannot
/// arrive at any later one would have to come round again. If it can arrive at what is the least time `t` of the other but for the
/// rounding of positions, the other takes that.
#[cold]
fn hurry(setting: &Axis, (waiting, its_earliest): (&Axis, f64), t: f64) -> bool {
    setting
        .earliest_but_for_rounding(&mut Solution::AtOnce)
        .is_some_and(|sooner| sooner < t && (its_earliest >= sooner || waiting.at(sooner).is_some()))
}
