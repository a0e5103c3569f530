//! Program flow.

use super::super::error::Mistake;
use super::super::expression::{Expression, Node};
use super::super::instruction::{Flow, Instruction, JobReference, JumpTarget};
use super::super::lexer::{Fault, Lexer, TokenKind, column, printable};
use super::{expression, operand};

type Parsed<T> = Result<T, Fault>;

/// Most arguments of a call.
const MAX_ARGUMENTS: usize = 8;

/// The instruction that begins with this word, if it is one of the flow.
pub(super) fn instruction(lexer: &mut Lexer<'_>, word: &str) -> Parsed<Option<Instruction>> {
    let flow = match word {
        "JUMP" => return jump(lexer).map(Some),
        "CALL" => return call(lexer).map(Some),
        "RET" => {
            let value = if at_condition(lexer) { None } else { Some(argument(lexer)?) };
            Flow::Return { value, condition: optional_condition(lexer)? }
        }
        "PAUSE" => Flow::Pause { condition: optional_condition(lexer)? },
        "ABORT" => Flow::Abort { condition: optional_condition(lexer)? },
        "END" => Flow::End,
        "IFTHEN" | "IFTHENEXP" => Flow::If(expression::condition(lexer)?),
        "ANDIF" | "ANDIFEXP" | "ANDEXP" => Flow::AndIf(expression::condition(lexer)?),
        "ORIF" | "ORIFEXP" | "OREXP" => Flow::OrIf(expression::condition(lexer)?),
        "ELSEIF" | "ELSEIFEXP" => Flow::ElseIf(expression::condition(lexer)?),
        "ELSE" => Flow::Else,
        "ENDIF" => Flow::EndIf,
        "WHILE" | "WHILEEXP" => Flow::While(expression::condition(lexer)?),
        "ENDWHILE" => Flow::EndWhile,
        "FOR" => for_loop(lexer)?,
        "NEXT" => Flow::Next(operand::counter(lexer)?),
        "SWITCH" => Flow::Switch(expression::number_or_text(lexer)?),
        "CASE" => Flow::Case(cases(lexer)?),
        "DEFAULT" => Flow::Default,
        "ENDSWITCH" => Flow::EndSwitch,
        _ => return Ok(None),
    };
    Ok(Some(Instruction::Flow(flow)))
}

/// `JUMP *L IF …`, `JUMP JOB:X`. Other targets are kept and not read.
fn jump(lexer: &mut Lexer<'_>) -> Parsed<Instruction> {
    let target = if operand::eat(lexer, b"*") {
        let fault = lexer.unexpected("the label's name");
        let token = lexer.name();
        let TokenKind::Text(name) = token.kind else { return Err(fault) };
        // The column of the star, which belongs to the name as it is written.
        JumpTarget::Label { column: column(token.start.saturating_sub(1)), name: printable(name) }
    } else if let Some(job) = job_reference(lexer)? {
        JumpTarget::Job(job)
    } else if lexer.peek().kind == TokenKind::End {
        return Err(lexer.unexpected("a label such as *START or JOB: and a name"));
    } else {
        return Ok(Instruction::Other { word: "JUMP".into() });
    };
    if is_user_frame(lexer) {
        return Ok(Instruction::Other { word: "JUMP".into() });
    }
    Ok(Instruction::Flow(Flow::Jump { target, condition: optional_condition(lexer)? }))
}

fn call(lexer: &mut Lexer<'_>) -> Parsed<Instruction> {
    let Some(target) = job_reference(lexer)? else {
        if lexer.peek().kind == TokenKind::End {
            return Err(lexer.unexpected("JOB: and a name"));
        }
        return Ok(Instruction::Other { word: "CALL".into() });
    };
    if is_user_frame(lexer) {
        return Ok(Instruction::Other { word: "CALL".into() });
    }
    let place = lexer.column();
    let arguments = arguments(lexer)?;
    if arguments.len() > MAX_ARGUMENTS {
        let mistake = Mistake::WrongCount {
            what: "the call",
            found: arguments.len(),
            unit: "arguments",
            expected: "at most 8",
        };
        return Err(Fault { column: place, mistake });
    }
    Ok(Instruction::Flow(Flow::Call { target, arguments, condition: optional_condition(lexer)? }))
}

/// `JOB:NAME`.
fn job_reference(lexer: &mut Lexer<'_>) -> Parsed<Option<JobReference>> {
    if !operand::eat_word(lexer, &["JOB"]) {
        return Ok(None);
    }
    operand::expect(lexer, b":", "`:` and a job's name")?;
    let fault = lexer.unexpected("a job's name");
    let token = lexer.name();
    let TokenKind::Text(name) = token.kind else { return Err(fault) };
    Ok(Some(JobReference { column: column(token.start), name: printable(name) }))
}

/// A job that runs in a user frame of the caller's choice.
fn is_user_frame(lexer: &Lexer<'_>) -> bool {
    lexer.peek().kind == TokenKind::Word("UF")
}

/// `ARGF1 ARGFB000`, or `(1, B000)`.
fn arguments(lexer: &mut Lexer<'_>) -> Parsed<Vec<Expression>> {
    let mut values = Vec::new();
    if operand::eat(lexer, b"(") {
        loop {
            values.push(argument(lexer)?);
            if operand::eat(lexer, b",") {
                continue;
            }
            operand::expect(lexer, b")", "`,` or `)`")?;
            return Ok(values);
        }
    }
    loop {
        let token = lexer.peek();
        let prefix = "ARGF";
        if !matches!(token.kind, TokenKind::Word(word) if word.starts_with(prefix)) {
            return Ok(values);
        }
        lexer.move_to(token.start + prefix.len());
        values.push(argument(lexer)?);
    }
}

/// A number, a variable or a text.
fn argument(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    match lexer.peek().kind {
        TokenKind::Text(_) => expression::text(lexer),
        TokenKind::Word(word) if operand::is_text_variable(word) => expression::text(lexer),
        _ => operand::operand(lexer),
    }
}

const IF_WORDS: &[&str] = &["IF", "IFEXPRESS", "IFEXP"];

fn at_condition(lexer: &Lexer<'_>) -> bool {
    match lexer.peek().kind {
        TokenKind::End => true,
        TokenKind::Word(word) => IF_WORDS.contains(&word),
        _ => false,
    }
}

fn optional_condition(lexer: &mut Lexer<'_>) -> Parsed<Option<Expression>> {
    if operand::eat_word(lexer, IF_WORDS) { expression::condition(lexer).map(Some) } else { Ok(None) }
}

/// `FOR I000=1 TO 10 STEP=2`; the pendant's form `FOR I000 START= 1 TO 10 STEP= 2` means the same.
fn for_loop(lexer: &mut Lexer<'_>) -> Parsed<Flow> {
    let variable = operand::counter(lexer)?;
    operand::eat_word(lexer, &["START"]);
    operand::expect(lexer, b"=", "`=` and the first value")?;
    let start = expression::number(lexer)?;
    if !operand::eat_word(lexer, &["TO"]) {
        return Err(lexer.unexpected("TO and the last value"));
    }
    operand::eat(lexer, b"=");
    let end = expression::number(lexer)?;
    let step = if operand::eat_word(lexer, &["STEP"]) {
        operand::eat(lexer, b"=");
        let step = expression::number(lexer)?;
        if let Node::Number { value: 0.0, .. } = step.node {
            let mistake = Mistake::Unexpected { found: "a step of 0".into(), expected: "a step that counts" };
            return Err(Fault { column: step.column, mistake });
        }
        Some(step)
    } else {
        None
    };
    Ok(Flow::For { variable, start, end, step })
}

fn cases(lexer: &mut Lexer<'_>) -> Parsed<Vec<Expression>> {
    operand::eat(lexer, b"=");
    let mut values = vec![expression::number_or_text(lexer)?];
    while operand::eat(lexer, b",") {
        values.push(expression::number_or_text(lexer)?);
    }
    Ok(values)
}
