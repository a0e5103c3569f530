//! Back inside the limits: what comes first if the current velocity or acceleration is outside, or cannot but get there.
//! See `docs/otg.md`, section 8.

use super::extremal::Problem;
use super::fixed_duration::Piece;
use crate::math::float::sqrt;

/// Most pieces of a brake.
pub(super) const MAX_BRAKE: usize = 4;

/// The pieces of a brake, jerk limit 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Brake {
    list: [Piece; MAX_BRAKE],
    len: usize,
    pub(super) duration: f64,
}

impl Brake {
    pub(super) const NONE: Self = Self {
        list: [Piece { duration: 0.0, jerk: 0.0, acceleration: 0.0 }; MAX_BRAKE],
        len: 0,
        duration: 0.0,
    };

    pub(super) fn one(piece: Piece) -> Self {
        let mut brake = Self::NONE;
        brake.list[0] = piece;
        brake.len = 1;
        brake.duration = piece.duration;
        brake
    }

    pub(super) fn as_slice(&self) -> &[Piece] {
        &self.list[..self.len]
    }

    /// Appends a piece and moves the problem's start to its end, with the acceleration `a` there.
    fn push(&mut self, problem: &mut Problem, duration: f64, jerk: f64, a: f64) {
        let acceleration = problem.a0;
        if duration > 0.0 && self.len < MAX_BRAKE {
            self.list[self.len] = Piece { duration, jerk, acceleration };
            self.len += 1;
            self.duration += duration;
            problem.displacement -= duration * (problem.v0 + duration * (2.0 * acceleration + a) / 6.0);
            problem.v0 += 0.5 * duration * (acceleration + a);
        }
        problem.a0 = a;
    }
}

/// The velocity at which the acceleration, brought to zero as fast as can be, ends.
fn highest_velocity(problem: &Problem) -> f64 {
    let a = problem.a0.max(0.0);
    problem.v0 + 0.5 * a * a
}

fn lowest_velocity(problem: &Problem) -> f64 {
    let a = problem.a0.min(0.0);
    problem.v0 - 0.5 * a * a
}

/// Moves the start of the problem inside its limits, and says how it got there.
pub(super) fn brake(problem: &mut Problem) -> Brake {
    let mut brake = acceleration_only(problem);
    let above = highest_velocity(problem) > problem.v_max;
    let below = lowest_velocity(problem) < problem.v_min;
    if above && (problem.a0 > 0.0 || !below) {
        for step in slow_down(problem) {
            brake.push(problem, step.duration, step.jerk, step.acceleration);
        }
        problem.v0 = problem.v_max;
    } else if below {
        for step in slow_down(&problem.mirror()) {
            brake.push(problem, step.duration, -step.jerk, -step.acceleration);
        }
        problem.v0 = problem.v_min;
    }
    brake
}

/// Brings the acceleration inside its limits, whatever the velocity.
pub(super) fn acceleration_only(problem: &mut Problem) -> Brake {
    let mut brake = Brake::NONE;
    let a = problem.a0;
    if a > problem.a_max {
        brake.push(problem, a - problem.a_max, -1.0, problem.a_max);
    } else if a < problem.a_min {
        brake.push(problem, problem.a_min - a, 1.0, problem.a_min);
    }
    brake
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
    let falling = sqrt((a0 * a0 + 2.0 * excess).max(0.0));
    let step = |duration: f64, jerk, acceleration| Step { duration, jerk, acceleration };
    if falling <= m.min(steepest) {
        let nothing = step(0.0, 0.0, -falling);
        [step(a0 + falling, -1.0, -falling), nothing, nothing]
    } else if m <= steepest {
        let left = excess + 0.5 * (a0 - m) * (a0 + m);
        [step(a0 + m, -1.0, -m), step(left / m, 0.0, -m), step(0.0, 0.0, -m)]
    } else {
        let lost = excess + 0.5 * (a0 * a0 + steepest * steepest); // n², did the valley have no limit
        let n = sqrt(lost.max(0.0)).min(m).max(steepest);
        let hold = if n < m { 0.0 } else { (lost - m * m) / m };
        [step(a0 + n, -1.0, -n), step(hold, 0.0, -n), step(n - steepest, 1.0, -steepest)]
    }
}
