//! Arm kinematics: from joints to the flange and back, with all derivatives that a controlled motion needs.
//!
//! Joint positions are in radians (metres for a prismatic joint), in the maker's own directions and zero. The pose
//! is always `base_from_flange`; tools and user frames multiply outside. Nothing here allocates, and every call has a
//! bounded cost.
//!
//! | model | inverse |
//! |---|---|
//! | [`SphericalWristArm`] | closed form, up to 8 branches |

mod axes;
mod chain;
mod differential;
mod error;
mod limits;
pub mod models;
mod singular_values;
mod spherical_wrist;

pub use axes::{Jacobian, JointAxes, JointAxis};
pub use chain::{
    DhConvention, DhRow, JointDescription, JointKind, NumericSolution, SerialChain, SolverSettings,
};
pub use error::{InverseError, ModelError, Singularity};
pub use limits::JointLimits;
pub use singular_values::SingularValues;
pub use spherical_wrist::{
    Configuration, Elbow, OpwParameters, Posture, Shoulder, SingularityDistances, Solution, Solutions,
    SphericalWristArm, SphericalWristGeometry, Wrist,
};

use crate::geometry::{Pose, PoseJet};

/// Joint positions and their first three derivatives along a parameter: time, or a path coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointJet<const N: usize> {
    /// Position in radians (metres for a prismatic joint).
    pub position: [f64; N],
    /// First derivative.
    pub velocity: [f64; N],
    /// Second derivative.
    pub acceleration: [f64; N],
    /// Third derivative.
    pub jerk: [f64; N],
}

impl<const N: usize> JointJet<N> {
    /// Joints that stand still.
    #[must_use]
    pub fn at_rest(position: [f64; N]) -> Self {
        Self { position, velocity: [0.0; N], acceleration: [0.0; N], jerk: [0.0; N] }
    }
}

/// What the control cycle asks of an arm with N joints.
pub trait Kinematics<const N: usize> {
    /// The flange's pose in the base frame at joint positions `q`.
    fn forward(&self, q: &[f64; N]) -> Pose;

    /// The joints' axes and the flange at joint positions `q`: the Jacobian and its derivatives follow from them.
    fn axes(&self, q: &[f64; N]) -> JointAxes<N>;

    /// The joint positions within the limits that reach the pose and lie nearest to `seed` (least sum of squared
    /// differences), full turns included.
    ///
    /// # Errors
    /// [`InverseError`] where no such positions exist.
    fn inverse_nearest(&self, base_from_flange: &Pose, seed: &[f64; N]) -> Result<[f64; N], InverseError>;

    /// The joints' derivatives while the flange moves as `base_from_flange` says, on the branch of `q`: the joint
    /// positions at `base_from_flange.pose`, as [`Kinematics::inverse_nearest`] gave them.
    ///
    /// # Errors
    /// [`InverseError::Singular`] where the arm cannot follow the motion at a bounded joint speed.
    fn joint_jet(&self, base_from_flange: &PoseJet, q: &[f64; N]) -> Result<JointJet<N>, InverseError>;

    /// Least and greatest position of each joint.
    fn position_limits(&self) -> &[(f64, f64); N];

    /// Greatest speed of each joint, in rad/s (m/s for a prismatic joint).
    fn velocity_limits(&self) -> &[f64; N];
}
