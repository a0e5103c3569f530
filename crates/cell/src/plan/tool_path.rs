//! The geometry of moves of the tool centre point.

use seamline::geometry::Pose;
use seamline::path::{Path, SplineError, spline};

use super::error::Problem;
use crate::cell::{Cell, JobRules};
use crate::job::{ArcPart, Coordinates, Frame, SplinePiece, Target, Zone};

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
        text: piece.points.get(index).map_or_else(|| "MOVS".into(), |point| format!("MOVS {}", point.name)),
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

/// The pose after an increment in a frame.
pub(super) fn increment(from: &Pose, target: &Target, frame: Frame, cell: &Cell) -> Result<Pose, Problem> {
    let name = || target.name.to_string();
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
    }
}
