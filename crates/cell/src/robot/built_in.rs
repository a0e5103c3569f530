//! The arms that come with the program.

use seamline::kinematics::{JointKind, JointLimits, Kinematics, models};

use super::{ArmDescription, Chain, Joint, Structure};
use crate::cell::BuiltInRobot;

/// All of them, by name.
pub const BUILT_IN: [(&str, BuiltInRobot); 4] = [
    ("ar2010", BuiltInRobot::Ar2010),
    ("irb2400", BuiltInRobot::Irb2400),
    ("ur5e", BuiltInRobot::Ur5e),
    ("scara600", BuiltInRobot::Scara600),
];

const TURNING: [JointKind; 6] = [JointKind::Revolute; 6];
const SCARA: [JointKind; 4] =
    [JointKind::Revolute, JointKind::Revolute, JointKind::Prismatic, JointKind::Revolute];

impl ArmDescription {
    /// An arm that comes with the program, with its maker's limits.
    #[must_use]
    pub fn built_in(robot: BuiltInRobot) -> Self {
        let (structure, joints) = match robot {
            BuiltInRobot::Ar2010 => {
                let arm = models::ar2010();
                let joints = joints(["S", "L", "U", "R", "B", "T"], TURNING, arm.limits());
                (Structure::SphericalWrist(*arm.geometry()), joints)
            }
            BuiltInRobot::Irb2400 => {
                let arm = models::irb2400();
                let joints = joints(["1", "2", "3", "4", "5", "6"], TURNING, arm.limits());
                (Structure::SphericalWrist(*arm.geometry()), joints)
            }
            BuiltInRobot::Ur5e => {
                let arm = models::ur5e();
                let names = ["base", "shoulder", "elbow", "wrist 1", "wrist 2", "wrist 3"];
                let at_zero = arm.axes(&[0.0; 6]);
                let (axes, base_from_flange) = (at_zero.axes.to_vec(), at_zero.base_from_flange);
                let structure = Structure::Chain(Chain::Axes { axes, base_from_flange });
                (structure, joints(names, TURNING, arm.limits()))
            }
            BuiltInRobot::Scara600 => {
                let arm = models::scara600();
                let joints = joints(["1", "2", "3", "4"], SCARA, arm.limits());
                (Structure::Scara(*arm.geometry()), joints)
            }
        };
        let name = BUILT_IN.iter().find(|(_, known)| *known == robot).map_or("", |(name, _)| name);
        Self { name: name.to_owned(), joints, structure }
    }
}

fn joints<const N: usize>(names: [&str; N], kinds: [JointKind; N], limits: &JointLimits<N>) -> Vec<Joint> {
    let ranges = limits.position().iter().zip(limits.velocity());
    let joint = |((name, kind), (&(position_min, position_max), &velocity_max)): ((&str, _), _)| Joint {
        name: name.to_owned(),
        kind,
        position_min,
        position_max,
        velocity_max,
    };
    names.into_iter().zip(kinds).zip(ranges).map(joint).collect()
}
