//! One axis, whatever its control and limits: brake first, then the motion proper.

use super::brake::{self, Brake};
use super::error::Error;
use super::extremal::Problem;
use super::fixed_duration::{self, Piece, Pieces};
use super::input::{Control, Input};
use super::profile::{Order, Point, Profile};
use super::second_order::{Cruise, SecondOrder};
use super::third_order::{Arrival, Span, ThirdOrder};

/// The problem of one axis, in the user's units.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisInput {
    pub(super) control: Control,
    pub(super) current: Point,
    pub(super) target: Point,
    pub(super) v_max: f64,
    pub(super) v_min: f64,
    pub(super) a_max: f64,
    pub(super) a_min: f64,
    pub(super) jerk: f64,
    /// Magnitude of the coordinates, which says how exact the displacement is.
    pub(super) coordinates: f64,
}

impl AxisInput {
    pub(super) fn of<const N: usize>(input: &Input<N>, axis: usize) -> Self {
        let Input { current, target, limits, .. } = input;
        let mut to =
            Point { p: target.position[axis], v: target.velocity[axis], a: target.acceleration[axis] };
        let from =
            Point { p: current.position[axis], v: current.velocity[axis], a: current.acceleration[axis] };
        let control = input.control[axis];
        if control == Control::Velocity {
            to.p = from.p;
        }
        Self {
            control,
            current: from,
            target: to,
            v_max: limits.velocity_max[axis],
            v_min: limits.velocity_min[axis],
            a_max: limits.acceleration_max[axis],
            a_min: limits.acceleration_min[axis],
            jerk: limits.jerk_max[axis],
            coordinates: from.p.abs() + to.p.abs(),
        }
    }

    /// Whether the axis is where it is to be, but for rounding.
    ///
    /// The least duration jumps at such a state: one rounding error beyond a moving target, the axis would have to come
    /// round again.
    fn is_at_target(&self) -> bool {
        let Self { current, target, control, jerk, .. } = self;
        let close = |a: f64, b: f64, size: f64| (a - b).abs() <= SAME * size;
        (*control == Control::Velocity || close(current.p, target.p, self.coordinates))
            && close(current.v, target.v, current.v.abs() + target.v.abs())
            && (*jerk == f64::INFINITY || close(current.a, target.a, current.a.abs() + target.a.abs()))
    }
}

/// States that differ by this fraction of their size or less are one: a few roundings.
const SAME: f64 = 4.0 * f64::EPSILON;

/// The motion after the brake.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::large_enum_variant)] // There is no heap to put the large one on, and it is the usual one.
enum Motion {
    /// Position control with limited jerk.
    Third(ThirdOrder),
    /// Position control with unlimited jerk.
    Second(SecondOrder),
    /// Velocity control: the velocity in the part of the position.
    Velocity(SecondOrder),
    /// A zero limit leaves one motion only: at constant acceleration, this long.
    Only(f64),
}

/// How an axis arrives at its own time.
#[derive(Debug, Clone, Copy)]
pub(super) enum Solution {
    /// It is there.
    AtOnce,
    Third(Arrival),
    Second(Cruise),
    Only,
}

/// What is known about an axis at a time at which it can arrive.
#[derive(Debug, Clone, Copy)]
pub(super) enum Reach {
    Third(Span),
    Other,
}

/// One axis, ready to be asked when it can arrive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    motion: Motion,
    brake: Brake,
    current: Point,
    target: Point,
    order: Order,
    /// The jerk limit, where the problem is normalised by it; otherwise 1.
    scale: f64,
    at_target: bool,
    velocity_control: bool,
}

impl Axis {
    pub(super) fn new(input: &AxisInput, axis: usize) -> Result<Self, Error> {
        let mut made = match input.control {
            Control::Position => Self::position(input, axis)?,
            Control::Velocity => Self::velocity(input, axis)?,
        };
        made.at_target = input.is_at_target();
        Ok(made)
    }

    /// An axis that nobody plans: it goes on at its acceleration.
    pub(super) fn coasting(input: &AxisInput) -> Self {
        let mut axis = Self::with(input, Motion::Only(0.0), Brake::NONE, Order::Third, 1.0);
        axis.target = axis.current;
        axis.at_target = true;
        axis
    }

    fn with(input: &AxisInput, motion: Motion, brake: Brake, order: Order, scale: f64) -> Self {
        let AxisInput { current, target, .. } = *input;
        let velocity_control = input.control == Control::Velocity;
        Self { motion, brake, current, target, order, scale, at_target: false, velocity_control }
    }

    /// The problem in units in which the jerk limit is 1.
    fn normalised(input: &AxisInput) -> Problem {
        let j = input.jerk;
        Problem {
            displacement: (input.target.p - input.current.p) / j,
            v0: input.current.v / j,
            a0: input.current.a / j,
            vf: input.target.v / j,
            af: input.target.a / j,
            v_max: input.v_max / j,
            v_min: input.v_min / j,
            a_max: input.a_max / j,
            a_min: input.a_min / j,
        }
    }

    fn position(input: &AxisInput, axis: usize) -> Result<Self, Error> {
        let AxisInput { current, target, v_max, v_min, a_max, a_min, jerk, .. } = *input;
        if jerk == 0.0 || a_max == 0.0 || a_min == 0.0 {
            let t = only_duration(input).ok_or(Error::Unreachable { axis })?;
            return Ok(Self::with(input, Motion::Only(t), Brake::NONE, Order::Third, 1.0));
        }
        if jerk < f64::INFINITY {
            let mut problem = Self::normalised(input);
            let brake = brake::brake(&mut problem);
            let third = ThirdOrder::new(problem, SAME * input.coordinates / jerk);
            return Ok(Self::with(input, Motion::Third(third), brake, Order::Third, jerk));
        }
        let order =
            if a_max < f64::INFINITY || a_min > f64::NEG_INFINITY { Order::Second } else { Order::First };
        if order == Order::First && (v_max == f64::INFINITY || v_min == f64::NEG_INFINITY) {
            return Err(Error::Unlimited { axis });
        }
        let (rise, fall) = (1.0 / a_max, -1.0 / a_min);
        let mut displacement = target.p - current.p;
        let mut brake = Brake::NONE;
        let v0 = current.v.clamp(v_min, v_max);
        let (v0, vf) = if order == Order::First { (0.0, 0.0) } else { (v0, target.v) };
        if order == Order::Second && v0 != current.v {
            let (duration, acceleration) = if current.v > v0 {
                ((current.v - v0) * fall, a_min)
            } else {
                ((v0 - current.v) * rise, a_max)
            };
            brake = Brake::one(Piece { duration, jerk: 0.0, acceleration });
            displacement -= 0.5 * (current.v + v0) * duration;
        }
        let second = SecondOrder { displacement, v0, vf, v_max, v_min, rise, fall };
        Ok(Self::with(input, Motion::Second(second), brake, order, 1.0))
    }

    fn velocity(input: &AxisInput, axis: usize) -> Result<Self, Error> {
        let AxisInput { current, target, a_max, a_min, jerk, .. } = *input;
        if jerk == 0.0 || (a_max == 0.0 && a_min == 0.0) {
            let t = only_duration(input).ok_or(Error::Unreachable { axis })?;
            return Ok(Self::with(input, Motion::Only(t), Brake::NONE, Order::Third, 1.0));
        }
        if jerk < f64::INFINITY {
            let mut problem = Self::normalised(input);
            let brake = brake::acceleration_only(&mut problem);
            let displacement = problem.vf - problem.v0;
            let (v0, vf, v_max, v_min) = (problem.a0, problem.af, problem.a_max, problem.a_min);
            let second = SecondOrder { displacement, v0, vf, v_max, v_min, rise: 1.0, fall: 1.0 };
            return Ok(Self::with(input, Motion::Velocity(second), brake, Order::Third, jerk));
        }
        let displacement = target.v - current.v;
        let second =
            SecondOrder { displacement, v0: 0.0, vf: 0.0, v_max: a_max, v_min: a_min, rise: 0.0, fall: 0.0 };
        Ok(Self::with(input, Motion::Velocity(second), Brake::NONE, Order::Second, 1.0))
    }

    /// The first arrival at or after `from`, at which the axis cannot arrive (or `from` is 0): duration and solution.
    pub(super) fn earliest(&self, from: f64) -> (f64, Solution) {
        if self.at_target && from <= 0.0 {
            return (0.0, Solution::AtOnce);
        }
        let from = (from - self.brake.duration).max(0.0);
        let (t, solution) = match &self.motion {
            Motion::Third(third) => {
                let arrival = third.earliest(from);
                (arrival.extremal.t, Solution::Third(arrival))
            }
            Motion::Second(second) | Motion::Velocity(second) => {
                let cruise = second.earliest(from);
                (cruise.duration(), Solution::Second(cruise))
            }
            Motion::Only(t) => (if from > *t { f64::INFINITY } else { *t }, Solution::Only),
        };
        (self.brake.duration + t, solution)
    }

    /// Whether the axis can arrive at `t`, and what the motion there is made from.
    pub(super) fn reachable(&self, t: f64) -> Option<Reach> {
        let t = t - self.brake.duration;
        match &self.motion {
            Motion::Third(third) => third.reachable(t).map(Reach::Third),
            Motion::Second(second) | Motion::Velocity(second) => second.reachable(t).then_some(Reach::Other),
            Motion::Only(only) => (*only == t).then_some(Reach::Other),
        }
    }

    /// The motion of a solution.
    pub(super) fn profile(&self, solution: &Solution) -> Profile {
        match (&self.motion, solution) {
            (Motion::Third(third), Solution::Third(arrival)) => {
                self.with_jerk(&fixed_duration::of_arrival(third, arrival))
            }
            (Motion::Second(second), Solution::Second(cruise)) => self.with_acceleration(second, cruise),
            (Motion::Velocity(second), Solution::Second(cruise)) => {
                self.with_acceleration_ramps(second, cruise)
            }
            (Motion::Only(t), Solution::Only) => self.only(*t),
            _ => Profile::ending_at(self.target, self.order),
        }
    }

    /// The motion that arrives at `t`, at which the axis can arrive.
    pub(super) fn profile_at(&self, t: f64, reach: &Reach) -> Profile {
        let t = t - self.brake.duration;
        match (&self.motion, reach) {
            (Motion::Third(third), Reach::Third(span)) => {
                self.with_jerk(&fixed_duration::between(third, t, span))
            }
            (Motion::Second(second), _) => self.with_acceleration(second, &second.between(t)),
            (Motion::Velocity(second), _) => self.with_acceleration_ramps(second, &second.between(t)),
            (Motion::Only(only), _) => self.only(*only),
            (Motion::Third(_), Reach::Other) => Profile::ending_at(self.target, self.order),
        }
    }
}

/// Duration of the motion at constant acceleration from start to target, if there is one.
fn only_duration(input: &AxisInput) -> Option<f64> {
    let AxisInput { current, target, control, v_max, v_min, a_max, a_min, .. } = *input;
    if input.is_at_target() {
        return Some(0.0);
    }
    let position = control == Control::Position;
    let (change, displacement) = (target.v - current.v, target.p - current.p);
    let t = if current.a != 0.0 {
        change / current.a
    } else if position && change == 0.0 {
        displacement / current.v
    } else {
        return None;
    };
    let travelled = 0.5 * (current.v + target.v) * t;
    let arrives =
        !position || (travelled - displacement).abs() <= ONLY * (travelled.abs() + input.coordinates);
    let within =
        (!position || (v_min <= current.v && current.v <= v_max)) && a_min <= current.a && current.a <= a_max;
    (t >= 0.0 && t.is_finite() && current.a == target.a && arrives && within).then_some(t)
}

/// How exactly, relative to the distance, a motion without choice must meet its target.
const ONLY: f64 = 1e-12;

/// Assembly of profiles in the user's units.
impl Axis {
    /// A profile that holds the brake so far, and the state after it.
    fn after_brake(&self) -> (Profile, Point) {
        let mut profile = Profile::ending_at(self.target, self.order);
        let mut now = self.current;
        if self.brake.duration > 0.0 {
            for piece in self.brake.as_slice() {
                profile.push_forward(piece, self.scale, &mut now);
            }
            profile.brake_is_complete();
        }
        (profile, now)
    }

    /// Pieces of constant jerk that lead to the target: up to the cruise reckoned from the start, then back from
    /// the target, so that rounding errors do not grow with the duration.
    fn with_jerk(&self, pieces: &Pieces) -> Profile {
        let (mut profile, mut now) = self.after_brake();
        let (list, cruise) = (pieces.as_slice(), pieces.cruise());
        let half = match cruise {
            Some((index, _)) => index + 1,
            None => list.len().div_ceil(2),
        };
        for (index, piece) in list[..half].iter().enumerate() {
            if let Some((_, velocity)) = cruise.filter(|(at, _)| *at == index) {
                now.v = velocity * self.scale;
            }
            profile.push_forward(piece, self.scale, &mut now);
        }
        profile.extend_backward(&list[half..], self.scale, self.target);
        profile
    }

    /// Position control without jerk limit: two ramps and a cruise.
    fn with_acceleration(&self, second: &SecondOrder, cruise: &Cruise) -> Profile {
        let (mut profile, mut now) = self.after_brake();
        let mut ramp = |now: &mut Point, to: f64, duration: f64| {
            let acceleration = if duration > 0.0 { (to - now.v) / duration } else { 0.0 };
            profile.push_forward(&Piece { duration, jerk: 0.0, acceleration }, 1.0, now);
            now.v = to; // jumps where the acceleration is unlimited
        };
        ramp(&mut now, cruise.w, cruise.first);
        ramp(&mut now, cruise.w, cruise.cruise);
        ramp(&mut now, second.vf, cruise.last);
        profile
    }

    /// Velocity control: two ramps of the acceleration and a hold, or one jump if the jerk is unlimited.
    fn with_acceleration_ramps(&self, second: &SecondOrder, cruise: &Cruise) -> Profile {
        let (mut profile, mut now) = self.after_brake();
        let ramp = |to: f64, from: f64, duration: f64| {
            let jerk = if second.rise == 0.0 { 0.0 } else { (to - from).signum() };
            Piece { duration, jerk, acceleration: from }
        };
        for piece in [
            ramp(cruise.w, second.v0, cruise.first),
            Piece { duration: cruise.cruise, jerk: 0.0, acceleration: cruise.w },
            ramp(second.vf, cruise.w, cruise.last),
        ] {
            profile.push_forward(&piece, self.scale, &mut now);
        }
        profile.end_at(Point { p: now.p, ..self.target });
        profile
    }

    /// The only motion that a zero limit leaves.
    fn only(&self, duration: f64) -> Profile {
        let (mut profile, mut now) = self.after_brake();
        profile.push_forward(&Piece { duration, jerk: 0.0, acceleration: now.a }, 1.0, &mut now);
        if self.velocity_control {
            profile.end_at(Point { p: now.p, ..self.target });
        }
        profile
    }
}
