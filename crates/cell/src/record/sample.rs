//! One cycle, as it is recorded.

use seamline::control::Mode;
use seamline::geometry::Pose;

/// The most joints that a sample holds; further entries of its arrays than the robot has joints stay zero.
pub const MAX_JOINTS: usize = 7;

/// One cycle of a run: SI units, the tool centre point in the robot frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since the start of the run, in seconds.
    pub time: f64,
    /// What the controller was doing.
    pub mode: Mode,
    /// Line of the job file, counted from 1; 0 before the first.
    pub line: u32,
    /// Number of the segment under way, as in [`SegmentInfo::segment`](super::SegmentInfo::segment); 0 for none.
    pub segment: u32,
    /// Rate of programme time in effect: 1 is full speed, 0 stands.
    pub override_rate: f64,
    /// Commanded joint positions, in radians (metres for a sliding joint).
    pub command: [f64; MAX_JOINTS],
    /// Joint positions that the drives report, in the same units.
    pub measured: [f64; MAX_JOINTS],
    /// Pose of the tool centre point: forward kinematics of the command.
    pub tcp: Pose,
    /// Speed of the commanded tool centre point, in m/s.
    pub tcp_speed: f64,
    /// The arc is lit.
    pub arc: bool,
    /// Seam correction in effect, across the seam, in metres; 0 without a tracker.
    pub seam_lateral: f64,
    /// Seam correction in effect, in height, in metres; 0 without a tracker.
    pub seam_height: f64,
    /// Distance of the tool centre point from the true seam, in metres; NaN where nobody knows.
    pub seam_error: f64,
}

impl Sample {
    /// A robot that stands at the origin at the start of a run.
    #[must_use]
    pub fn at_rest() -> Self {
        Self {
            time: 0.0,
            mode: Mode::Standstill,
            line: 0,
            segment: 0,
            override_rate: 1.0,
            command: [0.0; MAX_JOINTS],
            measured: [0.0; MAX_JOINTS],
            tcp: Pose::identity(),
            tcp_speed: 0.0,
            arc: false,
            seam_lateral: 0.0,
            seam_height: 0.0,
            seam_error: f64::NAN,
        }
    }
}
