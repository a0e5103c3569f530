//! Blocks: what a planner hands to the cycle, piece by piece, through a bounded queue.

use super::seam::{Playing, Tracked, Tracking};
use crate::arc::ArcSetting;
use crate::geometry::{Pose, PoseJet};
use crate::otg::{Sample, Trajectory};
use crate::path::{Path, PathState, TimingPiece};

/// Most pieces of timing in one block; a longer motion is several blocks.
pub const BLOCK_PIECES: usize = 48;

/// One entry of the queue.
#[expect(
    clippy::large_enum_variant,
    reason = "without a heap the largest one sets the size of the queue's entries"
)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command<const N: usize> {
    /// Move.
    Move(Block<N>),
    /// Stand still for a time that override does not change.
    Dwell {
        /// Line of the job.
        line: u32,
        /// Running number of the segment.
        segment: u32,
        /// Seconds.
        duration: f64,
    },
    /// Light the arc or put it out. The program goes on when it burns.
    Arc {
        /// Whether it burns from here on.
        on: bool,
        /// What the power source is set to.
        setting: ArcSetting,
    },
    /// From here on the power source is set to this.
    ArcSetting(ArcSetting),
    /// The taught path of the weld goes on: a seam is looked for along it, ahead of the motion.
    Taught {
        /// Without a weave.
        path: Path,
        /// Coordinate of the weld at which it begins, in metres. Where it does not go on from the one before, another weld begins.
        start: f64,
    },
    /// The seam is tracked from here on. The arm is at rest.
    TrackOn(Tracking),
    /// A pass is welded from the record of an earlier one from here on. The arm is at rest.
    PlayOn(Playing),
    /// The tracked weld goes on with the next move, where the taught path may bend a little. The arm is at rest.
    TrackOver,
    /// The seam is tracked, or the record played, no longer. The arm is at rest.
    TrackOff,
    /// A place in the program that the status reports when it is passed. Numbers rise.
    Marker(u32),
    /// The program ends here.
    End,
}

/// A stretch of motion with its geometry and timing. Blocks follow each other without a jump in joint position,
/// velocity and acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block<const N: usize> {
    /// Line of the job.
    pub line: u32,
    /// Running number of the segment.
    pub segment: u32,
    /// Tool centre point in the flange frame.
    pub flange_from_tcp: Pose,
    /// The arm is at rest where the block begins.
    pub starts_at_rest: bool,
    /// The arm is at rest where the block ends.
    pub ends_at_rest: bool,
    /// Where and when.
    pub motion: Motion<N>,
}

/// How a block moves.
#[expect(
    clippy::large_enum_variant,
    reason = "without a heap the larger one sets the size of the queue's entries"
)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion<const N: usize> {
    /// Each joint on its own trajectory.
    Joint(TrajectoryMotion<N>),
    /// The tool centre point along a path.
    Path(PathMotion),
}

/// A trajectory of the joints, or what is run of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryMotion<const N: usize> {
    trajectory: Trajectory<N>,
    /// From when to when, in the trajectory's time.
    from: f64,
    to: f64,
}

impl<const N: usize> TrajectoryMotion<N> {
    /// The whole of a trajectory.
    #[must_use]
    pub fn whole(trajectory: Trajectory<N>) -> Self {
        Self { trajectory, from: 0.0, to: trajectory.duration() }
    }

    /// What lies between two times of this one, 0 ≤ `from` ≤ `to` ≤ duration, in seconds.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let end = if to < self.duration() { self.from + to } else { self.to };
        Self { trajectory: self.trajectory, from: self.from + from, to: end }
    }

    /// The trajectory that it is of.
    #[must_use]
    pub fn trajectory(&self) -> &Trajectory<N> {
        &self.trajectory
    }

    /// Duration in seconds of programme time.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.to - self.from
    }

    /// The joints at a time since the block's start; from its end on exactly those of the end.
    #[must_use]
    pub fn at_time(&self, time: f64) -> Sample<N> {
        self.trajectory.at_time(if time < self.duration() { self.from + time } else { self.to })
    }
}

/// A path, and the motion along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathMotion {
    /// The tool centre point's path in the base frame.
    pub path: Path,
    /// Highest acceleration along the path while the rate changes, in the path coordinate's unit per s².
    pub acceleration: f64,
    /// Highest jerk likewise.
    pub jerk: f64,
    /// Where the path follows a tracked seam.
    pub tracked: Option<Tracked>,
    pub(super) tcp_from_flange: Pose,
    pieces: [TimingPiece; BLOCK_PIECES],
    /// When each piece begins, in seconds from the block's start.
    starts: [f64; BLOCK_PIECES],
    count: usize,
    duration: f64,
}

impl PathMotion {
    /// A motion along `path` with the tool at `flange_from_tcp`, and the limits along the path that a change of the
    /// rate keeps (acceleration, jerk; infinite for none). `None` where there are no pieces or more than
    /// [`BLOCK_PIECES`].
    #[must_use]
    pub fn new(
        path: Path,
        flange_from_tcp: &Pose,
        (acceleration, jerk): (f64, f64),
        timing: &[TimingPiece],
    ) -> Option<Self> {
        if timing.is_empty() || timing.len() > BLOCK_PIECES {
            return None;
        }
        let (mut pieces, mut starts, mut duration) =
            ([TimingPiece::default(); BLOCK_PIECES], [0.0; BLOCK_PIECES], 0.0);
        for (k, piece) in timing.iter().enumerate() {
            (pieces[k], starts[k]) = (*piece, duration);
            duration += piece.duration;
        }
        let tcp_from_flange = flange_from_tcp.inverse();
        Some(Self {
            path,
            acceleration,
            jerk,
            tracked: None,
            tcp_from_flange,
            pieces,
            starts,
            count: timing.len(),
            duration,
        })
    }

    /// The same motion along a tracked seam.
    #[must_use]
    pub fn on_seam(self, tracked: Tracked) -> Self {
        Self { tracked: Some(tracked), ..self }
    }

    /// Duration in seconds of programme time.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The path coordinate at a time since the block's start.
    #[must_use]
    pub fn state(&self, time: f64) -> PathState {
        let after = self.starts[..self.count].partition_point(|start| *start <= time);
        let k = after.saturating_sub(1);
        self.pieces[k].at((time - self.starts[k]).clamp(0.0, self.pieces[k].duration))
    }

    /// The flange's motion in programme time at a time since the block's start, without the correction of a tracked seam.
    #[must_use]
    pub fn flange(&self, time: f64) -> PoseJet {
        let state = self.state(time);
        let tcp = self.path.jet(state.position).in_time([state.velocity, state.acceleration, state.jerk]);
        tcp.attached(&self.tcp_from_flange)
    }
}

impl<const N: usize> Block<N> {
    /// Duration in seconds of programme time.
    #[must_use]
    pub fn duration(&self) -> f64 {
        match &self.motion {
            Motion::Joint(motion) => motion.duration(),
            Motion::Path(motion) => motion.duration(),
        }
    }
}
