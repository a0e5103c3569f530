//! Curves of the tool centre point: straight line, circular arc and polynomial.

use super::quintic::Quintic;
use crate::geometry::Vector3;
use crate::math::float::{atan2, sin_cos};

/// Three points lie on one line if the sine of the angle at the start is below this.
const COLLINEAR: f64 = 1e-6;

/// Why three points do not give an arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ArcError {
    /// Two of the three points agree (indices 0 start, 1 via, 2 end).
    Coincident(usize, usize),
    /// All three lie on one line.
    Collinear,
}

/// A curve with its arc length as coordinate.
#[allow(clippy::large_enum_variant, reason = "without a heap there is no place for it but here")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Curve {
    /// Straight from a point into a direction.
    Line {
        /// Start, in metres.
        start: Vector3,
        /// Unit vector; zero where start and end agree.
        direction: Vector3,
        /// Length in metres.
        length: f64,
    },
    /// Part of a circle.
    Arc(Arc),
    /// A blend, or a piece of a spline.
    Quintic(Quintic),
}

/// Part of a circle, less than a full turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// Centre of the circle, in metres.
    pub centre: Vector3,
    /// Radius in metres.
    pub radius: f64,
    /// Unit vector from the centre to the start.
    pub radial: Vector3,
    /// Unit tangent at the start.
    pub tangent: Vector3,
    /// Angle of the arc in radians, in (0, 2π).
    pub angle: f64,
}

/// Position and its first three derivatives with respect to arc length.
#[derive(Clone, Copy)]
pub(super) struct PointJet {
    position: Vector3,
    derivatives: [Vector3; 3],
}

impl PointJet {
    pub(super) fn new(position: Vector3, derivatives: [Vector3; 3]) -> Self {
        Self { position, derivatives }
    }

    pub(super) fn at_rest(self) -> Self {
        Self { derivatives: [Vector3::zeros(); 3], ..self }
    }

    pub(super) fn into_parts(self) -> (Vector3, [Vector3; 3]) {
        (self.position, self.derivatives)
    }
}

impl Curve {
    pub(super) fn line(start: Vector3, end: Vector3) -> Self {
        let difference = end - start;
        let length = difference.norm();
        let direction = if length > super::SAME_POSITION { difference / length } else { Vector3::zeros() };
        Self::Line { start, direction, length }
    }

    /// Length in metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        match self {
            Self::Line { length, .. } => *length,
            Self::Arc(arc) => arc.radius * arc.angle,
            Self::Quintic(quintic) => quintic.length(),
        }
    }

    /// Greatest curvature in 1/m.
    #[must_use]
    pub fn greatest_curvature(&self) -> f64 {
        match self {
            Self::Line { .. } => 0.0,
            Self::Arc(arc) => 1.0 / arc.radius,
            Self::Quintic(quintic) => quintic.greatest_curvature(),
        }
    }

    /// The part between two coordinates.
    pub(super) fn part(&self, from: f64, to: f64) -> Self {
        match self {
            Self::Line { start, direction, .. } => {
                Self::Line { start: start + direction * from, direction: *direction, length: to - from }
            }
            Self::Arc(arc) => Self::Arc(arc.turned(from / arc.radius, (to - from) / arc.radius)),
            Self::Quintic(quintic) => Self::Quintic(quintic.part(from, to)),
        }
    }

    pub(super) fn jet(&self, s: f64) -> PointJet {
        match self {
            Self::Line { start, direction, .. } => PointJet {
                position: start + direction * s,
                derivatives: [*direction, Vector3::zeros(), Vector3::zeros()],
            },
            Self::Arc(arc) => arc.jet(s),
            Self::Quintic(quintic) => quintic.jet(s),
        }
    }
}

impl Arc {
    /// The arc from `start` through `via` to `end`.
    ///
    /// # Errors
    /// [`ArcError`] where two points agree or all three lie on one line.
    pub fn through(start: Vector3, via: Vector3, end: Vector3) -> Result<Self, ArcError> {
        let (to_via, to_end) = (via - start, end - start);
        let coincident = |v: &Vector3| v.norm() <= super::SAME_POSITION;
        if coincident(&to_via) {
            return Err(ArcError::Coincident(0, 1));
        }
        if coincident(&to_end) {
            return Err(ArcError::Coincident(0, 2));
        }
        if coincident(&(end - via)) {
            return Err(ArcError::Coincident(1, 2));
        }
        let normal = to_via.cross(&to_end);
        if normal.norm() <= COLLINEAR * to_via.norm() * to_end.norm() {
            return Err(ArcError::Collinear);
        }
        // Circumcentre of the triangle, relative to the start.
        let to_centre = (to_end.norm_squared() * normal.cross(&to_via)
            - to_via.norm_squared() * normal.cross(&to_end))
            / (2.0 * normal.norm_squared());
        let radius = to_centre.norm();
        let radial = -to_centre / radius;
        let tangent = normal.normalize().cross(&radial);
        let from_centre = to_end - to_centre;
        let swept = atan2(from_centre.dot(&tangent), from_centre.dot(&radial));
        let angle = if swept <= 0.0 { swept + core::f64::consts::TAU } else { swept };
        Ok(Self { centre: start + to_centre, radius, radial, tangent, angle })
    }

    /// The same circle in the same sense, from `start` to `end` (points of it).
    pub(super) fn between(&self, start: Vector3, end: Vector3) -> Result<Self, ArcError> {
        if (end - start).norm() <= super::SAME_POSITION {
            return Err(ArcError::Coincident(0, 2));
        }
        let turned = self.turned(self.coordinate(start) / self.radius, 0.0);
        let angle = turned.coordinate(end) / self.radius;
        Ok(Self { angle, ..turned })
    }

    /// The same circle, begun `by` radians further on, over `angle` radians.
    fn turned(&self, by: f64, angle: f64) -> Self {
        let (sin, cos) = sin_cos(by);
        let radial = self.radial * cos + self.tangent * sin;
        let tangent = self.tangent * cos - self.radial * sin;
        Self { radial, tangent, angle, ..*self }
    }

    /// Arc length from the start to the point of the circle that lies in the direction of `point`, in [0, 2πr).
    pub(super) fn coordinate(&self, point: Vector3) -> f64 {
        let from_centre = point - self.centre;
        let angle = atan2(from_centre.dot(&self.tangent), from_centre.dot(&self.radial));
        self.radius * if angle < 0.0 { angle + core::f64::consts::TAU } else { angle }
    }

    fn jet(&self, s: f64) -> PointJet {
        let (sin, cos) = sin_cos(s / self.radius);
        let outward = self.radial * cos + self.tangent * sin;
        let forward = self.tangent * cos - self.radial * sin;
        let curvature = 1.0 / self.radius;
        PointJet {
            position: self.centre + outward * self.radius,
            derivatives: [forward, -outward * curvature, -forward * (curvature * curvature)],
        }
    }
}
