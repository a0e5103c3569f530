//! From bytes to a [`JobFile`](super::JobFile): the file's outline, its positions, its instructions.
//!
//! Every line is read on its own, so that one mistake hides no other; a line gives at most one error. Any line of the
//! program that begins with a word that is not known is kept as [`Instruction::Other`] and fails nothing.

mod data;
mod expression;
mod file;
mod flow;
mod header;
mod io;
mod moves;
mod operand;
mod weld;

pub(super) use operand::is_local_name;

use super::instruction::Instruction;
use super::lexer::{Fault, Lexer, TokenKind, printable};

/// Longer lines hold no instruction of INFORM; the bound keeps the depth of every expression small.
const MAX_LINE: usize = 1024;

/// Instructions that are read in full, for the nearest known name. The others stand in the table of dispositions.
pub(super) const INSTRUCTIONS: &[&str] = &[
    "ABORT",
    "ADD",
    "AND",
    "AOUT",
    "ARCOF",
    "ARCON",
    "ARCSET",
    "ATAN",
    "CALL",
    "CASE",
    "CLEAR",
    "CNVRT",
    "COMARCOF",
    "COMARCON",
    "COS",
    "DEC",
    "DEFAULT",
    "DIN",
    "DIV",
    "DOUT",
    "ELSE",
    "ELSEIF",
    "ELSEIFEXP",
    "END",
    "ENDIF",
    "ENDSWITCH",
    "ENDWHILE",
    "FOR",
    "GETARG",
    "GETE",
    "GETS",
    "IFTHEN",
    "IFTHENEXP",
    "IMOV",
    "INC",
    "JUMP",
    "MEMOF",
    "MEMON",
    "MOVC",
    "MOVJ",
    "MOVL",
    "MOVS",
    "MSG",
    "MUL",
    "NEXT",
    "NOP",
    "NOT",
    "OR",
    "PAUSE",
    "PULSE",
    "RET",
    "SET",
    "SETE",
    "SETUALM",
    "SIN",
    "SMOVC",
    "SMOVL",
    "SPEED",
    "SQRT",
    "SUB",
    "SWITCH",
    "TIMER",
    "WAIT",
    "WHILE",
    "WHILEEXP",
    "WVOF",
    "WVON",
    "XOR",
];

/// The instruction of a line, without indent and comment.
fn instruction(lexer: &mut Lexer<'_>) -> Result<Instruction, Fault> {
    let start = lexer.clone();
    let token = lexer.next();
    let word = match token.kind {
        TokenKind::Symbol(b"*") => return label(lexer),
        TokenKind::Word(word) => word,
        TokenKind::Symbol(b"+") => match lexer.next().kind {
            TokenKind::Word(word) => return Ok(Instruction::Other { word: format!("+{word}") }),
            _ => return Err(start.unexpected("an instruction")),
        },
        _ => return Err(start.unexpected("an instruction")),
    };
    let parsed = match word {
        "NOP" => Some(Instruction::Nop),
        "COMM" => return Ok(Instruction::Disabled),
        "SPEED" => Some(moves::speed_instruction(lexer)?),
        _ if moves::interpolation(word).is_some() => Some(moves::move_instruction(lexer, word)?),
        _ => match flow::instruction(lexer, word)? {
            Some(instruction) => Some(instruction),
            None => match data::instruction(lexer, word)? {
                Some(instruction) => Some(instruction),
                None => match io::instruction(lexer, word)? {
                    Some(instruction) => Some(instruction),
                    None => weld::instruction(lexer, word)?,
                },
            },
        },
    };
    let Some(parsed) = parsed else { return Ok(Instruction::Other { word: word.to_owned() }) };
    if !matches!(parsed, Instruction::Other { .. }) {
        operand::expect_end(lexer, "the end of the instruction")?;
    }
    Ok(parsed)
}

fn label(lexer: &mut Lexer<'_>) -> Result<Instruction, Fault> {
    let fault = lexer.unexpected("the label's name");
    let TokenKind::Text(name) = lexer.name().kind else { return Err(fault) };
    operand::expect_end(lexer, "the end of the line: a label's name has no blanks")?;
    Ok(Instruction::Label(printable(name)))
}
