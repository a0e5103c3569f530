//! An arm at one instant, as the lines that its joints turn about or slide along. All differential kinematics follows
//! from these lines alone, whatever the arm.

use nalgebra::SMatrix;

use super::JointJet;
use crate::geometry::{Pose, PoseJet, Vector3};

/// What a joint does along its axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// Turns about it.
    Revolute,
    /// Slides along it.
    Prismatic,
}

/// A joint's axis in the base frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointAxis {
    /// Unit vector, in the direction of positive motion.
    pub direction: Vector3,
    /// A point on the axis, in metres.
    pub point: Vector3,
    /// Revolute or prismatic.
    pub kind: JointKind,
}

/// The geometric Jacobian, 6 × N: linear rows first (metres per joint unit), then angular, of the flange in the base
/// frame.
pub type Jacobian<const N: usize> = SMatrix<f64, 6, N>;

/// An arm's joint axes and its flange in the base frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointAxes<const N: usize> {
    /// From the base to the flange.
    pub axes: [JointAxis; N],
    /// The flange.
    pub base_from_flange: Pose,
}

/// Motion of a link as a field of velocities: a point x of it moves with `origin` + `angular` × x. With the first and
/// second derivatives of both.
#[derive(Clone, Copy)]
struct LinkMotion {
    angular: [Vector3; 3],
    origin: [Vector3; 3],
}

impl LinkMotion {
    const REST: Self = Self { angular: [ZERO; 3], origin: [ZERO; 3] };

    /// First and second derivative of a unit vector that turns with the link.
    #[inline]
    fn turn(&self, v: &Vector3) -> [Vector3; 2] {
        let [w, dw, _] = &self.angular;
        let d1 = w.cross(v);
        [d1, dw.cross(v) + w.cross(&d1)]
    }

    /// First, second and third derivative of a point that moves with the link.
    #[inline]
    fn carry(&self, x: &Vector3) -> [Vector3; 3] {
        let ([w, dw, ddw], [v, dv, ddv]) = (&self.angular, &self.origin);
        let d1 = v + w.cross(x);
        let d2 = dv + dw.cross(x) + w.cross(&d1);
        let d3 = ddv + ddw.cross(x) + dw.cross(&d1) * 2.0 + w.cross(&d2);
        [d1, d2, d3]
    }

    /// The motion of the next link, behind a joint with derivatives (q′, q″, q‴).
    #[inline]
    fn behind(mut self, axis: &JointAxis, [d1, d2, d3]: [f64; 3]) -> Self {
        let z = axis.direction;
        let [dz, ddz] = self.turn(&z);
        let along = match axis.kind {
            JointKind::Prismatic => &mut self.origin,
            JointKind::Revolute => {
                let p = axis.point;
                let [dp, ddp, _] = self.carry(&p);
                let moment = p.cross(&z);
                let d_moment = dp.cross(&z) + p.cross(&dz);
                let dd_moment = ddp.cross(&z) + dp.cross(&dz) * 2.0 + p.cross(&ddz);
                self.origin[0] += moment * d1;
                self.origin[1] += moment * d2 + d_moment * d1;
                self.origin[2] += moment * d3 + d_moment * (2.0 * d2) + dd_moment * d1;
                &mut self.angular
            }
        };
        along[0] += z * d1;
        along[1] += z * d2 + dz * d1;
        along[2] += z * d3 + dz * (2.0 * d2) + ddz * d1;
        self
    }
}

const ZERO: Vector3 = Vector3::new(0.0, 0.0, 0.0);

impl<const N: usize> JointAxes<N> {
    /// The geometric Jacobian: (linear, angular) velocity of the flange in the base frame is J·q′.
    #[inline]
    #[must_use]
    pub fn jacobian(&self) -> Jacobian<N> {
        let flange = self.base_from_flange.translation.vector;
        let mut jacobian = Jacobian::<N>::zeros();
        for (axis, mut column) in self.axes.iter().zip(jacobian.column_iter_mut()) {
            let z = axis.direction;
            let (linear, angular) = match axis.kind {
                JointKind::Revolute => (z.cross(&(flange - axis.point)), z),
                JointKind::Prismatic => (z, ZERO),
            };
            column.fixed_rows_mut::<3>(0).copy_from(&linear);
            column.fixed_rows_mut::<3>(3).copy_from(&angular);
        }
        jacobian
    }

    /// The Jacobian's derivative at joint velocities `velocity`: acceleration of the flange is J·q″ + J′·q′.
    #[must_use]
    pub fn jacobian_derivative(&self, velocity: &[f64; N]) -> Jacobian<N> {
        let flange = self.base_from_flange.translation.vector;
        let mut link = LinkMotion::REST;
        let mut axis_motion = [(ZERO, ZERO); N];
        for ((axis, &rate), motion) in self.axes.iter().zip(velocity).zip(&mut axis_motion) {
            *motion = (link.turn(&axis.direction)[0], link.carry(&axis.point)[0]);
            link = link.behind(axis, [rate, 0.0, 0.0]);
        }
        let flange_velocity = link.carry(&flange)[0];
        let mut derivative = Jacobian::<N>::zeros();
        for ((axis, (dz, dp)), mut column) in
            self.axes.iter().zip(&axis_motion).zip(derivative.column_iter_mut())
        {
            let (linear, angular) = match axis.kind {
                JointKind::Revolute => {
                    let arm = flange - axis.point;
                    (dz.cross(&arm) + axis.direction.cross(&(flange_velocity - dp)), *dz)
                }
                JointKind::Prismatic => (*dz, ZERO),
            };
            column.fixed_rows_mut::<3>(0).copy_from(&linear);
            column.fixed_rows_mut::<3>(3).copy_from(&angular);
        }
        derivative
    }

    /// The flange's motion for given joint derivatives (the jet's positions are not used: the axes stand for them).
    #[must_use]
    pub fn forward_jet(&self, joints: &JointJet<N>) -> PoseJet {
        let mut link = LinkMotion::REST;
        for (i, axis) in self.axes.iter().enumerate() {
            link = link.behind(axis, [joints.velocity[i], joints.acceleration[i], joints.jerk[i]]);
        }
        PoseJet {
            pose: self.base_from_flange,
            linear: link.carry(&self.base_from_flange.translation.vector),
            angular: link.angular,
        }
    }
}
