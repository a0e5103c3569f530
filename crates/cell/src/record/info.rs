//! What a run was meant to do: the data that recorded samples are held against.

use seamline::geometry::Vector3;
use seamline::kinematics::JointKind;
use seamline::path::{Curve, Measure, Path};

/// A joint's name and limits, in radians or metres by its kind.
#[derive(Debug, Clone, PartialEq)]
pub struct JointInfo {
    /// Name on the axis, such as `S` or `L`.
    pub name: String,
    /// Turning or sliding.
    pub kind: JointKind,
    /// Least and greatest position.
    pub position: [f64; 2],
    /// Velocity limit, per second.
    pub velocity: f64,
    /// Acceleration limit, per s².
    pub acceleration: f64,
    /// Jerk limit, per s³.
    pub jerk: f64,
}

/// What a run's figures may be at most for the run to count as good.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Acceptance {
    /// Distance of the commanded tool centre point from the programmed line or arc, in metres.
    pub path_deviation: f64,
    /// Angle between the commanded orientation and the programmed one, in radians.
    pub orientation_deviation: f64,
    /// Distance from a passed corner, as a fraction of the permitted one.
    pub corner_error: f64,
    /// Relative error of the speed in the constant part of a weld.
    pub weld_speed_error: f64,
    /// Joint velocity and acceleration, as fractions of their limits.
    pub joint: f64,
    /// Joint jerk as a fraction of its limit. Third differences of samples overshoot a jerk that switches within a
    /// cycle, so that it is a little above 1.
    pub joint_jerk: f64,
}

impl Default for Acceptance {
    fn default() -> Self {
        Self {
            path_deviation: 1e-6,
            orientation_deviation: 1e-6,
            corner_error: 1.0,
            weld_speed_error: 0.01,
            joint: 1.0,
            joint_jerk: 1.01,
        }
    }
}

/// Which job ran on which robot.
#[derive(Debug, Clone, PartialEq)]
pub struct RunInfo {
    /// Name of the job.
    pub job: String,
    /// Name of the robot.
    pub robot: String,
    /// The robot's joints from the base on, at most [`MAX_JOINTS`](super::MAX_JOINTS).
    pub joints: Vec<JointInfo>,
    /// Cycle time in seconds.
    pub period: f64,
    /// The bounds that the figures are held against.
    pub acceptance: Acceptance,
}

/// What a segment programs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SegmentKind {
    /// A move in joint space: MOVJ.
    Joint,
    /// A line or an arc of the tool centre point in the robot frame: MOVL, MOVC.
    Path(Path),
    /// From one move into the next, past the point that both are taught to meet in.
    Corner {
        /// The way round, where it is a path of the tool centre point: between joint moves it is none.
        path: Option<Path>,
        /// The point, in the robot frame.
        corner: Vector3,
        /// Permitted distance from it, in metres.
        permitted: f64,
    },
    /// Standing still for a time.
    Dwell,
}

impl SegmentKind {
    /// The job language's word.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Joint => "MOVJ",
            Self::Path(path) => match path.curve() {
                Curve::Line { .. } => "MOVL",
                Curve::Arc(_) => "MOVC",
                Curve::Quintic(_) => "MOVS",
            },
            Self::Corner { .. } => "corner",
            Self::Dwell => "dwell",
        }
    }

    /// The path of the tool centre point that is run.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Path(path) => Some(path),
            Self::Corner { path, .. } => path.as_ref(),
            Self::Joint | Self::Dwell => None,
        }
    }
}

/// What tracking a seam does to a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OnSeam {
    /// Nothing.
    No,
    /// It follows the seam, beside the taught path.
    Tracked,
    /// It begins beside the taught path, where a seam was tracked before it.
    Leaves,
}

/// One planned segment of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SegmentInfo {
    /// Running number, from 1 on, rising: the number that samples carry.
    pub segment: u32,
    /// Line of the job file, counted from 1.
    pub line: u32,
    /// What it programs.
    pub kind: SegmentKind,
    /// Programmed speed of the tool centre point in m/s (rad/s for a turn on the spot), where there is one.
    pub speed: Option<f64>,
    /// The arc is lit.
    pub arc: bool,
    /// From where to where on the path (m from its start) the plan holds the programmed speed: the end of acceleration
    /// and the start of deceleration. None where the speed is never reached.
    pub constant_part: Option<[f64; 2]>,
    /// What tracking a seam does to it.
    pub seam: OnSeam,
    /// Over how much of the path, from its start and from its end (m), prefilters round the corners there: what is off the path in
    /// these parts belongs to the corners.
    pub rounded: [f64; 2],
}

impl SegmentInfo {
    /// Length of the path of the tool centre point, in metres; 0 where it only turns, moves in joint space or rests.
    #[must_use]
    pub fn length(&self) -> f64 {
        let path = self.kind.path().filter(|path| path.measure() == Measure::Length);
        path.map_or(0.0, Path::length)
    }
}

/// Something that happened at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Time since the start of the run, in seconds.
    pub time: f64,
    /// Line of the job file, counted from 1; 0 for none.
    pub line: u32,
    /// What kind of thing.
    pub kind: EventKind,
    /// What exactly, for people.
    pub text: String,
}

/// Kinds of events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The arc was lit. Found in the samples; need not be reported.
    ArcOn,
    /// The arc was put out. Found in the samples; need not be reported.
    ArcOff,
    /// The robot stands for a programmed time. Found in the samples; need not be reported.
    Dwell,
    /// An output was set or a message shown.
    Output,
    /// Something the user should know: an instruction accepted but not executed, a zone that stops exactly.
    Notice,
    /// A fault stopped the run.
    Fault,
}

impl EventKind {
    /// A word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ArcOn => "arc on",
            Self::ArcOff => "arc off",
            Self::Dwell => "dwell",
            Self::Output => "output",
            Self::Notice => "notice",
            Self::Fault => "fault",
        }
    }
}
