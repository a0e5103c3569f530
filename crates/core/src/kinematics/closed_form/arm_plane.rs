//! The vertical plane in which an arm's parallel axes move it, turned by joint 1.

use super::ON_AXIS;
use super::two_link::REACH_ROUNDING;
use crate::kinematics::InverseError;
use crate::math::float::{atan2, sin_cos, sqrt};

/// The arm's plane turned to a point, on one side of axis 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ArmPlane {
    pub(crate) theta1: f64,
    pub(crate) cos1: f64,
    pub(crate) sin1: f64,
    /// The point's coordinate along the plane, from axis 1: negative behind.
    pub(crate) radial: f64,
    /// Front and rear are one: the plane cannot be turned nearer to the point, or may be turned anyhow.
    pub(crate) singular: bool,
}

impl ArmPlane {
    /// Turns the plane, `offset` to the side of axis 1, to the point (x, y) = Rz(θ₁)·(radial, offset), where radial =
    /// ±√(x² + y² − offset²). On axis 1 itself θ₁ is `free`.
    #[inline]
    pub(crate) fn through(
        [x, y]: [f64; 2],
        offset: f64,
        front: bool,
        reach: f64,
        free: f64,
    ) -> Result<Self, InverseError> {
        let radius = sqrt(x * x + y * y);
        if radius <= ON_AXIS * reach && offset.abs() <= ON_AXIS * reach {
            let (sin1, cos1) = sin_cos(free);
            return Ok(Self { theta1: free, cos1, sin1, radial: 0.0, singular: true });
        }
        if radius < offset.abs() - REACH_ROUNDING * reach {
            return Err(InverseError::InsideLateralOffset { radius, offset: offset.abs() });
        }
        // (radius − offset)(radius + offset) keeps its digits where the two nearly agree.
        let magnitude = sqrt(((radius - offset) * (radius + offset)).max(0.0));
        let radial = if front { magnitude } else { -magnitude };
        // Scaled to a unit vector: where rounding left the radius short of the offset, the two lengths differ.
        let scale = 1.0 / (radius * sqrt(radial * radial + offset * offset));
        let (cos1, sin1) = ((x * radial + y * offset) * scale, (y * radial - x * offset) * scale);
        Ok(Self { theta1: atan2(sin1, cos1), cos1, sin1, radial, singular: magnitude == 0.0 })
    }
}
