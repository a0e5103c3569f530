//! Instructions in typed form.

mod data;
mod process;

pub use data::{Arithmetic, Bitwise, Data, Function};
pub use process::{ArcTags, Io, OutputValue, WeaveTags, Weld};

use super::expression::{Expression, Index, Variable};
use super::position::PositionKind;

/// One instruction of a program.
#[derive(Debug, Clone, PartialEq)]
pub enum Instruction {
    /// Nothing: `NOP`, an empty line, a comment.
    Nop,
    /// `*NAME`: a target of JUMP.
    Label(String),
    /// `COMM TIMER T=1.00`: an instruction that was switched off.
    Disabled,
    /// MOVJ, MOVL, MOVC, MOVS, IMOV, SMOVL, SMOVC.
    Move(Box<MoveInstruction>),
    /// `SPEED VJ= V=`: speeds of the moves that have none.
    Speed(Vec<SpeedTag>),
    /// Program flow.
    Flow(Flow),
    /// Variables and computing.
    Data(Data),
    /// Inputs, outputs, time, messages.
    Io(Io),
    /// Arc and weave.
    Weld(Weld),
    /// Any other instruction, known by name or not; its line is kept.
    Other {
        /// The first word.
        word: String,
    },
}

/// How a move goes to its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// MOVJ.
    Joint,
    /// MOVL.
    Linear,
    /// MOVC.
    Circular,
    /// MOVS.
    Spline,
    /// IMOV: by an increment, along a line.
    Incremental,
}

/// A coordinate system that an instruction names.
#[derive(Debug, Clone, PartialEq)]
pub enum FrameTag {
    /// `BF`.
    Base,
    /// `RF`.
    Robot,
    /// `TF`.
    Tool,
    /// `UF#(n)`.
    User(Index),
    /// `MTF`: the tool of the other robot.
    MasterTool,
}

/// A position that a move or an operation refers to.
#[derive(Debug, Clone, PartialEq)]
pub enum PositionReference {
    /// A step of the job: `C00001`.
    Step {
        /// Column in the line, from 1.
        column: u32,
        /// C, BC or EC.
        kind: PositionKind,
        /// Its number.
        number: u32,
    },
    /// A position variable: `P100`, `LP007`, `P[LI002]`.
    Variable(Variable),
}

/// What a speed counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeedKind {
    /// `VJ=`: percent of the joints' speed limits.
    Joint,
    /// `V=`: speed of the tool centre point, in the cell's unit (mm/s unless it says otherwise).
    Linear,
    /// `VR=`: speed of rotation in deg/s.
    Rotation,
    /// `VE=`: percent of the external axes' speed limits.
    External,
}

impl SpeedKind {
    /// The tag in the file.
    #[must_use]
    pub fn tag(self) -> &'static str {
        match self {
            Self::Joint => "VJ=",
            Self::Linear => "V=",
            Self::Rotation => "VR=",
            Self::External => "VE=",
        }
    }

    /// Name, least and greatest value in the file's unit.
    #[must_use]
    pub fn range(self) -> (&'static str, f64, f64) {
        match self {
            Self::Joint => ("VJ (%)", 0.01, 100.0),
            Self::Linear => ("V", 0.01, 10_000.0),
            Self::Rotation => ("VR (deg/s)", 0.01, 1000.0),
            Self::External => ("VE (%)", 0.01, 100.0),
        }
    }
}

/// A speed as written.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedTag {
    /// What it counts.
    pub kind: SpeedKind,
    /// A number, or an integer variable that counts 0.01 %, 0.1 mm/s or 0.1 deg/s.
    pub value: Expression,
}

/// A move with all its tags.
#[derive(Debug, Clone, PartialEq)]
pub struct MoveInstruction {
    /// How it goes.
    pub interpolation: Interpolation,
    /// SMOVL, SMOVC: relative to a workpiece that a station turns.
    pub coordinated: bool,
    /// The robot's target; `None` where only a station moves.
    pub target: Option<PositionReference>,
    /// Base axis and station targets in the same move.
    pub external: Vec<PositionReference>,
    /// IMOV's coordinate system.
    pub frame: Option<FrameTag>,
    /// The speed, if the line has one.
    pub speed: Option<SpeedTag>,
    /// `PL=`.
    pub position_level: Option<Expression>,
    /// `CR=`, mm.
    pub corner_radius: Option<Expression>,
    /// `ACC=`, percent.
    pub acceleration: Option<Expression>,
    /// `DEC=`, percent.
    pub deceleration: Option<Expression>,
    /// `NWAIT`: the next instructions run while this move does.
    pub no_wait: bool,
    /// `CONT` of the ERC: pass without stop.
    pub continuous: bool,
    /// `FPT`: the point ends one arc and begins another.
    pub fixed_point: bool,
    /// `UNTIL`: the move ends when the condition holds.
    pub until: Option<Expression>,
    /// Tags that are kept and not executed, as written: `SRCH RIN#(3)=ON DIS=20.0`.
    pub other_tags: Vec<String>,
    /// Moves of further groups on the same line: `+MOVJ EC00000`.
    pub others: Vec<MoveInstruction>,
}

impl MoveInstruction {
    /// The instruction's word.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match (self.interpolation, self.coordinated) {
            (Interpolation::Joint, _) => "MOVJ",
            (Interpolation::Linear, false) => "MOVL",
            (Interpolation::Linear, true) => "SMOVL",
            (Interpolation::Circular, false) => "MOVC",
            (Interpolation::Circular, true) => "SMOVC",
            (Interpolation::Spline, _) => "MOVS",
            (Interpolation::Incremental, _) => "IMOV",
        }
    }
}

/// A job that JUMP or CALL names.
#[derive(Debug, Clone, PartialEq)]
pub struct JobReference {
    /// Column in the line, from 1.
    pub column: u32,
    /// The name.
    pub name: String,
}

/// Where JUMP goes.
#[derive(Debug, Clone, PartialEq)]
pub enum JumpTarget {
    /// A label of this job.
    Label {
        /// Column in the line, from 1.
        column: u32,
        /// The name, without `*`.
        name: String,
    },
    /// The start of another job.
    Job(JobReference),
}

/// Program flow.
#[derive(Debug, Clone, PartialEq)]
pub enum Flow {
    /// `JUMP *L IF …`.
    Jump {
        /// Where to.
        target: JumpTarget,
        /// `IF`.
        condition: Option<Expression>,
    },
    /// `CALL JOB:X ARGF1 IF …`.
    Call {
        /// Which job.
        target: JobReference,
        /// `ARGF…` or `(…, …)`.
        arguments: Vec<Expression>,
        /// `IF`.
        condition: Option<Expression>,
    },
    /// `RET`, with a value or a condition.
    Return {
        /// The value for `$RV`.
        value: Option<Expression>,
        /// `IF`.
        condition: Option<Expression>,
    },
    /// `PAUSE`: hold until the operator starts again.
    Pause {
        /// `IF`.
        condition: Option<Expression>,
    },
    /// `ABORT`: end the whole run.
    Abort {
        /// `IF`.
        condition: Option<Expression>,
    },
    /// `END`.
    End,
    /// `IFTHEN` and `IFTHENEXP`.
    If(Expression),
    /// `ANDIF`, `ANDIFEXP`, `ANDEXP` on a line of its own: joins the IF, ELSEIF or WHILE above.
    AndIf(Expression),
    /// `ORIF`, `ORIFEXP`, `OREXP` on a line of its own.
    OrIf(Expression),
    /// `ELSEIF` and `ELSEIFEXP`.
    ElseIf(Expression),
    /// `ELSE`.
    Else,
    /// `ENDIF`.
    EndIf,
    /// `WHILE` and `WHILEEXP`.
    While(Expression),
    /// `ENDWHILE`.
    EndWhile,
    /// `FOR I000=1 TO 10 STEP=2`.
    For {
        /// The counter.
        variable: Variable,
        /// First value.
        start: Expression,
        /// Last value.
        end: Expression,
        /// Step; 1 where it is missing.
        step: Option<Expression>,
    },
    /// `NEXT I000`.
    Next(Variable),
    /// `SWITCH I000`.
    Switch(Expression),
    /// `CASE 1` or `CASE 1,2`.
    Case(Vec<Expression>),
    /// `DEFAULT`.
    Default,
    /// `ENDSWITCH`.
    EndSwitch,
}
