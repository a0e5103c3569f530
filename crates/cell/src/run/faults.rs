//! Faults in words.

use seamline::drive::DriveFault;
use seamline::kinematics::JointKind;
use seamline::safety::Fault;
use seamline::seam::Rejection;

use crate::record::JointInfo;
use crate::robot::JointUnit;

/// One sentence with name, joint and values, in degrees and millimetres.
#[must_use]
pub fn describe(fault: &Fault, joints: &[JointInfo]) -> String {
    let joint = |axis: usize| joints.get(axis).map_or("?", |joint| joint.name.as_str());
    let beyond = |what: &str, axis: usize, value: f64, limit: f64, per: &str| {
        let unit = JointUnit::of(joints.get(axis).map_or(JointKind::Revolute, |joint| joint.kind));
        let [value, limit] = [value, limit].map(|si| si * unit.per_si);
        let (joint, unit) = (joint(axis), unit.name);
        format!("{what} of joint {joint}: {value:.3} {unit}{per}, limit {limit:.3} {unit}{per}")
    };
    match *fault {
        Fault::FollowingError { axis, value, limit } => beyond("following error", axis, value, limit, ""),
        Fault::PositionLimit { axis, value, limit } => beyond("position limit", axis, value, limit, ""),
        Fault::VelocityLimit { axis, value, limit } => beyond("velocity limit", axis, value, limit, "/s"),
        Fault::AccelerationLimit { axis, value, limit } => {
            beyond("acceleration limit", axis, value, limit, "/s²")
        }
        Fault::JerkLimit { axis, value, limit } => beyond("jerk limit", axis, value, limit, "/s³"),
        Fault::Workspace { position } => at("workspace left", &position),
        Fault::NoInverse { position } => at("no joint solution", &position),
        Fault::NotFinite { axis } => format!("joint {} is not a number", joint(axis)),
        Fault::Starved => "no motion planned ahead".into(),
        Fault::PathForgotten { moves } => {
            format!("more than {moves} moves within the length of the prefilter on the feedrate")
        }
        Fault::Drive(DriveFault::Silent) => "drives silent".into(),
        Fault::Drive(DriveFault::Axis(axis, code)) => format!("drive of joint {}: alarm {code}", joint(axis)),
        Fault::Overrun { count } => format!("{count} cycles in a row were late"),
        Fault::EmergencyStop => "emergency stop".into(),
        Fault::ArcNotLit { tries: 1 } => "the arc did not light".into(),
        Fault::ArcNotLit { tries } => format!("the arc did not light in {tries} strikes"),
        Fault::ArcLost { seconds } => {
            format!("the arc went out ({:.0} ms without current)", 1000.0 * seconds)
        }
        Fault::NoRecord { file, weld } => {
            format!("MPF#({file}) holds no whole record of weld {}", weld + 1)
        }
        Fault::SeamLost { seen_to, dropped } => {
            let why = dropped.map_or("the sensor is silent", Rejection::name);
            format!(
                "the seam is lost: seen up to {:.1} mm of the tracked path (last reading: {why})",
                1000.0 * seen_to
            )
        }
    }
}

fn at(what: &str, position: &seamline::geometry::Vector3) -> String {
    let mm = position * 1000.0;
    format!("{what} at ({:.1}, {:.1}, {:.1}) mm", mm.x, mm.y, mm.z)
}
