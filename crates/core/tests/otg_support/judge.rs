//! The judge: integrates the phases anew from the definition of constant jerk alone, and looks at every limit.
//!
//! Nothing here comes from the generator but the durations and the controls of the phases.

use seamline::otg::{Control, Input, Order, Phase, Profile, State, Trajectory};

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
    /// On by a time at constant jerk: the definition (p + v t + a t²/2 + j t³/6, in the form in which t³ alone does not overflow).
    fn on(self, t: f64, j: f64) -> Self {
        let Motion { p, v, a } = self;
        Motion { p: p + t * (v + t * (a / 2.0 + t * j / 6.0)), v: v + t * (a + t * j / 2.0), a: a + j * t }
    }

    fn of(phase: &Phase) -> Self {
        Motion { p: phase.position, v: phase.velocity, a: phase.acceleration }
    }
}

fn judge_axis<const N: usize>(
    input: &Input<N>,
    trajectory: &Trajectory<N>,
    axis: usize,
    together: bool,
) -> Verdict {
    let profile = &trajectory.profiles()[axis];
    let position_control = input.control[axis] == Control::Position;
    let bounds = Bounds::new(input, axis, profile);
    let scale = bounds.scale;
    let mut verdict = Verdict::default();
    let mut now = Motion {
        p: input.current.position[axis],
        v: input.current.velocity[axis],
        a: input.current.acceleration[axis],
    };
    let mut sum = 0.0;
    for (index, phase) in profile.phases().iter().enumerate() {
        sum += phase.duration;
        match profile.order() {
            Order::Third => {}
            Order::Second => now.a = phase.acceleration,
            Order::First => (now.v, now.a) = (phase.velocity, 0.0),
        }
        let stored = Motion::of(phase);
        let jump = off(now.p, stored.p, scale.p)
            .max(off(now.v, stored.v, scale.v))
            .max(off(now.a, stored.a, scale.a));
        verdict.worst(&Verdict { jump, ..Verdict::default() });
        verdict.worst(&bounds.of_phase(phase, index < profile.brake().len()));
        // The rounding of an acceleration must not grow with a long hold or cruise.
        if phase.jerk == 0.0 && (now.a - stored.a).abs() <= 1e-13 * scale.a {
            now.a = stored.a;
        }
        now = now.on(phase.duration, phase.jerk);
    }
    let (target, end) = (&input.target, profile.end());
    let drift = if input.target_moves[axis] { target.velocity[axis] } else { 0.0 };
    let to_p =
        if position_control { target.position[axis] + drift * profile.duration() } else { end.position };
    verdict.position = off(now.p, to_p, scale.p);
    if profile.order() != Order::First {
        verdict.velocity = off(now.v, target.velocity[axis], scale.v);
    }
    if profile.order() == Order::Third {
        verdict.acceleration = off(now.a, target.acceleration[axis], scale.a);
    }
    let said = if together { trajectory.duration() } else { profile.duration() };
    verdict.duration = off(sum, said, said);
    let in_time = profile.duration() <= trajectory.duration() * (1.0 + 1e-12);
    let exact = (end.velocity, end.acceleration) == (target.velocity[axis], target.acceleration[axis])
        && end.position == to_p;
    if !(in_time && exact) {
        verdict.jump = f64::NAN;
    }
    verdict
}

fn off(a: f64, b: f64, scale: f64) -> f64 {
    if a == b { 0.0 } else { (a - b).abs() / scale }
}

/// What the motion may do, and how large its numbers get.
struct Bounds {
    v: (f64, f64),
    a: (f64, f64),
    jerk: f64,
    position_control: bool,
    /// Largest velocity and acceleration on the way; for positions the coordinates, and the largest velocity times the duration.
    scale: Motion,
}

impl Bounds {
    fn new<const N: usize>(input: &Input<N>, axis: usize, profile: &Profile) -> Self {
        let l = &input.limits;
        let position_control = input.control[axis] == Control::Position;
        let mut scale = Motion {
            p: 0.0,
            v: input.current.velocity[axis].abs().max(input.target.velocity[axis].abs()),
            a: input.current.acceleration[axis].abs().max(input.target.acceleration[axis].abs()),
        };
        for phase in profile.phases() {
            let turn = Motion::of(phase).on(turn(phase), phase.jerk);
            scale.v = scale.v.max(phase.velocity.abs()).max(turn.v.abs());
            scale.a = scale.a.max(phase.acceleration.abs());
        }
        let coordinates = input.current.position[axis].abs() + profile.end().position.abs();
        scale.p = coordinates + scale.v * profile.duration();
        Self {
            v: (l.velocity_min[axis], l.velocity_max[axis]),
            a: (l.acceleration_min[axis], l.acceleration_max[axis]),
            jerk: l.jerk_max[axis],
            position_control,
            scale,
        }
    }

    /// The extremes of a phase: the acceleration at its ends, the velocity there and where the acceleration is zero.
    fn of_phase(&self, phase: &Phase, brake: bool) -> Verdict {
        let mut verdict =
            Verdict { jerk_limit: beyond(phase.jerk, (-self.jerk, self.jerk), 0.0), ..Verdict::default() };
        if brake {
            return verdict;
        }
        let start = Motion::of(phase);
        let end = start.on(phase.duration, phase.jerk);
        let beyond_a = |a: f64| beyond(a, self.a, self.scale.a);
        verdict.acceleration_limit = beyond_a(start.a).max(beyond_a(end.a));
        if self.position_control {
            let beyond_v = |v: f64| beyond(v, self.v, self.scale.v);
            let turn = start.on(turn(phase), phase.jerk);
            verdict.velocity_limit = beyond_v(start.v).max(beyond_v(end.v)).max(beyond_v(turn.v));
        }
        verdict
    }
}

/// Time within the phase at which the acceleration is zero; the start if there is none.
fn turn(phase: &Phase) -> f64 {
    let turn = -phase.acceleration / phase.jerk;
    if turn > 0.0 && turn < phase.duration { turn } else { 0.0 }
}

/// How far a value is outside two bounds, relative to the bound that it passes or, if that is larger, to the scale.
fn beyond(value: f64, (low, high): (f64, f64), scale: f64) -> f64 {
    let over = |excess: f64, bound: f64| if excess > 0.0 { excess / scale.max(bound.abs()) } else { 0.0 };
    if value.is_nan() { f64::NAN } else { over(value - high, high).max(over(low - value, low)) }
}

/// Continuity from one cycle to the next within what the jerk limits allow.
pub fn is_smooth<const N: usize>(input: &Input<N>, before: &State<N>, after: &State<N>, cycle: f64) -> bool {
    (0..N).all(|axis| {
        let (p, v, a) = (before.position[axis], before.velocity[axis], before.acceleration[axis]);
        let j = input.limits.jerk_max[axis];
        let within = |x: f64, mean: f64, reach: f64, size: f64| {
            (x - mean).abs() <= reach * (1.0 + 1e-9) + 1e-12 * size
        };
        let size_v = v.abs() + input.limits.velocity_max[axis].max(-input.limits.velocity_min[axis]);
        let size_a = a.abs() + input.limits.acceleration_max[axis].max(-input.limits.acceleration_min[axis]);
        within(after.acceleration[axis], a, j * cycle, size_a)
            && within(after.velocity[axis], v + a * cycle, j * cycle * cycle / 2.0, size_v)
            && within(
                after.position[axis],
                p + cycle * (v + cycle * a / 2.0),
                j * cycle * cycle * cycle / 6.0,
                // Both ends count: they are what a displacement is rounded by.
                p.abs() + input.target.position[axis].abs() + size_v * cycle,
            )
    })
}

/// Velocity and acceleration within their limits to 1e-12 of these.
pub fn is_within_limits<const N: usize>(input: &Input<N>, state: &State<N>) -> bool {
    let l = &input.limits;
    let within = |x: f64, min: f64, max: f64| min * (1.0 + 1e-12) <= x && x <= max * (1.0 + 1e-12);
    (0..N).all(|axis| {
        within(state.velocity[axis], l.velocity_min[axis], l.velocity_max[axis])
            && within(state.acceleration[axis], l.acceleration_min[axis], l.acceleration_max[axis])
    })
}
