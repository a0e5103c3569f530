//! What planning refuses, and where.

use std::fmt;

use thiserror::Error;

use crate::job::{Frame, Location};

/// A step that cannot be planned.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{at}: {problem}")]
pub struct PlanError {
    /// The instruction.
    pub at: Location,
    /// What is wrong with it.
    pub problem: Problem,
}

/// What is wrong with a step.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Problem {
    /// A run does not execute this instruction.
    #[error("`{text}` is refused: {reason}")]
    Refused {
        /// The instruction as written.
        text: String,
        /// Why.
        reason: String,
    },
    /// The cell has no such tool.
    #[error("tool {number} is not in the cell file; expected a [[tool]] table with this number")]
    UnknownTool {
        /// Its number.
        number: u32,
    },
    /// The cell has no such frame.
    #[error("user frame {number} is not in the cell file; expected a [[user_frame]] table with this number")]
    UnknownFrame {
        /// Its number.
        number: u32,
    },
    /// A frame that positions cannot be taken in.
    #[error("{name} is given in a frame that is not supported ({frame:?}); expected base, robot or user")]
    UnsupportedFrame {
        /// The position.
        name: String,
        /// Its frame.
        frame: Frame,
    },
    /// The cell has no such arc condition.
    #[error("{kind}#({number}) is not in the cell file; expected {table} with this number")]
    UnknownCondition {
        /// `ASF` or `AEF`.
        kind: &'static str,
        /// Its number.
        number: u32,
        /// The table's name.
        table: &'static str,
    },
    /// A position has too few values.
    #[error("{name} has {found} values, expected {expected} for this robot")]
    PositionLength {
        /// The position.
        name: String,
        /// Values found.
        found: usize,
        /// Joints of the robot.
        expected: usize,
    },
    /// A position is of a kind that the robot's moves do not take.
    #[error("{name} is a station position, expected a robot position")]
    StationPosition {
        /// The position.
        name: String,
    },
    /// A position whose joints are out of range.
    #[error("{name}: joint {joint} at {value:.2} {unit} is outside {min:.1} … {max:.1} {unit}")]
    JointRange {
        /// The position.
        name: String,
        /// The joint's name.
        joint: String,
        /// Its position.
        value: f64,
        /// Soft limit below.
        min: f64,
        /// Soft limit above.
        max: f64,
        /// The unit of all three: degrees or millimetres.
        unit: &'static str,
    },
    /// A position that the arm does not reach.
    #[error("{name} cannot be reached: {reason}")]
    Unreachable {
        /// The position.
        name: String,
        /// Why.
        reason: String,
    },
    /// The tool centre point would leave the cell's workspace.
    #[error(
        "the tool centre point would leave the workspace at ({:.1}, {:.1}, {:.1}) mm; safety.workspace_min_mm and \
         workspace_max_mm permit ({:.0}, {:.0}, {:.0}) to ({:.0}, {:.0}, {:.0}) mm",
        .position_mm[0], .position_mm[1], .position_mm[2],
        .min_mm[0], .min_mm[1], .min_mm[2], .max_mm[0], .max_mm[1], .max_mm[2]
    )]
    Workspace {
        /// Where.
        position_mm: [f64; 3],
        /// The workspace's lowest corner.
        min_mm: [f64; 3],
        /// Its highest corner.
        max_mm: [f64; 3],
    },
    /// A path that the arm cannot follow.
    #[error("{place} the robot cannot go on: {reason}")]
    Path {
        /// Where along the move.
        place: Place,
        /// Why, with a remedy where there is one.
        reason: String,
    },
    /// The move's speed is of a kind that does not fit.
    #[error("{found} does not fit this move, expected {expected}")]
    Speed {
        /// The speed's tag.
        found: &'static str,
        /// What fits.
        expected: &'static str,
    },
    /// The weld would be slower than programmed, and the cell refuses that.
    #[error("{0}; the cell refuses a slowdown while the arc is on (arc.refuse_slowdown)")]
    WeldSlowdown(String),
    /// A weave that cannot be, or does not agree with the cell's limits.
    #[error("{0}")]
    Weave(String),
    /// Too many short moves for a prefilter on the feedrate.
    #[error(
        "more than {most} moves within the {seconds:.2} s that the prefilter on the feedrate takes: expected longer or slower moves, or \
         `on = \"joints\"` in [vibration]"
    )]
    ShortMoves {
        /// How many there may be.
        most: usize,
        /// The prefilter's length.
        seconds: f64,
    },
    /// A seam that cannot be tracked.
    #[error("{0}")]
    Track(String),
    /// The generator gives no motion.
    #[error("no motion to {name}: {reason}")]
    Generator {
        /// The position.
        name: String,
        /// Why.
        reason: String,
    },
}

/// A place along a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Path coordinate, and the path's whole length: mm, or degrees for a turn on the spot.
    pub at: f64,
    /// The whole.
    pub of: f64,
    /// The unit.
    pub unit: &'static str,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at {:.1} of {:.1} {}", self.at, self.of, self.unit)
    }
}
