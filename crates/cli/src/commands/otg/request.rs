//! A question to the generator, as it stands on a line.

use seamline::otg::{Control, Input, Limits, State, Synchronization};

use crate::json_lines::{Mistake, Numbers, Object};

/// Most axes of a question.
pub(super) const AXES_MAX: usize = 16;

const KEYS: [&str; 12] = [
    "id",
    "control",
    "synchronization",
    "enabled",
    "current",
    "target",
    "target_moves",
    "limits",
    "duration_min",
    "duration_step",
    "sample",
    "profiles",
];
const STATE_KEYS: [&str; 3] = ["position", "velocity", "acceleration"];
const LIMIT_KEYS: [&str; 7] = [
    "velocity_max",
    "velocity_min",
    "acceleration_max",
    "acceleration_min",
    "jerk_max",
    "position_max",
    "position_min",
];

const CONTROLS: [(&str, Control); 2] = [("position", Control::Position), ("velocity", Control::Velocity)];
const SYNCHRONIZATIONS: [(&str, Synchronization); 5] = [
    ("none", Synchronization::None),
    ("time", Synchronization::Time),
    ("time_if_necessary", Synchronization::TimeIfNecessary),
    ("phase", Synchronization::Phase),
    ("phase_strict", Synchronization::PhaseStrict),
];

/// A target's velocities and accelerations: what is not given is zero.
const ZERO_IF_NULL: Numbers = Numbers { null: Some(0.0), ..Numbers::ANY };
/// Positions, some of which may not matter.
const NAN_IF_NULL: Numbers = Numbers { null: Some(f64::NAN), ..Numbers::ANY };
const UPPER: Numbers = Numbers {
    min: 0.0,
    null: Some(f64::INFINITY),
    expected: "a number of 0 or more, or null for no limit",
    ..Numbers::ANY
};
const LOWER: Numbers = Numbers {
    max: 0.0,
    null: Some(f64::NEG_INFINITY),
    expected: "a number of 0 or less, or null for no limit",
    ..Numbers::ANY
};
const HIGHEST: Numbers = Numbers { null: Some(f64::INFINITY), ..Numbers::ANY };
const LOWEST: Numbers = Numbers { null: Some(f64::NEG_INFINITY), ..Numbers::ANY };
const SECONDS: Numbers = Numbers { min: 0.0, expected: "seconds, 0 or more", ..Numbers::ANY };
const FRACTION: Numbers = Numbers { min: 0.0, max: 1.0, expected: "a number from 0 to 1", ..Numbers::ANY };

/// A question of N axes.
pub(super) struct Request<const N: usize> {
    pub(super) input: Input<N>,
    /// Instants to sample at, as fractions of the duration.
    pub(super) sample: Vec<f64>,
    /// Whether the answer shows each axis's pieces.
    pub(super) profiles: bool,
}

/// How many axes a question has: as many as its current position. At most [`AXES_MAX`], at least one.
pub(super) fn axes(line: &Object<'_>) -> Result<usize, Mistake> {
    line.check_spelling(&KEYS)?;
    let expected = "a list of 1 to 16 numbers";
    let position = match state(line, "current")? {
        Some(current) => current.list("position", expected)?,
        None => None,
    };
    match position.map(<[_]>::len) {
        Some(axes @ 1..=AXES_MAX) => Ok(axes),
        Some(other) => {
            Err(Mistake::new(format!("current.position: found a list of {other}, expected {expected}")))
        }
        None => Err(Mistake::missing("current.position", expected)),
    }
}

impl<const N: usize> Request<N> {
    pub(super) fn read(line: &Object<'_>) -> Result<Self, Mistake> {
        let mut input = Input::new(State::default(), State::default(), limits(line)?);
        line.choices("control", &CONTROLS, &mut input.control)?;
        line.choices("synchronization", &SYNCHRONIZATIONS, &mut input.synchronization)?;
        if let Some(current) = state(line, "current")? {
            current.fill_required("position", &Numbers::ANY, &mut input.current.position)?;
            current.fill("velocity", &Numbers::ANY, &mut input.current.velocity)?;
            current.fill("acceleration", &Numbers::ANY, &mut input.current.acceleration)?;
        }
        line.flags("enabled", &mut input.enabled)?;
        line.flags("target_moves", &mut input.target_moves)?;
        input.target = target(line, &input)?;
        input.duration_min = line.number("duration_min", &SECONDS)?;
        input.duration_step = line.number("duration_step", &SECONDS)?;
        Ok(Self {
            input,
            sample: line.numbers("sample", &FRACTION)?.unwrap_or_default(),
            profiles: line.flag("profiles")?.unwrap_or(false),
        })
    }
}

fn state<'a>(line: &Object<'a>, key: &'static str) -> Result<Option<Object<'a>>, Mistake> {
    line.object(key, &STATE_KEYS)
}

/// The target; axes in velocity control need no position, and those that are not planned nothing.
fn target<const N: usize>(line: &Object<'_>, input: &Input<N>) -> Result<State<N>, Mistake> {
    let mut target = State::at_rest([f64::NAN; N]);
    if let Some(given) = state(line, "target")? {
        given.fill("position", &NAN_IF_NULL, &mut target.position)?;
        given.fill("velocity", &ZERO_IF_NULL, &mut target.velocity)?;
        given.fill("acceleration", &ZERO_IF_NULL, &mut target.acceleration)?;
    }
    for (axis, position) in target.position.iter_mut().enumerate() {
        if input.control[axis] == Control::Velocity || !input.enabled[axis] {
            *position = 0.0;
        } else if position.is_nan() {
            let expected = "a number (only axes in velocity control need none)";
            return Err(Mistake::missing(&format!("target.position[{axis}]"), expected));
        }
    }
    Ok(target)
}

fn limits<const N: usize>(line: &Object<'_>) -> Result<Limits<N>, Mistake> {
    let unlimited = [f64::INFINITY; N];
    let mut limits = Limits::symmetric(unlimited, unlimited, unlimited);
    let Some(given) = line.object("limits", &LIMIT_KEYS)? else { return Ok(limits) };
    given.fill("velocity_max", &UPPER, &mut limits.velocity_max)?;
    given.fill("acceleration_max", &UPPER, &mut limits.acceleration_max)?;
    given.fill("jerk_max", &UPPER, &mut limits.jerk_max)?;
    limits.velocity_min = limits.velocity_max.map(|v| -v);
    limits.acceleration_min = limits.acceleration_max.map(|a| -a);
    given.fill("velocity_min", &LOWER, &mut limits.velocity_min)?;
    given.fill("acceleration_min", &LOWER, &mut limits.acceleration_min)?;
    given.fill("position_max", &HIGHEST, &mut limits.position_max)?;
    given.fill("position_min", &LOWEST, &mut limits.position_min)?;
    Ok(limits)
}
