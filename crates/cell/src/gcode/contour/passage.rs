//! How a smooth curve along a row of points passes one of them.

use nalgebra::{Matrix4, Matrix4x3};
use seamline::geometry::Vector3;

use crate::job::Passage;

/// Points on either side that are looked at, at most, and the lesser numbers that are tried where so many do not lie on a
/// smooth curve.
const SIDES: [usize; 4] = [6, 4, 3, 2];
/// Degree of the polynomial that is laid through them.
const DEGREE: usize = 3;

/// The passage at point `at`: position, tangent and curvature of the polynomial of degree three by chord length that lies
/// nearest to its neighbours (least squares), as many as lie within `residual` of it. Where `through`, it leads through the point itself.
/// `None` where no neighbours do.
pub(super) fn passage(points: &[Vector3], at: usize, through: bool, residual: f64) -> Option<Passage> {
    SIDES.into_iter().find_map(|side| {
        let first = at.saturating_sub(side);
        let near = points.get(first..(at + side + 1).min(points.len()))?;
        through_near(near, at - first, through, residual)
    })
}

fn through_near(points: &[Vector3], at: usize, through: bool, residual: f64) -> Option<Passage> {
    let centre = *points.get(at)?;
    let places = places(points, at)?;
    // Where the point itself is given, the others alone decide.
    let degree = DEGREE.min(points.len() - 1);
    let powers = |place: f64| [1.0, place, place * place, place * place * place];
    let mut normal = Matrix4::zeros();
    let mut right = Matrix4x3::zeros();
    for (point, place) in points.iter().zip(&places) {
        let powers = powers(*place);
        let offset = point - centre;
        for row in 0..=degree {
            for column in 0..=degree {
                normal[(row, column)] += powers[row] * powers[column];
            }
            for axis in 0..3 {
                right[(row, axis)] += powers[row] * offset[axis];
            }
        }
    }
    // Coefficients that are not asked for are zero.
    for unused in (degree + 1..=DEGREE).chain(through.then_some(0)) {
        for other in 0..=DEGREE {
            (normal[(unused, other)], normal[(other, unused)]) = (0.0, 0.0);
        }
        normal[(unused, unused)] = 1.0;
        for axis in 0..3 {
            right[(unused, axis)] = 0.0;
        }
    }
    let solved = normal.cholesky()?.solve(&right);
    let coefficient = |row: usize| Vector3::new(solved[(row, 0)], solved[(row, 1)], solved[(row, 2)]);
    let [c0, c1, c2, c3] = [0, 1, 2, 3].map(coefficient);
    let near = points.iter().zip(&places).all(|(point, place)| {
        let on_curve = c0 + (c1 + (c2 + c3 * *place) * *place) * *place;
        (point - centre - on_curve).norm_squared() <= residual * residual
    });
    let tangent = c1.try_normalize(f64::EPSILON)?;
    let bend = (c2 - tangent * tangent.dot(&c2)) * 2.0;
    // The scale of the places cancels.
    let curvature_per_mm = bend / c1.norm_squared();
    near.then_some(Passage { position_mm: centre + c0, tangent, curvature_per_mm })
}

/// Places of the points by chord length, 0 at `at` and at most 1 in size.
fn places(points: &[Vector3], at: usize) -> Option<Vec<f64>> {
    let mut places = Vec::with_capacity(points.len());
    let mut way = 0.0;
    for (index, point) in points.iter().enumerate() {
        if let Some(before) = index.checked_sub(1).and_then(|before| points.get(before)) {
            way += (point - before).norm();
        }
        places.push(way);
    }
    let own = *places.get(at)?;
    let span = own.max(way - own);
    places.iter_mut().for_each(|place| *place = (*place - own) / span);
    (span > 0.0).then_some(places)
}
