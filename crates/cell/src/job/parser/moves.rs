//! Moves and SPEED.

use super::super::error::Mistake;
use super::super::expression::{Expression, Node, VariableKind};
use super::super::instruction::{
    Instruction, Interpolation, MoveInstruction, PositionReference, SpeedKind, SpeedTag,
};
use super::super::lexer::{Fault, Lexer, TokenKind, column, printable};
use super::super::position::PositionKind;
use super::{expression, operand};

type Parsed<T> = Result<T, Fault>;

/// The move that a word names, and whether it is coordinated with a station.
pub(super) fn interpolation(word: &str) -> Option<(Interpolation, bool)> {
    Some(match word {
        "MOVJ" => (Interpolation::Joint, false),
        "MOVL" => (Interpolation::Linear, false),
        "MOVC" => (Interpolation::Circular, false),
        "MOVS" => (Interpolation::Spline, false),
        "IMOV" => (Interpolation::Incremental, false),
        "SMOVL" => (Interpolation::Linear, true),
        "SMOVC" => (Interpolation::Circular, true),
        _ => return None,
    })
}

/// A move, with the moves of further groups that stand on its line behind `+`.
pub(super) fn move_instruction(lexer: &mut Lexer<'_>, word: &str) -> Parsed<Instruction> {
    let mut first = one_move(lexer, word)?;
    while operand::eat(lexer, b"+") {
        let fault = lexer.unexpected("a move of another group");
        match lexer.next().kind {
            TokenKind::Word(word) if interpolation(word).is_some() => {
                first.others.push(one_move(lexer, word)?)
            }
            _ => return Err(fault),
        }
    }
    Ok(Instruction::Move(Box::new(first)))
}

/// `SPEED VJ=50.00 V=276 VR=30.0`.
pub(super) fn speed_instruction(lexer: &mut Lexer<'_>) -> Parsed<Instruction> {
    let mut tags: Vec<SpeedTag> = Vec::new();
    while lexer.peek().kind != TokenKind::End {
        let place = lexer.clone();
        let TokenKind::Word(word) = lexer.next().kind else {
            return Err(place.unexpected("VJ=, V=, VR= or VE="));
        };
        let kind = speed_kind(word).ok_or_else(|| place.unexpected("VJ=, V=, VR= or VE="))?;
        if tags.iter().any(|tag| tag.kind == kind) {
            return Err(conflict(&place, kind.tag(), kind.tag()));
        }
        tags.push(speed_tag(lexer, kind)?);
    }
    if tags.is_empty() {
        return Err(lexer.unexpected("VJ=, V=, VR= or VE="));
    }
    Ok(Instruction::Speed(tags))
}

fn one_move(lexer: &mut Lexer<'_>, word: &str) -> Parsed<MoveInstruction> {
    let (interpolation, coordinated) = interpolation(word).unwrap_or((Interpolation::Joint, false));
    let mut step = MoveInstruction {
        interpolation,
        coordinated,
        target: None,
        external: Vec::new(),
        frame: None,
        speed: None,
        position_level: None,
        corner_radius: None,
        acceleration: None,
        deceleration: None,
        no_wait: false,
        continuous: false,
        fixed_point: false,
        until: None,
        other_tags: Vec::new(),
        others: Vec::new(),
    };
    loop {
        match lexer.peek().kind {
            TokenKind::End | TokenKind::Symbol(b"+") => break,
            TokenKind::Word(word) => tag(lexer, &mut step, word)?,
            _ => return Err(lexer.unexpected("a position or a tag such as V= or PL=")),
        }
    }
    if step.target.is_none() && step.external.is_empty() {
        let mistake = Mistake::MissingTarget { instruction: word.to_owned() };
        return Err(Fault { column: lexer.column(), mistake });
    }
    Ok(step)
}

fn tag(lexer: &mut Lexer<'_>, step: &mut MoveInstruction, word: &str) -> Parsed<()> {
    if let Some(position) = position(lexer)? {
        return add_position(step, position);
    }
    let place = lexer.clone();
    let slot = match word {
        "PL" => Some((&mut step.position_level, "PL=", "PL", 0.0, 8.0)),
        "CR" => Some((&mut step.corner_radius, "CR=", "CR (mm)", 0.1, 6553.5)),
        "ACC" => Some((&mut step.acceleration, "ACC=", "ACC (%)", 20.0, 100.0)),
        "DEC" => Some((&mut step.deceleration, "DEC=", "DEC (%)", 20.0, 100.0)),
        _ => None,
    };
    if let Some((slot, name, what, min, max)) = slot {
        lexer.next();
        if slot.is_some() {
            return Err(conflict(&place, name, name));
        }
        let value = operand::tag_value(lexer)?;
        operand::check_range(&value, what, min, max)?;
        if let (Node::Number { value: v, .. }, "PL=") = (&value.node, name) {
            check_whole(&value, *v)?;
        }
        *slot = Some(value);
        return Ok(());
    }
    match word {
        "NWAIT" => step.no_wait = true,
        "CONT" => step.continuous = true,
        "FPT" => step.fixed_point = true,
        "UNTIL" => {
            lexer.next();
            step.until = Some(expression::condition(lexer)?);
            return Ok(());
        }
        "BF" | "RF" | "TF" | "UF" | "MTF" if step.interpolation == Interpolation::Incremental => {
            step.frame = Some(operand::frame(lexer)?);
            return Ok(());
        }
        _ => return speed_or_other(lexer, step, word),
    }
    lexer.next();
    Ok(())
}

fn speed_or_other(lexer: &mut Lexer<'_>, step: &mut MoveInstruction, word: &str) -> Parsed<()> {
    let Some(kind) = speed_kind(word) else {
        if let TokenKind::Text(tag) = lexer.name().kind {
            step.other_tags.push(printable(tag));
        }
        return Ok(());
    };
    let place = lexer.clone();
    lexer.next();
    if let Some(first) = &step.speed {
        return Err(conflict(&place, kind.tag(), first.kind.tag()));
    }
    let expected = match (step.interpolation, kind) {
        (Interpolation::Joint, SpeedKind::Linear | SpeedKind::Rotation) => Some("VJ= for a joint move"),
        (Interpolation::Joint, _) | (_, SpeedKind::Linear | SpeedKind::Rotation | SpeedKind::External) => {
            None
        }
        (_, SpeedKind::Joint) => Some("V=, VR= or VE= for a move along a path"),
    };
    if let Some(expected) = expected {
        return Err(place.unexpected(expected));
    }
    step.speed = Some(speed_tag(lexer, kind)?);
    Ok(())
}

fn speed_kind(word: &str) -> Option<SpeedKind> {
    [SpeedKind::Joint, SpeedKind::Linear, SpeedKind::Rotation, SpeedKind::External]
        .into_iter()
        .find(|kind| kind.tag().trim_end_matches('=') == word)
}

fn speed_tag(lexer: &mut Lexer<'_>, kind: SpeedKind) -> Parsed<SpeedTag> {
    let value = operand::tag_value(lexer)?;
    let (what, min, max) = kind.range();
    operand::check_range(&value, what, min, max)?;
    Ok(SpeedTag { kind, value })
}

fn add_position(step: &mut MoveInstruction, position: PositionReference) -> Parsed<()> {
    let (column, robot) = match &position {
        PositionReference::Step { column, kind, .. } => (*column, *kind == PositionKind::C),
        PositionReference::Variable(v) => (v.column, matches!(v.kind, VariableKind::P | VariableKind::Px)),
    };
    if !robot {
        step.external.push(position);
        return Ok(());
    }
    if step.target.is_some() {
        let mistake = Mistake::Unexpected {
            found: "a second target position".into(),
            expected: "a tag such as V= or PL=",
        };
        return Err(Fault { column, mistake });
    }
    step.target = Some(position);
    Ok(())
}

/// A position, if one is next: `C00001`, `P100`, `LP007`, `P[LI002]`, and those of track and stations.
fn position(lexer: &mut Lexer<'_>) -> Parsed<Option<PositionReference>> {
    let token = lexer.peek();
    let TokenKind::Word(word) = token.kind else { return Ok(None) };
    for kind in [PositionKind::Bc, PositionKind::Ec, PositionKind::C] {
        let digits = word.strip_prefix(kind.letters()).filter(|d| !d.is_empty());
        let Some(digits) = digits.filter(|d| d.bytes().all(|b| b.is_ascii_digit())) else { continue };
        let column = column(token.start);
        let number = digits.parse().map_err(|_| Fault {
            column,
            mistake: Mistake::BadNumber { found: word.to_owned(), expected: "a position such as C00001" },
        })?;
        lexer.next();
        return Ok(Some(PositionReference::Step { column, kind, number }));
    }
    if !operand::is_position_variable(lexer) {
        return Ok(None);
    }
    operand::variable(lexer, "a position").map(|v| Some(PositionReference::Variable(v)))
}

fn check_whole(expression: &Expression, value: f64) -> Parsed<()> {
    if value.fract() == 0.0 {
        return Ok(());
    }
    let mistake = Mistake::BadNumber { found: value.to_string(), expected: "a whole number" };
    Err(Fault { column: expression.column, mistake })
}

fn conflict(place: &Lexer<'_>, tag: &str, instead: &str) -> Fault {
    let mistake = Mistake::TagConflict { tag: tag.to_owned(), instead: instead.to_owned() };
    Fault { column: place.column(), mistake }
}
