//! Orientation along a path: the shortest turn between two rotations, at constant rate.

use crate::geometry::{Rotation, Vector3};

/// The geodesic between two orientations: one axis, one angle in [0, π].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geodesic {
    start: Rotation,
    end: Rotation,
    /// Unit axis in the parent frame; zero where there is nothing to turn.
    axis: Vector3,
    angle: f64,
}

impl Geodesic {
    /// The shortest way from `start` to `end`. Exactly half a turn apart, where two ways are equally short, the axis
    /// is that of the quaternion quotient.
    #[must_use]
    pub fn new(start: Rotation, end: Rotation) -> Self {
        let turn = end * start.inverse();
        match turn.axis_angle() {
            Some((axis, angle)) if angle > super::SAME_ORIENTATION => {
                Self { start, end, axis: axis.into_inner(), angle }
            }
            _ => Self { start, end, axis: Vector3::zeros(), angle: 0.0 },
        }
    }

    /// The whole angle, in radians.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// The orientation after `angle`, and the angular velocity with its two derivatives, at a constant `rate` of
    /// radians per unit of the path coordinate. From the whole angle on it is exactly the end.
    #[must_use]
    pub(super) fn at(&self, angle: f64, rate: f64) -> (Rotation, [Vector3; 3]) {
        let rotation = if self.angle == 0.0 {
            self.start
        } else if angle >= self.angle {
            self.end
        } else {
            Rotation::from_scaled_axis(self.axis * angle) * self.start
        };
        (rotation, [self.axis * rate, Vector3::zeros(), Vector3::zeros()])
    }
}
