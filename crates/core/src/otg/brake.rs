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

/// A state on the brake that no motion within the limits leaves for good, but from which the target may be reached before a limit is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    /// The problem from here on.
    pub(super) problem: Problem,
    /// The state, in the user's units.
    pub(super) start: Point,
    /// Time since the brake began.
    pub(super) time: f64,
    /// Phases of the brake until here.
    pub(super) phases: usize,
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

    /// Moves the start of the problem inside its limits. Says where on the way the target may be within reach.
    pub(super) fn apply(&mut self) -> Option<Turn> {
        self.apply_acceleration();
        let above = too_fast(self.problem);
        let below = too_fast(&self.problem.mirror());
        if !(above || below) {
            return None;
        }
        let Problem { a0, v_max, v_min, .. } = *self.problem;
        let downward = above && (a0 > 0.0 || !below);
        let sign = if downward { 1.0 } else { -1.0 };
        let mut turn = self.turn(sign);
        let slowing = if downward { slow_down(self.problem) } else { slow_down(&self.problem.mirror()) };
        for step in [slowing.fall, slowing.hold] {
            self.push(step.duration, sign * step.jerk, sign * step.acceleration);
        }
        if let Some(rise) = slowing.rise {
            turn = turn.or_else(|| self.turn(-sign));
            self.push(rise.duration, sign * rise.jerk, sign * rise.acceleration);
        }
        self.problem.v0 = if downward { v_max } else { v_min };
        self.now.v = self.problem.v0 * self.scale;
        turn
    }

    /// The present state, if both accelerations have the sign given: a motion that passes through zero acceleration would pass a limit.
    fn turn(&self, sign: f64) -> Option<Turn> {
        let Problem { a0, af, .. } = *self.problem;
        (sign * a0 > 0.0 && sign * af > 0.0).then(|| Turn {
            problem: *self.problem,
            start: *self.now,
            time: self.profile.duration(),
            phases: self.profile.phases().len(),
        })
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

/// The pieces that bring the velocity down to its upper limit.
#[derive(Debug, Clone, Copy)]
struct Slowing {
    fall: Step,
    hold: Step,
    /// Where the lower velocity limit is near, the turn away from it; before it the axis has as much deceleration as does not lead below.
    rise: Option<Step>,
}

/// Brings the velocity down to its upper limit, with as much deceleration there as the limits allow and as does not lead
/// below the lower velocity limit later.
fn slow_down(problem: &Problem) -> Slowing {
    let Problem { v0, a0, v_max, v_min, a_min, .. } = *problem;
    let m = -a_min;
    let steepest = sqrt(2.0 * (v_max - v_min));
    let excess = v0 - v_max;
    // The deceleration at v_max if the acceleration falls all the way.
    let falling = sqrt(larger(a0 * a0 + 2.0 * excess, 0.0));
    let step = |duration: f64, jerk, acceleration| Step { duration, jerk, acceleration };
    if falling <= smaller(m, steepest) {
        Slowing { fall: step(a0 + falling, -1.0, -falling), hold: step(0.0, 0.0, -falling), rise: None }
    } else if m <= steepest {
        let left = excess + 0.5 * (a0 - m) * (a0 + m);
        Slowing { fall: step(a0 + m, -1.0, -m), hold: step(left / m, 0.0, -m), rise: None }
    } else {
        let lost = excess + 0.5 * (a0 * a0 + steepest * steepest); // n², did the valley have no limit
        let n = between(sqrt(larger(lost, 0.0)), steepest, m);
        let hold = if n < m { 0.0 } else { (lost - m * m) / m };
        Slowing {
            fall: step(a0 + n, -1.0, -n),
            hold: step(hold, 0.0, -n),
            rise: Some(step(n - steepest, 1.0, -steepest)),
        }
    }
}
