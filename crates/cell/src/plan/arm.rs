//! The arm of a cell, ready for planning and running.

use seamline::geometry::Pose;
use seamline::kinematics::{
    ClosedForm, Configuration, InverseError, InverseMethod, Kinematics, SixAxisArm, SphericalWristArm,
};
use seamline::safety::MotionLimits;

use crate::cell::{Cell, Robot};
use crate::job;
use crate::robot::{ArmDescription, ArmError};

/// What planning asks of an arm beyond what the cycle does.
pub trait PlanningArm<const N: usize>: Kinematics<N> + Clone {
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
}

impl PlanningArm<6> for SixAxisArm {
    fn in_configuration(
        &self,
        base_from_flange: &Pose,
        configuration: &job::Configuration,
        reference: &[f64; 6],
    ) -> Result<[f64; 6], InverseError> {
        let c = configuration;
        let digits =
            [c.no_flip, c.lower_arm, c.rear, c.r_beyond_180, c.t_beyond_180, c.s_beyond_180].map(u8::from);
        match (spherical_wrist(self), Configuration::from_rconf(digits)) {
            (Some(arm), Some(configuration)) => {
                arm.inverse_in_configuration(base_from_flange, &configuration, reference)
            }
            // The flags name the branches of a spherical wrist; another arm goes to the nearest joints.
            _ => self.inverse_nearest(base_from_flange, reference),
        }
    }

    fn same_branch(&self, base_from_flange: &Pose, seed: &[f64; 6]) -> Result<[f64; 6], InverseError> {
        let Some(arm) = spherical_wrist(self) else { return self.inverse_nearest(base_from_flange, seed) };
        let posture = arm.posture(seed);
        let all = arm.inverse_within_limits(base_from_flange, seed)?;
        let same =
            all.as_slice().iter().find(|solution| solution.posture == posture || solution.at_wrist_pole);
        // The branch ends here, or leaves the limits: the nearest joints show by how much the arm would have to jump.
        same.map_or_else(|| self.inverse_nearest(base_from_flange, seed), |solution| Ok(solution.q))
    }

    fn configuration(&self, q: &[f64; 6]) -> job::Configuration {
        let Some(arm) = spherical_wrist(self) else { return job::Configuration::default() };
        let flags = arm.configuration(q).to_rconf().map(|digit| digit == 1);
        job::Configuration::from_flags(&flags)
    }
}

/// The closed form whose branches have the names of `RCONF`.
fn spherical_wrist(arm: &SixAxisArm) -> Option<&SphericalWristArm> {
    match arm.method() {
        InverseMethod::Exact(ClosedForm::SphericalWrist(arm)) => Some(arm),
        _ => None,
    }
}

/// An arm with all that a cell says about its joints. SI units.
#[derive(Debug, Clone)]
pub struct Arm<const N: usize, K> {
    /// The name that reports show.
    pub name: String,
    /// The names of the joints.
    pub joint_names: Vec<String>,
    /// The model, with the soft limits as its position limits.
    pub kinematics: K,
    /// Limits of the joints.
    pub limits: MotionLimits<N>,
    /// Encoder pulses per degree, with the axis's sign.
    pub pulses_per_degree: [f64; N],
    /// Permitted deviation of a joint from its drive's model.
    pub following_error: [f64; N],
    /// Where the simulated arm stands at first.
    pub home: [f64; N],
}

impl Arm<6, SixAxisArm> {
    /// The arm of a cell.
    ///
    /// # Errors
    /// [`ArmError`] where the cell's robot is no six-axis arm.
    pub fn from_cell(cell: &Cell) -> Result<Self, ArmError> {
        let robot = &cell.robot;
        let kinematics = ArmDescription::from_cell(robot)?.six_axis()?;
        let limits = motion_limits(robot)?;
        Ok(Self {
            name: robot.name.clone(),
            joint_names: robot.joints.iter().map(|joint| joint.name.clone()).collect(),
            kinematics,
            limits,
            // Joints of an arm turn: the unit of `pulses_per_unit` is the radian.
            pulses_per_degree: joints(robot, |joint| joint.pulses_per_unit.to_radians())?,
            following_error: joints(robot, |joint| joint.following_error)?,
            home: joints(robot, |joint| joint.home)?,
        })
    }
}

fn joints<T: Copy, const N: usize>(
    robot: &Robot,
    of: impl Fn(&crate::cell::Joint) -> T,
) -> Result<[T; N], ArmError> {
    let values: Vec<T> = robot.joints.iter().map(of).collect();
    values.try_into().map_err(|_| ArmError::JointCount { found: robot.joints.len(), expected: N })
}

fn motion_limits<const N: usize>(robot: &Robot) -> Result<MotionLimits<N>, ArmError> {
    Ok(MotionLimits {
        position: joints(robot, crate::cell::Joint::soft_limits)?,
        velocity: joints(robot, |joint| joint.velocity)?,
        acceleration: joints(robot, |joint| joint.acceleration)?,
        jerk: joints(robot, |joint| joint.jerk)?,
    })
}
