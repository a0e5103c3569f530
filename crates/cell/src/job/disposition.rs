//! What a run does with each instruction: one table for `check` and `run`.

use super::expression::{Expression, Index, Node, SignalReference, Variable, VariableKind};
use super::instruction::{
    CallTarget, Data, Flow, Instruction, Interpolation, Io, JumpTarget, MoveInstruction, OutputValue,
    PositionReference, Weld,
};

/// What a run does with an instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Disposition {
    /// It is executed as the controller's maker describes it.
    Executed,
    /// It is accepted and reported, with what is done instead.
    Accepted(&'static str),
    /// A run ends before it, for this reason.
    Refused(&'static str),
}

use Disposition::{Accepted, Executed, Refused};

const REPORTED: Disposition = Accepted("reported with its time");
const INPUTS: Disposition = Accepted("inputs come from the cell's script or policy");
const SHIFT: Disposition = Refused("position shifts are not built");
const FRAMES: Disposition = Refused("user frames come from the cell file and are not changed by jobs");
const STRINGS: Disposition = Refused("string functions are not built");
const CELL_DATA: Disposition = Refused("registers, parameters and condition files are not changed by jobs");
const MEMO: Disposition = Refused("root-pass memory is not built");
const RAMP: Disposition = Refused("ramps of the arc's values are not built");
const OPERATOR: Disposition = Refused("it asks the operator for a value");
const WORK: Disposition = Refused("it drives a tool that this cell does not have");
const SYSTEM_VARIABLE: Disposition =
    Refused("it reads a system variable, flag or register that is not there");

/// Instructions that are known by name only.
const OTHERS: &[(&str, Disposition)] = &[
    ("ADVINIT", Accepted("no instruction runs ahead")),
    ("ADVSTOP", Accepted("no instruction runs ahead")),
    ("ANTOUT", REPORTED),
    ("ARATION", REPORTED),
    ("ARATIOF", REPORTED),
    ("ARCCTE", RAMP),
    ("ARCCTS", RAMP),
    ("ASC", STRINGS),
    ("AWELD", REPORTED),
    ("CAT$", STRINGS),
    ("CHR$", STRINGS),
    ("CLS", REPORTED),
    ("COMARCOF", Refused("seam tracking through the arc is not built")),
    ("COMARCON", Refused("seam tracking through the arc is not built")),
    ("CWAIT", Accepted("no instruction runs ahead of a move")),
    ("DI", Accepted("there are no interrupt jobs")),
    ("DIALOG", OPERATOR),
    ("EI", Accepted("there are no interrupt jobs")),
    ("GETFILE", CELL_DATA),
    ("GETPOS", Refused("positions of other steps are not read")),
    ("GETPRM", CELL_DATA),
    ("GETREG", CELL_DATA),
    ("GUNCL", WORK),
    ("HAND", REPORTED),
    ("HSEN", WORK),
    ("INPUT", OPERATOR),
    ("INVMAT", SHIFT),
    ("LATESTJOB", Accepted("jobs do not change while they run")),
    ("LEN", STRINGS),
    ("MACRO1", Refused("it runs a macro of the maker or integrator")),
    ("MEMOF", MEMO),
    ("MEMON", MEMO),
    ("MFRAME", FRAMES),
    ("MID$", STRINGS),
    ("MSHIFT", SHIFT),
    ("MULMAT", SHIFT),
    ("PRINT", REPORTED),
    ("PSTART", Accepted("there is one task: the other job is not started")),
    ("PWAIT", Accepted("there is one task: nothing to wait for")),
    ("REFP", Accepted("reference points matter to weaves only")),
    ("SETFILE", CELL_DATA),
    ("SETPRM", CELL_DATA),
    ("SETREG", CELL_DATA),
    ("SETTM", REPORTED),
    ("SFTOF", Accepted("no shift is on")),
    ("SFTOF3D", Accepted("no shift is on")),
    ("SFTON", SHIFT),
    ("SFTON3D", SHIFT),
    ("SPOT", WORK),
    ("STROKE", WORK),
    ("STRSTR", STRINGS),
    ("STRWAIT", WORK),
    ("TOOLOF", WORK),
    ("TOOLON", WORK),
    ("TSYNC", Accepted("there is one task: nothing to wait for")),
    ("VAL", STRINGS),
    ("VAL2STR", STRINGS),
    ("VWELD", REPORTED),
];

/// What a run does with this instruction, and why.
#[must_use]
pub fn disposition(instruction: &Instruction) -> Disposition {
    match instruction {
        Instruction::Nop | Instruction::Label(_) | Instruction::Disabled | Instruction::Speed(_) => Executed,
        Instruction::Move(step) => of_move(step),
        Instruction::Flow(flow) => of_flow(flow),
        Instruction::Data(data) => of_data(data),
        Instruction::Io(io) => of_io(io),
        Instruction::Weld(weld) => of_weld(weld),
        Instruction::Other { word } => OTHERS
            .iter()
            .find(|(name, _)| name == word)
            .map_or(Refused("this instruction is not known"), |(_, disposition)| *disposition),
    }
}

/// The names in the table of instructions that are known by name only.
pub(super) fn other_words() -> impl Iterator<Item = &'static str> {
    OTHERS.iter().map(|(word, _)| *word)
}

fn of_move(step: &MoveInstruction) -> Disposition {
    let station = |p: &PositionReference| match p {
        PositionReference::Step { .. } => false,
        PositionReference::Variable(v) => matches!(v.kind, VariableKind::Bp | VariableKind::Ex),
    };
    if step.coordinated {
        Refused("coordinated motion with a station is not built")
    } else if step.target.as_ref().is_none_or(station) || !step.external.is_empty() || !step.others.is_empty()
    {
        Refused("base axes, stations and second robots are not built")
    } else if step.interpolation == Interpolation::Spline {
        Refused("splines are not built")
    } else if step.until.is_some() {
        Refused("moves that an input ends are not built")
    } else if !step.other_tags.is_empty() {
        Refused("a tag of this move would change the motion and is not built")
    } else if step.no_wait {
        Accepted("the next instruction waits for the end of the move")
    } else if step.corner_radius.is_some() || step.continuous || !is_zero(step.position_level.as_ref()) {
        Accepted("zones are not built: the robot stops exactly on the point")
    } else {
        Executed
    }
}

fn is_zero(level: Option<&Expression>) -> bool {
    level.is_some_and(|e| matches!(e.node, Node::Number { value: 0.0, .. }))
}

fn of_flow(flow: &Flow) -> Disposition {
    let executed = |condition: &Option<Expression>| if_readable(condition.iter(), Executed);
    match flow {
        Flow::Jump { target: JumpTarget::Indirect(_), .. }
        | Flow::Call { target: CallTarget::Indirect(_), .. } => {
            Refused("jumps to a job or label that a value chooses are not built")
        }
        Flow::Jump { condition, .. } | Flow::Pause { condition } | Flow::Abort { condition } => {
            executed(condition)
        }
        Flow::Call { arguments, condition, .. } => if_readable(arguments.iter().chain(condition), Executed),
        Flow::Return { value, condition } => if_readable(value.iter().chain(condition), Executed),
        Flow::If(e) | Flow::AndIf(e) | Flow::OrIf(e) | Flow::ElseIf(e) | Flow::While(e) | Flow::Switch(e) => {
            if_readable([e], Executed)
        }
        Flow::For { start, end, step, .. } => if_readable([start, end].into_iter().chain(step), Executed),
        Flow::Case(values) => if_readable(values, Executed),
        Flow::End
        | Flow::Else
        | Flow::EndIf
        | Flow::EndWhile
        | Flow::Next(_)
        | Flow::Default
        | Flow::EndSwitch => Executed,
    }
}

fn of_data(data: &Data) -> Disposition {
    match data {
        Data::SetSignal { value, .. } => if_readable([value], REPORTED),
        Data::GetSystem { source, .. } => match source.as_str() {
            "$PX000" | "$PX001" | "$RV" => Executed,
            _ => SYSTEM_VARIABLE,
        },
        Data::Set { variable, value }
        | Data::Function { variable, value, .. }
        | Data::Bitwise { variable, value, .. } => {
            of_position_variable(variable, if_readable([value], Executed))
        }
        Data::Arithmetic { variable, element, value, .. } => {
            of_position_variable(variable, if_readable(element.iter().chain([value]), Executed))
        }
        Data::SetElement { variable, element, value } => {
            of_position_variable(variable, if_readable([element, value], Executed))
        }
        Data::GetElement { source, element, .. } => {
            of_position_variable(source, if_readable([element], Executed))
        }
        Data::Clear { count, .. } => if_readable(count, Executed),
        Data::SetTool { variable, tool } => of_position_variable(variable, if_readable([tool], Executed)),
        Data::Convert { tool, .. } => if_readable(tool, Executed),
        Data::GetArgument { number, .. } => if_readable([number], Executed),
        Data::Step { .. } | Data::ClearStack => Executed,
    }
}

/// Positions of tracks and stations are kept for nobody: no move here uses them.
fn of_position_variable(variable: &Variable, otherwise: Disposition) -> Disposition {
    if matches!(variable.kind, VariableKind::Bp | VariableKind::Ex) {
        return Accepted("positions of base axes and stations are not used");
    }
    otherwise
}

fn of_io(io: &Io) -> Disposition {
    match io {
        Io::Timer { time } => if_readable([time], Executed),
        Io::Wait { condition, timeout } => if_readable([condition].into_iter().chain(timeout), INPUTS),
        Io::DigitalInput { .. } => INPUTS,
        Io::DigitalOutput { value: OutputValue::Value(value), .. } => if_readable([value], REPORTED),
        Io::DigitalOutput { value: OutputValue::Invert, .. } => REPORTED,
        Io::Pulse { value, time, .. } => if_readable(value.iter().chain(time), REPORTED),
        Io::AnalogOutput { port, value } => if_readable([port, value], REPORTED),
        Io::Message { text } => if_readable([text], REPORTED),
        Io::Alarm { code, text, subcode, stop_mode } => {
            if_readable([code].into_iter().chain(text).chain(subcode).chain(stop_mode), REPORTED)
        }
    }
}

fn of_weld(weld: &Weld) -> Disposition {
    match weld {
        Weld::WeaveOn(_) => Refused("weaving is not built"),
        Weld::WeaveOff => Accepted("no weave is on"),
        Weld::ArcOn(tags) | Weld::ArcOff(tags) | Weld::ArcSet(tags) => {
            let values =
                [&tags.file, &tags.current, &tags.voltage, &tags.voltage_percent, &tags.time, &tags.speed];
            let accepted = if tags.other_tags.is_empty() {
                Executed
            } else {
                Accepted("the tags without a value here have no effect")
            };
            if_readable(values.into_iter().flatten(), accepted)
        }
    }
}

/// `otherwise`, unless an expression reads something that is not there.
fn if_readable<'a>(
    expressions: impl IntoIterator<Item = &'a Expression>,
    otherwise: Disposition,
) -> Disposition {
    if expressions.into_iter().any(reads_system) { SYSTEM_VARIABLE } else { otherwise }
}

fn reads_system(expression: &Expression) -> bool {
    let index = |index: &Index| match index {
        Index::Fixed(_) => false,
        Index::Computed(inner) => reads_system(inner),
    };
    match &expression.node {
        Node::System(_) => true,
        Node::Number { .. } | Node::State(_) | Node::Text(_) => false,
        Node::Variable(Variable { index: i, .. }) | Node::Signal(SignalReference { number: i, .. }) => {
            index(i)
        }
        Node::Negated(inner) | Node::Not(inner) => reads_system(inner),
        Node::Binary { left, right, .. } => reads_system(left) || reads_system(right),
    }
}
