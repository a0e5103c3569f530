//! Arcs of G2 and G3: circles, spirals and helices about an axis of the work frame.

use core::f64::consts::TAU;

use seamline::geometry::Vector3;

use crate::job::{CurvePiece, Mistake, Passage};

/// As LinuxCNC: the radii at start and end may differ by a thousandth, or by so much (mm) where that is more, and by
/// so much at most.
const RADIUS_SHARE: f64 = 1e-3;
const RADIUS_LEAST: f64 = 0.005;
const RADIUS_MOST: f64 = 0.5;
/// Radii within this (mm) are the same: the arc is a circle's.
const SAME_RADIUS: f64 = 1e-6;
/// Start and end within this (mm) are the same: the arc is a full turn.
const SAME_POINT: f64 = 1e-6;
/// Angle of one piece of a circle, at most.
const CIRCLE_PIECE: f64 = TAU / 3.0;
/// Angle of one piece of a spiral or helix: its curve is then within a millionth of the radius.
const SPIRAL_PIECE: f64 = TAU / 16.0;

/// The plane that arcs turn in, by the axes of the work frame: G17, G18, G19.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Plane {
    Xy,
    Zx,
    Yz,
}

impl Plane {
    /// The two axes of the plane in the order of their right-handed turn, and the axis across.
    pub(super) fn axes(self) -> [usize; 3] {
        match self {
            Self::Xy => [0, 1, 2],
            Self::Zx => [2, 0, 1],
            Self::Yz => [1, 2, 0],
        }
    }
}

/// An arc about an axis across the plane: the radius and the height change evenly with the angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arc {
    plane: Plane,
    /// In mm, in the plane's axes.
    centre: [f64; 2],
    /// Radii at start and end, in mm.
    radii: [f64; 2],
    /// Angle at the start, and how far it turns: positive against the clock.
    from: f64,
    sweep: f64,
    /// Height at the start, and how much it grows.
    height: f64,
    rise: f64,
}

/// Where an arc turns around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Centre {
    /// In the plane's axes, mm.
    At([f64; 2]),
    /// At this distance; negative: the longer way round.
    Radius(f64),
}

/// A piece of an arc.
pub(super) enum Piece {
    /// Of a circle: a point on the way, and the end.
    Circle { via: Vector3, end: Vector3 },
    /// Of a spiral or helix.
    Curve(CurvePiece),
}

impl Arc {
    /// From `start` to `end`, with the clock or against it, `turns` times past the end's direction.
    ///
    /// # Errors
    /// Where centre or radius do not fit the ends.
    pub(super) fn new(
        plane: Plane,
        [start, end]: [Vector3; 2],
        centre: Centre,
        clockwise: bool,
        turns: u32,
    ) -> Result<Self, Mistake> {
        let [u, v, across] = plane.axes();
        let [first, last] = [start, end].map(|point| [point[u], point[v]]);
        let centre = match centre {
            Centre::At(centre) => centre,
            Centre::Radius(radius) => centre_at(radius, first, last, clockwise)?,
        };
        let seen = [first, last].map(|point| [point[0] - centre[0], point[1] - centre[1]]);
        let radii = seen.map(|[x, y]| x.hypot(y));
        let tolerance = (RADIUS_SHARE * radii[0]).clamp(RADIUS_LEAST, RADIUS_MOST);
        if (radii[0] - radii[1]).abs() > tolerance || radii[0] <= SAME_RADIUS {
            let [start_mm, end_mm] = radii;
            return Err(Mistake::ArcRadius { start_mm, end_mm, tolerance_mm: tolerance });
        }
        let [from, to] = seen.map(|[x, y]| y.atan2(x));
        let full = (last[0] - first[0]).hypot(last[1] - first[1]) <= SAME_POINT;
        let turn = if clockwise { from - to } else { to - from };
        let turn = if full { TAU } else { turn.rem_euclid(TAU) };
        let turn = turn + TAU * f64::from(turns.saturating_sub(1));
        let sweep = if clockwise { -turn } else { turn };
        Ok(Self {
            plane,
            centre,
            radii,
            from,
            sweep,
            height: start[across],
            rise: end[across] - start[across],
        })
    }

    /// The pieces in order; the last one ends in `end` itself.
    pub(super) fn pieces(&self, end: Vector3) -> Vec<Piece> {
        let circle = (self.radii[0] - self.radii[1]).abs() <= SAME_RADIUS && self.rise == 0.0;
        let most = if circle { CIRCLE_PIECE } else { SPIRAL_PIECE };
        // A turn more than a whole number of pieces by rounding only.
        let count = (self.sweep.abs() / most - 1e-9).ceil().max(1.0);
        let place = |index: f64| index / count;
        let piece = |index: f64| {
            let last = index + 1.0 == count;
            if circle {
                let end = if last { end } else { self.passage(place(index + 1.0)).position_mm };
                return Piece::Circle { via: self.passage(place(index + 0.5)).position_mm, end };
            }
            let mut curve =
                CurvePiece { start: self.passage(place(index)), end: self.passage(place(index + 1.0)) };
            if last {
                curve.end.position_mm = end;
            }
            Piece::Curve(curve)
        };
        (0..count as u32).map(|index| piece(f64::from(index))).collect()
    }

    /// How it passes its point at a share of the whole angle.
    fn passage(&self, share: f64) -> Passage {
        let [u, v, across] = self.plane.axes();
        let growth = self.radii[1] - self.radii[0];
        let radius = self.radii[0] + growth * share;
        let (sin, cos) = (self.from + self.sweep * share).sin_cos();
        let in_space = |x: f64, y: f64, z: f64| {
            let mut vector = Vector3::zeros();
            (vector[u], vector[v], vector[across]) = (x, y, z);
            vector
        };
        let (outward, forward) = (in_space(cos, sin, 0.0), in_space(-sin, cos, 0.0));
        let centre = in_space(self.centre[0], self.centre[1], self.height + self.rise * share);
        // With the share as parameter.
        let first = outward * growth + forward * (radius * self.sweep) + in_space(0.0, 0.0, self.rise);
        let second = forward * (2.0 * growth * self.sweep) - outward * (radius * self.sweep * self.sweep);
        let tangent = first.normalize();
        Passage {
            position_mm: centre + outward * radius,
            tangent,
            curvature_per_mm: (second - tangent * tangent.dot(&second)) / first.norm_squared(),
        }
    }
}

/// The centre at a distance from both ends, on the side that the turn asks for.
fn centre_at(radius: f64, start: [f64; 2], end: [f64; 2], clockwise: bool) -> Result<[f64; 2], Mistake> {
    let way = [end[0] - start[0], end[1] - start[1]];
    let apart = way[0].hypot(way[1]);
    let small = Mistake::ArcTooSmall { radius_mm: radius, apart_mm: apart };
    // Half the way is less than the radius, or more by rounding in the file.
    if apart <= SAME_POINT || apart / 2.0 > radius.abs() + RADIUS_LEAST {
        return Err(small);
    }
    let across = (radius * radius - apart * apart / 4.0).max(0.0).sqrt();
    // Against the clock and the shorter way round, the centre lies on the left.
    let left = if clockwise == (radius < 0.0) { across } else { -across };
    Ok([start[0] + way[0] / 2.0 - way[1] / apart * left, start[1] + way[1] / 2.0 + way[0] / apart * left])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(pieces: &[Piece]) -> Vec<[f64; 3]> {
        let end = |piece: &Piece| match piece {
            Piece::Circle { end, .. } => *end,
            Piece::Curve(curve) => curve.end.position_mm,
        };
        pieces.iter().map(|piece| end(piece).map(|x| (x * 1e6).round() / 1e6 + 0.0).into()).collect()
    }

    #[test]
    fn quarter_turns_by_centre_and_by_radius() {
        let (start, end) = (Vector3::new(10.0, 0.0, 0.0), Vector3::new(0.0, 10.0, 0.0));
        for (clockwise, centre, sweep) in [
            (false, Centre::At([0.0, 0.0]), 90.0),
            (true, Centre::At([0.0, 0.0]), -270.0),
            (false, Centre::Radius(10.0), 90.0),
            (false, Centre::Radius(-10.0), 270.0),
            (true, Centre::Radius(10.0), -90.0),
            (true, Centre::Radius(-10.0), -270.0),
        ] {
            let arc = Arc::new(Plane::Xy, [start, end], centre, clockwise, 1).unwrap();
            assert!((arc.sweep.to_degrees() - sweep).abs() < 1e-9, "{clockwise} {centre:?}: {arc:?}");
        }
    }

    #[test]
    fn a_full_circle_and_a_helix_of_two_turns() {
        let start = Vector3::new(1.0, 0.0, 5.0);
        let circle = Arc::new(Plane::Xy, [start, start], Centre::At([0.0, 0.0]), false, 1).unwrap();
        let pieces = circle.pieces(start);
        assert_eq!(ends(&pieces), [[-0.5, 0.866_025, 5.0], [-0.5, -0.866_025, 5.0], [1.0, 0.0, 5.0]]);
        let end = Vector3::new(1.0, 0.0, 1.0);
        let helix = Arc::new(Plane::Xy, [start, end], Centre::At([0.0, 0.0]), true, 2).unwrap();
        let pieces = helix.pieces(end);
        assert_eq!(pieces.len(), 32);
        assert_eq!(ends(&pieces)[3], [0.0, -1.0, 4.5]);
        assert_eq!(ends(&pieces)[31], [1.0, 0.0, 1.0]);
        // A helix of slope 2/τ has the curvature r/(r² + slope²).
        let slope = 2.0 / TAU;
        let Piece::Curve(curve) = &pieces[7] else { panic!() };
        let wanted = 1.0 / (1.0 + slope * slope);
        assert!((curve.start.curvature_per_mm.norm() - wanted).abs() < 1e-12);
    }

    #[test]
    fn in_the_other_planes_g2_turns_as_seen_from_the_third_axis() {
        // G18: from +Z to +X is against the clock seen from +Y.
        let (start, end) = (Vector3::new(0.0, 3.0, 2.0), Vector3::new(2.0, 3.0, 0.0));
        let arc = Arc::new(Plane::Zx, [start, end], Centre::At([0.0, 0.0]), false, 1).unwrap();
        assert!((arc.sweep.to_degrees() - 90.0).abs() < 1e-9);
        let Piece::Circle { via, .. } = arc.pieces(end)[0] else { panic!() };
        assert!((via - Vector3::new(2f64.sqrt(), 3.0, 2f64.sqrt())).norm() < 1e-12);
    }
}
