//! Variables and computing.

use super::super::expression::{Expression, SignalReference, Variable};
use super::FrameTag;

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
