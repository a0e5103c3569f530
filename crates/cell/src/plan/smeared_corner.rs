//! How near to a corner the tool passes when prefilters average its way.
//!
//! Seen from the corner, and across the way of the middle of its blend, the tool at s is off by g(s), s from the middle. What comes out of
//! the prefilters is off by the mean of g over some of the way. There are two ways to bound it.
//!
//! *Steady*: the speed is bounded as far as the kernels reach. Of the mean only the variance is used, Var(s) ≤ σ² ṡ². For any mean,
//!
//! ```text
//! E g(s) ≤ G(E s²)        G(u): the least concave function with g(s) ≤ G(s²)
//! ```
//!
//! which is exact enough to be of use from corners that are long against the kernels, G = g(0) + ½ κ u, to those that are short,
//! G = √u · sin(β/2).
//!
//! *Lingering*: the speed is bounded on the blend only, and the acceleration beyond it. So the distance from the middle is bounded by the
//! time until or since, and g by that; the kernels' own distribution gives the mean. `docs/vibration.md` has the derivation.

use seamline::geometry::Vector3;

use super::route::Route;
use super::smear::{Bend, Cap, FOR_JOINTS, Smear};
use super::timing::PathLimits;
use crate::cell::Vibration;

/// Places on either side that are looked at, in powers of their distance, the nearest at this share of the blend.
const PLACES: usize = 64;
const NEAREST: f64 = 1.0 / 32.0;
/// What is kept back of the permitted error: for means whose middle is not the blend's, and for the joints' own curvature.
const BUDGET: f64 = 1.0 - FOR_JOINTS;
const SPREAD: f64 = 1.05;
/// Halvings of the speed's bracket, and the least share of the greatest speed that is worth a try.
const HALVINGS: usize = 30;
const SLOWEST: f64 = 1e-3;

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
    /// The greatest acceleration and jerk near it.
    pub(super) limits: [f64; 2],
    /// The greatest speed near it.
    pub(super) fastest: f64,
}

/// A speed that is not to be passed on a corner's blend, nor so far, in metres, before and behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pass {
    speed: f64,
    reach: f64,
}

impl Pass {
    pub(super) fn cap(&self, [from, to]: [f64; 2]) -> Cap {
        let limits = PathLimits::of_speed(self.speed);
        Cap { place: from, from: from - self.reach, to: to + self.reach, limits }
    }
}

/// How far off the tool is within a distance along the route, before and behind the middle.
struct Offsets(Vec<[f64; 2]>);

impl Offsets {
    fn within(&self, distance: f64) -> f64 {
        let square = distance * distance;
        let after = self.0.partition_point(|[at, _]| *at < square);
        match (after.checked_sub(1).and_then(|before| self.0.get(before)), self.0.get(after)) {
            (Some([from, a]), Some([to, b])) => {
                let [from, to] = [from.sqrt(), to.sqrt()];
                a + (b - a).max(0.0) * (distance - from) / (to - from)
            }
            (Some([_, only]), None) | (None, Some([_, only])) => *only,
            (None, None) => 0.0,
        }
    }
}

impl Passing<'_> {
    /// What costs less time: to be as slow as the permitted error asks for while anything of the corner is in the prefilters, or to be slower
    /// still, on the blend only. With the `arc` on the tool does not linger. `bends` are those of the joints on the blend, and around it.
    pub(super) fn pass(&self, smear: &Smear, bends: &[Bend; 2], arc: bool) -> Pass {
        let offsets = self.offsets(self.fastest * smear.length);
        let speed = self.steady(&offsets, smear).min(smear.speed(&bends[0], FOR_JOINTS * self.permitted));
        let steady = Pass { speed, reach: speed * smear.length };
        if arc || speed >= self.fastest {
            return steady;
        }
        let lingering = Pass { speed: self.lingering(offsets, smear, &bends[1]), reach: 0.0 };
        let linger = self.lost(&lingering, self.fastest) < self.lost(&steady, self.fastest);
        if linger { lingering } else { steady }
    }

    /// The time that a pass costs, compared with passing at the greatest speed; the blend by itself permits `speed`.
    pub(super) fn lost(&self, pass: &Pass, speed: f64) -> f64 {
        let slowest = pass.speed.min(speed);
        let less = |speed: f64| (1.0 / speed - 1.0 / self.fastest).max(0.0);
        let change = (self.fastest - slowest).max(0.0);
        let changing = change / self.limits[0] + self.limits[0] / self.limits[1];
        (self.blend[1] - self.blend[0]) * less(slowest)
            + 2.0 * pass.reach * less(pass.speed)
            + changing * change / self.fastest
    }

    /// The greatest speed that keeps the permitted error if it is not passed within the kernels' length of the corner.
    fn steady(&self, offsets: &[[f64; 2]], smear: &Smear) -> f64 {
        let keeps = |speed: f64| {
            let reach = speed * smear.length;
            let known = offsets.partition_point(|[square, _]| *square <= reach * reach);
            let square = SPREAD * smear.variance * speed * speed;
            concave(&offsets[..known], square) <= BUDGET * self.permitted
        };
        greatest(0.0, self.fastest, keeps)
    }

    /// The greatest speed on the blend that keeps the permitted error whatever comes before and behind it; 0 where there is none.
    fn lingering(&self, mut offsets: Vec<[f64; 2]>, smear: &Smear, bend: &Bend) -> f64 {
        for k in 1..offsets.len() {
            offsets[k][1] = offsets[k][1].max(offsets[k - 1][1]);
        }
        let offsets = Offsets(offsets);
        let half = 0.5 * (self.blend[1] - self.blend[0]);
        let keeps = |speed: f64| {
            // At most this far from the middle: at the greatest acceleration from the blend on.
            let distance = |cells: usize| {
                let time = smear.cell() * cells as f64;
                let beyond = (time - half / speed).max(0.0);
                let gained = (0.5 * self.limits[0] * beyond * beyond).min(self.fastest * beyond);
                speed * time + gained
            };
            let off = smear.mean_off(|cells| offsets.within(distance(cells)));
            let square = 0.5 * smear.mean_off(|cells| distance(cells).powi(2));
            off <= BUDGET * self.permitted
                && square * bend.place <= FOR_JOINTS * self.permitted
                && square * bend.turn <= Vibration::TURN_ERROR
        };
        let slowest = SLOWEST * self.fastest;
        if keeps(slowest) { greatest(slowest, self.fastest, keeps) } else { 0.0 }
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

/// The greatest speed up to `high` that keeps something, where `low` does.
fn greatest(mut low: f64, mut high: f64, keeps: impl Fn(f64) -> bool) -> f64 {
    if keeps(high) {
        return high;
    }
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
    fn distances_lie_between_the_places_looked_at() {
        let offsets = Offsets(vec![[0.0, 1.0], [1.0, 1.0], [9.0, 5.0]]);
        assert_eq!([0.0, 0.5, 1.0, 2.0, 3.0, 7.0].map(|d| offsets.within(d)), [1.0, 1.0, 1.0, 3.0, 5.0, 5.0]);
    }

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
