//! How far the arm is from each of its singularities.

use super::SphericalWristArm;
use crate::math::float::sin;

/// How far a spherical-wrist arm is from each of its singularities, each by its own measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingularityDistances {
    /// |sin θ₅|: zero where axes 4 and 6 are in one line.
    pub wrist: f64,
    /// |sin| of the angle between upper arm and the line from elbow to wrist: zero stretched and folded.
    pub elbow: f64,
    /// Distance in metres of the wrist centre from the line through axis 1 (or, with a lateral offset, how far it
    /// lies in front of or behind the plane where it comes nearest).
    pub shoulder: f64,
}

impl SphericalWristArm {
    /// Distances from the singularities at joint positions `q`.
    #[must_use]
    pub fn singularity_distances(&self, q: &[f64; 6]) -> SingularityDistances {
        let theta = self.thetas(q);
        SingularityDistances {
            wrist: sin(theta[4]).abs(),
            elbow: sin(theta[2] + self.elbow_angle).abs(),
            shoulder: self.wrist_radius(&theta).abs(),
        }
    }
}
