//! Poses and their derivatives.
//!
//! A pose is a rigid transformation named by its two frames: `base_from_tcp` maps coordinates in the tool centre
//! point's frame to coordinates in the base frame. Lengths in metres, angles in radians.

mod euler;
mod pose_jet;

pub use euler::{EulerZyx, unwind};
pub use pose_jet::PoseJet;

/// A rigid transformation between two frames (position in metres, unit quaternion).
pub type Pose = nalgebra::Isometry3<f64>;
/// A vector in space.
pub type Vector3 = nalgebra::Vector3<f64>;
/// A rotation as unit quaternion.
pub type Rotation = nalgebra::UnitQuaternion<f64>;

/// Whether every coordinate of a pose is a finite number.
#[inline]
#[must_use]
pub fn is_finite(pose: &Pose) -> bool {
    (pose.translation.vector.sum() + pose.rotation.coords.sum()).is_finite()
}
