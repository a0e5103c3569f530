//! Instructions in typed form.

use super::expression::{Expression, Index, SignalReference, Variable};
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

/// Functions of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// Square root.
    Sqrt,
    /// Sine of degrees.
    Sin,
    /// Cosine of degrees.
    Cos,
    /// Arc tangent in degrees.
    Atan,
}

/// Operations that change a variable in place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arithmetic {
    /// ADD.
    Add,
    /// SUB.
    Subtract,
    /// MUL.
    Multiply,
    /// DIV.
    Divide,
}

/// Bitwise operations on bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bitwise {
    /// AND.
    And,
    /// OR.
    Or,
    /// XOR.
    Xor,
    /// NOT of the second operand.
    Not,
}

/// Variables and computing.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// `SET B000 5`, `SET P000 P001`, `SET LI000 EXPRESS LI000 / 0.6`.
    Set {
        /// What is set.
        variable: Variable,
        /// To what.
        value: Expression,
    },
    /// `SET OT#(1) LOGICEXP(…)`, `SET FL010 …`: destinations that are no variables.
    SetSignal {
        /// The output.
        signal: SignalReference,
        /// The condition or state.
        value: Expression,
    },
    /// ADD, SUB, MUL, DIV.
    Arithmetic {
        /// Which.
        operation: Arithmetic,
        /// First operand and result.
        variable: Variable,
        /// One element of a position variable, from 1.
        element: Option<Expression>,
        /// Second operand.
        value: Expression,
    },
    /// INC (+1) and DEC (−1).
    Step {
        /// The variable.
        variable: Variable,
        /// +1 or −1.
        by: i8,
    },
    /// `CLEAR B000 10`, `CLEAR D010 ALL`.
    Clear {
        /// The first variable.
        variable: Variable,
        /// How many; `None` is ALL.
        count: Option<Expression>,
    },
    /// `CLEAR STACK`: the calls are forgotten.
    ClearStack,
    /// SQRT, SIN, COS, ATAN.
    Function {
        /// Which.
        function: Function,
        /// The result.
        variable: Variable,
        /// The argument.
        value: Expression,
    },
    /// AND, OR, XOR, NOT of bytes.
    Bitwise {
        /// Which.
        operation: Bitwise,
        /// First operand and result.
        variable: Variable,
        /// Second operand.
        value: Expression,
    },
    /// `SETE P009 (4) 0`: element 1 to 6 in µm and 0.0001°, or in pulses.
    SetElement {
        /// The position variable.
        variable: Variable,
        /// The element, from 1.
        element: Expression,
        /// The value.
        value: Expression,
    },
    /// `SETE P009 TL#(1)`: the tool number of a position.
    SetTool {
        /// The position variable.
        variable: Variable,
        /// The tool.
        tool: Expression,
    },
    /// `GETE D000 P000 (3)`.
    GetElement {
        /// The result.
        variable: Variable,
        /// The position variable.
        source: Variable,
        /// The element, from 1.
        element: Expression,
    },
    /// `GETS LPX000 $PX000`.
    GetSystem {
        /// The result.
        variable: Variable,
        /// The system variable's name, such as `$PX000`.
        source: String,
    },
    /// `CNVRT PX000 PX001 BF`.
    Convert {
        /// The result.
        variable: Variable,
        /// The position to be converted.
        source: Variable,
        /// The frame of the result.
        frame: FrameTag,
        /// `TL#(n)`.
        tool: Option<Expression>,
    },
    /// `GETARG LB000 IARG#(1)`.
    GetArgument {
        /// The result.
        variable: Variable,
        /// Which argument, from 1.
        number: Expression,
    },
}

/// What DOUT sets an output to.
#[derive(Debug, Clone, PartialEq)]
pub enum OutputValue {
    /// ON, OFF, a number or a variable.
    Value(Expression),
    /// INVERT.
    Invert,
}

/// Inputs, outputs, time, messages.
#[derive(Debug, Clone, PartialEq)]
pub enum Io {
    /// `TIMER T=0.50`.
    Timer {
        /// Seconds, or an integer variable that counts 0.01 s.
        time: Expression,
    },
    /// `WAIT IN#(141)=ON T=3.00`.
    Wait {
        /// What is waited for.
        condition: Expression,
        /// After this time the program goes on in any case.
        timeout: Option<Expression>,
    },
    /// `DOUT OT#(1) ON`.
    DigitalOutput {
        /// The output.
        signal: SignalReference,
        /// Its value.
        value: OutputValue,
    },
    /// `PULSE OT#(11) T=2.00`.
    Pulse {
        /// The output.
        signal: SignalReference,
        /// Bit pattern of a group.
        value: Option<Expression>,
        /// The pulse's length; 0.3 s where it is missing.
        time: Option<Expression>,
    },
    /// `DIN B010 IGH#(5)`.
    DigitalInput {
        /// The result.
        variable: Variable,
        /// The signal.
        signal: SignalReference,
    },
    /// `AOUT AO#(1) I003`.
    AnalogOutput {
        /// The port.
        port: Expression,
        /// Volts, or an integer variable that counts 0.01 V.
        value: Expression,
    },
    /// `MSG "…"`.
    Message {
        /// The text, or a string variable.
        text: Expression,
    },
    /// `SETUALM 8001 "…" 0`.
    Alarm {
        /// The code, 8000 to 8999.
        code: Expression,
        /// The text.
        text: Option<Expression>,
        /// The subcode, 0 to 255.
        subcode: Option<Expression>,
        /// `SMODE=`: 0 all stop, 1 none stops, 2 this task stops.
        stop_mode: Option<Expression>,
    },
}

/// A condition of the arc or the weave: from the cell's files, or written in the line.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ArcTags {
    /// `ASF#(n)` or `AEF#(n)`.
    pub file: Option<Expression>,
    /// `AC=`: current, A.
    pub current: Option<Expression>,
    /// `AV=`: voltage, V.
    pub voltage: Option<Expression>,
    /// `AVP=`: voltage, percent of the proper one.
    pub voltage_percent: Option<Expression>,
    /// `T=`: seconds before the robot moves on.
    pub time: Option<Expression>,
    /// `V=`: speed of the weld.
    pub speed: Option<Expression>,
    /// `WELDn`: power source.
    pub power_source: Option<u32>,
    /// Tags that are kept and not executed: `RETRY`, `ACOND=0`.
    pub other_tags: Vec<String>,
}

/// Weave parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WeaveTags {
    /// `WEV#(n)`.
    pub file: Option<Expression>,
    /// `AMP=`: amplitude to one side, mm.
    pub amplitude: Option<Expression>,
    /// `FREQ=`: Hz.
    pub frequency: Option<Expression>,
    /// `ANGL=`: deg.
    pub angle: Option<Expression>,
    /// `DIR=`: 0 or 1.
    pub direction: Option<Expression>,
    /// Tags that are kept and not executed: `RB1`.
    pub other_tags: Vec<String>,
}

/// Arc and weave.
#[derive(Debug, Clone, PartialEq)]
pub enum Weld {
    /// ARCON.
    ArcOn(Box<ArcTags>),
    /// ARCOF.
    ArcOff(Box<ArcTags>),
    /// ARCSET.
    ArcSet(Box<ArcTags>),
    /// WVON.
    WeaveOn(Box<WeaveTags>),
    /// WVOF.
    WeaveOff,
}
