//! General serial chains of turning and sliding joints.
//!
//! Forward kinematics goes from link to link; the inverse is numeric, or in closed form where the structure allows it.

pub(super) mod description;
mod solver;
mod structure;

pub use description::{DhConvention, DhRow, JointDescription};
pub use solver::{NumericSolution, SolverSettings};

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::differential::inverse_jet;
use super::{InverseError, JointAxes, JointAxis, JointJet, JointKind, JointLimits, Kinematics, ModelError};
use crate::geometry::{Pose, PoseJet, Vector3};
use crate::math::float::sin_cos;

/// A serial chain of N joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SerialChain<const N: usize> {
    links: [Link; N],
    /// From the last joint's frame.
    flange: Frame,
    limits: JointLimits<N>,
}

/// A joint with what lies before it. Its axis is the z axis of its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Link {
    parent_from_joint: Frame,
    kind: JointKind,
}

/// A rigid transformation as a matrix: columns are at hand, and turning about z touches two of them.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Frame {
    rotation: Matrix3<f64>,
    position: Vector3,
}

impl Frame {
    fn of(pose: &Pose) -> Self {
        Self { rotation: pose.rotation.to_rotation_matrix().into_inner(), position: pose.translation.vector }
    }

    #[inline]
    fn then(&self, next: &Self) -> Self {
        Self {
            rotation: self.rotation * next.rotation,
            position: self.rotation * next.position + self.position,
        }
    }

    #[inline]
    fn turned_about_z(&self, angle: f64) -> Self {
        let (sin, cos) = sin_cos(angle);
        let (x, y, z) = (self.rotation.column(0), self.rotation.column(1), self.rotation.column(2));
        let rotation = Matrix3::from_columns(&[x * cos + y * sin, y * cos - x * sin, z.into_owned()]);
        Self { rotation, position: self.position }
    }

    #[inline]
    fn pose(&self) -> Pose {
        let rotation = Rotation3::from_matrix_unchecked(self.rotation);
        Pose::from_parts(self.position.into(), UnitQuaternion::from_rotation_matrix(&rotation))
    }
}

impl<const N: usize> SerialChain<N> {
    /// A chain from its joints, base to flange, as URDF describes them.
    ///
    /// # Errors
    /// [`ModelError`] for a number that is not finite or an axis without direction.
    pub fn try_new(
        joints: &[JointDescription; N],
        last_from_flange: &Pose,
        limits: JointLimits<N>,
    ) -> Result<Self, ModelError> {
        let mut turned = [(Pose::identity(), JointKind::Revolute); N];
        // Joint frames are turned so that their z axis is the joint's axis.
        let mut described_from_turned = Pose::identity();
        for (axis, (turned, joint)) in turned.iter_mut().zip(joints).enumerate() {
            let turn = joint.z_onto_axis(axis)?;
            *turned = (described_from_turned.inverse() * joint.parent_from_joint * turn, joint.kind);
            described_from_turned = turn;
        }
        Self::of_z_joints(&turned, &(described_from_turned.inverse() * last_from_flange), limits).checked()
    }

    /// A chain from its axes at zero (a product of exponentials).
    ///
    /// # Errors
    /// [`ModelError`] for a number that is not finite or an axis without direction.
    pub fn from_axes(at_zero: &JointAxes<N>, limits: JointLimits<N>) -> Result<Self, ModelError> {
        let mut unit = *at_zero;
        for (index, axis) in unit.axes.iter_mut().enumerate() {
            axis.direction = axis.direction.try_normalize(0.0).ok_or(ModelError::Axis { axis: index })?;
        }
        Self::of_unit_axes(&unit, limits).checked()
    }

    /// A chain from its axes at zero, whose directions are of unit length.
    pub(super) fn of_unit_axes(at_zero: &JointAxes<N>, limits: JointLimits<N>) -> Self {
        let mut base_from_last = Pose::identity();
        let joints = at_zero.axes.map(|axis| {
            let base_from_joint = Pose::from_parts(axis.point.into(), description::z_onto(&axis.direction));
            let parent_from_joint = base_from_last.inverse() * base_from_joint;
            base_from_last = base_from_joint;
            (parent_from_joint, axis.kind)
        });
        Self::of_z_joints(&joints, &(base_from_last.inverse() * at_zero.base_from_flange), limits)
    }

    /// A chain from a table of Denavit–Hartenberg parameters.
    ///
    /// # Errors
    /// [`ModelError::NotFinite`].
    pub fn from_dh(
        rows: &[DhRow; N],
        convention: DhConvention,
        base_from_first: &Pose,
        last_from_flange: &Pose,
        limits: JointLimits<N>,
    ) -> Result<Self, ModelError> {
        let (joints, flange) = description::from_dh(rows, convention);
        let mut joints = joints;
        if let Some((first, _)) = joints.first_mut() {
            *first = base_from_first * *first;
        }
        Self::of_z_joints(&joints, &(flange * last_from_flange), limits).checked()
    }

    /// A chain whose joint axes are the z axes of their frames.
    pub(super) fn of_z_joints(
        joints: &[(Pose, JointKind); N],
        last_from_flange: &Pose,
        limits: JointLimits<N>,
    ) -> Self {
        let links = joints
            .map(|(parent_from_joint, kind)| Link { parent_from_joint: Frame::of(&parent_from_joint), kind });
        Self { links, flange: Frame::of(last_from_flange), limits }
    }

    fn checked(self) -> Result<Self, ModelError> {
        let sum = |frame: &Frame| frame.rotation.sum() + frame.position.sum();
        let numbers: f64 = self.links.iter().map(|link| sum(&link.parent_from_joint)).sum();
        if (numbers + sum(&self.flange)).is_finite() { Ok(self) } else { Err(ModelError::NotFinite) }
    }

    /// The chain's limits.
    #[must_use]
    pub fn limits(&self) -> &JointLimits<N> {
        &self.limits
    }

    /// The last joint's frame turned to `q`, and each joint's frame passed on the way.
    #[inline]
    fn walk(&self, q: &[f64; N], mut passed: impl FnMut(usize, &Frame)) -> Frame {
        let mut frame = Frame { rotation: Matrix3::identity(), position: Vector3::zeros() };
        for (i, (link, &position)) in self.links.iter().zip(q).enumerate() {
            let joint = frame.then(&link.parent_from_joint);
            passed(i, &joint);
            frame = match link.kind {
                JointKind::Revolute => joint.turned_about_z(position),
                JointKind::Prismatic => {
                    Frame { position: joint.position + joint.rotation.column(2) * position, ..joint }
                }
            };
        }
        frame.then(&self.flange)
    }
}

impl<const N: usize> Kinematics<N> for SerialChain<N> {
    #[inline]
    fn forward(&self, q: &[f64; N]) -> Pose {
        self.walk(q, |_, _| ()).pose()
    }

    #[inline]
    fn axes(&self, q: &[f64; N]) -> JointAxes<N> {
        let mut axes = self.links.map(|Link { kind, .. }| JointAxis {
            direction: Vector3::zeros(),
            point: Vector3::zeros(),
            kind,
        });
        let flange = self.walk(q, |i, joint| {
            axes[i].direction = joint.rotation.column(2).into_owned();
            axes[i].point = joint.position;
        });
        JointAxes { axes, base_from_flange: flange.pose() }
    }

    /// The numeric inverse from the seed, and from other starts where that fails: [`SerialChain::solve`] with
    /// [`SolverSettings::TO_ROUNDING`]. It is the solution that the seed leads to, usually the nearest.
    fn inverse_nearest(&self, base_from_flange: &Pose, seed: &[f64; N]) -> Result<[f64; N], InverseError> {
        Ok(self.solve(base_from_flange, seed, &SolverSettings::TO_ROUNDING)?.q)
    }

    fn joint_jet(&self, base_from_flange: &PoseJet, q: &[f64; N]) -> Result<JointJet<N>, InverseError> {
        inverse_jet(&self.axes(q), base_from_flange, q)
    }

    fn position_limits(&self) -> &[(f64, f64); N] {
        self.limits.position()
    }

    fn velocity_limits(&self) -> &[f64; N] {
        self.limits.velocity()
    }
}
