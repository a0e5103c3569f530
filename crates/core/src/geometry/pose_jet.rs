//! A pose with its first three derivatives along a parameter.

use super::{Pose, Vector3, is_finite};

/// A moving pose at one instant: its value and its first three derivatives with respect to a parameter (a path
/// coordinate, or time). Vectors are given in the pose's parent frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseJet {
    /// The pose itself.
    pub pose: Pose,
    /// First, second and third derivative of the position.
    pub linear: [Vector3; 3],
    /// Angular velocity ω (R′ = ω × R) and its first and second derivative.
    pub angular: [Vector3; 3],
}

impl PoseJet {
    /// A pose at rest.
    #[must_use]
    pub fn at_rest(pose: Pose) -> Self {
        Self { pose, linear: [Vector3::zeros(); 3], angular: [Vector3::zeros(); 3] }
    }

    /// Whether every coordinate of the pose and of its derivatives is a finite number.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let vectors = self.linear.iter().chain(&self.angular);
        is_finite(&self.pose) && vectors.map(Vector3::sum).sum::<f64>().is_finite()
    }

    /// The jet of `self · offset`, for a frame that is rigidly attached: from the tool centre point's motion to the
    /// flange's, say. Exact.
    #[must_use]
    pub fn attached(&self, offset: &Pose) -> Self {
        let [w, dw, ddw] = self.angular;
        let arm = self.pose.rotation * offset.translation.vector;
        // Derivatives of a vector that turns with the frame: r′ = ω×r, r″ = ω′×r + ω×r′, r‴ = ω″×r + 2ω′×r′ + ω×r″.
        let d1 = w.cross(&arm);
        let d2 = dw.cross(&arm) + w.cross(&d1);
        let d3 = ddw.cross(&arm) + dw.cross(&d1) * 2.0 + w.cross(&d2);
        let [l1, l2, l3] = self.linear;
        Self { pose: self.pose * offset, linear: [l1 + d1, l2 + d2, l3 + d3], angular: self.angular }
    }

    /// The jet of `frame · self`, seen from another fixed frame.
    #[must_use]
    pub fn seen_from(&self, frame: &Pose) -> Self {
        let turn = |v: Vector3| frame.rotation * v;
        Self { pose: frame * self.pose, linear: self.linear.map(turn), angular: self.angular.map(turn) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rotation;

    /// A screw motion with uneven speed, differentiated by hand for the parent and numerically for the attached frame.
    fn jet(t: f64) -> PoseJet {
        let axis = Vector3::new(0.3, -0.5, 0.8).normalize();
        let angle = 0.7 * t + 0.4 * t * t - 0.2 * t * t * t;
        let rotation = Rotation::from_scaled_axis(axis * angle);
        let position = Vector3::new(t, t * t, -t * t * t);
        PoseJet {
            pose: Pose::from_parts(position.into(), rotation),
            linear: [
                Vector3::new(1.0, 2.0 * t, -3.0 * t * t),
                Vector3::new(0.0, 2.0, -6.0 * t),
                Vector3::new(0.0, 0.0, -6.0),
            ],
            angular: [axis * (0.7 + 0.8 * t - 0.6 * t * t), axis * (0.8 - 1.2 * t), axis * -1.2],
        }
    }

    #[test]
    fn attached_frame_has_the_derivatives_of_its_own_motion() {
        let offset = Pose::new(Vector3::new(0.2, -0.1, 0.4), Vector3::new(0.1, 0.2, 0.3));
        let frame = Pose::new(Vector3::new(1.0, 2.0, 3.0), Vector3::new(-0.4, 0.2, 0.9));
        let position = |t: f64| (frame * jet(t).pose * offset).translation.vector;
        let (t, h) = (0.4, 1e-2);
        let got = jet(t).attached(&offset).seen_from(&frame);
        let p = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| position(t + k * h));
        let d1 = (p[0] - p[1] * 8.0 + p[3] * 8.0 - p[4]) / (12.0 * h);
        let d2 = (-p[0] + p[1] * 16.0 - p[2] * 30.0 + p[3] * 16.0 - p[4]) / (12.0 * h * h);
        let d3 = (-p[0] + p[1] * 2.0 - p[3] * 2.0 + p[4]) / (2.0 * h * h * h);
        assert!((got.linear[0] - d1).norm() < 1e-8);
        assert!((got.linear[1] - d2).norm() < 1e-7);
        assert!((got.linear[2] - d3).norm() < 1e-3);
    }
}
