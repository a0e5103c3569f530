//! Euler angles, for the edges: job files and cells speak them, the inside uses unit quaternions.

use core::f64::consts::{PI, TAU};

use super::Rotation;
use crate::math::float::round;

/// Rotation R = Rz(z)·Ry(y)·Rx(x): the roll, pitch, yaw of URDF and the Rx, Ry, Rz of INFORM. Radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EulerZyx {
    /// Rotation about x, applied first.
    pub x: f64,
    /// Rotation about the fixed y axis, applied second.
    pub y: f64,
    /// Rotation about the fixed z axis, applied last.
    pub z: f64,
}

impl EulerZyx {
    /// The angles of a rotation; y in [−π/2, π/2]. At y = ±π/2, where x and z turn about one axis, x is 0.
    #[must_use]
    pub fn from_rotation(rotation: &Rotation) -> Self {
        let (x, y, z) = rotation.euler_angles();
        Self { x, y, z }
    }

    /// The rotation with these angles.
    #[must_use]
    pub fn to_rotation(self) -> Rotation {
        Rotation::from_euler_angles(self.x, self.y, self.z)
    }
}

/// The angle equal to `target` modulo a full turn that lies nearest to `current`: from 10° to 350° is −10°.
///
/// Exactly half a turn away either way, the answer is the one above `current`.
#[must_use]
pub fn unwind(target: f64, current: f64) -> f64 {
    let difference = target - current;
    let turned = difference - TAU * round(difference / TAU);
    current + if turned <= -PI { turned + TAU } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unwinds_across_the_full_turn() {
        let degrees = |d: f64| d.to_radians();
        assert!((unwind(degrees(350.0), degrees(10.0)) - degrees(-10.0)).abs() < 1e-12);
        assert!((unwind(degrees(-179.0), degrees(179.0)) - degrees(181.0)).abs() < 1e-12);
        assert!((unwind(degrees(10.0), degrees(730.0)) - degrees(730.0)).abs() < 1e-12);
        assert!((unwind(degrees(180.0), 0.0) - PI).abs() < 1e-12);
        assert!((unwind(degrees(-180.0), 0.0) - PI).abs() < 1e-12);
    }

    #[test]
    fn angles_survive_the_round_trip() {
        for (x, y, z) in [(0.1, -0.4, 2.0), (-3.0, 1.5, -0.2), (0.0, 0.0, 3.1)] {
            let back = EulerZyx::from_rotation(&EulerZyx { x, y, z }.to_rotation());
            assert!((back.x - x).abs() < 1e-12 && (back.y - y).abs() < 1e-12 && (back.z - z).abs() < 1e-12);
        }
    }

    #[test]
    fn order_is_z_y_x() {
        let r = EulerZyx { x: 0.3, y: -0.7, z: 1.1 }.to_rotation();
        let product = Rotation::from_axis_angle(&nalgebra::Vector3::z_axis(), 1.1)
            * Rotation::from_axis_angle(&nalgebra::Vector3::y_axis(), -0.7)
            * Rotation::from_axis_angle(&nalgebra::Vector3::x_axis(), 0.3);
        assert!(r.angle_to(&product) < 1e-15);
    }
}
