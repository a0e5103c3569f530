//! Why a description is no arm.

use seamline::kinematics::ModelError;
use thiserror::Error;

use crate::cell::JOINTS_MAX;

/// Why a description is no arm.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ArmError {
    /// The URDF file is wrong.
    #[error(transparent)]
    Urdf(#[from] UrdfError),
    /// The model has another number of joints than the cell file, or than is possible.
    #[error("found {found} joints, expected {expected}")]
    JointCount {
        /// The model's joints.
        found: usize,
        /// What would do.
        expected: usize,
    },
    /// The arm is of another structure than its user can work with.
    #[error("expected {expected}")]
    Structure {
        /// What would do.
        expected: &'static str,
    },
    /// A joint of the model is of another kind than in the cell file.
    #[error("joint {name}: the model's is {model}, the cell file's is {cell}")]
    JointKind {
        /// The joint's name in the cell file.
        name: String,
        /// The model's.
        model: &'static str,
        /// The cell file's.
        cell: &'static str,
    },
    /// The numbers are no arm.
    #[error("{}", in_words(.0))]
    Model(ModelError),
}

impl From<ModelError> for ArmError {
    fn from(error: ModelError) -> Self {
        Self::Model(error)
    }
}

fn in_words(error: &ModelError) -> String {
    match *error {
        ModelError::NotFinite => "a dimension is not a finite number".to_owned(),
        ModelError::Axis { axis } => format!("joint {}: its axis has no direction", axis + 1),
        ModelError::Length { value } => format!("a length is {value} m, expected a positive one"),
        ModelError::Sign { axis, value } => {
            format!("joint {}: its sign is {value}, expected 1 or -1", axis + 1)
        }
        ModelError::PositionLimits { axis, min, max } => {
            format!("joint {}: positions from {min} to {max}, expected least before greatest", axis + 1)
        }
        ModelError::VelocityLimit { axis, value } => {
            format!("joint {}: its greatest speed is {value}, expected a positive one", axis + 1)
        }
    }
}

/// What is wrong with a URDF file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}: {problem}")]
pub struct UrdfError {
    /// The file as the caller named it.
    pub file: String,
    /// What is wrong.
    pub problem: UrdfProblem,
}

/// What is wrong in a URDF file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UrdfProblem {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// The file is not URDF.
    #[error("not URDF: {0}")]
    Syntax(String),
    /// There is no link of this name.
    #[error("link {link}: not in the file, expected one of {}", .known.join(", "))]
    UnknownLink {
        /// The name.
        link: String,
        /// What there is.
        known: Vec<String>,
    },
    /// Two joints move one link.
    #[error("link {link}: the child of joints {first} and {second}, expected a tree")]
    TwoParents {
        /// The link.
        link: String,
        /// One joint.
        first: String,
        /// The other.
        second: String,
    },
    /// The chain's base is open.
    #[error("base: found {} roots ({}), expected one, or a base link by name", .found.len(), .found.join(", "))]
    Roots {
        /// The links that are no joint's child.
        found: Vec<String>,
    },
    /// The chain's end is open.
    #[error("tip: found {} ends ({}), expected one, or a tip link by name", .found.len(), .found.join(", "))]
    Tips {
        /// The links that are no joint's parent.
        found: Vec<String>,
    },
    /// No joints lead from one to the other.
    #[error("link {tip}: does not hang on link {base}")]
    NoChain {
        /// The chain's base.
        base: String,
        /// The chain's tip.
        tip: String,
    },
    /// Too few or too many joints.
    #[error("from link {base} to link {tip}: found {found} moving joints, expected 1 to {JOINTS_MAX}")]
    JointCount {
        /// The chain's base.
        base: String,
        /// The chain's tip.
        tip: String,
        /// Joints that move.
        found: usize,
    },
    /// A joint that an arm cannot have.
    #[error("joint {joint}: {found}, expected {expected}")]
    Joint {
        /// The joint's name.
        joint: String,
        /// What it has.
        found: String,
        /// What it should have.
        expected: &'static str,
    },
}
