//! Corners: one path joined to the next without a stop, within a permitted error.
//!
//! Either path is trimmed, and a blend leads from one cut to the other, with the tangents, curvatures and turning rates
//! that the paths have there. The further back the cuts, the wider the blend and the greater its error; the solver finds
//! the cuts at which the error is the permitted one.
//!
//! The **error** of a blend is the greater of two distances: from the corner point to the blend, and the farthest that
//! a point of the blend lies from the two paths. At a corner of two straight lines it is the first, where a line runs
//! into an arc without a kink it is the second, and nowhere does it jump between them.

mod error;
mod trim;

use self::trim::Joint;
use super::{Measure, Path, SAME_POSITION};
use crate::geometry::{PoseJet, Vector3};
use crate::math::float::atan2;

/// Tangents within this angle (rad) are one direction: at 1 m/s the velocity steps by 1 µm/s.
const SAME_DIRECTION: f64 = 1e-6;
/// Curvatures within this (1/m) are one: at 1 m/s the acceleration steps by 0.1 mm/s².
const SAME_CURVATURE: f64 = 1e-4;
/// Turning rates within this (rad/m) are one: at 1 m/s the angular velocity steps by 1 µrad/s.
const SAME_TURNING: f64 = 1e-6;
/// Derivatives of the turning rate within this (rad/m²) are one.
const SAME_TURNING_CHANGE: f64 = 1e-4;
/// Sharper than this (rad; 177°) a path turns back: a blend's tip would have a radius of a hundredth of its error, and
/// be passed hardly faster than at a stop.
const REVERSAL: f64 = 3.089;

/// The orientation error that a blend may have in any case: 0.2°.
const ORIENTATION_ERROR: f64 = 0.2 * core::f64::consts::PI / 180.0;

/// What is permitted where two paths meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerZone {
    /// Permitted error of the position, in metres.
    pub position: f64,
    /// Permitted error of the orientation, in radians: the greatest angle between the blend's orientation and the one
    /// that the paths have after the same share of the way from cut to cut.
    ///
    /// With `None` it is 0.2°, or where that is more, what a blend has that is as long as a right-angled corner's with
    /// the permitted position error. So a real corner is given its position error, whatever the orientation does
    /// there; and on a path that goes straight on, where the position asks for no blend at all, a change of the
    /// turning rate is not smeared over the whole path.
    pub orientation: Option<f64>,
    /// How far, at most, the path before and the path after may be trimmed, in metres along them.
    pub room: [f64; 2],
}

/// How one path goes on into the next.
#[allow(clippy::large_enum_variant, reason = "without a heap there is no place for it but here")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Corner {
    /// Tangent, curvature and turning rate go on as they are: the two may be run as one.
    Smooth,
    /// By a blend.
    Blend(Blend),
    /// Not without a stop.
    Stop(MustStop),
}

/// Why a corner cannot be passed without a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MustStop {
    /// The second path does not start where the first one ends (1 µm, 1 µrad).
    Apart,
    /// One of the paths turns on the spot, or has no length.
    OnTheSpot,
    /// The path turns back: by more than 177°.
    Reversal,
    /// No error is permitted, or no room.
    NothingPermitted,
}

/// What kept a blend from being longer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    /// The permitted error of the position.
    Position,
    /// The permitted error of the orientation.
    Orientation,
    /// The room on one side or both; a bend of less radius than a blend would be long counts as room too.
    Room,
}

/// Two paths joined by a blend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blend {
    /// The first path up to the blend.
    pub before: Path,
    /// The blend.
    pub path: Path,
    /// The second path from the blend on.
    pub after: Path,
    /// How much of the first and of the second path the blend replaces, in metres.
    pub trims: [f64; 2],
    /// The error of the position in metres, as the module says.
    pub error: f64,
    /// The error of the orientation in radians, to a few per cent (see [`CornerZone::orientation`]).
    pub orientation_error: f64,
    /// The blend's greatest curvature in 1/m, to 0.2 %.
    pub greatest_curvature: f64,
    /// What kept the blend from being longer.
    pub bound: Bound,
}

impl Corner {
    /// Joins `before` to `after`, where the end of one is the start of the other, with a blend whose error is the
    /// permitted one to 0.1 % and not above it, or smaller where the room ends first.
    ///
    /// Both cuts have the same distance from the corner, unless the room on one side is shorter: then the other may be
    /// twice as far.
    ///
    /// Cost: about 4 µs for two straight lines in closed form, 6 µs where one is an arc (bounded root finding), and up to
    /// 13 µs where the orientation bounds the blend. `cargo run --release --example corners` measures it.
    #[must_use]
    pub fn between(before: &Path, after: &Path, zone: &CornerZone) -> Self {
        let moves = |path: &Path| path.measure() == Measure::Length && path.length() > SAME_POSITION;
        if !(moves(before) && moves(after)) {
            return Self::Stop(MustStop::OnTheSpot);
        }
        let ends = [before.jet(before.length()), after.jet(0.0)];
        if apart(&ends) {
            return Self::Stop(MustStop::Apart);
        }
        let angle = angle(&ends[0].linear[0], &ends[1].linear[0]);
        if angle > REVERSAL {
            return Self::Stop(MustStop::Reversal);
        }
        if angle <= SAME_DIRECTION && goes_on(&ends) {
            return Self::Smooth;
        }
        let joint = Joint::new(before, after, &ends, angle, zone.room);
        let permitted = zone.position > 0.0 && zone.orientation.is_none_or(|error| error > 0.0);
        let blend = if permitted { joint.blend(zone) } else { None };
        blend.map_or(Self::Stop(MustStop::NothingPermitted), Self::Blend)
    }
}

fn apart([end, start]: &[PoseJet; 2]) -> bool {
    let gap = start.pose.translation.vector - end.pose.translation.vector;
    let turn = (start.pose.rotation * end.pose.rotation.inverse()).imag() * 2.0;
    let together = gap.norm() <= 1e-6 && turn.norm() <= 1e-6;
    !together
}

/// The angle between two unit vectors, in [0, π], exact for small ones.
fn angle(a: &Vector3, b: &Vector3) -> f64 {
    atan2(a.cross(b).norm(), a.dot(b))
}

/// Whether curvature and turning go on as they are.
fn goes_on([end, start]: &[PoseJet; 2]) -> bool {
    let within = |a: &Vector3, b: &Vector3, bound: f64| (a - b).norm() <= bound;
    within(&end.linear[1], &start.linear[1], SAME_CURVATURE)
        && within(&end.angular[0], &start.angular[0], SAME_TURNING)
        && within(&end.angular[1], &start.angular[1], SAME_TURNING_CHANGE)
}
