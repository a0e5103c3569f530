//! From a job's positions to joints and poses.

use seamline::geometry::Pose;
use seamline::kinematics::InverseError;

use super::arm::{Arm, PlanningArm};
use super::error::Problem;
use crate::cell::Cell;
use crate::job::{Coordinates, Frame, Target, joints_from_pulses};

/// Values that a robot's position has as a rule.
const SIX: usize = 6;

/// A tool of the cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ToolPose {
    pub(super) flange_from_tcp: Pose,
}

/// A target in the robot's own terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Goal<const N: usize> {
    /// The tool centre point in the base frame.
    pub(super) base_from_tcp: Pose,
    pub(super) tool: ToolPose,
    /// The joints that were taught: given as pulses, or by the configuration.
    pub(super) joints: Result<[f64; N], InverseError>,
}

impl ToolPose {
    pub(super) fn of(cell: &Cell, number: u32) -> Result<Self, Problem> {
        let tool = cell.tool(number).ok_or(Problem::UnknownTool { number })?;
        Ok(Self { flange_from_tcp: tool.flange_from_tcp })
    }
}

/// The target in robot terms; joints that the job leaves open lie near `reference`.
pub(super) fn goal<const N: usize, K: PlanningArm<N>>(
    target: &Target,
    cell: &Cell,
    arm: &Arm<N, K>,
    reference: &[f64; N],
) -> Result<Goal<N>, Problem> {
    let name = || target.to_string();
    let tool = ToolPose::of(cell, target.position.tool)?;
    match &target.position.coordinates {
        Coordinates::Pulses(pulses) => {
            let joints = joints_of(pulses, arm, &name())?;
            check_range(&joints, arm, &name())?;
            let base_from_tcp = arm.kinematics.forward(&joints) * tool.flange_from_tcp;
            Ok(Goal { base_from_tcp, tool, joints: Ok(joints) })
        }
        Coordinates::Rectangular(position) => {
            let taught = base_from_frame(position.frame, cell, &name())? * position.pose();
            let base_from_tcp = with_taken_orientation(&taught, &tool, &arm.kinematics);
            let base_from_flange = base_from_tcp * tool.flange_from_tcp.inverse();
            let joints =
                arm.kinematics.in_configuration(&base_from_flange, &position.configuration, reference);
            // No way leads to an orientation that the arm cannot take.
            if let Err(error @ InverseError::OutOfOrientation { .. }) = &joints {
                return Err(Problem::Unreachable { name: name(), reason: arm.in_words(error) });
            }
            Ok(Goal { base_from_tcp, tool, joints })
        }
        Coordinates::Angles(_) => Err(Problem::StationPosition { name: name() }),
    }
}

/// The tool centre point where it is taught, turned to what the arm can take by no more than the job's digits round.
fn with_taken_orientation<const N: usize>(
    base_from_tcp: &Pose,
    tool: &ToolPose,
    arm: &impl PlanningArm<N>,
) -> Pose {
    let flange_from_tcp = &tool.flange_from_tcp.rotation;
    let base_from_flange = base_from_tcp.rotation * flange_from_tcp.inverse();
    let taken = arm.taken_orientation(&base_from_flange);
    // Bit for bit as taught where there is nothing to turn.
    let rotation = if taken == base_from_flange { base_from_tcp.rotation } else { taken * flange_from_tcp };
    Pose::from_parts(base_from_tcp.translation, rotation)
}

/// The joints after an increment in pulses.
pub(super) fn pulse_increment<const N: usize, K>(
    target: &Target,
    arm: &Arm<N, K>,
    from: &[f64; N],
) -> Result<[f64; N], Problem> {
    let name = target.to_string();
    let Coordinates::Pulses(pulses) = &target.position.coordinates else {
        return Err(Problem::StationPosition { name });
    };
    let step = joints_of(pulses, arm, &name)?;
    let joints = std::array::from_fn(|joint| from[joint] + step[joint]);
    check_range(&joints, arm, &name)?;
    Ok(joints)
}

fn joints_of<const N: usize, K>(pulses: &[i32], arm: &Arm<N, K>, name: &str) -> Result<[f64; N], Problem> {
    let length = || Problem::PositionLength { name: name.into(), found: pulses.len(), expected: N };
    // Behind a six-axis arm's values may stand those of other axes; behind fewer there is nothing but filling.
    if N < SIX && pulses.iter().skip(N).any(|&pulses| pulses != 0) {
        return Err(length());
    }
    joints_from_pulses(pulses, &arm.pulses_per_unit).ok_or_else(length)
}

/// The frame that a target is given in; `name` is the target's.
pub(super) fn base_from_frame(frame: Frame, cell: &Cell, name: &str) -> Result<Pose, Problem> {
    match frame {
        Frame::Base | Frame::Robot => Ok(Pose::identity()),
        Frame::User(number) => {
            let frame = cell.user_frame(number).ok_or(Problem::UnknownFrame { number })?;
            Ok(frame.base_from_user)
        }
        frame => Err(Problem::UnsupportedFrame { name: name.into(), frame }),
    }
}

/// The joints lie within the soft limits.
fn check_range<const N: usize, K>(joints: &[f64; N], arm: &Arm<N, K>, name: &str) -> Result<(), Problem> {
    for (joint, (value, (min, max))) in joints.iter().zip(arm.limits.position).enumerate() {
        if !(min..=max).contains(value) {
            let unit = arm.unit(joint);
            return Err(Problem::JointRange {
                name: name.into(),
                joint: arm.joint_names[joint].clone(),
                value: value * unit.per_si,
                min: min * unit.per_si,
                max: max * unit.per_si,
                unit: unit.name,
            });
        }
    }
    Ok(())
}
