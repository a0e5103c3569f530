//! Operands: variables, signals, expressions and conditions.

use std::fmt;

/// The kinds of variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum VariableKind {
    /// Byte, 0 to 255.
    B,
    /// Integer of 16 bits.
    I,
    /// Integer of 32 bits.
    D,
    /// Real number.
    R,
    /// String.
    S,
    /// Robot position.
    P,
    /// Base axis position.
    Bp,
    /// Station position.
    Ex,
    /// Positions of all the job's axes at once; without track and station the same as P.
    Px,
}

impl VariableKind {
    /// All kinds with their letters, longer names first.
    pub const NAMES: [(&'static str, Self); 9] = [
        ("PX", Self::Px),
        ("BP", Self::Bp),
        ("EX", Self::Ex),
        ("B", Self::B),
        ("I", Self::I),
        ("D", Self::D),
        ("R", Self::R),
        ("S", Self::S),
        ("P", Self::P),
    ];

    /// The letters in the file.
    #[must_use]
    pub fn letters(self) -> &'static str {
        Self::NAMES.iter().find(|(_, kind)| *kind == self).map_or("", |(letters, _)| letters)
    }

    /// Name, least and greatest value of a variable that holds a number; `None` for the others.
    #[must_use]
    pub fn range(self) -> Option<(&'static str, f64, f64)> {
        match self {
            Self::B => Some(("the value of a B variable", 0.0, 255.0)),
            Self::I => Some(("the value of an I variable", -32_768.0, 32_767.0)),
            Self::D => Some(("the value of a D variable", -2_147_483_648.0, 2_147_483_647.0)),
            Self::R => Some(("the value of an R variable", -f64::from(f32::MAX), f64::from(f32::MAX))),
            Self::S | Self::P | Self::Bp | Self::Ex | Self::Px => None,
        }
    }

    /// Whether it holds a position.
    #[must_use]
    pub fn is_position(self) -> bool {
        matches!(self, Self::P | Self::Bp | Self::Ex | Self::Px)
    }
}

/// A variable as an instruction names it: `B010`, `LI000`, `P[LI002]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Column in the line, from 1.
    pub column: u32,
    /// `L` prefix: a variable of one call of one job.
    pub local: bool,
    /// The kind.
    pub kind: VariableKind,
    /// The number.
    pub index: Index,
}

/// A number that is written, or computed when the instruction runs.
#[derive(Debug, Clone, PartialEq)]
pub enum Index {
    /// Written: `B010`, `IN#(3)`.
    Fixed(u32),
    /// From an expression: `P[LI002]`, `IN#(LB000)`.
    Computed(Box<Expression>),
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let local = if self.local { "L" } else { "" };
        match self.index {
            Index::Fixed(number) => write!(f, "{local}{}{number:03}", self.kind.letters()),
            Index::Computed(_) => write!(f, "{local}{}[…]", self.kind.letters()),
        }
    }
}

/// Kinds of signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SignalKind {
    /// `IN#`: one input.
    Input,
    /// `IG#`: a group of eight inputs.
    InputGroup,
    /// `IGH#`: a group of four inputs.
    InputHalfGroup,
    /// `IGU#`: a group that the user defines.
    InputUserGroup,
    /// `OT#`: one output.
    Output,
    /// `OG#`: a group of eight outputs.
    OutputGroup,
    /// `OGH#`: a group of four outputs.
    OutputHalfGroup,
    /// `OGU#`: a group that the user defines.
    OutputUserGroup,
    /// `SIN#`: an input of the controller itself.
    SpecificInput,
    /// `SOUT#`: an output of the controller itself.
    SpecificOutput,
    /// `RIN#`: a direct (fast) input.
    DirectInput,
}

impl SignalKind {
    /// All kinds with their names in the file.
    pub const NAMES: [(&'static str, Self); 11] = [
        ("IN", Self::Input),
        ("IG", Self::InputGroup),
        ("IGH", Self::InputHalfGroup),
        ("IGU", Self::InputUserGroup),
        ("OT", Self::Output),
        ("OG", Self::OutputGroup),
        ("OGH", Self::OutputHalfGroup),
        ("OGU", Self::OutputUserGroup),
        ("SIN", Self::SpecificInput),
        ("SOUT", Self::SpecificOutput),
        ("RIN", Self::DirectInput),
    ];

    /// The name in the file, without `#`.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }

    /// Whether the job sets it, and not the world.
    #[must_use]
    pub fn is_output(self) -> bool {
        matches!(self, Self::Output | Self::OutputGroup | Self::OutputHalfGroup | Self::OutputUserGroup)
    }
}

/// A signal as an instruction names it: `IN#(141)`.
#[derive(Debug, Clone, PartialEq)]
pub struct SignalReference {
    /// The kind.
    pub kind: SignalKind,
    /// The number.
    pub number: Index,
}

/// An expression with the place where it starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    /// Column in the line, from 1.
    pub column: u32,
    /// What it is.
    pub node: Node,
}

/// The parts of an expression. Depth is bounded by [`MAX_DEPTH`](super::MAX_DEPTH).
#[derive(Debug, Clone, PartialEq)]
pub enum Node {
    /// A number; `whole` where it was written without a decimal point.
    Number {
        /// The value.
        value: f64,
        /// No decimal point was written.
        whole: bool,
    },
    /// `ON` or `OFF`.
    State(bool),
    /// A string in quotes, as bytes.
    Text(Vec<u8>),
    /// A variable.
    Variable(Variable),
    /// A signal.
    Signal(SignalReference),
    /// A system variable, flag or register by its name: `$B002`, `FL010`, `MREG#(5)`.
    System(String),
    /// −x.
    Negated(Box<Expression>),
    /// NOT x.
    Not(Box<Expression>),
    /// Two operands.
    Binary {
        /// The operator.
        operator: Operator,
        /// Left operand.
        left: Box<Expression>,
        /// Right operand.
        right: Box<Expression>,
    },
}

/// Operators of two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// x + y.
    Add,
    /// x − y.
    Subtract,
    /// x · y.
    Multiply,
    /// x / y.
    Divide,
    /// x = y.
    Equal,
    /// x <> y.
    NotEqual,
    /// x < y.
    Less,
    /// x <= y.
    LessEqual,
    /// x > y.
    Greater,
    /// x >= y.
    GreaterEqual,
    /// Both conditions.
    And,
    /// Either condition.
    Or,
}

impl Operator {
    /// Whether it joins two conditions.
    #[must_use]
    pub fn is_logical(self) -> bool {
        matches!(self, Self::And | Self::Or)
    }

    /// Whether it yields a number.
    #[must_use]
    pub fn is_arithmetic(self) -> bool {
        matches!(self, Self::Add | Self::Subtract | Self::Multiply | Self::Divide)
    }
}

impl Expression {
    /// Whether it is a condition: a comparison, or conditions joined.
    #[must_use]
    pub fn is_condition(&self) -> bool {
        match &self.node {
            Node::Not(_) => true,
            Node::Binary { operator, .. } => !operator.is_arithmetic(),
            _ => false,
        }
    }
}
