//! Inputs, outputs, time, messages; arc and weave.

use super::super::expression::{Expression, SignalReference, Variable};

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

/// Arc, weave and seam tracking.
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
    /// COMARCON, with its tags: those of tracking through the arc.
    TrackOn(Vec<String>),
    /// COMARCOF.
    TrackOff,
    /// `MEMON REC MPF#(n)`, `MEMON PLY MPF#(n)`.
    MemoryOn {
        /// It is recorded; otherwise played.
        record: bool,
        /// `MPF#(n)`.
        file: Box<Expression>,
    },
    /// MEMOF.
    MemoryOff,
}
