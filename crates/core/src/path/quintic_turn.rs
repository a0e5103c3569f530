//! An orientation whose rotation vector is a polynomial of degree five in the path coordinate.

use super::quintic::{End, derivatives, meeting};
use super::rotation_vector::{RotationVectorJet, vector_jet};
use crate::geometry::{PoseJet, Rotation, Vector3};

/// A turn that has given orientations, angular velocities and angular accelerations at both ends: relative to a
/// reference its rotation vector is a polynomial of degree five. Beside the reference, geodesics through it have a
/// rotation vector that is linear in the path coordinate; so a blend of two geodesics around the orientation where
/// they meet is the blend of two straight lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuinticTurn {
    reference: Rotation,
    /// Of 1, x, … x⁵ with x = (s + from)/span, in the parent frame.
    coefficients: [Vector3; 6],
    from: f64,
    span: f64,
}

impl QuinticTurn {
    /// From one jet's orientation, angular velocity and acceleration to the other's, over a path of length `span`, by
    /// rotation vectors relative to `reference` (less than half a turn from either).
    pub(super) fn between(start: &PoseJet, end: &PoseJet, reference: Rotation, span: f64) -> Self {
        let at = |jet: &PoseJet| -> End {
            let [vector, first, second] =
                vector_jet(&(jet.pose.rotation * reference.inverse()), &jet.angular[0], &jet.angular[1]);
            [vector, first * span, second * (span * span)]
        };
        Self { reference, coefficients: meeting(&at(start), &at(end)), from: 0.0, span }
    }

    pub(super) fn part(&self, from: f64) -> Self {
        Self { from: self.from + from, ..*self }
    }

    pub(super) fn tilted(&self, tilt: &Rotation) -> Self {
        Self { reference: self.reference * tilt, ..*self }
    }

    /// The orientation at coordinate `s`, and the angular velocity with its two derivatives.
    pub(super) fn at(&self, s: f64) -> (Rotation, [Vector3; 3]) {
        let rate = 1.0 / self.span;
        let [vector, first, second, third] = derivatives(&self.coefficients, (s + self.from) * rate);
        let jet = RotationVectorJet {
            vector,
            first: first * rate,
            second: second * (rate * rate),
            third: third * (rate * rate * rate),
        };
        let (turn, angular) = jet.rotation();
        (turn * self.reference, angular)
    }
}
