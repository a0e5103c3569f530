//! The judge: integrates the phases anew from the definition of constant jerk alone, and looks at every limit.
//!
//! Nothing here comes from the generator but the durations and the controls of the phases.

use seamline::otg::{Control, Input, Order, Phase, Trajectory};

/// The worst found, each relative to the problem's own scale.
#[derive(Debug, Clone, Copy, Default)]
pub struct Verdict {
    /// Final position, of the way travelled and the coordinates.
    pub position: f64,
    /// Final velocity, of the highest.
    pub velocity: f64,
    /// Final acceleration, of the highest.
    pub acceleration: f64,
    /// Passing of a velocity limit, of the limit.
    pub velocity_limit: f64,
    /// Passing of an acceleration limit, of the limit.
    pub acceleration_limit: f64,
    /// Passing of the jerk limit, of the limit.
    pub jerk_limit: f64,
    /// Jump of position, velocity or acceleration between two phases.
    pub jump: f64,
    /// Difference of the phases' durations from the duration said.
    pub duration: f64,
}

impl Verdict {
    pub fn worst(&mut self, other: &Verdict) {
        // NaN must win.
        let worse = |a: f64, b: f64| if b.is_nan() || b > a { b } else { a };
        self.position = worse(self.position, other.position);
        self.velocity = worse(self.velocity, other.velocity);
        self.acceleration = worse(self.acceleration, other.acceleration);
        self.velocity_limit = worse(self.velocity_limit, other.velocity_limit);
        self.acceleration_limit = worse(self.acceleration_limit, other.acceleration_limit);
        self.jerk_limit = worse(self.jerk_limit, other.jerk_limit);
        self.jump = worse(self.jump, other.jump);
        self.duration = worse(self.duration, other.duration);
    }

    /// Within the exactness promised.
    pub fn is_good(&self) -> bool {
        self.position <= 1e-8
            && self.velocity <= 1e-8
            && self.acceleration <= 1e-10
            && self.velocity_limit <= 1e-12
            && self.acceleration_limit <= 1e-12
            && self.jerk_limit <= 1e-12
            && self.jump <= 1e-9
            && self.duration <= 1e-12
    }
}

/// Judges all axes. `together`: every axis must take the trajectory's duration.
pub fn judge<const N: usize>(input: &Input<N>, trajectory: &Trajectory<N>, together: bool) -> Verdict {
    let mut verdict = Verdict::default();
    for axis in 0..N {
        if input.enabled[axis] {
            verdict.worst(&judge_axis(input, trajectory, axis, together));
        }
    }
    verdict
}

#[derive(Debug, Clone, Copy)]
struct Motion {
    p: f64,
    v: f64,
    a: f64,
}

impl Motion {
    /// On by a time at constant jerk: the definition.
    fn on(self, t: f64, j: f64) -> Self {
        let Motion { p, v, a } = self;
        Motion {
            p: p + v * t + a * t * t / 2.0 + j * t * t * t / 6.0,
            v: v + a * t + j * t * t / 2.0,
            a: a + j * t,
        }
    }

    fn of(phase: &Phase) -> Self {
        Motion { p: phase.position, v: phase.velocity, a: phase.acceleration }
    }
}

/// How far a value is outside two bounds, relative to the bound that it passes.
fn beyond(value: f64, low: f64, high: f64) -> f64 {
    let over = |excess: f64, bound: f64| {
        if excess <= 0.0 {
            0.0
        } else if bound == 0.0 {
            excess
        } else {
            excess / bound.abs()
        }
    };
    if value.is_nan() { f64::NAN } else { over(value - high, high).max(over(low - value, low)) }
}

fn judge_axis<const N: usize>(
    input: &Input<N>,
    trajectory: &Trajectory<N>,
    axis: usize,
    together: bool,
) -> Verdict {
    let profile = &trajectory.profiles()[axis];
    let (limits, position_control) = (&input.limits, input.control[axis] == Control::Position);
    let mut verdict = Verdict::default();
    let mut now = Motion {
        p: input.current.position[axis],
        v: input.current.velocity[axis],
        a: input.current.acceleration[axis],
    };
    let order = profile.order();
    let mut scale =
        Motion { p: now.p.abs() + input.target.position[axis].abs(), v: now.v.abs(), a: now.a.abs() };
    if !position_control {
        scale.p = now.p.abs();
    }
    let mut sum = 0.0;
    for (index, phase) in profile.phases().iter().enumerate() {
        let t = phase.duration;
        sum += t;
        match order {
            Order::Third => {}
            Order::Second => now.a = phase.acceleration,
            Order::First => (now.v, now.a) = (phase.velocity, 0.0),
        }
        let jump = now;
        // Round-off of an acceleration that is to be zero must not grow with a long cruise.
        if phase.jerk == 0.0 && now.a.abs() <= 1e-13 * scale.a {
            now.a = 0.0;
        }
        let stored = Motion::of(phase);
        let end = now.on(t, phase.jerk);
        scale.v = scale.v.max(end.v.abs()).max(now.v.abs());
        scale.a = scale.a.max(end.a.abs()).max(now.a.abs());
        scale.p += t * now.v.abs().max(end.v.abs());
        let off = |a: f64, b: f64, scale: f64| if a == b { 0.0 } else { (a - b).abs() / scale };
        verdict.worst(&Verdict {
            jump: off(jump.p, stored.p, scale.p)
                .max(off(jump.v, stored.v, scale.v))
                .max(off(jump.a, stored.a, scale.a)),
            ..Verdict::default()
        });
        if index >= profile.brake().len() {
            verdict.worst(&limits_of_phase(phase, limits_of(input, axis), position_control));
        } else if order == Order::Third {
            let jerk_limit = beyond(phase.jerk, -limits.jerk_max[axis], limits.jerk_max[axis]);
            verdict.worst(&Verdict { jerk_limit, ..Verdict::default() });
        }
        now = end;
    }
    let target = &input.target;
    let end = profile.end();
    let off = |a: f64, b: f64, scale: f64| if a == b { 0.0 } else { (a - b).abs() / scale };
    let to_p = if position_control { target.position[axis] } else { end.position };
    scale.v = scale.v.max(target.velocity[axis].abs());
    scale.a = scale.a.max(target.acceleration[axis].abs());
    verdict.position = off(now.p, to_p, scale.p);
    if order != Order::First {
        verdict.velocity = off(now.v, target.velocity[axis], scale.v);
    }
    if order == Order::Third {
        verdict.acceleration = off(now.a, target.acceleration[axis], scale.a);
    }
    let said = if together { trajectory.duration() } else { profile.duration() };
    verdict.duration = off(sum, said, said);
    if profile.duration() > trajectory.duration() * (1.0 + 1e-14) {
        verdict.duration = f64::NAN;
    }
    let exact = (end.velocity, end.acceleration) == (target.velocity[axis], target.acceleration[axis]);
    if !exact || end.position != to_p {
        verdict.jump = f64::NAN;
    }
    verdict
}

struct AxisLimits {
    v: (f64, f64),
    a: (f64, f64),
    j: f64,
}

fn limits_of<const N: usize>(input: &Input<N>, axis: usize) -> AxisLimits {
    let l = &input.limits;
    AxisLimits {
        v: (l.velocity_min[axis], l.velocity_max[axis]),
        a: (l.acceleration_min[axis], l.acceleration_max[axis]),
        j: l.jerk_max[axis],
    }
}

/// The extremes of a phase: the acceleration at its ends, the velocity there and where the acceleration is zero.
fn limits_of_phase(phase: &Phase, limits: AxisLimits, position_control: bool) -> Verdict {
    let start = Motion::of(phase);
    let end = start.on(phase.duration, phase.jerk);
    let mut velocity_limit = 0.0_f64;
    if position_control {
        let mut check = |v: f64| velocity_limit = velocity_limit.max(beyond(v, limits.v.0, limits.v.1));
        check(start.v);
        check(end.v);
        let turn = -phase.acceleration / phase.jerk;
        if turn > 0.0 && turn < phase.duration {
            check(start.on(turn, phase.jerk).v);
        }
    }
    let beyond_a = |a: f64| beyond(a, limits.a.0, limits.a.1);
    Verdict {
        velocity_limit,
        acceleration_limit: beyond_a(start.a).max(beyond_a(end.a)),
        jerk_limit: beyond(phase.jerk, -limits.j, limits.j),
        ..Verdict::default()
    }
}
