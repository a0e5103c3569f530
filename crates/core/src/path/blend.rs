//! A path that goes on from one path's motion into another's, with continuous curvature.

use super::curve::PointJet;
use super::quintic::{End, Quintic, meeting};
use super::quintic_turn::QuinticTurn;
use super::{Curve, Measure, Orientation, Path, SAME_POSITION};
use crate::geometry::{PoseJet, Rotation, Vector3};
use crate::math::float::sqrt;

/// The proportions of a blend: where its second and third control points stand, as shares of the way from where the
/// tangents of its ends meet (0) back to the end (1). The first control point is the end itself; for curved ends the
/// third is moved sideways by what the curvature asks.
///
/// Chosen for two straight lines and a given distance from the corner, so that κ·√|x‴| (its greatest values; the speed
/// at given normal acceleration goes as κ^−½, at given jerk as |x‴|^−⅓) is small at every angle. Up to 60° that is a
/// polynomial at almost even speed, {0.6, 0.2}; sharper corners want their inner control points apart, so that the tip
/// is wide. Against the best pair at each angle (on a grid of 0.01), the square root of that product is within 10 % up
/// to 135°, 30 % up to 170° and 53 % up to 177°.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Proportions {
    second: f64,
    third: f64,
}

impl Proportions {
    /// For two tangents, by the cosine of the angle between them.
    pub(super) fn at(angle_cosine: f64) -> Self {
        let sharpness = (0.5 * (1.0 - angle_cosine)).clamp(0.0, 1.0);
        let square = sharpness * sharpness;
        let fifth = square * square * sharpness;
        Self { second: 0.6 + 0.3 * fifth, third: 0.2 + 0.16 * sharpness + 0.5 * fifth }
    }

    /// For two straight lines: the distance of the blend's middle from the corner, as a share of the distance that
    /// its ends' middle has from there (a quintic's middle is (P₀ + 5P₁ + 10P₂ + 10P₃ + 5P₄ + P₅)/32).
    pub(super) fn middle(&self) -> f64 {
        (1.0 + 5.0 * self.second + 10.0 * self.third) / 16.0
    }
}

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

/// The end of a blend at a point, which reaches `reach` metres along its tangent: with `sign` 1 it leaves the point,
/// with −1 it arrives there.
fn end(point: &PointJet, reach: f64, shape: &Proportions, sign: f64) -> End {
    let (position, [tangent, curvature, _]) = point.into_parts();
    let speed = 5.0 * (1.0 - shape.second) * reach;
    let growth = 20.0 * (2.0 * shape.second - shape.third - 1.0) * reach;
    [position, tangent * speed, curvature * (speed * speed) + tangent * (sign * growth)]
}

/// The polynomial from one point to the other.
pub(super) fn polynomial(
    ends: &[PointJet; 2],
    [before, after]: [f64; 2],
    shape: &Proportions,
) -> [Vector3; 6] {
    meeting(&end(&ends[0], before, shape, 1.0), &end(&ends[1], after, shape, -1.0))
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
        weave: None,
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
    let shape = Proportions::at(start.linear[0].dot(&finish.linear[0]));
    let ends = [start, finish].map(|jet| PointJet::new(jet.pose.translation.vector, jet.linear));
    path(start, finish, polynomial(&ends, [reach; 2], &shape), halfway)
}
