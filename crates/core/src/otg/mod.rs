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
use synchronize::{Demand, Plan, common_duration};

/// Plans the motion from the current to the target state.
///
/// # Errors
/// [`Error`] names axis, quantity and value. Valid input has a trajectory unless a zero limit keeps the axis from its target, a line was
/// demanded that is none, or a position limit would be passed.
pub fn calculate<const N: usize>(input: &Input<N>) -> Result<Trajectory<N>, Error> {
    validate::validate(input)?;
    let groups = Groups::new(input)?;
    let mut error = None;
    let axes: [Axis; N] = core::array::from_fn(|axis| {
        let made = match &groups.line {
            Some(line) if line.reference == axis => Axis::new(&line.scalar, axis),
            _ if groups.planned[axis] => Axis::new(&AxisInput::of(input, axis), axis),
            _ => Ok(Axis::coasting(&AxisInput::of(input, axis))),
        };
        made.unwrap_or_else(|e| {
            error = error.or(Some(e));
            Axis::coasting(&AxisInput::of(input, axis))
        })
    });
    if let Some(error) = error {
        return Err(error);
    }
    let mut plans: [Plan; N] = core::array::from_fn(|axis| Plan::new(&axes[axis]));
    let duration_min = core::array::from_fn(|axis| plans[groups.leader(axis)].earliest);

    let demand = Demand { min: input.duration_min.unwrap_or(0.0), step: input.duration_step.unwrap_or(0.0) };
    let mut durations = [0.0; N];
    let common = common_duration(&axes, &mut plans, &groups.together, &groups.early, &demand)?;
    let mut duration = common;
    for axis in 0..N {
        durations[axis] = if groups.together[axis] {
            common
        } else if groups.alone[axis] {
            let only = core::array::from_fn(|other| other == axis);
            let own = common_duration(&axes, &mut plans, &only, &[false; N], &demand)?;
            duration = own.max(duration);
            own
        } else {
            plans[axis].earliest
        };
    }
    let mut profiles: [Profile; N] =
        core::array::from_fn(|axis| plans[axis].profile(&axes[axis], durations[axis]));
    if let Some(line) = &groups.line {
        spread(input, line, &groups.members, &mut profiles);
    }
    let trajectory = Trajectory { profiles, duration, duration_min, synchronized: groups.modes };
    trajectory.check_positions(input)?;
    Ok(trajectory)
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
