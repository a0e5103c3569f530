//! One axis, whatever its control and limits: brake first, then the motion proper.

use super::brake::{Brake, Turn};
use super::error::Error;
use super::extremal::Problem;
use super::fixed_duration::{Draft, Piece, Ramps};
use super::input::{Control, Input};
use super::number::{NOISE, between, larger, smaller};
use super::profile::{Order, Point, Profile};
use super::rest_to_rest::RestToRest;
use super::second_order::{Cruise, SecondOrder};
use super::third_order::{Arrival, Passage, ThirdOrder};

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
    /// Velocity of the frame in which all this is said: that of the target, if it moves on.
    pub(super) drift: f64,
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
        let mut drift = 0.0;
        if control == Control::Velocity {
            to.p = from.p;
        } else if input.target_moves[axis] {
            drift = to.v;
        }
        let from = Point { v: from.v - drift, ..from };
        to.v -= drift;
        Self {
            control,
            current: from,
            target: to,
            v_max: limits.velocity_max[axis] - drift,
            v_min: limits.velocity_min[axis] - drift,
            a_max: limits.acceleration_max[axis],
            a_min: limits.acceleration_min[axis],
            jerk: limits.jerk_max[axis],
            drift,
            coordinates: from.p.abs() + to.p.abs(),
        }
    }

    /// Whether a limit leaves the axis no way in some direction.
    pub(super) fn has_zero_limit(&self) -> bool {
        let Self { v_max, v_min, a_max, a_min, jerk, .. } = *self;
        [v_max, v_min, a_max, a_min, jerk].contains(&0.0)
    }

    /// Whether the axis starts and ends at rest.
    fn is_rest_to_rest(&self) -> bool {
        let Self { current, target, .. } = self;
        current.v == 0.0 && current.a == 0.0 && target.v == 0.0 && target.a == 0.0
    }

    /// Whether the axis is where it is to be, but for rounding.
    ///
    /// The least duration jumps at such a state: one rounding error beyond a moving target, the axis would have to come
    /// round again.
    fn is_at_target(&self) -> bool {
        let Self { current, target, control, jerk, drift, .. } = self;
        let close = |a: f64, b: f64, size: f64| (a - b).abs() <= NOISE * size;
        (*control == Control::Velocity || close(current.p, target.p, self.coordinates))
            && close(current.v, target.v, current.v.abs() + target.v.abs() + drift.abs())
            && (*jerk == f64::INFINITY || close(current.a, target.a, current.a.abs() + target.a.abs()))
    }
}

/// The motion after the brake.
#[derive(Debug, Clone, Copy)]
enum Motion {
    /// Position control with limited jerk; and how far the displacement may be off because its ends are large.
    Third(Problem, f64),
    /// The same from rest to rest.
    Rest(RestToRest),
    /// Position control with unlimited jerk.
    Second(SecondOrder),
    /// Velocity control: the velocity in the part of the position.
    Velocity(SecondOrder),
    /// A zero limit leaves one motion only: at constant acceleration, this long.
    Only(f64),
}

/// How an axis arrives.
#[derive(Debug, Clone, Copy)]
pub(super) enum Solution {
    /// It is there.
    AtOnce,
    Earliest(Arrival),
    Ramps(Ramps),
    /// The mixture that arrives after this time, without the brake: rare, and too large to be kept for every axis.
    Mixture(f64),
    /// Before the brake is complete, from where it turns.
    FromTurn(Arrival),
    /// Likewise the mixture that arrives this time after the turn.
    MixtureFromTurn(f64),
    Second(Cruise),
    Only,
}

/// One axis, ready to be asked when it can arrive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    motion: Motion,
    /// Duration of the brake, whose phases are in the profile already.
    brake: f64,
    /// State after the brake, in the user's units.
    start: Point,
    /// Where on the brake the target may be within reach.
    turn: Option<Turn>,
    /// The jerk limit, where the problem is normalised by it, negative where it is mirrored; otherwise 1.
    scale: f64,
    /// Of the coordinates.
    size: f64,
    at_target: bool,
    velocity_control: bool,
}

impl Axis {
    /// An axis that nobody plans.
    pub(super) const IDLE: Self = Self {
        motion: Motion::Only(0.0),
        brake: 0.0,
        start: Point { p: 0.0, v: 0.0, a: 0.0 },
        turn: None,
        scale: 0.0,
        size: 0.0,
        at_target: false,
        velocity_control: false,
    };

    /// Begins the profile with the brake, if one is needed, and makes the axis ready for the motion after it.
    pub(super) fn set(&mut self, input: &AxisInput, axis: usize, profile: &mut Profile) -> Result<(), Error> {
        self.start = input.current;
        self.scale = 1.0;
        self.size = input.coordinates;
        self.at_target = input.is_at_target();
        self.velocity_control = input.control == Control::Velocity;
        profile.begin(input.target, Order::Third);
        if input.jerk == 0.0 || input.a_max == 0.0 || input.a_min == 0.0 {
            if input.jerk == f64::INFINITY {
                profile.begin(input.target, Order::Second);
            }
            self.start.a = only_acceleration(input);
            self.motion = Motion::Only(only_duration(input).ok_or(Error::Unreachable { axis })?);
        } else if self.velocity_control {
            self.set_velocity(input, profile);
        } else if input.jerk < f64::INFINITY {
            self.set_third_order(input, profile);
        } else {
            self.set_second_order(input, profile);
            let unlimited = input.v_max == f64::INFINITY || input.v_min == f64::NEG_INFINITY;
            if profile.order() == Order::First && unlimited {
                return Err(Error::Unlimited { axis });
            }
        }
        if profile.duration() > 0.0 {
            self.brake = profile.duration();
            profile.brake_is_complete();
        }
        Ok(())
    }

    /// The problem in units in which the jerk limit is 1, mirrored where the way leads backward: most motions then get there by the
    /// family that gets farthest forward.
    fn normalise(&mut self, input: &AxisInput) -> Problem {
        let AxisInput { current, target, .. } = input;
        let displacement = target.p - current.p;
        let forward = displacement >= 0.0;
        self.scale = if forward { input.jerk } else { -input.jerk };
        let unit = 1.0 / self.scale;
        let limits =
            |max: f64, min: f64| if forward { (max * unit, min * unit) } else { (min * unit, max * unit) };
        let (v_max, v_min) = limits(input.v_max, input.v_min);
        let (a_max, a_min) = limits(input.a_max, input.a_min);
        Problem {
            displacement: displacement * unit,
            v0: current.v * unit,
            a0: current.a * unit,
            vf: target.v * unit,
            af: target.a * unit,
            v_max,
            v_min,
            a_max,
            a_min,
        }
    }

    fn set_third_order(&mut self, input: &AxisInput, profile: &mut Profile) {
        let mut problem = self.normalise(input);
        if input.is_rest_to_rest() {
            self.motion = Motion::Rest(RestToRest::new(&problem));
            return;
        }
        self.turn = Brake { problem: &mut problem, profile, now: &mut self.start, scale: self.scale }.apply();
        self.motion = Motion::Third(problem, NOISE * input.coordinates / input.jerk);
    }

    fn set_second_order(&mut self, input: &AxisInput, profile: &mut Profile) {
        let AxisInput { current, target, v_max, v_min, a_max, a_min, .. } = *input;
        let (rise, fall) = (1.0 / a_max, -1.0 / a_min);
        let (mut v0, mut vf) = (0.0, 0.0);
        if rise == 0.0 && fall == 0.0 {
            profile.begin(target, Order::First);
        } else {
            profile.begin(target, Order::Second);
            (v0, vf) = (between(current.v, v_min, v_max), target.v);
            let (duration, acceleration) = if current.v > v0 {
                ((current.v - v0) * fall, a_min)
            } else {
                ((v0 - current.v) * rise, a_max)
            };
            profile.push_forward(&Piece { duration, jerk: 0.0, acceleration }, 1.0, &mut self.start);
            self.start.v = v0;
        }
        let displacement = target.p - self.start.p;
        self.motion = Motion::Second(SecondOrder { displacement, v0, vf, v_max, v_min, rise, fall });
    }

    fn set_velocity(&mut self, input: &AxisInput, profile: &mut Profile) {
        if input.jerk == f64::INFINITY {
            profile.begin(input.target, Order::Second);
            let displacement = input.target.v - input.current.v;
            let (v_max, v_min) = (input.a_max, input.a_min);
            let jump = SecondOrder { displacement, v0: 0.0, vf: 0.0, v_max, v_min, rise: 0.0, fall: 0.0 };
            self.motion = Motion::Velocity(jump);
            return;
        }
        let mut problem = self.normalise(input);
        Brake { problem: &mut problem, profile, now: &mut self.start, scale: self.scale }
            .apply_acceleration();
        let Problem { v0, a0, vf, af, a_max, a_min, .. } = problem;
        let (displacement, v0, vf, v_max, v_min) = (vf - v0, a0, af, a_max, a_min);
        self.motion =
            Motion::Velocity(SecondOrder { displacement, v0, vf, v_max, v_min, rise: 1.0, fall: 1.0 });
    }

    /// The first arrival at or after `from`, at which the axis cannot arrive (or `from` is 0): its time and the solution.
    pub(super) fn earliest(&self, from: f64, solution: &mut Solution) -> f64 {
        if self.at_target && from <= 0.0 {
            *solution = Solution::AtOnce;
            return 0.0;
        }
        if let Some(turn) = &self.turn
            && let Some(arrival) = self.beyond_turn(turn).earliest_on_island(larger(from - turn.time, 0.0))
        {
            *solution = Solution::FromTurn(arrival);
            return turn.time + arrival.t;
        }
        let from = larger(from - self.brake, 0.0);
        let t = match &self.motion {
            Motion::Third(problem, coordinates) => {
                let arrival = ThirdOrder::new(*problem, *coordinates).earliest(from);
                *solution = Solution::Earliest(arrival);
                arrival.t
            }
            Motion::Rest(rest) => {
                // Never asked for a later one: every time from the first on is possible.
                let arrival = rest.earliest();
                *solution = Solution::Earliest(arrival);
                arrival.t
            }
            Motion::Second(second) | Motion::Velocity(second) => {
                let cruise = second.earliest(from);
                *solution = Solution::Second(cruise);
                cruise.duration()
            }
            Motion::Only(t) => {
                *solution = Solution::Only;
                if from > *t { f64::INFINITY } else { *t }
            }
        };
        self.brake + t
    }

    /// The first arrival if the target were nearer by the rounding of positions.
    #[cold]
    pub(super) fn earliest_but_for_rounding(&self, solution: &mut Solution) -> Option<f64> {
        let from_end = |arrival: Arrival| Arrival { from_end: true, ..arrival };
        if let Some(turn) = &self.turn
            && let third = self.beyond_turn(turn)
            && let Some(arrival) = third.earliest_on_island(0.0)
        {
            let arrival = third.nearer(&arrival).earliest_on_island(0.0)?;
            *solution = Solution::FromTurn(from_end(arrival));
            return Some(turn.time + arrival.t);
        }
        let arrival = match &self.motion {
            Motion::Third(problem, coordinates) => {
                let third = ThirdOrder::new(*problem, *coordinates);
                third.nearer(&third.earliest(0.0)).earliest(0.0)
            }
            Motion::Rest(rest) => rest.nearer(NOISE * self.size / self.scale.abs()).earliest(),
            _ => return None,
        };
        *solution = Solution::Earliest(from_end(arrival));
        Some(self.brake + arrival.t)
    }

    /// The arrival at `t`, if the axis can arrive then.
    pub(super) fn at(&self, t: f64) -> Option<Solution> {
        if let Some(turn) = &self.turn
            && let Some(passage) = self.beyond_turn(turn).at_on_island(t - turn.time)
        {
            return Some(match passage {
                Passage::Mean(_) => Solution::MixtureFromTurn(t - turn.time),
                Passage::Extreme(arrival) => Solution::FromTurn(arrival),
            });
        }
        let t = t - self.brake;
        match &self.motion {
            Motion::Third(problem, coordinates) => match Ramps::arriving(problem, t) {
                Some(ramps) => Some(Solution::Ramps(ramps)),
                None => ThirdOrder::new(*problem, *coordinates).at(t).map(|passage| match passage {
                    Passage::Mean(_) => Solution::Mixture(t),
                    Passage::Extreme(arrival) => Solution::Earliest(arrival),
                }),
            },
            Motion::Rest(rest) => Some(Solution::Earliest(rest.at(t))),
            Motion::Second(second) | Motion::Velocity(second) => second.at(t).map(Solution::Second),
            Motion::Only(only) => (*only == t).then_some(Solution::Only),
        }
    }

    /// Adds the motion of a solution to the profile. False if the numbers have overflowed.
    pub(super) fn write(&self, solution: &Solution, profile: &mut Profile) -> bool {
        match (&self.motion, solution) {
            (Motion::Third(problem, _), Solution::Earliest(arrival)) => {
                self.draft(profile).arrival(problem.a0, problem.af, arrival)
            }
            (Motion::Rest(_), Solution::Earliest(arrival)) => self.draft(profile).arrival(0.0, 0.0, arrival),
            (Motion::Third(problem, _), Solution::Ramps(ramps)) => self.draft(profile).ramps(problem, ramps),
            (Motion::Third(problem, coordinates), Solution::Mixture(t)) => {
                let passage = ThirdOrder::new(*problem, *coordinates).at(*t);
                self.draft(profile).passage(problem, passage)
            }
            (Motion::Third(..), Solution::FromTurn(arrival)) => self.turn.is_some_and(|turn| {
                let Problem { a0, af, .. } = turn.problem;
                self.write_from(&turn, profile, |draft| draft.arrival(a0, af, arrival))
            }),
            (Motion::Third(..), Solution::MixtureFromTurn(t)) => self.turn.is_some_and(|turn| {
                let passage = self.beyond_turn(&turn).at_on_island(*t);
                self.write_from(&turn, profile, |draft| draft.passage(&turn.problem, passage))
            }),
            (Motion::Second(second), Solution::Second(cruise)) => self.write_second(second, cruise, profile),
            (Motion::Velocity(second), Solution::Second(cruise)) => {
                self.write_velocity(second, cruise, profile)
            }
            (Motion::Only(t), Solution::Only) => self.write_only(*t, profile),
            _ => {
                // There already: no brake either.
                profile.begin(profile.target(), profile.order());
                true
            }
        }
    }

    fn draft<'a>(&self, profile: &'a mut Profile) -> Draft<'a> {
        Draft { profile, now: self.start, scale: self.scale, size: self.size }
    }

    /// The problem from the turn of the brake on.
    fn beyond_turn(&self, turn: &Turn) -> ThirdOrder {
        let coordinates = if let Motion::Third(_, coordinates) = self.motion { coordinates } else { 0.0 };
        ThirdOrder::new(turn.problem, coordinates)
    }

    /// Goes on from the turn of the brake. What comes before the velocity is inside its limits is the brake.
    fn write_from(
        &self,
        turn: &Turn,
        profile: &mut Profile,
        write: impl FnOnce(&mut Draft<'_>) -> bool,
    ) -> bool {
        profile.cut(turn.phases);
        let mut draft = Draft { profile, now: turn.start, scale: self.scale, size: self.size };
        let joined = write(&mut draft);
        let Problem { v_max, v_min, .. } = turn.problem;
        let (one, other) = (v_max * self.scale, v_min * self.scale);
        profile.brake_until_within(turn.phases, smaller(one, other), larger(one, other));
        joined
    }

    /// Position control without jerk limit: two ramps and a cruise.
    fn write_second(&self, second: &SecondOrder, cruise: &Cruise, profile: &mut Profile) -> bool {
        let mut now = self.start;
        for (to, duration) in [(cruise.w, cruise.first), (cruise.w, cruise.cruise), (second.vf, cruise.last)]
        {
            let acceleration = if duration > 0.0 { (to - now.v) / duration } else { 0.0 };
            profile.push_forward(&Piece { duration, jerk: 0.0, acceleration }, 1.0, &mut now);
            now.v = to; // jumps where the acceleration is unlimited
        }
        profile.joins(now, (profile.target().p, now.v), self.size)
    }

    /// Velocity control: two ramps of the acceleration and a hold, or a hold alone if the jerk is unlimited.
    fn write_velocity(&self, second: &SecondOrder, cruise: &Cruise, profile: &mut Profile) -> bool {
        let mut now = self.start;
        let ramp = |to: f64, from: f64, duration: f64| {
            let jerk = if to >= from { 1.0 } else { -1.0 };
            Piece { duration, jerk, acceleration: from }
        };
        for piece in [
            ramp(cruise.w, second.v0, cruise.first),
            Piece { duration: cruise.cruise, jerk: 0.0, acceleration: cruise.w },
            ramp(second.vf, cruise.w, cruise.last),
        ] {
            profile.push_forward(&piece, self.scale, &mut now);
        }
        let end = Point { p: now.p, ..profile.target() };
        profile.end_at(end);
        profile.duration() == 0.0 || profile.joins(now, (end.p, end.v), self.size)
    }

    /// The only motion that a zero limit leaves.
    fn write_only(&self, duration: f64, profile: &mut Profile) -> bool {
        let mut now = self.start;
        profile.push_forward(&Piece { duration, jerk: 0.0, acceleration: now.a }, 1.0, &mut now);
        if self.velocity_control {
            profile.end_at(Point { p: now.p, ..profile.target() });
        }
        let target = profile.target();
        profile.joins(now, (target.p, target.v), self.size) || self.velocity_control
    }
}

/// The acceleration that a zero limit leaves: the one there is or, where it may jump, none.
fn only_acceleration(input: &AxisInput) -> f64 {
    if input.jerk == f64::INFINITY { 0.0 } else { input.current.a }
}

/// Duration of the motion at constant acceleration from start to target, if there is one.
fn only_duration(input: &AxisInput) -> Option<f64> {
    let AxisInput { current, target, control, v_max, v_min, a_max, a_min, jerk, .. } = *input;
    if input.is_at_target() {
        return Some(0.0);
    }
    let position = control == Control::Position;
    let (change, displacement) = (target.v - current.v, target.p - current.p);
    let a = only_acceleration(input);
    let t = if a != 0.0 {
        change / a
    } else if position && change == 0.0 {
        displacement / current.v
    } else {
        return None;
    };
    let end = if jerk == f64::INFINITY { a } else { target.a };
    let travelled = 0.5 * (current.v + target.v) * t;
    let arrives =
        !position || (travelled - displacement).abs() <= ONLY * (travelled.abs() + input.coordinates);
    let within = (!position || (v_min <= current.v && current.v <= v_max)) && a_min <= a && a <= a_max;
    (t >= 0.0 && t.is_finite() && a == end && arrives && within).then_some(t)
}

/// How exactly, relative to the distance, a motion without choice must meet its target.
const ONLY: f64 = 1e-12;
