//! Faults in words.

use seamline::drive::DriveFault;
use seamline::safety::Fault;

/// One sentence with name, joint and values, in degrees and millimetres.
#[must_use]
pub fn describe(fault: &Fault, joint_names: &[String]) -> String {
    let joint = |axis: usize| joint_names.get(axis).map_or("?", String::as_str);
    let deg = |radians: f64| radians.to_degrees();
    let beyond = |what: &str, axis: usize, value: f64, limit: f64, unit: &str| {
        format!("{what} of joint {}: {:.3} {unit}, limit {:.3} {unit}", joint(axis), deg(value), deg(limit))
    };
    match *fault {
        Fault::FollowingError { axis, value, limit } => beyond("following error", axis, value, limit, "deg"),
        Fault::PositionLimit { axis, value, limit } => beyond("position limit", axis, value, limit, "deg"),
        Fault::VelocityLimit { axis, value, limit } => beyond("velocity limit", axis, value, limit, "deg/s"),
        Fault::AccelerationLimit { axis, value, limit } => {
            beyond("acceleration limit", axis, value, limit, "deg/s²")
        }
        Fault::JerkLimit { axis, value, limit } => beyond("jerk limit", axis, value, limit, "deg/s³"),
        Fault::Workspace { position } => at("workspace left", &position),
        Fault::NoInverse { position } => at("no joint solution", &position),
        Fault::NotFinite { axis } => format!("joint {} is not a number", joint(axis)),
        Fault::Starved => "no motion planned ahead".into(),
        Fault::Drive(DriveFault::Silent) => "drives silent".into(),
        Fault::Drive(DriveFault::Axis(axis, code)) => format!("drive of joint {}: alarm {code}", joint(axis)),
        Fault::Overrun { count } => format!("{count} cycles in a row were late"),
        Fault::EmergencyStop => "emergency stop".into(),
    }
}

fn at(what: &str, position: &seamline::geometry::Vector3) -> String {
    let mm = position * 1000.0;
    format!("{what} at ({:.1}, {:.1}, {:.1}) mm", mm.x, mm.y, mm.z)
}
