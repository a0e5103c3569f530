//! Orientation along a path: the shortest turn between two rotations, a smooth turn through three, or a polynomial one.

use super::quintic_turn::QuinticTurn;
use super::rotation_vector::RotationVectorJet;
use crate::geometry::{Rotation, Vector3};

/// The orientation as function of the path coordinate.
#[allow(clippy::large_enum_variant, reason = "without a heap there is no place for it but here")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Orientation {
    /// From start to end, the shortest way, at constant rate.
    Geodesic(Geodesic),
    /// Through an orientation on the way.
    Through(Through),
    /// With given angular velocities and accelerations at both ends.
    Quintic(QuinticTurn),
}

impl Orientation {
    /// Followed by a constant rotation in the turning frame: the angular velocity stays.
    pub(super) fn tilted(&self, tilt: &Rotation) -> Self {
        match *self {
            Self::Geodesic(of) => {
                Self::Geodesic(Geodesic { start: of.start * tilt, end: of.end * tilt, ..of })
            }
            Self::Through(of) => Self::Through(Through { via: of.via * tilt, ..of }),
            Self::Quintic(of) => Self::Quintic(of.tilted(tilt)),
        }
    }

    /// What the orientation is between two coordinates of a path of `length`.
    pub(super) fn part(&self, from: f64, to: f64, length: f64) -> Self {
        match *self {
            Self::Geodesic(of) => Self::Geodesic(of.part(from, to, length)),
            Self::Through(of) => Self::Through(Through { via_at: of.via_at - from, ..of }),
            Self::Quintic(of) => Self::Quintic(of.part(from)),
        }
    }

    /// The orientation at coordinate `s` of a path of `length`, and the angular velocity with its two derivatives.
    pub(super) fn at(&self, s: f64, length: f64) -> (Rotation, [Vector3; 3]) {
        match self {
            Self::Geodesic(geodesic) => {
                let rate = if length > 0.0 { geodesic.angle() / length } else { 0.0 };
                geodesic.at(rate * s, rate)
            }
            Self::Through(through) => through.at(s),
            Self::Quintic(turn) => turn.at(s),
        }
    }
}

/// A smooth turn through an orientation on the way: relative to it the rotation vector is the parabola through
/// start, zero and end. Where the three lie evenly on one geodesic, it is that geodesic. It follows turns of more
/// than half a revolution, which the geodesic from start to end would take the other way round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Through {
    via: Rotation,
    via_at: f64,
    /// Coefficients of (s − via_at) and its square, in the parent frame.
    linear: Vector3,
    quadratic: Vector3,
}

impl Through {
    /// Turns from `start` at 0 through `via` at coordinate `via_at` to `end` at `length`.
    pub(super) fn new(start: Rotation, via: Rotation, end: Rotation, via_at: f64, length: f64) -> Self {
        let back = (start * via.inverse()).scaled_axis();
        let ahead = (end * via.inverse()).scaled_axis();
        let (before, after) = (via_at, length - via_at);
        let quadratic = (back / before + ahead / after) / length;
        Self { via, via_at, linear: ahead / after - quadratic * after, quadratic }
    }

    fn at(&self, s: f64) -> (Rotation, [Vector3; 3]) {
        let x = s - self.via_at;
        let jet = RotationVectorJet {
            vector: (self.linear + self.quadratic * x) * x,
            first: self.linear + self.quadratic * (2.0 * x),
            second: self.quadratic * 2.0,
            third: Vector3::zeros(),
        };
        let (turn, angular) = jet.rotation();
        (turn * self.via, angular)
    }
}

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

    /// The turn between two coordinates of a path of `length`, about the same axis.
    fn part(&self, from: f64, to: f64, length: f64) -> Self {
        let rate = if length > 0.0 { self.angle / length } else { 0.0 };
        let (start, _) = self.at(rate * from, rate);
        let (end, _) = self.at(rate * to, rate);
        Self { start, end, axis: self.axis, angle: rate * (to - from) }
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
