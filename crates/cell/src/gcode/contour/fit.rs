//! A curve from passage to passage, held against the points that it replaces.

use seamline::geometry::{Pose, PoseJet, Vector3};
use seamline::path::{Curve, Path, Quintic};

use crate::job::{CurvePiece, Passage};

/// Newton steps to the foot of a point on the curve, from a guess that is good to a part of a chord.
const STEPS: usize = 2;

/// The greatest distance between the curve and the lines from point to point, in mm; `None` where it is more than
/// `tolerance`, or the curve does not pass the points in their order.
///
/// The distance is taken at every point and, half way between the feet of two neighbours, from the line that joins them.
pub(super) fn deviation(piece: &CurvePiece, points: &[Vector3], tolerance: f64) -> Option<f64> {
    let path = path(piece)?;
    let Curve::Quintic(curve) = path.curve() else { return None };
    let ways: Vec<f64> = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
    let whole: f64 = ways.iter().sum();
    let (mut greatest, mut way, mut foot) = (0.0_f64, 0.0, 0.0);
    for ((pair, length), index) in points.windows(2).zip(&ways).zip(1..) {
        way += length;
        let next = if index == ways.len() { 1.0 } else { foot_of(curve, &pair[1], way / whole) };
        if next <= foot {
            return None;
        }
        let half_way = at(curve, 0.5 * (foot + next))[0];
        greatest = greatest
            .max((at(curve, next)[0] - pair[1]).norm())
            .max(distance_to_line(&half_way, &pair[0], &pair[1], *length));
        if greatest > tolerance {
            return None;
        }
        foot = next;
    }
    Some(greatest)
}

/// The curve as the planner makes it, in the work frame.
fn path(piece: &CurvePiece) -> Option<Path> {
    let jet = |passage: &Passage| PoseJet {
        linear: [passage.tangent, passage.curvature_per_mm * 1000.0, Vector3::zeros()],
        ..PoseJet::at_rest(Pose::translation(
            passage.position_mm.x / 1000.0,
            passage.position_mm.y / 1000.0,
            passage.position_mm.z / 1000.0,
        ))
    };
    Path::blend(&jet(&piece.start), &jet(&piece.end)).ok()
}

/// Point and derivative in mm.
fn at(curve: &Quintic, u: f64) -> [Vector3; 2] {
    curve.at_parameter(u).map(|metres| metres * 1000.0)
}

/// Where the curve passes nearest to a point, near a guess.
fn foot_of(curve: &Quintic, point: &Vector3, mut u: f64) -> f64 {
    for _ in 0..STEPS {
        let [place, first] = at(curve, u);
        u = (u + (point - place).dot(&first) / first.norm_squared()).clamp(0.0, 1.0);
    }
    u
}

fn distance_to_line(point: &Vector3, from: &Vector3, to: &Vector3, length: f64) -> f64 {
    let direction = (to - from) / length;
    let offset = point - from;
    (offset - direction * offset.dot(&direction).clamp(0.0, length)).norm()
}
