//! A path that goes on from one path's motion into another's, with continuous curvature.

use super::quintic::{End, Quintic, meeting};
use super::quintic_turn::QuinticTurn;
use super::{Curve, Measure, Orientation, Path, SAME_POSITION};
use crate::geometry::{PoseJet, Rotation, Vector3};
use crate::math::float::sqrt;

/// The control points of a blend, as shares of the way from where the ends' tangents meet (0) back to the end (1).
/// The first control point is the end itself, the second stands at `SECOND`, the third at `THIRD`; for curved ends
/// the third is moved sideways by what the curvature asks.
pub(super) const SECOND: f64 = 0.6;
pub(super) const THIRD: f64 = 0.2;

/// A blend reaches at most this many times the distance of its ends along either tangent.
const GREATEST_REACH: f64 = 2.0;

/// Why two motions cannot be joined by a blend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BlendError {
    /// Both ends are the same point.
    Coincident,
    /// An end does not move along its path: its tangent is not a unit vector.
    AtRest,
    /// The blend would stand still on its way, or is not finite.
    Singular,
}

/// The end of a blend at a jet, which reaches `reach` metres along its tangent: with `sign` 1 it leaves the jet, with
/// −1 it arrives there.
fn end(jet: &PoseJet, reach: f64, sign: f64) -> End {
    let [tangent, curvature, _] = jet.linear;
    let speed = 5.0 * (1.0 - SECOND) * reach;
    let growth = 20.0 * (2.0 * SECOND - THIRD - 1.0) * reach;
    [jet.pose.translation.vector, tangent * speed, curvature * (speed * speed) + tangent * (sign * growth)]
}

/// The polynomial from one jet to the other, with a reach for each.
pub(super) fn polynomial(start: &PoseJet, finish: &PoseJet, [before, after]: [f64; 2]) -> [Vector3; 6] {
    meeting(&end(start, before, 1.0), &end(finish, after, -1.0))
}

/// How far a blend of two straight lines would reach: to where the tangents meet, if both ends are as far from there.
fn reach(start: &PoseJet, finish: &PoseJet) -> f64 {
    let chord = (finish.pose.translation.vector - start.pose.translation.vector).norm();
    let half_angle_cosine = sqrt(0.5 * (1.0 + start.linear[0].dot(&finish.linear[0])).max(0.0));
    chord * f64::min(0.5 / half_angle_cosine.max(0.1), GREATEST_REACH)
}

/// The blend of two jets along arc length, with orientations relative to `reference`.
pub(super) fn path(
    start: &PoseJet,
    finish: &PoseJet,
    coefficients: [Vector3; 6],
    reference: Rotation,
) -> Result<Path, BlendError> {
    let curve = Quintic::new(coefficients).ok_or(BlendError::Singular)?;
    let length = curve.length();
    let turn = QuinticTurn::between(start, finish, reference, length);
    Ok(Path {
        curve: Curve::Quintic(curve),
        orientation: Orientation::Quintic(turn),
        length,
        measure: Measure::Length,
    })
}

/// See [`Path::blend`].
pub(super) fn between(start: &PoseJet, finish: &PoseJet) -> Result<Path, BlendError> {
    let unit = |jet: &PoseJet| (jet.linear[0].norm() - 1.0).abs() < 1e-6;
    if !(unit(start) && unit(finish)) {
        return Err(BlendError::AtRest);
    }
    if (finish.pose.translation.vector - start.pose.translation.vector).norm() <= SAME_POSITION {
        return Err(BlendError::Coincident);
    }
    let reach = reach(start, finish);
    let turn = (finish.pose.rotation * start.pose.rotation.inverse()).scaled_axis();
    let halfway = Rotation::from_scaled_axis(turn / 2.0) * start.pose.rotation;
    path(start, finish, polynomial(start, finish, [reach; 2]), halfway)
}
