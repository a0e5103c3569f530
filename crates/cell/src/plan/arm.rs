//! The arm of a cell, ready for planning and running.

mod scara;
mod six_axis;

use seamline::geometry::{Pose, Rotation};
use seamline::kinematics::{InverseError, JointKind, Kinematics, ScaraArm, SixAxisArm};
use seamline::safety::MotionLimits;

use crate::cell::{Cell, Joint, Robot};
use crate::job;
use crate::robot::{ArmDescription, ArmError, JointUnit};

/// What planning asks of an arm beyond what the cycle does.
pub trait PlanningArm<const N: usize>: Kinematics<N> + Clone {
    /// The arm that a description is about.
    ///
    /// # Errors
    /// [`ArmError`] where that is no such arm.
    fn from_description(description: &ArmDescription) -> Result<Self, ArmError>;

    /// The joints that reach a flange pose in a configuration.
    ///
    /// # Errors
    /// [`InverseError`] where there are none within the limits.
    fn in_configuration(
        &self,
        base_from_flange: &Pose,
        configuration: &job::Configuration,
        reference: &[f64; N],
    ) -> Result<[f64; N], InverseError>;

    /// The joints that reach a flange pose on the branch of `seed`: no singularity lies between. Near a singularity the
    /// nearest joints may lie on another branch; these do not.
    ///
    /// # Errors
    /// [`InverseError`] where this branch does not reach the pose, or not within the limits.
    fn same_branch(&self, base_from_flange: &Pose, seed: &[f64; N]) -> Result<[f64; N], InverseError>;

    /// The configuration of joint positions.
    fn configuration(&self, q: &[f64; N]) -> job::Configuration;

    /// The orientation of the flange that the arm can take, where one that it cannot take differs by the rounding of a job's
    /// digits only; any other orientation as it is. An arm that turns about three axes takes all of them.
    fn taken_orientation(&self, base_from_flange: &Rotation) -> Rotation {
        *base_from_flange
    }

    /// Why there are no joints, where this arm has better words for it than arms have in general.
    fn in_own_words(&self, _error: &InverseError) -> Option<String> {
        None
    }
}

/// An arm with all that a cell says about its joints. SI units.
#[derive(Debug, Clone)]
pub struct Arm<const N: usize, K> {
    /// The name that reports show.
    pub name: String,
    /// The names of the joints.
    pub joint_names: Vec<String>,
    /// Turning or sliding.
    pub joint_kinds: [JointKind; N],
    /// The model, with the soft limits as its position limits.
    pub kinematics: K,
    /// Limits of the joints.
    pub limits: MotionLimits<N>,
    /// Encoder pulses per radian or metre, with the axis's sign.
    pub pulses_per_unit: [f64; N],
    /// Permitted deviation of a joint from its drive's model.
    pub following_error: [f64; N],
    /// Where the simulated arm stands at first.
    pub home: [f64; N],
}

impl<const N: usize, K: PlanningArm<N>> Arm<N, K> {
    /// The arm of a cell.
    ///
    /// # Errors
    /// [`ArmError`] where the cell's robot is no such arm.
    pub fn from_cell(cell: &Cell) -> Result<Self, ArmError> {
        let robot = &cell.robot;
        let kinematics = K::from_description(&ArmDescription::from_cell(robot)?)?;
        Ok(Self {
            name: robot.name.clone(),
            joint_names: robot.joints.iter().map(|joint| joint.name.clone()).collect(),
            joint_kinds: joints(robot, |joint| joint.kind)?,
            kinematics,
            limits: MotionLimits {
                position: joints(robot, Joint::soft_limits)?,
                velocity: joints(robot, |joint| joint.velocity)?,
                acceleration: joints(robot, |joint| joint.acceleration)?,
                jerk: joints(robot, |joint| joint.jerk)?,
            },
            pulses_per_unit: joints(robot, |joint| joint.pulses_per_unit)?,
            following_error: joints(robot, |joint| joint.following_error)?,
            home: joints(robot, |joint| joint.home)?,
        })
    }
}

impl<const N: usize, K> Arm<N, K> {
    /// The unit that people read this joint's coordinate in.
    #[must_use]
    pub fn unit(&self, joint: usize) -> JointUnit {
        JointUnit::of(self.joint_kinds[joint])
    }
}

/// The arm of a cell, of one of the kinds that jobs run on.
#[derive(Debug, Clone)]
pub enum CellArm {
    /// Six axes of any structure.
    SixAxis(Box<Arm<6, SixAxisArm>>),
    /// Two links in a level plane, a stroke and a turn.
    Scara(Box<Arm<4, ScaraArm>>),
}

impl CellArm {
    /// The arm of a cell.
    ///
    /// # Errors
    /// [`ArmError`] where the cell's robot is of neither kind, or its numbers are no arm.
    pub fn from_cell(cell: &Cell) -> Result<Self, ArmError> {
        if ArmDescription::from_cell(&cell.robot)?.is_scara() {
            Arm::from_cell(cell).map(Box::new).map(Self::Scara)
        } else {
            Arm::from_cell(cell).map(Box::new).map(Self::SixAxis)
        }
    }
}

fn joints<T: Copy, const N: usize>(robot: &Robot, of: impl Fn(&Joint) -> T) -> Result<[T; N], ArmError> {
    let values: Vec<T> = robot.joints.iter().map(of).collect();
    values.try_into().map_err(|_| ArmError::JointCount { found: robot.joints.len(), expected: N })
}
