//! Arms whose number of joints is known only at run time: built in, from a cell file, from URDF.
//!
//! An [`ArmDescription`] is data. [`ArmDescription::with_arm`] builds the arm that it describes, with the best inverse
//! that its structure allows, and hands it to a piece of work that is generic over arms.

mod built_in;
mod cell_file;
mod error;
mod unit;
mod urdf;

use seamline::geometry::Pose;
use seamline::kinematics::{
    DhConvention, DhRow, InverseMethod, JointAxes, JointAxis, JointKind, JointLimits, Kinematics, ScaraArm,
    ScaraGeometry, SerialChain, SixAxisArm, SphericalWristArm, SphericalWristGeometry,
};

use crate::cell::JOINTS_MAX;

pub use built_in::BUILT_IN;
pub use error::{ArmError, UrdfError, UrdfProblem};
pub use unit::JointUnit;

/// An arm as data.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmDescription {
    /// The name that its source gives it.
    pub name: String,
    /// The joints from base to flange.
    pub joints: Vec<Joint>,
    structure: Structure,
}

/// A joint's name, kind and limits. Radians or metres by its kind, and seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The maker's letter or name.
    pub name: String,
    /// Turning or sliding.
    pub kind: JointKind,
    /// Least position; minus infinity where there is none.
    pub position_min: f64,
    /// Greatest position; infinity where there is none.
    pub position_max: f64,
    /// Greatest speed; infinity where there is none.
    pub velocity_max: f64,
}

/// What holds the joints together.
#[derive(Debug, Clone, PartialEq)]
enum Structure {
    SphericalWrist(SphericalWristGeometry),
    Scara(ScaraGeometry),
    Chain(Chain),
}

/// A chain of any structure.
#[derive(Debug, Clone, PartialEq)]
enum Chain {
    Dh {
        convention: DhConvention,
        rows: Vec<DhRow>,
    },
    /// By the joints' axes and the flange with all joints at zero.
    Axes {
        axes: Vec<JointAxis>,
        base_from_flange: Pose,
    },
}

/// How an arm's inverse is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Inverse {
    /// In closed form.
    ClosedForm,
    /// In closed form for the nearest arm that has one, and from there numerically.
    Polished,
    /// Numerically.
    Numeric,
}

/// Work for an arm of any number of joints.
pub trait ArmTask {
    /// What comes of it.
    type Output;

    /// Does the work.
    fn run<const N: usize>(self, arm: &impl Kinematics<N>, inverse: Inverse) -> Self::Output;
}

impl ArmDescription {
    /// Builds the arm, and lets `task` work with it.
    ///
    /// # Errors
    /// [`ArmError`] where the numbers are no arm, or the arm has no joint or more than seven.
    pub fn with_arm<T: ArmTask>(&self, task: T) -> Result<T::Output, ArmError> {
        match &self.structure {
            Structure::SphericalWrist(geometry) => {
                let arm = SphericalWristArm::try_new(*geometry, self.limits()?)?;
                Ok(task.run(&arm, Inverse::ClosedForm))
            }
            Structure::Scara(_) => Ok(task.run(&self.scara()?, Inverse::ClosedForm)),
            Structure::Chain(chain) => self.with_chain(chain, task),
        }
    }

    /// The arm, if it has six axes, with the best inverse that its structure allows.
    ///
    /// # Errors
    /// [`ArmError`] where the numbers are no arm, or the arm has another number of joints.
    pub fn six_axis(&self) -> Result<SixAxisArm, ArmError> {
        match &self.structure {
            Structure::SphericalWrist(geometry) => {
                Ok(SphericalWristArm::try_new(*geometry, self.limits()?)?.into())
            }
            Structure::Scara(_) => Err(ArmError::JointCount { found: self.joints.len(), expected: 6 }),
            Structure::Chain(chain) => Ok(SixAxisArm::from_chain(self.build(chain)?)),
        }
    }

    /// Whether the arm is a SCARA by its structure.
    #[must_use]
    pub fn is_scara(&self) -> bool {
        matches!(self.structure, Structure::Scara(_))
    }

    /// The arm, if it is a SCARA.
    ///
    /// # Errors
    /// [`ArmError`] where the numbers are no arm, or the arm has another structure.
    pub fn scara(&self) -> Result<ScaraArm, ArmError> {
        match &self.structure {
            Structure::Scara(geometry) => Ok(ScaraArm::try_new(*geometry, self.limits()?)?),
            _ => Err(ArmError::Structure { expected: "a SCARA" }),
        }
    }

    fn with_chain<T: ArmTask>(&self, chain: &Chain, task: T) -> Result<T::Output, ArmError> {
        match self.joints.len() {
            1 => Ok(task.run(&self.build::<1>(chain)?, Inverse::Numeric)),
            2 => Ok(task.run(&self.build::<2>(chain)?, Inverse::Numeric)),
            3 => Ok(task.run(&self.build::<3>(chain)?, Inverse::Numeric)),
            4 => Ok(task.run(&self.build::<4>(chain)?, Inverse::Numeric)),
            5 => Ok(task.run(&self.build::<5>(chain)?, Inverse::Numeric)),
            6 => {
                let arm = self.six_axis()?;
                let inverse = match arm.method() {
                    InverseMethod::Exact(_) => Inverse::ClosedForm,
                    InverseMethod::Polished(_) => Inverse::Polished,
                    InverseMethod::Numeric => Inverse::Numeric,
                };
                Ok(task.run(&arm, inverse))
            }
            7 => Ok(task.run(&self.build::<7>(chain)?, Inverse::Numeric)),
            found => Err(ArmError::JointCount { found, expected: JOINTS_MAX }),
        }
    }

    fn build<const N: usize>(&self, chain: &Chain) -> Result<SerialChain<N>, ArmError> {
        let limits = self.limits()?;
        let built = match chain {
            Chain::Dh { convention, rows } => {
                SerialChain::from_dh(&array(rows)?, *convention, &Pose::identity(), &Pose::identity(), limits)
            }
            Chain::Axes { axes, base_from_flange } => {
                let at_zero = JointAxes { axes: array(axes)?, base_from_flange: *base_from_flange };
                SerialChain::from_axes(&at_zero, limits)
            }
        };
        Ok(built?)
    }

    fn limits<const N: usize>(&self) -> Result<JointLimits<N>, ArmError> {
        let joints: [&Joint; N] = array(&self.joints.iter().collect::<Vec<_>>())?;
        let position = joints.map(|joint| (joint.position_min, joint.position_max));
        Ok(JointLimits::try_new(position, joints.map(|joint| joint.velocity_max))?)
    }
}

fn array<T: Copy, const N: usize>(values: &[T]) -> Result<[T; N], ArmError> {
    values.try_into().map_err(|_| ArmError::JointCount { found: values.len(), expected: N })
}
