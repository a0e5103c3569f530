//! Whether a planned move stays in the cell's workspace.

use seamline::geometry::{Pose, Vector3};
use seamline::kinematics::Kinematics;
use seamline::otg::Trajectory;
use seamline::path::Path;

use super::error::Problem;
use crate::cell::Safety;

/// Places looked at along a path: a line needs its ends only, an arc bulges by less than 0.2 % of its radius between two.
const PLACES: u32 = 64;
/// Distance of the instants looked at in a joint move, in seconds.
const INSTANT: f64 = 0.01;

fn inside(safety: &Safety, position: &Vector3) -> bool {
    (0..3).all(|k| (safety.workspace_min[k]..=safety.workspace_max[k]).contains(&position[k]))
}

fn problem(safety: &Safety, position: &Vector3) -> Problem {
    let mm = |v: &Vector3| [v.x * 1000.0, v.y * 1000.0, v.z * 1000.0];
    Problem::Workspace {
        position_mm: mm(position),
        min_mm: mm(&safety.workspace_min),
        max_mm: mm(&safety.workspace_max),
    }
}

/// The tool centre point's path lies in the workspace.
pub(super) fn check_path(path: &Path, safety: &Safety) -> Result<(), Problem> {
    let at = |k: u32| path.pose(path.length() * f64::from(k) / f64::from(PLACES)).translation.vector;
    let outside = (0..=PLACES).map(at).find(|position| !inside(safety, position));
    outside.map_or(Ok(()), |position| Err(problem(safety, &position)))
}

/// The same with the tool centre point up to `reach` metres beside the path.
pub(super) fn check_path_with_room(path: &Path, reach: f64, safety: &Safety) -> Result<(), Problem> {
    let room = Vector3::repeat(reach);
    let (workspace_min, workspace_max) = (safety.workspace_min + room, safety.workspace_max - room);
    check_path(path, &Safety { workspace_min, workspace_max })
}

/// The tool centre point stays in the workspace during a joint move.
pub(super) fn check_joint_move<const N: usize>(
    trajectory: &Trajectory<N>,
    kinematics: &impl Kinematics<N>,
    flange_from_tcp: &Pose,
    safety: &Safety,
) -> Result<(), Problem> {
    let instants = (trajectory.duration() / INSTANT).ceil() as u32 + 1;
    let at = |k: u32| {
        let joints = trajectory.at_time((f64::from(k) * INSTANT).min(trajectory.duration())).position;
        (kinematics.forward(&joints) * flange_from_tcp).translation.vector
    };
    let outside = (0..instants).map(at).find(|position| !inside(safety, position));
    outside.map_or(Ok(()), |position| Err(problem(safety, &position)))
}
