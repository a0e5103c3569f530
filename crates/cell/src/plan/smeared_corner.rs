//! How near to a corner the tool passes when prefilters average its way.
//!
//! Seen from the corner, and across the way of the middle of its blend, the tool at s is off by g(s), s from the middle. What comes out of
//! the prefilters is off by the mean of g over some of the way, of which only the variance is known: Var(s) ≤ σ² ṡ². For any mean,
//!
//! ```text
//! E g(s) ≤ G(E s²)        G(u): the least concave function with g(s) ≤ G(s²)
//! ```
//!
//! which is exact enough to be of use from corners that are long against the kernels, G = g(0) + ½ κ u, to those that are short,
//! G = √u · sin(β/2).

use seamline::geometry::Vector3;

use super::route::Route;
use super::smear::Smear;

/// Places on either side that are looked at, in powers of their distance, the nearest at this share of the blend.
const PLACES: usize = 64;
const NEAREST: f64 = 1.0 / 32.0;
/// What is kept back of the permitted error: for means whose middle is not the blend's, and for the joints' own curvature.
const BUDGET: f64 = 0.95;
const SPREAD: f64 = 1.05;
/// Halvings of the speed's bracket.
const HALVINGS: usize = 30;

/// A corner of a route.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passing<'a> {
    pub(super) route: &'a Route,
    /// Where its blend begins and ends.
    pub(super) blend: [f64; 2],
    /// The point.
    pub(super) corner: Vector3,
    /// The permitted distance from it.
    pub(super) permitted: f64,
}

impl Passing<'_> {
    /// The greatest speed, up to `fastest`, that keeps the permitted error if it is not passed within the kernels' length of the corner.
    pub(super) fn speed(&self, smear: &Smear, fastest: f64) -> f64 {
        let offsets = self.offsets(fastest * smear.length);
        let keeps = |speed: f64| {
            let reach = speed * smear.length;
            let known = offsets.partition_point(|[square, _]| *square <= reach * reach);
            let square = SPREAD * smear.variance * speed * speed;
            concave(&offsets[..known], square) <= BUDGET * self.permitted
        };
        if keeps(fastest) {
            return fastest;
        }
        let (mut low, mut high) = (0.0, fastest);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if keeps(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Squares of distances along the route from the blend's middle, with the greatest offset there on either side.
    fn offsets(&self, farthest: f64) -> Vec<[f64; 2]> {
        let [from, to] = self.blend;
        let middle = 0.5 * (from + to);
        let tangent = self.route.jet(middle).linear[0];
        let offset = |s: f64| {
            // Before its start and after its end the tool rests.
            let place = self.route.pose(s.clamp(0.0, self.route.length())).translation.vector - self.corner;
            (place - tangent * tangent.dot(&place)).norm()
        };
        let nearest = NEAREST * (to - from);
        let ratio = (farthest / nearest).max(2.0).powf(1.0 / (PLACES - 1) as f64);
        let distances = (0..PLACES).map(|k| nearest * ratio.powi(k as i32));
        let both = |s: f64| [s * s, offset(middle - s).max(offset(middle + s))];
        [0.0].into_iter().chain(distances).map(both).collect()
    }
}

/// The value at `x` of the least concave function above points with rising first coordinates.
fn concave(points: &[[f64; 2]], x: f64) -> f64 {
    let mut hull: Vec<[f64; 2]> = Vec::with_capacity(points.len());
    for point in points {
        while let [.., a, b] = hull[..]
            && (b[1] - a[1]) * (point[0] - a[0]) <= (point[1] - a[1]) * (b[0] - a[0])
        {
            hull.pop();
        }
        hull.push(*point);
    }
    let after = hull.partition_point(|point| point[0] < x);
    match (after.checked_sub(1).and_then(|before| hull.get(before)), hull.get(after)) {
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]),
        (Some(only), None) | (None, Some(only)) => only[1],
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_concave_function_lies_on_the_outer_points() {
        let points = [[0.0, 1.0], [1.0, 1.1], [2.0, 3.0], [3.0, 3.5], [4.0, 3.4], [6.0, 5.0]];
        assert_eq!(concave(&points, 0.0), 1.0);
        assert!((concave(&points, 1.0) - 2.0).abs() < 1e-15);
        assert!((concave(&points, 4.0) - 4.0).abs() < 1e-15);
        assert_eq!(concave(&points, 9.0), 5.0);
        assert_eq!(concave(&[], 1.0), 0.0);
    }
}
