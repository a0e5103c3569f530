//! What can go wrong in motion, with the evidence, and what stop it demands.

use crate::drive::DriveFault;
use crate::geometry::Vector3;
use crate::seam::Rejection;

/// A fault found by the cycle. Joints are counted from 0; SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// The measured position lags the command by more than the drive's model explains.
    FollowingError {
        /// Joint.
        axis: usize,
        /// Deviation from the expected position.
        value: f64,
        /// What is permitted.
        limit: f64,
    },
    /// The command would leave the joint's range.
    PositionLimit {
        /// Joint.
        axis: usize,
        /// The position.
        value: f64,
        /// The limit on that side.
        limit: f64,
    },
    /// The command's joint velocity is too high.
    VelocityLimit {
        /// Joint.
        axis: usize,
        /// The velocity.
        value: f64,
        /// Its limit.
        limit: f64,
    },
    /// The command's joint acceleration is too high.
    AccelerationLimit {
        /// Joint.
        axis: usize,
        /// The acceleration.
        value: f64,
        /// Its limit.
        limit: f64,
    },
    /// The command's joint jerk is too high.
    JerkLimit {
        /// Joint.
        axis: usize,
        /// The jerk.
        value: f64,
        /// Its limit.
        limit: f64,
    },
    /// The tool centre point would leave the permitted box.
    Workspace {
        /// Position of the tool centre point in the base frame.
        position: Vector3,
    },
    /// A command or a measurement is not a finite number.
    NotFinite {
        /// Joint.
        axis: usize,
    },
    /// The path has no joint solution here.
    NoInverse {
        /// Position of the flange in the base frame.
        position: Vector3,
    },
    /// The queue ran empty in the middle of a motion.
    Starved,
    /// More moves than the cycle remembers lie within the length of the prefilters on the feedrate.
    PathForgotten {
        /// How many it remembers.
        moves: usize,
    },
    /// The drives do not answer or report a fault.
    Drive(DriveFault),
    /// The cycle was late more often in a row than permitted.
    Overrun {
        /// Late cycles in a row.
        count: u32,
    },
    /// The operator pressed the emergency stop.
    EmergencyStop,
    /// The arc did not light.
    ArcNotLit {
        /// Strikes in a row.
        tries: u32,
    },
    /// The arc went out.
    ArcLost {
        /// Seconds without arc.
        seconds: f64,
    },
    /// The seam is not seen any more.
    SeamLost {
        /// Coordinate of the weld up to which it was seen, in metres.
        seen_to: f64,
        /// Why the sensor's last reading was dropped; `None` where there was none.
        dropped: Option<Rejection>,
    },
    /// A pass is to be welded from a record that is not there, or not whole.
    NoRecord {
        /// Number of the memory file, MPF.
        file: u32,
        /// Number of the weld in it, from 0 on.
        weld: u32,
    },
}

/// How the arm is brought to rest, in the words of IEC 60204-1; from the mildest to the severest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StopCategory {
    /// Deceleration along the path; power stays on, and the job can go on.
    Category2,
    /// Each joint decelerates within its limits, off the path, which cannot be followed further. Then power off.
    Category1,
    /// Power off at once: nothing can be commanded any more.
    Category0,
}

impl Fault {
    /// The stop this fault demands.
    #[must_use]
    pub fn category(&self) -> StopCategory {
        match self {
            Self::Drive(_) => StopCategory::Category0,
            Self::FollowingError { .. }
            | Self::Overrun { .. }
            | Self::EmergencyStop
            | Self::ArcNotLit { .. }
            | Self::ArcLost { .. }
            | Self::SeamLost { .. }
            | Self::NoRecord { .. } => StopCategory::Category2,
            Self::PositionLimit { .. }
            | Self::VelocityLimit { .. }
            | Self::AccelerationLimit { .. }
            | Self::JerkLimit { .. }
            | Self::Workspace { .. }
            | Self::NotFinite { .. }
            | Self::NoInverse { .. }
            | Self::Starved
            | Self::PathForgotten { .. } => StopCategory::Category1,
        }
    }
}
