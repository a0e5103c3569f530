//! Arm kinematics: from joints to the flange and back, with all derivatives that a controlled motion needs.
//!
//! Joint positions are in radians (metres for a prismatic joint), in the maker's own directions and zero. The pose
//! is always `base_from_flange`; tools and user frames multiply outside. Nothing here allocates, and every call has a
//! bounded cost.
//!
//! | model | inverse |
//! |---|---|
//! | [`SphericalWristArm`] | closed form, up to 8 branches by name |
//! | [`ThreeParallelArm`] | closed form, up to 8 branches |
//! | [`ScaraArm`] | closed form, both elbows |
//! | [`SerialChain`] | numeric: damped Newton, then Taylor steps |
//! | [`SixAxisArm`] | a chain, with the closed form where its structure has one, polished where it has one nearly |
//!
//! ```
//! use seamline::kinematics::{Kinematics, models};
//!
//! let arm = models::ar2010();
//! let q = [0.1, 0.2, -0.3, 0.4, -0.5, 0.6];
//! let base_from_flange = arm.forward(&q);
//! let found = arm.inverse_nearest(&base_from_flange, &q).expect("q itself reaches it");
//! assert!(found.iter().zip(q).all(|(found, q)| (found - q).abs() < 1e-12));
//! let branches = arm.inverse(&base_from_flange, &q).expect("q is one of them");
//! assert_eq!(branches.as_slice().len(), 8);
//! ```

mod axes;
mod branches;
mod chain;
mod closed_form;
mod differential;
mod error;
mod limits;
pub mod models;
mod scara;
mod singular_values;
mod six_axis;
mod spherical_wrist;
mod three_parallel;

pub use axes::{Jacobian, JointAxes, JointAxis, JointKind};
pub use branches::Branches;
pub use chain::{DhConvention, DhRow, JointDescription, NumericSolution, SerialChain, SolverSettings};
pub use error::{InverseError, ModelError, Singularity};
pub use limits::JointLimits;
pub use scara::{Handedness, ScaraArm, ScaraGeometry, ScaraSolution, ScaraSolutions};
pub use singular_values::SingularValues;
pub use six_axis::{ClosedForm, InverseMethod, SixAxisArm};
pub use spherical_wrist::{
    Configuration, Elbow, OpwParameters, Posture, Shoulder, SingularityDistances, Solution, Solutions,
    SphericalWristArm, SphericalWristGeometry, Wrist,
};
pub use three_parallel::ThreeParallelArm;

use crate::geometry::{Pose, PoseJet};
use crate::math::taylor::Taylor;

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

    /// From positions and the series that have them as values.
    #[inline]
    fn of_series(position: [f64; N], series: [Taylor; N]) -> Self {
        let derivatives = series.map(|s| s.derivatives());
        Self {
            position,
            velocity: derivatives.map(|[d1, _, _]| d1),
            acceleration: derivatives.map(|[_, d2, _]| d2),
            jerk: derivatives.map(|[_, _, d3]| d3),
        }
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

    /// Every solution within the limits that the model knows, each joint in the turn nearest to `reference`: one a
    /// branch of a closed form; a numeric inverse knows only the one that [`Kinematics::inverse_nearest`] finds.
    ///
    /// # Errors
    /// [`InverseError`] where there is none.
    fn inverse_branches(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; N],
    ) -> Result<Branches<[f64; N], 8>, InverseError> {
        let mut found = Branches::none(*reference);
        found.push(self.inverse_nearest(base_from_flange, reference)?);
        Ok(found)
    }

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
