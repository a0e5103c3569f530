//! What a run does with each instruction: one table for `check` and `run`.

use std::borrow::Cow;

use super::instruction::{Data, Instruction, Io, MoveInstruction, Weld};
use super::names::nearest;
use super::parser::INSTRUCTIONS;
use super::walk;

/// What a run does with an instruction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Disposition {
    /// It is executed as the controller's maker describes it.
    Executed,
    /// It is accepted and reported, with what is done instead.
    Accepted(&'static str),
    /// A run ends before it, for this reason; it names the nearest known instruction where the word is not known.
    Refused(Cow<'static, str>),
}

use Disposition::{Accepted, Executed};

/// Refused for a reason that is always the same.
const fn refused(reason: &'static str) -> Disposition {
    Disposition::Refused(Cow::Borrowed(reason))
}

const REPORTED: Disposition = Accepted("reported with its time");
const INPUTS: Disposition = Accepted("inputs come from the cell's script or policy");
const SHIFT: Disposition = refused("position shifts are not built");
const FRAMES: Disposition = refused("user frames come from the cell file and are not changed by jobs");
const STRINGS: Disposition = refused("string functions are not built");
const CELL_DATA: Disposition = refused("registers, flags, parameters and condition files are not kept");
const RAMP: Disposition = refused("ramps of the arc's values are not built");
const GROUPS: Disposition = refused("base axes, stations and second robots are not built");
const OPERATOR: Disposition = refused("it asks the operator for a value");
const CHOSEN: Disposition =
    refused("jobs and labels that a value chooses, and jobs in another frame, are not built");
const WORK: Disposition = refused("it drives a tool that this cell does not have");
const SYSTEM_VARIABLE: Disposition =
    refused("it reads a system variable, flag or register that is not there");

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
    ("CALL", CHOSEN),
    ("CAT$", STRINGS),
    ("CHR$", STRINGS),
    ("CLEAR", REPORTED),
    ("CLS", REPORTED),
    ("CWAIT", Accepted("no instruction runs ahead of a move")),
    ("DI", Accepted("there are no interrupt jobs")),
    ("DIALOG", OPERATOR),
    ("EI", Accepted("there are no interrupt jobs")),
    ("GETFILE", CELL_DATA),
    ("GETPOS", refused("positions of other steps are not read")),
    ("GETPRM", CELL_DATA),
    ("GETREG", CELL_DATA),
    ("GUNCL", WORK),
    ("HAND", REPORTED),
    ("HSEN", WORK),
    ("INPUT", OPERATOR),
    ("INVMAT", SHIFT),
    ("JUMP", CHOSEN),
    ("LATESTJOB", Accepted("jobs do not change while they run")),
    ("LEN", STRINGS),
    ("MACRO1", refused("it runs a macro of the maker or integrator")),
    ("MFRAME", FRAMES),
    ("MID$", STRINGS),
    ("MSHIFT", SHIFT),
    ("MULMAT", SHIFT),
    ("PRINT", REPORTED),
    ("PSTART", Accepted("there is one task: the other job is not started")),
    ("PWAIT", Accepted("there is one task: nothing to wait for")),
    ("REFP", Accepted("a weave takes its plane from the travel and the wire")),
    ("SET", CELL_DATA),
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
    if walk::reads_system(instruction) {
        return SYSTEM_VARIABLE;
    }
    match instruction {
        Instruction::Nop | Instruction::Label(_) | Instruction::Disabled | Instruction::Speed(_) => Executed,
        Instruction::Flow(_) => Executed,
        Instruction::Move(step) => of_move(step),
        Instruction::Data(data) => of_data(data),
        Instruction::Io(Io::Timer { .. }) => Executed,
        Instruction::Io(Io::Wait { .. } | Io::DigitalInput { .. }) => INPUTS,
        Instruction::Io(_) => REPORTED,
        Instruction::Weld(weld) => of_weld(weld),
        Instruction::Other { word } => of_other(word),
    }
}

fn of_other(word: &str) -> Disposition {
    if let Some((_, known)) = OTHERS.iter().find(|(name, _)| *name == word) {
        return known.clone();
    }
    // A move of a second group on a line of its own.
    if word.starts_with('+') {
        return GROUPS;
    }
    let known = OTHERS.iter().map(|(word, _)| *word).chain(INSTRUCTIONS.iter().copied());
    let nearest = nearest(word, known);
    Disposition::Refused(Cow::Owned(format!("this instruction is not known{nearest}")))
}

fn of_move(step: &MoveInstruction) -> Disposition {
    if step.coordinated {
        refused("coordinated motion with a station is not built")
    } else if step.target.is_none() || !step.external.is_empty() || !step.others.is_empty() {
        GROUPS
    } else if step.until.is_some() {
        refused("moves that an input ends are not built")
    } else if !step.other_tags.is_empty() {
        refused("a tag of this move would change the motion and is not built")
    } else if step.no_wait {
        Accepted("the next instruction waits for the end of the move")
    } else {
        Executed
    }
}

fn of_data(data: &Data) -> Disposition {
    match data {
        Data::SetSignal { .. } => REPORTED,
        Data::GetSystem { source, .. } if !matches!(source.as_str(), "$PX000" | "$PX001" | "$RV") => {
            SYSTEM_VARIABLE
        }
        _ => Executed,
    }
}

fn of_weld(weld: &Weld) -> Disposition {
    match weld {
        Weld::WeaveOn(_) | Weld::WeaveOff | Weld::TrackOff | Weld::MemoryOn { .. } | Weld::MemoryOff => {
            Executed
        }
        Weld::TrackOn(tags) if tags.is_empty() => Executed,
        Weld::TrackOn(_) => Accepted(
            "its tags are those of tracking through the arc and have no effect: the cell's seam sensor is followed",
        ),
        Weld::ArcOn(tags) | Weld::ArcOff(tags) | Weld::ArcSet(tags) if tags.other_tags.is_empty() => Executed,
        Weld::ArcOn(_) | Weld::ArcOff(_) | Weld::ArcSet(_) => {
            Accepted("tags of the power source, such as RETRY, have no effect")
        }
    }
}
