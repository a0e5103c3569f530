//! The geometry of moves of the tool centre point.

use nalgebra::Point3;
use seamline::geometry::{Pose, PoseJet, Vector3};
use seamline::path::{BlendError, Path, SplineError, spline};

use super::error::Problem;
use super::resolve::base_from_frame;
use crate::cell::{Cell, JobRules};
use crate::job::{ArcPart, Coordinates, CurvePiece, Frame, Passage, SplinePiece, Target, Zone};

pub(super) fn line(start: &Pose, end: &Pose) -> Path {
    Path::line(start, end)
}

/// The piece of the circle through three poses that is run from `start`, and whether it had to be straight.
pub(super) fn arc(start: &Pose, poses: &[Pose; 3], part: ArcPart) -> (Path, bool) {
    let [first, second, third] = poses;
    let (path, end) = match part {
        ArcPart::Whole => (Path::arc(start, second, third), third),
        ArcPart::First => (Path::arc_between(first, second, third, start, second), second),
        ArcPart::Second => (Path::arc_between(first, second, third, start, third), third),
    };
    path.map_or_else(|_| (Path::line(start, end), true), |path| (path, false))
}

/// The piece of the spline through all poses that ends in one of them.
pub(super) fn spline_piece(poses: &[Pose], piece: &SplinePiece) -> Result<Path, Problem> {
    let at_rest = Path::line(&Pose::identity(), &Pose::identity());
    let mut pieces = vec![at_rest; poses.len().saturating_sub(1)];
    let refused = |index: usize, reason: &str| Problem::Refused {
        text: piece.points.get(index).map_or_else(|| "MOVS".into(), |point| format!("MOVS {point}")),
        reason: reason.into(),
    };
    spline(poses, None, None, &mut pieces).map_err(|error| match error {
        SplineError::TooFew | SplineError::Pieces => refused(0, "a spline needs three points"),
        SplineError::Coincident(index) => refused(index, "the point is the same as the one before"),
        SplineError::Reversal(index) => refused(index, "the spline would turn back at this point"),
        SplineError::Singular(index) => refused(index, "no smooth curve leads to the next point"),
    })?;
    pieces.get(piece.end.wrapping_sub(1)).copied().ok_or_else(|| refused(piece.end, "it has no such point"))
}

/// A curve given in the frame of its target, with the target's orientation all along.
pub(super) fn curve(piece: &CurvePiece, target: &Target, end: &Pose, cell: &Cell) -> Result<Path, Problem> {
    let Coordinates::Rectangular(position) = &target.position.coordinates else {
        return Err(Problem::StationPosition { name: target.to_string() });
    };
    let frame = base_from_frame(position.frame, cell, &target.to_string())?;
    let jet = |passage: &Passage| {
        let position = frame * Point3::from(passage.position_mm / 1000.0);
        let linear = [
            frame.rotation * passage.tangent,
            frame.rotation * (passage.curvature_per_mm * 1000.0),
            Vector3::zeros(),
        ];
        PoseJet { linear, ..PoseJet::at_rest(Pose::from_parts(position.coords.into(), end.rotation)) }
    };
    Path::blend(&jet(&piece.start), &jet(&piece.end)).map_err(|error| Problem::Refused {
        text: "the curve".into(),
        reason: match error {
            BlendError::Coincident => "it ends where it starts".into(),
            BlendError::AtRest | BlendError::Singular => "it stands still on its way".into(),
        },
    })
}

/// The pose after an increment in a frame.
pub(super) fn increment(from: &Pose, target: &Target, frame: Frame, cell: &Cell) -> Result<Pose, Problem> {
    let name = || target.to_string();
    let Coordinates::Rectangular(increment) = &target.position.coordinates else {
        return Err(Problem::StationPosition { name: name() });
    };
    let step = increment.pose();
    let in_base = |base_from_frame: &Pose| {
        let shift = base_from_frame.rotation * step.translation.vector;
        let turn = base_from_frame.rotation * step.rotation * base_from_frame.rotation.inverse();
        Pose::from_parts((from.translation.vector + shift).into(), turn * from.rotation)
    };
    match frame {
        Frame::Base | Frame::Robot => Ok(in_base(&Pose::identity())),
        Frame::Tool => Ok(from * step),
        Frame::User(number) => {
            let frame = cell.user_frame(number).ok_or(Problem::UnknownFrame { number })?;
            Ok(in_base(&frame.base_from_user))
        }
        Frame::MasterTool => Err(Problem::UnsupportedFrame { name: name(), frame }),
    }
}

/// How far from its end a move may be passed, in metres; `None` where the robot stops there. A corner radius is taken for what it is
/// between two lines at right angles.
pub(super) fn pass(zone: &Zone, rules: &JobRules) -> Option<f64> {
    match zone {
        Zone::Exact => None,
        Zone::Level(level) => rules.position_levels.get(usize::from(*level)).copied(),
        Zone::CornerRadius { mm } => Some(mm / 1000.0 * (std::f64::consts::SQRT_2 - 1.0)),
        Zone::Unspecified => Some(rules.corner_error),
        Zone::Tolerance { mm } => Some(mm / 1000.0),
    }
}
