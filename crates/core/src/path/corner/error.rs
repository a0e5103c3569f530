//! How far a blend lies from the corner, and from the paths that it joins.

use core::f64::consts::PI;

use super::super::quintic::{derivatives, foot};
use super::super::{Arc, Curve, Path};
use crate::geometry::Vector3;
use crate::math::float::{atan2, sin_cos, sqrt};

/// Intervals in which the blend is searched for its greatest distance from the paths.
const INTERVALS: u32 = 12;
/// Steps of the golden section within two of them.
const SECTIONS: u32 = 14;
/// Where the orientations are compared: at eighths of the blend.
const COMPARISONS: u32 = 8;

/// One of the two paths as seen from the corner, prepared for the distance from points nearby.
pub(super) enum Side<'a> {
    Straight {
        start: Vector3,
        direction: Vector3,
        length: f64,
    },
    /// With the arc's last point, seen from the centre: cosine and sine of its angle.
    Round {
        arc: &'a Arc,
        end: [f64; 2],
    },
    Polynomial {
        coefficients: &'a [Vector3; 6],
        range: [f64; 2],
    },
}

impl<'a> Side<'a> {
    /// Of a polynomial curve, only what lies within `reach` metres of the coordinate `at` counts.
    pub(super) fn new(path: &'a Path, at: f64, reach: f64) -> Self {
        match path.curve() {
            Curve::Line { start, direction, length } => {
                Self::Straight { start: *start, direction: *direction, length: *length }
            }
            Curve::Arc(arc) => {
                let (sin, cos) = sin_cos(arc.angle);
                Self::Round { arc, end: [cos, sin] }
            }
            Curve::Quintic(curve) => {
                let (coefficients, range) = curve.around(at, reach);
                Self::Polynomial { coefficients, range }
            }
        }
    }

    /// Distance of a point from the path.
    fn distance(&self, point: &Vector3) -> f64 {
        let square = match self {
            Self::Straight { start, direction, length } => {
                let offset = point - start;
                (offset - direction * offset.dot(direction).max(0.0).min(*length)).norm_squared()
            }
            Self::Round { arc, end } => square_from_arc(arc, *end, point),
            Self::Polynomial { coefficients, range: [first, last] } => {
                let nearest = foot(coefficients, point, 0.5 * (first + last), [*first, *last]);
                (derivatives(coefficients, nearest)[0] - point).norm_squared()
            }
        };
        sqrt(square)
    }
}

/// Square of the distance of a point from an arc, whose ends count beyond its angle.
fn square_from_arc(arc: &Arc, [cos, sin]: [f64; 2], point: &Vector3) -> f64 {
    let offset = point - arc.centre;
    let (x, y) = (offset.dot(&arc.radial), offset.dot(&arc.tangent));
    let above = offset.dot(&arc.radial.cross(&arc.tangent));
    let square = |x: f64, y: f64| x * x + y * y + above * above;
    let (past_start, short_of_end) = (y >= 0.0, x * sin - y * cos >= 0.0);
    let within = if arc.angle <= PI { past_start && short_of_end } else { past_start || short_of_end };
    if within {
        square(sqrt(x * x + y * y) - arc.radius, 0.0)
    } else {
        square(x - arc.radius, y).min(square(x - arc.radius * cos, y - arc.radius * sin))
    }
}

/// Least distance of a polynomial curve from the corner point: Newton's iteration from the nearest of a few samples.
pub(super) fn from_corner(blend: &[Vector3; 6], corner: &Vector3) -> f64 {
    let square = |u: f64| (derivatives(blend, u)[0] - corner).norm_squared();
    let step = 1.0 / f64::from(INTERVALS);
    let (mut nearest, mut least) = (0.5, square(0.5));
    for k in 1..INTERVALS {
        let u = f64::from(k) * step;
        let value = square(u);
        if value < least {
            (nearest, least) = (u, value);
        }
    }
    let u = foot(blend, corner, nearest, [nearest - step, nearest + step]);
    sqrt(square(u).min(least))
}

/// Greatest distance of a polynomial curve from two paths, or `least` if that is more: golden section about each sample
/// that is farther than its neighbours, since a step of the curvature gives one bulge on either side.
pub(super) fn from_paths(blend: &[Vector3; 6], sides: &[Side<'_>; 2], least: f64) -> f64 {
    let distance = |u: f64| {
        let point = derivatives(blend, u)[0];
        sides[0].distance(&point).min(sides[1].distance(&point))
    };
    let step = 1.0 / f64::from(INTERVALS);
    let (mut before, mut here, mut greatest) = (0.0, 0.0, least);
    for k in 1..=INTERVALS {
        let u = f64::from(k) * step;
        let after = if k == INTERVALS { 0.0 } else { distance(u) };
        // Only a bulge that may turn out greatest: between samples it rises by less than a fifth.
        if here > before && here >= after && 1.2 * here > greatest {
            greatest = greatest.max(top(&distance, [u - 2.0 * step, u]));
        }
        (before, here) = (here, after);
    }
    greatest
}

/// The greatest value between two parameters, by golden section.
fn top(value: &impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_left, mut at_right) = (value(left), value(right));
    for _ in 0..SECTIONS {
        if at_left > at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = value(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = value(right);
        }
    }
    at_left.max(at_right)
}

/// Greatest angle between the orientations of a blend and of the paths that it joins, after the same share of the
/// way from cut to cut.
pub(super) fn of_orientation(blend: &Path, before: &Path, after: &Path, trims: [f64; 2]) -> f64 {
    let whole = trims[0] + trims[1];
    let mut greatest: f64 = 0.0;
    for k in 1..COMPARISONS {
        let share = f64::from(k) / f64::from(COMPARISONS);
        let from_corner = share * whole - trims[0];
        let original = if from_corner < 0.0 {
            before.rotation(before.length() + from_corner)
        } else {
            after.rotation(from_corner)
        };
        let difference = blend.rotation(share * blend.length()) * original.inverse();
        greatest = greatest.max(2.0 * atan2(difference.imag().norm(), difference.scalar().abs()));
    }
    greatest
}
