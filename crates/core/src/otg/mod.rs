//! The online trajectory generator: from any state to any state, in the least time, within limits of velocity, acceleration and jerk.
//!
//! [`calculate`] answers an [`Input`] with a [`Trajectory`]. The derivation is in `docs/otg.md`; the problem is that of L. Berscheid and
//! T. Kröger (*Jerk-limited Real-time Trajectory Generation with Arbitrary Target States*, RSS 2021), the method is another.
//!
//! | room | holds |
//! |---|---|
//! | `input`, `error`, `validate` | the question, and why it may have no answer |
//! | `extremal` | the motions that get farthest in a given time: one family, one parameter |
//! | `third_order` | when an axis can arrive: the least time, and the intervals in which it cannot |
//! | `fixed_duration` | how it arrives at a given time |
//! | `rest_to_rest` | the same for an axis that starts and ends at rest, in closed form but for one search |
//! | `second_order` | the same one derivative down: unlimited jerk, and velocity control |
//! | `brake` | back inside the limits first |
//! | `axis` | one axis, whichever of these it needs |
//! | `line` | phase synchronization: one scalar problem along the line |
//! | `synchronize` | the instant at which all axes can arrive |
//! | `profile`, `extrema`, `trajectory` | the answer |
//! | `generator` | the answer one cycle at a time |
//!
//! Units: any, as long as all of one axis agree; time in seconds. The answer does not depend on them: no tolerance has a unit.
//!
//! What is not here: no tolerance that decides whether a solution is valid, no list of profile cases, no iteration without bound, no longest duration.

mod axis;
mod brake;
mod error;
mod extrema;
mod extremal;
mod fixed_duration;
mod generator;
mod input;
mod line;
mod number;
mod profile;
mod rest_to_rest;
mod second_order;
mod synchronize;
mod third_order;
mod trajectory;
mod validate;

pub use error::{Error, Quantity};
pub use extrema::PositionExtrema;
pub use generator::{Generator, Output, Status};
pub use input::{Control, Input, Limits, State, Synchronization};
pub use profile::{MAX_PHASES, Order, Phase, Profile};
pub use trajectory::{Sample, Trajectory};

use axis::{Axis, AxisInput};
use line::Line;
use number::larger;
use synchronize::{Demand, Never, Plan, common_duration};
use validate::out_of_range;

/// Plans the motion from the current to the target state.
///
/// ```
/// use seamline::otg::{Input, Limits, State, calculate};
/// // Two axes in rad: the second one moves already.
/// let current = State { position: [0.0, 0.5], velocity: [0.0, 0.1], acceleration: [0.0, 0.0] };
/// let limits = Limits::symmetric([2.0, 3.0], [10.0, 10.0], [100.0, 100.0]);
/// let trajectory = calculate(&Input::new(current, State::at_rest([1.0, -0.5]), limits))?;
/// let halfway = trajectory.at_time(trajectory.duration() / 2.0);
/// assert!(halfway.velocity[0] <= 2.0 && halfway.velocity[1] < 0.0);
/// assert_eq!(trajectory.at_time(trajectory.duration()).position, [1.0, -0.5]);
/// # Ok::<(), seamline::otg::Error>(())
/// ```
///
/// # Errors
/// [`Error`] names axis, quantity and value. Valid input has a trajectory unless a zero limit keeps the axis from its target, a line was
/// demanded that is none, or a position limit would be passed.
///
/// # Cost
/// Some 2,200 instructions an axis, from rest to rest 1,150; bounded, see `docs/otg.md`, section 12.
pub fn calculate<const N: usize>(input: &Input<N>) -> Result<Trajectory<N>, Error> {
    let mut trajectory = Trajectory::default();
    calculate_into(input, &mut trajectory)?;
    Ok(trajectory)
}

/// As [`calculate`], into a trajectory that is there already: no large value is moved.
///
/// # Errors
/// As [`calculate`]; the trajectory is then not one to be followed.
pub fn calculate_into<const N: usize>(input: &Input<N>, trajectory: &mut Trajectory<N>) -> Result<(), Error> {
    validate::validate(input)?;
    let groups = Groups::new(input, &mut trajectory.synchronized)?;
    let mut axes = [Axis::IDLE; N];
    let mut plans = [Plan::AT_ONCE; N];
    for axis in 0..N {
        let own = AxisInput::of(input, axis);
        let profile = &mut trajectory.profiles[axis];
        let problem = match &groups.line {
            Some(line) if line.reference == axis => &line.scalar,
            _ => &own,
        };
        if matches!(groups.roles[axis], Role::Off | Role::Follower) {
            profile.begin(own.current, Order::Third);
        } else {
            let set = axes[axis].set(problem, axis, profile);
            set.map_err(|error| match error {
                Error::Unreachable { axis } => unreachable(input, &groups, axis),
                other => other,
            })?;
            plans[axis].find_earliest(&axes[axis]);
        }
        trajectory.duration_min[axis] = plans[axis].earliest;
    }

    let demand = Demand { min: input.duration_min.unwrap_or(0.0), step: input.duration_step.unwrap_or(0.0) };
    let never = |Never { axis }: Never| unreachable(input, &groups, axis);
    trajectory.duration = common_duration(&axes, &mut plans, &groups.roles, &demand).map_err(never)?;
    for axis in 0..N {
        match groups.roles[axis] {
            Role::Off | Role::Follower => continue,
            Role::Alone => {
                let only =
                    core::array::from_fn(|other| if other == axis { Role::Together } else { Role::Off });
                let duration = common_duration(&axes, &mut plans, &only, &demand).map_err(never)?;
                trajectory.duration = larger(duration, trajectory.duration);
            }
            Role::Early | Role::Together => {}
        }
        if !axes[axis].write(&plans[axis].solution, &mut trajectory.profiles[axis]) {
            return Err(out_of_range(input, axis));
        }
    }
    if let Some(line) = &groups.line {
        spread(input, line, trajectory)?;
    }
    for axis in (0..N).filter(|&axis| input.target_moves[axis] && groups.roles[axis] != Role::Off) {
        trajectory.profiles[axis].carry(AxisInput::of(input, axis).drift);
    }
    // An axis that arrives long before the others goes on, and so may its numbers.
    let duration = trajectory.duration;
    let overflows = |axis: &usize| {
        let profile = &trajectory.profiles[*axis];
        profile.duration() < duration && !profile.after_end(duration).position.is_finite()
    };
    if let Some(axis) = (0..N).filter(|&axis| groups.roles[axis] != Role::Off).find(overflows) {
        return Err(out_of_range(input, axis));
    }
    trajectory.check_positions(input)
}

/// Why an axis, or one of the line that it leads, does not arrive: a limit is zero, or has become so beside the other numbers.
#[cold]
fn unreachable<const N: usize>(input: &Input<N>, groups: &Groups<N>, axis: usize) -> Error {
    let leads = groups.line.as_ref().is_some_and(|line| line.reference == axis);
    let concerned = |other: &usize| *other == axis || (leads && groups.roles[*other] == Role::Follower);
    let zero = |other: &usize| AxisInput::of(input, *other).has_zero_limit();
    match (0..N).filter(concerned).find(zero) {
        Some(axis) => Error::Unreachable { axis },
        None => out_of_range(input, axis),
    }
}

/// Gives the axes of a line their shares of the motion along it.
fn spread<const N: usize>(
    input: &Input<N>,
    line: &Line<N>,
    trajectory: &mut Trajectory<N>,
) -> Result<(), Error> {
    let scalar = trajectory.profiles[line.reference];
    let duration_min = trajectory.duration_min[line.reference];
    for axis in (0..N).filter(|&axis| trajectory.synchronized[axis] == Synchronization::Phase) {
        let AxisInput { current, target, control, .. } = AxisInput::of(input, axis);
        let profile = &mut trajectory.profiles[axis];
        *profile = scalar.along(current, target, control, line.direction[axis]);
        if !profile.is_finite() {
            return Err(out_of_range(input, axis));
        }
        trajectory.duration_min[axis] = duration_min;
    }
    Ok(())
}

/// What an axis is in the synchronization.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// Not planned.
    Off,
    /// Arrives at its own time.
    Alone,
    /// Arrives at its own time, which the others' is not before.
    Early,
    /// Arrives with the others.
    Together,
    /// Moves along the line, planned for the line's reference.
    Follower,
}

/// Which axes arrive together, and how.
struct Groups<const N: usize> {
    roles: [Role; N],
    /// The line that phase-synchronized axes keep to.
    line: Option<Line<N>>,
}

impl<const N: usize> Groups<N> {
    fn new(input: &Input<N>, modes: &mut [Synchronization; N]) -> Result<Self, Error> {
        let mut groups = Self { roles: [Role::Off; N], line: None };
        let mut members = [false; N];
        for axis in (0..N).filter(|&axis| input.enabled[axis]) {
            let at_rest = input.target.velocity[axis] == 0.0 && input.target.acceleration[axis] == 0.0;
            groups.roles[axis] = match input.synchronization[axis] {
                Synchronization::None => Role::Alone,
                Synchronization::TimeIfNecessary if at_rest => Role::Early,
                Synchronization::Time | Synchronization::TimeIfNecessary => Role::Together,
                Synchronization::Phase | Synchronization::PhaseStrict => {
                    members[axis] = true;
                    Role::Follower
                }
            };
        }
        if members.contains(&true) {
            groups.find_line(input, &members)?;
        }
        *modes = groups.roles.map(|role| match role {
            Role::Off | Role::Alone | Role::Early => Synchronization::None,
            Role::Together => Synchronization::Time,
            Role::Follower => Synchronization::Phase,
        });
        if let Some(line) = &groups.line {
            groups.roles[line.reference] = Role::Together;
        }
        Ok(groups)
    }

    /// The line of these axes or, if there is none, time synchronization.
    fn find_line(&mut self, input: &Input<N>, members: &[bool; N]) -> Result<(), Error> {
        match Line::new(input, members) {
            Ok(line) => self.line = Some(line),
            Err(axis) => {
                let strict = |axis: usize| input.synchronization[axis] == Synchronization::PhaseStrict;
                if (0..N).any(|axis| members[axis] && strict(axis)) {
                    return Err(Error::NotCollinear { axis });
                }
                for axis in (0..N).filter(|&axis| members[axis]) {
                    self.roles[axis] = Role::Together;
                }
            }
        }
        Ok(())
    }
}
