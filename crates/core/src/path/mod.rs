//! Paths of the tool centre point in space: position and orientation as functions of one path coordinate.
//!
//! The coordinate s runs from 0 to [`Path::length`]: arc length in metres, or, for a path that turns on the spot, the
//! angle in radians. Position and orientation have exact derivatives in s, so that joint limits along the path can be
//! asked exactly.
//!
//! Lines and arcs come from a job's instructions. What joins them without a stop is a [`Quintic`] curve: its curvature
//! and turning rate go on from one path's into the next one's, so that the joints' accelerations do not step. [`corner`]
//! finds the blend that keeps a permitted error, [`spline`] leads a free curve through given poses.

mod blend;
pub mod corner;
mod curve;
mod orientation;
mod quintic;
mod quintic_turn;
mod rotation_vector;
mod seam_frame;
mod spline;
mod timing;

pub use blend::BlendError;
pub use curve::{Arc, ArcError, Curve};
pub use orientation::{Geodesic, Orientation, Through};
pub use quintic::Quintic;
pub use quintic_turn::QuinticTurn;
pub use seam_frame::{SeamFrame, displaced};
pub use spline::{SplineError, spline};
pub use timing::{PathState, TimingPiece};

use crate::geometry::{Pose, PoseJet, Rotation};
use crate::weave::Weave;

/// Positions closer than this are one point: 1 nm.
pub const SAME_POSITION: f64 = 1e-9;
/// Orientations closer than this are one: 1 nrad.
pub const SAME_ORIENTATION: f64 = 1e-9;

/// What a path's coordinate counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Arc length of the tool centre point, in metres.
    Length,
    /// Angle of a turn on the spot, in radians.
    Angle,
}

/// A segment of a tool path: where, and how turned, at each value of the path coordinate. A weave may go about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Path {
    curve: Curve,
    orientation: Orientation,
    length: f64,
    measure: Measure,
    weave: Option<PathWeave>,
}

/// A weave on a path.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PathWeave {
    weave: Weave,
    /// The weave's coordinate at the path's start.
    start: f64,
}

impl Path {
    /// A straight line from one pose to another, or a turn on the spot where the positions agree.
    #[must_use]
    pub fn line(start: &Pose, end: &Pose) -> Self {
        let curve = Curve::line(start.translation.vector, end.translation.vector);
        let turn = Geodesic::new(start.rotation, end.rotation);
        let (length, measure) = if curve.length() > SAME_POSITION {
            (curve.length(), Measure::Length)
        } else {
            (turn.angle(), Measure::Angle)
        };
        Self { curve, orientation: Orientation::Geodesic(turn), length, measure, weave: None }
    }

    /// A circular arc from `start` through `via` to `end`, in position and orientation.
    ///
    /// # Errors
    /// [`ArcError`] where the three positions do not determine a circle.
    pub fn arc(start: &Pose, via: &Pose, end: &Pose) -> Result<Self, ArcError> {
        let arc = Arc::through(start.translation.vector, via.translation.vector, end.translation.vector)?;
        let length = arc.radius * arc.angle;
        let via_at = arc.coordinate(via.translation.vector);
        let turn = Through::new(start.rotation, via.rotation, end.rotation, via_at, length);
        let orientation = Orientation::Through(turn);
        Ok(Self { curve: Curve::Arc(arc), orientation, length, measure: Measure::Length, weave: None })
    }

    /// Part of the circle through three poses: from `start` to `end`, which both lie on it. The orientation follows the
    /// geodesic from start to end.
    ///
    /// # Errors
    /// [`ArcError`] where the three positions do not determine a circle, or start and end agree.
    pub fn arc_between(
        first: &Pose,
        second: &Pose,
        third: &Pose,
        start: &Pose,
        end: &Pose,
    ) -> Result<Self, ArcError> {
        let position = |pose: &Pose| pose.translation.vector;
        let circle = Arc::through(position(first), position(second), position(third))?;
        let arc = circle.between(position(start), position(end))?;
        let orientation = Orientation::Geodesic(Geodesic::new(start.rotation, end.rotation));
        let length = arc.radius * arc.angle;
        Ok(Self { curve: Curve::Arc(arc), orientation, length, measure: Measure::Length, weave: None })
    }

    /// A curve that goes on from `start`'s motion into `end`'s: it has their positions, tangents, curvatures,
    /// orientations, angular velocities and angular accelerations, all along arc length. It leads from `start` forward
    /// to `end`; made for ends of which each lies ahead of the other, as at a corner.
    ///
    /// Both jets are along arc length, as [`Path::jet`] gives them; their third derivatives are not used. The curve's
    /// length comes by quadrature, to rounding (about 1 µs); [`Path::jet`] then costs about 0.3 µs.
    ///
    /// # Errors
    /// [`BlendError`] where a jet does not move or both are in one place.
    pub fn blend(start: &PoseJet, end: &PoseJet) -> Result<Self, BlendError> {
        blend::between(start, end)
    }

    /// The piece of the path between two of its coordinates, `from` ≤ `to`: the same poses and derivatives, with
    /// coordinates counted from `from`.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let curve = match self.measure {
            Measure::Length => self.curve.part(from, to),
            Measure::Angle => self.curve,
        };
        Self {
            curve,
            orientation: self.orientation.part(from, to, self.length),
            length: to - from,
            measure: self.measure,
            weave: self.weave.map(|on| PathWeave { start: on.start + from, ..on }),
        }
    }

    /// The same path with a weave about it; `start` is the weave's coordinate where the path begins, in metres. The path coordinate goes on
    /// counting the way along the seam.
    #[must_use]
    pub fn woven(&self, weave: &Weave, start: f64) -> Self {
        Self { weave: Some(PathWeave { weave: *weave, start }), ..*self }
    }

    /// The same path without a weave.
    #[must_use]
    pub fn seam(&self) -> Self {
        Self { weave: None, ..*self }
    }

    /// Whether a weave goes about it.
    #[must_use]
    pub fn is_woven(&self) -> bool {
        self.weave.is_some()
    }

    /// The weave about it.
    #[must_use]
    pub fn weave(&self) -> Option<&Weave> {
        self.weave.as_ref().map(|on| &on.weave)
    }

    /// The same way of the tool centre point with the tool turned by a constant rotation in its own frame.
    #[must_use]
    pub fn tilted(&self, tilt: &Rotation) -> Self {
        Self { orientation: self.orientation.tilted(tilt), ..*self }
    }

    /// Length of the path: metres or radians, as [`Path::measure`] says. Zero where nothing moves.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// What the path coordinate counts.
    #[must_use]
    pub fn measure(&self) -> Measure {
        self.measure
    }

    /// The curve of the tool centre point.
    #[must_use]
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// The orientation along the path.
    #[must_use]
    pub fn orientation(&self) -> &Orientation {
        &self.orientation
    }

    /// The pose at coordinate `s`, and its derivatives with respect to s.
    #[must_use]
    pub fn jet(&self, s: f64) -> PoseJet {
        self.weave_about(&self.seam_jet(s), s)
    }

    /// The weave of coordinate `s` about a motion along the seam, which need not be the path's own: it may have been corrected.
    #[must_use]
    pub fn weave_about(&self, seam: &PoseJet, s: f64) -> PoseJet {
        match &self.weave {
            Some(on) => displaced(seam, &on.weave.offset(on.start + s)),
            None => *seam,
        }
    }

    /// The pose at coordinate `s` and its derivatives without the weave.
    #[must_use]
    pub fn seam_jet(&self, s: f64) -> PoseJet {
        let (position, linear) = match self.measure {
            Measure::Length => self.curve.jet(s),
            Measure::Angle => self.curve.jet(0.0).at_rest(),
        }
        .into_parts();
        let (rotation, angular) = self.orientation.at(s, self.length);
        PoseJet { pose: Pose::from_parts(position.into(), rotation), linear, angular }
    }

    fn rotation(&self, s: f64) -> Rotation {
        self.orientation.at(s, self.length).0
    }

    /// The pose at coordinate `s`.
    #[must_use]
    pub fn pose(&self, s: f64) -> Pose {
        self.jet(s).pose
    }
}

#[cfg(test)]
mod tests;
