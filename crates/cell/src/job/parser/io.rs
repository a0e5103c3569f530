//! Inputs, outputs, time, messages.

use super::super::expression::SignalReference;
use super::super::instruction::{Instruction, Io, OutputValue};
use super::super::lexer::{Fault, Lexer, TokenKind};
use super::{expression, operand};

type Parsed<T> = Result<T, Fault>;

/// Longest time of TIMER, WAIT and PULSE, in seconds: 16 bits of 0.01 s.
const MAX_TIME: f64 = 655.35;

/// The instruction that begins with this word, if it is one of these.
pub(super) fn instruction(lexer: &mut Lexer<'_>, word: &str) -> Parsed<Option<Instruction>> {
    let io = match word {
        "TIMER" => {
            if !operand::eat_word(lexer, &["T"]) {
                return Err(lexer.unexpected("T= and a time in seconds"));
            }
            Io::Timer { time: time(lexer)? }
        }
        "WAIT" => {
            operand::eat_word(lexer, &["FOREXPRESS"]);
            Io::Wait { condition: expression::condition(lexer)?, timeout: optional_time(lexer)? }
        }
        "DOUT" => {
            let signal = output(lexer)?;
            let value = if operand::eat_word(lexer, &["INVERT"]) {
                OutputValue::Invert
            } else {
                OutputValue::Value(expression::number(lexer)?)
            };
            Io::DigitalOutput { signal, value }
        }
        "PULSE" => {
            let signal = output(lexer)?;
            let bare = matches!(lexer.peek().kind, TokenKind::End | TokenKind::Word("T"));
            let value = if bare { None } else { Some(operand::operand(lexer)?) };
            Io::Pulse { signal, value, time: optional_time(lexer)? }
        }
        "DIN" => {
            let variable = operand::numeric_variable(lexer)?;
            Io::DigitalInput { variable, signal: operand::signal(lexer, "a signal such as IN#(1)")? }
        }
        "AOUT" => {
            if !operand::eat_word(lexer, &["AO"]) {
                return Err(lexer.unexpected("AO#(n)"));
            }
            let port = operand::hash_expression(lexer)?;
            let value = operand::operand(lexer)?;
            operand::check_range(&value, "the output (V)", -14.0, 14.0)?;
            Io::AnalogOutput { port, value }
        }
        "MSG" => Io::Message { text: expression::text(lexer)? },
        "SETUALM" => alarm(lexer)?,
        _ => return Ok(None),
    };
    Ok(Some(Instruction::Io(io)))
}

fn alarm(lexer: &mut Lexer<'_>) -> Parsed<Io> {
    let code = operand::operand(lexer)?;
    operand::check_range(&code, "the alarm code", 8000.0, 8999.0)?;
    let text = match lexer.peek().kind {
        TokenKind::Text(_) => Some(expression::text(lexer)?),
        TokenKind::Word(word) if operand::is_text_variable(word) => Some(expression::text(lexer)?),
        _ => None,
    };
    let at_end = matches!(lexer.peek().kind, TokenKind::End | TokenKind::Word("SMODE"));
    let subcode = if at_end { None } else { Some(operand::operand(lexer)?) };
    if let Some(subcode) = &subcode {
        operand::check_range(subcode, "the alarm's subcode", 0.0, 255.0)?;
    }
    let stop_mode =
        if operand::eat_word(lexer, &["SMODE"]) { Some(operand::tag_value(lexer)?) } else { None };
    Ok(Io::Alarm { code, text, subcode, stop_mode })
}

fn output(lexer: &mut Lexer<'_>) -> Parsed<SignalReference> {
    const EXPECTED: &str = "an output such as OT#(1) or OG#(1)";
    let place = lexer.clone();
    let signal = operand::signal(lexer, EXPECTED)?;
    if signal.kind.is_output() { Ok(signal) } else { Err(place.unexpected(EXPECTED)) }
}

fn optional_time(lexer: &mut Lexer<'_>) -> Parsed<Option<super::super::Expression>> {
    if operand::eat_word(lexer, &["T"]) { time(lexer).map(Some) } else { Ok(None) }
}

/// `=` and seconds.
pub(super) fn time(lexer: &mut Lexer<'_>) -> Parsed<super::super::Expression> {
    let value = operand::tag_value(lexer)?;
    operand::check_range(&value, "T (s)", 0.0, MAX_TIME)?;
    Ok(value)
}
