//! Jobs: INFORM files (`.JBI`), read without loss, checked, and walked step by step.
//!
//! ```text
//! bytes ─▶ lexer ─▶ parser ─▶ JobFile ─▶ JobSet (references resolved) ─▶ Interpreter ─▶ Step
//!                                                                          ▲
//!                                                              World (inputs, position, arc speed)
//! ```
//!
//! | module | holds |
//! |---|---|
//! | [`JobFile`], [`Job`], [`Statement`], [`Instruction`] | a file as it stands: nothing is lost |
//! | [`JobSet`] | the entry job and all that it calls |
//! | [`disposition()`] | what a run does with each instruction: executed, accepted, refused |
//! | [`Interpreter`] | the program, one [`Step`] at a time; it has no clock and no thread |
//!
//! Units here are those of the file (mm, degrees, pulses, mm/s, percent), and every name says so. The conversions
//! to SI are [`Rectangular::pose`], [`joints_from_pulses`] and [`Speed::metres_per_second`].

mod blocks;
mod check;
mod condition;
mod disposition;
mod error;
mod expression;
mod instruction;
mod interpreter;
mod lexer;
mod names;
mod parser;
mod position;
mod program;
mod set;
mod step;
mod walk;
mod world;

pub use condition::{Condition, Side};
pub use disposition::{Disposition, disposition};
pub use error::{JobError, JobErrors, LoadError, Mistake, Nearest};
pub use expression::{
    Expression, Index, Node, Operator, SignalKind, SignalReference, Variable, VariableKind,
};
pub use instruction::{
    ArcTags, Arithmetic, Bitwise, Data, Flow, FrameTag, Function, Instruction, Interpolation, Io,
    JobReference, JumpTarget, MoveInstruction, OutputValue, PositionReference, SpeedKind, SpeedTag,
    WeaveTags, Weld,
};
pub(crate) use lexer::{Fault, column, printable};

pub use interpreter::{Interpreter, MAX_CALLS, MAX_IDLE};
pub use position::{
    Configuration, Coordinates, Frame, JobPosition, PositionKind, PositionName, Rectangular,
    joints_from_pulses, pulses_from_joints,
};
pub use program::{Header, Job, JobFile, Statement};
pub use set::JobSet;
pub use step::{
    Action, ArcCondition, ArcPart, CircularArc, CurvePiece, LinearSpeedUnit, Location, Move, MovePath, Note,
    Output, Passage, Speed, SpeedOrigin, SplinePiece, Step, Target, WeaveCondition, Zone,
};
pub use world::World;

/// How deep expressions and blocks may nest.
pub const MAX_DEPTH: usize = 32;
