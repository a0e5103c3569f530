//! The motion at an instant of a block.

use super::block::{Block, Motion};
use super::lookahead::{AlongPath, JointMotion};
use super::seam::Corrections;
use super::trail::Way;
use crate::geometry::PoseJet;
use crate::kinematics::{JointJet, Kinematics};
use crate::path::{Measure, PathState};
use crate::safety::Fault;

/// An instant of a block.
#[derive(Debug, Clone, Copy)]
pub(super) struct At<'a, const N: usize> {
    pub(super) block: &'a Block<N>,
    /// Programme time at which the block begins, and time since then.
    pub(super) start: f64,
    pub(super) since: f64,
}

/// The joints' motion and position at an instant of a block.
pub(super) fn joint_motion<const N: usize, K: Kinematics<N>>(
    at: &At<'_, N>,
    seed: &[f64; N],
    corrections: &Corrections<'_, N>,
    kinematics: &K,
) -> Result<(JointMotion<N>, [f64; N]), Fault> {
    let JointJet { position, velocity, acceleration, jerk } = joints_on(at, seed, corrections, kinematics)?;
    let path = along_path(at.block, at.since);
    Ok((JointMotion { velocity, acceleration, jerk, path }, position))
}

/// The path covered at a time since a block's start.
pub(super) fn way_on<const N: usize>(block: &Block<N>, time: f64) -> Way {
    match &block.motion {
        Motion::Joint(_) => Way { path: time, tool: 0.0 },
        Motion::Path(motion) => {
            let path = motion.state(time).position - motion.state(0.0).position;
            let tool = if motion.path.measure() == Measure::Length { path } else { 0.0 };
            Way { path, tool }
        }
    }
}

/// The tool's motion along its path at a time since a block's start.
pub(super) fn along_path<const N: usize>(block: &Block<N>, time: f64) -> AlongPath {
    match &block.motion {
        Motion::Joint(_) => AlongPath::NONE,
        Motion::Path(motion) => {
            let PathState { velocity, acceleration, jerk, .. } = motion.state(time);
            let (acceleration_limit, jerk_limit) = (motion.acceleration, motion.jerk);
            AlongPath { velocity, acceleration, jerk, acceleration_limit, jerk_limit }
        }
    }
}

/// The joints at an instant of a block, in programme time, on the branch nearest to `seed`; with what takes them off the planned motion.
pub(super) fn joints_on<const N: usize, K: Kinematics<N>>(
    at: &At<'_, N>,
    seed: &[f64; N],
    corrections: &Corrections<'_, N>,
    kinematics: &K,
) -> Result<JointJet<N>, Fault> {
    let mut jet = match &at.block.motion {
        Motion::Joint(motion) => {
            let state = motion.at_time(at.since);
            let (position, velocity) = (state.position, state.velocity);
            JointJet { position, velocity, acceleration: state.acceleration, jerk: state.jerk }
        }
        Motion::Path(motion) => joints_of(&motion.flange_on(at.since, corrections.seam), seed, kinematics)?,
    };
    if let Some(fade) = corrections.fade {
        fade.add(&mut jet, at.start + at.since);
    }
    Ok(jet)
}

/// The joints where the flange moves like this, on the branch nearest to `seed`.
pub(super) fn joints_of<const N: usize, K: Kinematics<N>>(
    flange: &PoseJet,
    seed: &[f64; N],
    kinematics: &K,
) -> Result<JointJet<N>, Fault> {
    let inverse = || {
        let q = kinematics.inverse_nearest(&flange.pose, seed)?;
        kinematics.joint_jet(flange, &q)
    };
    inverse().map_err(|_| Fault::NoInverse { position: flange.pose.translation.vector })
}
