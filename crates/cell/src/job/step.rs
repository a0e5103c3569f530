//! What an interpreter hands out: steps for the planner and the cell.

use std::fmt;
use std::sync::Arc;

use seamline::geometry::Vector3;

use super::condition::Condition;
use super::expression::SignalKind;
use super::instruction::SpeedKind;
use super::position::{Frame, JobPosition, PositionName};

/// Where in a program something happens.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// The job's name.
    pub job: Arc<str>,
    /// Line in its file, from 1.
    pub line: u32,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} line {}", self.job, self.line)
    }
}

/// One thing to do, in the order of the program.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The instruction that asks for it.
    pub at: Location,
    /// What is to be done.
    pub action: Action,
    /// What the operator should know about how the line was read.
    pub notes: Vec<Note>,
}

/// What a step does.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Move the robot.
    Move(Box<Move>),
    /// Light the arc.
    ArcOn(ArcCondition),
    /// End the arc.
    ArcOff(ArcCondition),
    /// Change the arc.
    ArcSet(ArcCondition),
    /// Weave from here on.
    WeaveOn(WeaveCondition),
    /// Weave no longer.
    WeaveOff,
    /// Track the seam from here on.
    TrackOn,
    /// Track it no longer.
    TrackOff,
    /// What is tracked is kept, or welded from what was.
    MemoryOn {
        /// It is kept; otherwise played.
        record: bool,
        /// Number of the file, MPF.
        file: u32,
    },
    /// That no longer.
    MemoryOff,
    /// Stand still.
    Dwell {
        /// How long.
        seconds: f64,
    },
    /// Wait until the condition holds, or the time is over.
    Wait {
        /// With all variables replaced by their values.
        condition: Condition,
        /// `None`: without end.
        timeout_seconds: Option<f64>,
    },
    /// Set an output.
    Output(Output),
    /// A message for the operator.
    Message {
        /// The text; bytes that are no UTF-8 are escaped.
        text: String,
    },
    /// An alarm that the job raises.
    Alarm {
        /// 8000 to 8999.
        code: u32,
        /// The text.
        text: String,
        /// 0 to 255.
        subcode: u32,
        /// Whether the job ends here.
        stops: bool,
    },
    /// Hold until the operator starts again.
    Pause,
    /// An instruction that is accepted and reported, and does nothing here.
    Accepted {
        /// The instruction as written.
        text: String,
        /// Why nothing is done.
        note: &'static str,
    },
    /// An instruction that is refused: a run ends here with this reason.
    Unsupported {
        /// The instruction as written.
        text: String,
        /// Why, and the nearest known instruction where the word is not known.
        reason: String,
    },
    /// The program's end.
    End,
}

/// A move with every value found.
#[derive(Debug, Clone, PartialEq)]
pub struct Move {
    /// How it goes.
    pub path: MovePath,
    /// Where it ends. For [`MovePath::Incremental`] the increment.
    pub target: Target,
    /// How fast.
    pub speed: Speed,
    /// Which rule supplied the speed.
    pub speed_origin: SpeedOrigin,
    /// How the end point is passed.
    pub zone: Zone,
    /// `ACC=`: share of the acceleration limits, 0.2 to 1.
    pub acceleration: f64,
    /// `DEC=`: share of the deceleration limits, 0.2 to 1.
    pub deceleration: f64,
    /// `NWAIT`: the following steps up to the next move need not wait for this one.
    pub no_wait: bool,
}

/// The geometry of a move.
#[derive(Debug, Clone, PartialEq)]
pub enum MovePath {
    /// MOVJ: all joints together.
    Joint,
    /// MOVL, and the first point of MOVC and of MOVS: a line.
    Linear,
    /// MOVC: along a circle.
    Circular(Box<CircularArc>),
    /// MOVS: a piece of the spline through the points of its run.
    Spline(SplinePiece),
    /// A smooth curve from point to point, with the tool upright all along: part of a helix, or of a contour of G-code.
    Curve(Box<CurvePiece>),
    /// IMOV: a line by an increment in a frame.
    Incremental {
        /// The increment's frame; `None` where the increment counts pulses, axis by axis.
        frame: Option<Frame>,
    },
}

/// A piece of the circle through three points. Where they are collinear, the piece is straight.
#[derive(Debug, Clone, PartialEq)]
pub struct CircularArc {
    /// The three points, in the order in which they are passed.
    pub points: [Target; 3],
    /// Which piece of it.
    pub part: ArcPart,
}

/// Which piece of a circle through three points is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArcPart {
    /// From the first point through the second to the third.
    Whole,
    /// From the first point to the second.
    First,
    /// From the second point to the third: a further point of a chain.
    Second,
}

/// A piece of the spline through the points of a run of MOVS.
#[derive(Debug, Clone, PartialEq)]
pub struct SplinePiece {
    /// All points of the run, in the order in which they are passed; at least three.
    pub points: Arc<[Target]>,
    /// Index of the point that the piece ends in, 1 or more; it begins in the point before.
    pub end: usize,
}

/// The polynomial of degree five that has the position, tangent and curvature of two passages. It starts where the move before ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePiece {
    /// At its start.
    pub start: Passage,
    /// At its end.
    pub end: Passage,
}

/// How a curve passes a point, by arc length; in the frame of the move's target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// The point, in mm.
    pub position_mm: Vector3,
    /// Unit vector.
    pub tangent: Vector3,
    /// Towards the centre of curvature, in 1/mm.
    pub curvature_per_mm: Vector3,
}

/// A point that a move goes to.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Its name in the job; none where the line itself has the coordinates.
    pub name: Option<PositionName>,
    /// Its coordinates.
    pub position: JobPosition,
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.name {
            Some(name) => write!(f, "{name}"),
            None => write!(f, "the target"),
        }
    }
}

/// The speed of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Speed {
    /// Percent of the joints' speed limits.
    JointPercent(f64),
    /// Tool centre point, mm/s.
    Linear {
        /// mm/s.
        mm_s: f64,
    },
    /// Rotation, deg/s.
    Rotation {
        /// deg/s.
        deg_s: f64,
    },
    /// Percent of the external axes' speed limits.
    ExternalPercent(f64),
}

impl Speed {
    /// Metres per second, where the speed is one of the tool centre point.
    #[must_use]
    pub fn metres_per_second(self) -> Option<f64> {
        if let Self::Linear { mm_s } = self { Some(mm_s / 1000.0) } else { None }
    }

    /// Radians per second, where the speed is one of rotation.
    #[must_use]
    pub fn radians_per_second(self) -> Option<f64> {
        if let Self::Rotation { deg_s } = self { Some(deg_s.to_radians()) } else { None }
    }
}

/// Which rule supplied a speed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SpeedOrigin {
    /// It stands in the line.
    Written,
    /// The last SPEED instruction.
    SpeedInstruction(Location),
    /// The arc's condition, between ARCON and ARCOF.
    ArcCondition,
    /// The last move of the same sort that had one.
    LastMove(Location),
    /// The cell's default: nothing in the job gives one.
    Cell,
}

/// How the end point of a move is passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Zone {
    /// `PL=0`: the robot stops on the point.
    Exact,
    /// `PL=1` to `PL=8`.
    Level(u8),
    /// `CR=`: corner radius in mm.
    CornerRadius {
        /// mm.
        mm: f64,
    },
    /// Nothing is written: the path runs on without a stop.
    Unspecified,
    /// `G64 P`: how far from the programmed path the tool may be; with 0 it stops where the path bends.
    Tolerance {
        /// mm.
        mm: f64,
    },
}

/// An arc condition: from the cell, or written, with every value found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ArcCondition {
    /// Number of the cell's condition: ASF for ARCON and ARCSET, AEF for ARCOF.
    pub file: Option<u32>,
    /// A.
    pub current: Option<f64>,
    /// V.
    pub voltage: Option<f64>,
    /// Percent of the proper voltage.
    pub voltage_percent: Option<f64>,
    /// Seconds that the robot stands before it goes on.
    pub seconds: Option<f64>,
    /// mm/s.
    pub speed_mm_s: Option<f64>,
    /// Number of the power source, from `WELDn`.
    pub power_source: Option<u32>,
}

/// A weave condition: from the cell, or written, with every value found. What is written goes before the cell's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WeaveCondition {
    /// Number of the cell's condition, WEV.
    pub file: Option<u32>,
    /// From the seam to either side, mm.
    pub amplitude_mm: Option<f64>,
    /// Hz.
    pub frequency_hz: Option<f64>,
    /// Tilt of the weaving plane about the travel, deg.
    pub angle_deg: Option<f64>,
    /// The first swing goes to the right.
    pub right_first: Option<bool>,
}

/// An output that the job sets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Output {
    /// DOUT.
    Digital {
        /// OT, OG, OGH, OGU.
        kind: SignalKind,
        /// Its number.
        number: u32,
        /// 0 or 1, or a group's bits.
        value: u32,
    },
    /// PULSE: as DOUT, and back to 0 after the time.
    Pulse {
        /// OT, OG, OGH, OGU.
        kind: SignalKind,
        /// Its number.
        number: u32,
        /// 0 or 1, or a group's bits.
        value: u32,
        /// The pulse's length.
        seconds: f64,
    },
    /// AOUT.
    Analog {
        /// The port.
        number: u32,
        /// V.
        volts: f64,
    },
}

/// A remark on how a line was read.
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// `V=` is an integer: written by a script, whose unit may be another.
    IntegerSpeed {
        /// As written.
        value: f64,
        /// The unit it was read in.
        unit: LinearSpeedUnit,
    },
    /// The line has no speed.
    SpeedSupplied(SpeedKind, SpeedOrigin),
    /// `NWAIT` or another tag that is accepted without effect.
    TagWithoutEffect(&'static str),
    /// A MOVC with fewer than three points in its run: the line goes straight.
    ArcTooShort,
    /// A MOVS with fewer than three points in its run: the line goes straight.
    SplineTooShort,
    /// The two halves of an arc have different speeds; the whole arc takes the end point's.
    ArcSpeedsDiffer,
    /// Rows of short lines of a G-code program that run as smooth curves.
    Contours {
        /// How many lines.
        lines: u64,
        /// How many curves.
        curves: u64,
        /// Greatest distance between them.
        deviation_mm: f64,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::IntegerSpeed { value, unit } => {
                write!(f, "V={value} is an integer, read as {unit}; the cell file sets the unit of V")
            }
            Self::SpeedSupplied(kind, origin) => {
                write!(f, "{} is missing, taken from {origin}", kind.tag().trim_end_matches('='))
            }
            Self::TagWithoutEffect(tag) => write!(f, "{tag} has no effect"),
            Self::ArcTooShort => write!(f, "fewer than three MOVC points in a row: the robot goes straight"),
            Self::SplineTooShort => {
                write!(f, "fewer than three MOVS points in a row: the robot goes straight")
            }
            Self::ArcSpeedsDiffer => write!(f, "the arc runs at the speed of its end point"),
            Self::Contours { lines, curves, deviation_mm } => {
                write!(
                    f,
                    "{lines} lines run as {curves} smooth curves, at most {deviation_mm:.4} mm off them"
                )
            }
        }
    }
}

impl fmt::Display for SpeedOrigin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Written => write!(f, "the line itself"),
            Self::SpeedInstruction(at) => write!(f, "SPEED in {at}"),
            Self::ArcCondition => write!(f, "the arc's condition"),
            Self::LastMove(at) => write!(f, "the move in {at}"),
            Self::Cell => write!(f, "the cell's default"),
        }
    }
}

impl fmt::Display for Zone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact => write!(f, "PL=0"),
            Self::Level(level) => write!(f, "PL={level}"),
            Self::CornerRadius { mm } => write!(f, "CR={mm}"),
            Self::Unspecified => write!(f, "no PL"),
            Self::Tolerance { mm } => write!(f, "within {mm} mm"),
        }
    }
}

/// The unit of `V=` numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LinearSpeedUnit {
    /// What controllers write.
    #[default]
    MillimetrePerSecond,
    /// What some scripts write.
    CentimetrePerMinute,
    /// Millimetres per minute.
    MillimetrePerMinute,
}

impl LinearSpeedUnit {
    /// The value of one unit in mm/s.
    #[must_use]
    pub fn mm_s(self) -> f64 {
        match self {
            Self::MillimetrePerSecond => 1.0,
            Self::CentimetrePerMinute => 10.0 / 60.0,
            Self::MillimetrePerMinute => 1.0 / 60.0,
        }
    }
}

impl fmt::Display for LinearSpeedUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::MillimetrePerSecond => "mm/s",
            Self::CentimetrePerMinute => "cm/min",
            Self::MillimetrePerMinute => "mm/min",
        })
    }
}
