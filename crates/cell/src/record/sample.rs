//! One cycle, as it is recorded.

use seamline::geometry::Pose;

/// The most joints that a sample holds; further entries of its arrays than the robot has joints stay zero.
pub const MAX_JOINTS: usize = 7;

/// What the controller was doing in a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunMode {
    /// Drives off.
    Disabled,
    /// Drives on, nothing to do.
    Standstill,
    /// A job runs.
    Running,
    /// A job is paused, and the robot stands.
    Holding,
    /// Coming to a stop along the path.
    Stopping,
    /// A fault is latched.
    Fault,
}

impl RunMode {
    /// Every mode, in the order of declaration.
    pub const ALL: [Self; 6] =
        [Self::Disabled, Self::Standstill, Self::Running, Self::Holding, Self::Stopping, Self::Fault];

    /// The word in the recording.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Disabled => "disabled",
            Self::Standstill => "standstill",
            Self::Running => "running",
            Self::Holding => "holding",
            Self::Stopping => "stopping",
            Self::Fault => "fault",
        }
    }

    /// The mode with this word.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.name() == name)
    }
}

impl From<seamline::control::Mode> for RunMode {
    fn from(mode: seamline::control::Mode) -> Self {
        use seamline::control::Mode;
        match mode {
            Mode::Disabled => Self::Disabled,
            Mode::Standstill => Self::Standstill,
            Mode::Running => Self::Running,
            Mode::Holding => Self::Holding,
            Mode::Stopping => Self::Stopping,
            Mode::Fault => Self::Fault,
        }
    }
}

/// One cycle of a run: SI units, the tool centre point in the robot frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since the start of the run, in seconds.
    pub time: f64,
    /// What the controller was doing.
    pub mode: RunMode,
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
            mode: RunMode::Standstill,
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
