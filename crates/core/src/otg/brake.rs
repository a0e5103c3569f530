//! Back inside the limits: what comes first if the current velocity or acceleration is outside, or cannot but get there.
//! See `docs/otg.md`, section 8.

use super::extremal::Problem;
use super::fixed_duration::Piece;
use super::number::{NOISE, SIXTH, between, larger, smaller};
use super::profile::{Point, Profile};
use crate::math::float::sqrt;

/// A problem whose start is being moved inside its limits, and the phases that do it.
#[derive(Debug)]
pub(super) struct Brake<'a> {
    pub(super) problem: &'a mut Problem,
    pub(super) profile: &'a mut Profile,
    /// The start, in the user's units.
    pub(super) now: &'a mut Point,
    /// The jerk limit.
    pub(super) scale: f64,
}

impl Brake<'_> {
    /// Appends a piece and moves the start to its end, with the acceleration `a` there.
    fn push(&mut self, duration: f64, jerk: f64, a: f64) {
        let (problem, t) = (&mut *self.problem, duration);
        let acceleration = problem.a0;
        if t > 0.0 {
            self.profile.push_forward(&Piece { duration, jerk, acceleration }, self.scale, self.now);
            problem.displacement -= t * (problem.v0 + t * (2.0 * acceleration + a) * SIXTH);
            problem.v0 += 0.5 * t * (acceleration + a);
        }
        problem.a0 = a;
    }

    /// Moves the start of the problem inside its limits.
    pub(super) fn apply(&mut self) {
        self.apply_acceleration();
        let above = too_fast(self.problem);
        let below = too_fast(&self.problem.mirror());
        if above && (self.problem.a0 > 0.0 || !below) {
            for step in slow_down(self.problem) {
                self.push(step.duration, step.jerk, step.acceleration);
            }
            self.problem.v0 = self.problem.v_max;
        } else if below {
            for step in slow_down(&self.problem.mirror()) {
                self.push(step.duration, -step.jerk, -step.acceleration);
            }
            self.problem.v0 = self.problem.v_min;
        } else {
            return;
        }
        self.now.v = self.problem.v0 * self.scale;
    }

    /// Brings the acceleration inside its limits, whatever the velocity.
    pub(super) fn apply_acceleration(&mut self) {
        let Problem { a0, a_max, a_min, .. } = *self.problem;
        if a0 > a_max {
            self.push(a0 - a_max, -1.0, a_max);
        } else if a0 < a_min {
            self.push(a_min - a0, 1.0, a_min);
        }
    }
}

/// Whether the velocity is, or cannot but get, above its limit by more than rounding: where it ends if the acceleration is brought
/// to zero as fast as can be.
fn too_fast(problem: &Problem) -> bool {
    let a = larger(problem.a0, 0.0);
    let change = 0.5 * a * a;
    problem.v0 + change > problem.v_max + NOISE * (problem.v0.abs() + change)
}

/// A piece of the brake, with the acceleration at its end.
#[derive(Debug, Clone, Copy)]
struct Step {
    duration: f64,
    jerk: f64,
    acceleration: f64,
}

/// Brings the velocity down to its upper limit, with as much deceleration there as the limits allow and as does not lead
/// below the lower velocity limit later.
fn slow_down(problem: &Problem) -> [Step; 3] {
    let Problem { v0, a0, v_max, v_min, a_min, .. } = *problem;
    let m = -a_min;
    let steepest = sqrt(2.0 * (v_max - v_min));
    let excess = v0 - v_max;
    // The deceleration at v_max if the acceleration falls all the way.
    let falling = sqrt(larger(a0 * a0 + 2.0 * excess, 0.0));
    let step = |duration: f64, jerk, acceleration| Step { duration, jerk, acceleration };
    if falling <= smaller(m, steepest) {
        let nothing = step(0.0, 0.0, -falling);
        [step(a0 + falling, -1.0, -falling), nothing, nothing]
    } else if m <= steepest {
        let left = excess + 0.5 * (a0 - m) * (a0 + m);
        [step(a0 + m, -1.0, -m), step(left / m, 0.0, -m), step(0.0, 0.0, -m)]
    } else {
        let lost = excess + 0.5 * (a0 * a0 + steepest * steepest); // n², did the valley have no limit
        let n = between(sqrt(larger(lost, 0.0)), steepest, m);
        let hold = if n < m { 0.0 } else { (lost - m * m) / m };
        [step(a0 + n, -1.0, -n), step(hold, 0.0, -n), step(n - steepest, 1.0, -steepest)]
    }
}
