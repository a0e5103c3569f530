//! The online trajectory generator: from any state to any state, in the least time, within limits of velocity, acceleration and jerk.
//!
//! [`calculate`] answers an [`Input`] with a [`Trajectory`]. The derivation is in `docs/otg.md`; after T. Kröger and L. Berscheid
//! (*Jerk-limited Real-time Trajectory Generation with Arbitrary Target States*, RSS 2021) for the problem, with a method of its own.
//!
//! | room | holds |
//! |---|---|
//! | `input`, `error`, `validate` | the question, and why it may have no answer |
//! | `extremal` | the motions that get farthest in a given time: one family, one parameter |
//! | `third_order` | when an axis can arrive: the least time, and the intervals in which it cannot |
//! | `fixed_duration` | how it arrives at a given time |
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
use synchronize::{Demand, Plan, common_duration};

/// Plans the motion from the current to the target state.
///
/// # Errors
/// [`Error`] names axis, quantity and value. Valid input has a trajectory unless a zero limit keeps the axis from its target, a line was
/// demanded that is none, or a position limit would be passed.
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
    let groups = Groups::new(input)?;
    let mut axes = [Axis::IDLE; N];
    let mut plans = [Plan::AT_ONCE; N];
    for axis in 0..N {
        let profile = &mut trajectory.profiles[axis];
        match &groups.line {
            Some(line) if line.reference == axis => axes[axis].set(&line.scalar, axis, profile)?,
            _ if groups.planned[axis] => axes[axis].set(&AxisInput::of(input, axis), axis, profile)?,
            _ => profile.begin(AxisInput::of(input, axis).current, Order::Third),
        }
        plans[axis].find_earliest(&axes[axis]);
    }
    trajectory.duration_min = core::array::from_fn(|axis| plans[groups.leader(axis)].earliest);
    trajectory.synchronized = groups.modes;

    let demand = Demand { min: input.duration_min.unwrap_or(0.0), step: input.duration_step.unwrap_or(0.0) };
    let common = common_duration(&axes, &mut plans, &groups.together, &groups.early, &demand)?;
    trajectory.duration = common;
    for axis in (0..N).filter(|&axis| groups.planned[axis]) {
        if groups.alone[axis] {
            let only = core::array::from_fn(|other| other == axis);
            let duration = common_duration(&axes, &mut plans, &only, &[false; N], &demand)?;
            trajectory.duration = larger(duration, trajectory.duration);
        }
        axes[axis].write(&plans[axis].solution, &mut trajectory.profiles[axis]);
    }
    if let Some(line) = &groups.line {
        spread(input, line, &groups.members, &mut trajectory.profiles);
    }
    trajectory.check_positions(input)
}

/// Gives the axes of a line their shares of the motion along it.
fn spread<const N: usize>(
    input: &Input<N>,
    line: &Line<N>,
    members: &[bool; N],
    profiles: &mut [Profile; N],
) {
    let scalar = profiles[line.reference];
    for axis in (0..N).filter(|&axis| members[axis]) {
        let AxisInput { current, target, control, .. } = AxisInput::of(input, axis);
        profiles[axis] = scalar.along(current, target, control, line.direction[axis]);
    }
}

/// Which axes arrive together, and how.
struct Groups<const N: usize> {
    /// The line that phase-synchronized axes keep to.
    line: Option<Line<N>>,
    /// Its axes.
    members: [bool; N],
    /// Axes that are planned themselves: all enabled ones but those that follow the line's reference.
    planned: [bool; N],
    /// Planned axes that arrive at the common instant.
    together: [bool; N],
    /// Planned axes that may arrive before it.
    early: [bool; N],
    /// Planned axes that are not synchronized.
    alone: [bool; N],
    /// What each axis in fact gets.
    modes: [Synchronization; N],
}

impl<const N: usize> Groups<N> {
    fn new(input: &Input<N>) -> Result<Self, Error> {
        use Synchronization::{None as Alone, Phase, PhaseStrict, Time, TimeIfNecessary};
        let asked = |axis: usize| input.synchronization[axis];
        let phase = |axis: usize| input.enabled[axis] && matches!(asked(axis), Phase | PhaseStrict);
        let mut members: [bool; N] = core::array::from_fn(phase);
        let mut line = None;
        if members.contains(&true) {
            match Line::new(input, &members) {
                Ok(found) => line = Some(found),
                Err(axis) if (0..N).any(|i| members[i] && asked(i) == PhaseStrict) => {
                    return Err(Error::NotCollinear { axis });
                }
                Err(_) => members = [false; N],
            }
        }
        let reference = line.as_ref().map(|line| line.reference);
        let at_rest = |i: usize| input.target.velocity[i] == 0.0 && input.target.acceleration[i] == 0.0;
        let modes = core::array::from_fn(|i| match asked(i) {
            _ if !input.enabled[i] => Alone,
            Phase | PhaseStrict => {
                if members[i] {
                    Phase
                } else {
                    Time
                }
            }
            TimeIfNecessary => {
                if at_rest(i) {
                    Alone
                } else {
                    Time
                }
            }
            Time => Time,
            Alone => Alone,
        });
        let planned: [bool; N] =
            core::array::from_fn(|i| input.enabled[i] && (!members[i] || reference == Some(i)));
        let early: [bool; N] =
            core::array::from_fn(|i| planned[i] && asked(i) == TimeIfNecessary && modes[i] == Alone);
        let together = core::array::from_fn(|i| planned[i] && modes[i] != Alone);
        let alone = core::array::from_fn(|i| planned[i] && modes[i] == Alone && !early[i]);
        Ok(Self { line, members, planned, together, early, alone, modes })
    }

    /// The axis that is planned for this one.
    fn leader(&self, axis: usize) -> usize {
        match &self.line {
            Some(line) if self.members[axis] => line.reference,
            _ => axis,
        }
    }
}
