//! How a chain is given: joint by joint, or by a table of Denavit–Hartenberg parameters.

use crate::geometry::{Pose, Rotation, Vector3};
use crate::kinematics::{JointKind, ModelError};

/// A joint as URDF describes it: where its frame stands on the link before, and its axis in that frame. Fixed joints
/// in between multiply into the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointDescription {
    /// The joint's frame on the link before, at position zero.
    pub parent_from_joint: Pose,
    /// The axis in the joint's frame, of any length but zero.
    pub axis: Vector3,
    /// Revolute or prismatic.
    pub kind: JointKind,
}

impl JointDescription {
    /// The rotation that takes z onto the joint's axis.
    pub(super) fn z_onto_axis(&self, axis: usize) -> Result<Pose, ModelError> {
        let direction = self.axis.try_normalize(0.0).ok_or(ModelError::Axis { axis })?;
        Ok(Pose::from_parts(Vector3::zeros().into(), z_onto(&direction)))
    }
}

/// A rotation that takes z onto a unit vector.
pub(super) fn z_onto(direction: &Vector3) -> Rotation {
    // Exactly opposite, any half turn across will do.
    Rotation::rotation_between(&Vector3::z(), direction)
        .unwrap_or_else(|| Rotation::from_axis_angle(&Vector3::x_axis(), core::f64::consts::PI))
}

/// Which of the two conventions a table follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DhConvention {
    /// Denavit & Hartenberg 1955: Rz(θ)·Tz(d)·Tx(a)·Rx(α), a and α of the link behind the joint.
    Standard,
    /// Craig: Rx(α)·Tx(a)·Rz(θ)·Tz(d), a and α of the link before the joint.
    Modified,
}

/// One row of a table; metres and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DhRow {
    /// Length a along x.
    pub a: f64,
    /// Twist α about x.
    pub alpha: f64,
    /// Offset d along z; of a prismatic joint, at position zero.
    pub d: f64,
    /// Angle θ about z; of a revolute joint, at position zero.
    pub theta: f64,
    /// Revolute or prismatic.
    pub kind: JointKind,
}

/// The joint frames that a table describes, each on the one before, and the flange behind the last.
pub(crate) fn from_dh<const N: usize>(
    rows: &[DhRow; N],
    convention: DhConvention,
) -> ([(Pose, JointKind); N], Pose) {
    let mut parent_from_joint = Pose::identity();
    let joints = rows.map(|row| {
        let along_x = Pose::from_parts([row.a, 0.0, 0.0].into(), turned(&Vector3::x(), row.alpha));
        let along_z = Pose::from_parts([0.0, 0.0, row.d].into(), turned(&Vector3::z(), row.theta));
        let (before, behind) = match convention {
            DhConvention::Standard => (Pose::identity(), along_z * along_x),
            DhConvention::Modified => (along_x, along_z),
        };
        let joint = (parent_from_joint * before, row.kind);
        parent_from_joint = behind;
        joint
    });
    (joints, parent_from_joint)
}

fn turned(axis: &Vector3, angle: f64) -> Rotation {
    Rotation::from_scaled_axis(axis * angle)
}
