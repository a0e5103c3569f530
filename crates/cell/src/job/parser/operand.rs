//! Operands: numbers, variables, signals, frames.

use super::super::error::Mistake;
use super::super::expression::{
    Expression, Index, Node, SignalKind, SignalReference, Variable, VariableKind,
};
use super::super::instruction::FrameTag;
use super::super::lexer::{Fault, Lexer, TokenKind, column, printable};
use super::expression::{Kind, number, require};

type Parsed<T> = Result<T, Fault>;

/// Greatest number of a variable, signal, condition or position.
const MAX_NUMBER: u32 = 99_999;

/// Takes the symbol if it is next.
pub(super) fn eat(lexer: &mut Lexer<'_>, symbol: &[u8]) -> bool {
    let found = lexer.peek().kind == TokenKind::Symbol(symbol);
    if found {
        lexer.next();
    }
    found
}

/// Takes the word if it is next.
pub(super) fn eat_word(lexer: &mut Lexer<'_>, words: &[&str]) -> bool {
    let found = matches!(lexer.peek().kind, TokenKind::Word(word) if words.contains(&word));
    if found {
        lexer.next();
    }
    found
}

/// The symbol must be next.
pub(super) fn expect(lexer: &mut Lexer<'_>, symbol: &[u8], expected: &'static str) -> Parsed<()> {
    if eat(lexer, symbol) { Ok(()) } else { Err(lexer.unexpected(expected)) }
}

/// Nothing more may stand on the line.
pub(super) fn expect_end(lexer: &Lexer<'_>, expected: &'static str) -> Parsed<()> {
    if lexer.peek().kind == TokenKind::End { Ok(()) } else { Err(lexer.unexpected(expected)) }
}

/// A whole number without sign.
pub(super) fn integer(lexer: &mut Lexer<'_>, expected: &'static str) -> Parsed<u32> {
    let TokenKind::Number(text) = lexer.peek().kind else { return Err(lexer.unexpected(expected)) };
    let value = text.parse::<u32>().ok().filter(|n| *n <= MAX_NUMBER);
    let value = value.ok_or_else(|| lexer.bad_number(expected))?;
    lexer.next();
    Ok(value)
}

/// A decimal number, perhaps with a minus sign: its value, and whether it was written without a point.
pub(super) fn decimal(lexer: &mut Lexer<'_>, expected: &'static str) -> Parsed<(f64, bool)> {
    let negative = eat(lexer, b"-");
    let TokenKind::Number(text) = lexer.peek().kind else { return Err(lexer.unexpected(expected)) };
    let (value, whole) = decimal_text(text).ok_or_else(|| lexer.bad_number(expected))?;
    lexer.next();
    Ok((if negative { -value } else { value }, whole))
}

/// Digits with at most one point. What `f64` reads beyond that (`1e5`, `inf`) is no number of a job.
fn decimal_text(text: &str) -> Option<(f64, bool)> {
    let plain = text.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    let value = if plain { text.parse::<f64>().ok().filter(|v| v.is_finite()) } else { None };
    value.map(|v| (v, !text.contains('.')))
}

/// `=` and an operand, after the tag's word.
pub(super) fn tag_value(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    expect(lexer, b"=", "`=` and a value")?;
    operand(lexer)
}

/// A number or variable, without operators.
pub(super) fn operand(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let column = lexer.column();
    let node = match lexer.peek().kind {
        TokenKind::Number(_) | TokenKind::Symbol(b"-") => {
            let (value, whole) = decimal(lexer, "a number or variable")?;
            Node::Number { value, whole }
        }
        TokenKind::Word(word) if word.starts_with('$') || is_system(word) => system(lexer),
        _ => Node::Variable(variable(lexer, "a number or variable")?),
    };
    let expression = Expression { column, node };
    require(&expression, &[Kind::Number], "a number")?;
    Ok(expression)
}

/// A literal operand must lie in the range; variables are checked when they are read.
pub(super) fn check_range(e: &Expression, what: &'static str, min: f64, max: f64) -> Parsed<()> {
    match e.node {
        Node::Number { value, .. } if !(min..=max).contains(&value) => {
            Err(Fault { column: e.column, mistake: Mistake::OutOfRange { what, value, min, max } })
        }
        _ => Ok(()),
    }
}

/// A variable of any kind.
pub(super) fn variable(lexer: &mut Lexer<'_>, expected: &'static str) -> Parsed<Variable> {
    let token = lexer.peek();
    let TokenKind::Word(word) = token.kind else { return Err(lexer.unexpected(expected)) };
    let (local, kind, digits) = split_variable(word).ok_or_else(|| lexer.unexpected(expected))?;
    lexer.next();
    let index = if digits.is_empty() {
        expect(lexer, b"[", expected)?;
        lexer.enter()?;
        let inner = Box::new(number(lexer)?);
        lexer.leave();
        expect(lexer, b"]", "`]`")?;
        fixed_or_computed(inner)
    } else {
        let fault = || {
            let mistake =
                Mistake::BadNumber { found: word.into(), expected: "a variable such as B000 or LI010" };
            Fault { column: column(token.start), mistake }
        };
        Index::Fixed(digits.parse::<u32>().ok().filter(|n| *n <= MAX_NUMBER).ok_or_else(fault)?)
    };
    Ok(Variable { column: column(token.start), local, kind, index })
}

/// A variable that counts: B, I or D.
pub(super) fn counter(lexer: &mut Lexer<'_>) -> Parsed<Variable> {
    of_kind(lexer, "a B, I or D variable", |k| {
        matches!(k, VariableKind::B | VariableKind::I | VariableKind::D)
    })
}

/// A variable that holds a number: B, I, D or R.
pub(super) fn numeric_variable(lexer: &mut Lexer<'_>) -> Parsed<Variable> {
    of_kind(lexer, "a B, I, D or R variable", |k| k.range().is_some())
}

fn of_kind(
    lexer: &mut Lexer<'_>,
    expected: &'static str,
    fits: impl Fn(VariableKind) -> bool,
) -> Parsed<Variable> {
    let place = lexer.clone();
    let variable = variable(lexer, expected)?;
    if fits(variable.kind) { Ok(variable) } else { Err(place.unexpected(expected)) }
}

/// Whether the word is a variable, or one's letters before a bracket.
pub(super) fn is_variable(word: &str) -> bool {
    split_variable(word).is_some()
}

/// Whether the word is a string variable.
pub(super) fn is_text_variable(word: &str) -> bool {
    split_variable(word).is_some_and(|(_, kind, _)| kind == VariableKind::S)
}

/// Whether a position variable is next.
pub(super) fn is_position_variable(lexer: &Lexer<'_>) -> bool {
    let TokenKind::Word(word) = lexer.peek().kind else { return false };
    split_variable(word).is_some_and(|(_, kind, digits)| {
        let mut ahead = lexer.clone();
        ahead.next();
        kind.is_position() && (!digits.is_empty() || ahead.peek().kind == TokenKind::Symbol(b"["))
    })
}

/// Whether the word is a local variable with its number: `LB000`.
pub(in super::super) fn is_local_name(word: &str) -> bool {
    split_variable(word).is_some_and(|(local, _, digits)| local && !digits.is_empty())
}

/// `LP007` is local, P, "007"; `P` before a bracket has no digits.
fn split_variable(word: &str) -> Option<(bool, VariableKind, &str)> {
    let of = |text: &str| {
        VariableKind::NAMES.into_iter().find_map(|(letters, kind)| {
            let digits = text.strip_prefix(letters)?;
            digits.bytes().all(|b| b.is_ascii_digit()).then_some((kind, letters.len()))
        })
    };
    if let Some((kind, letters)) = of(word) {
        return Some((false, kind, word.get(letters..)?));
    }
    let local = word.strip_prefix('L')?;
    of(local).and_then(|(kind, letters)| Some((true, kind, local.get(letters..)?)))
}

/// A signal such as `IN#(3)`.
pub(super) fn signal(lexer: &mut Lexer<'_>, expected: &'static str) -> Parsed<SignalReference> {
    let TokenKind::Word(word) = lexer.peek().kind else { return Err(lexer.unexpected(expected)) };
    let found = SignalKind::NAMES.iter().find(|(name, _)| *name == word);
    let (_, kind) = found.ok_or_else(|| lexer.unexpected(expected))?;
    lexer.next();
    Ok(SignalReference { kind: *kind, number: hash_number(lexer)? })
}

/// `#(n)` behind a name.
pub(super) fn hash_number(lexer: &mut Lexer<'_>) -> Parsed<Index> {
    Ok(fixed_or_computed(Box::new(hash_expression(lexer)?)))
}

/// `#(n)` behind a name, as an expression.
pub(super) fn hash_expression(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    expect(lexer, b"#", "`#(` and a number")?;
    parenthesised(lexer)
}

/// `(n)`.
pub(super) fn parenthesised(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    expect(lexer, b"(", "`(` and a number")?;
    lexer.enter()?;
    let inner = number(lexer)?;
    lexer.leave();
    check_range(&inner, "the number", 0.0, f64::from(MAX_NUMBER))?;
    if let Node::Number { value, whole: false } = inner.node {
        let mistake = Mistake::BadNumber { found: value.to_string(), expected: "a whole number" };
        return Err(Fault { column: inner.column, mistake });
    }
    expect(lexer, b")", "`)`")?;
    Ok(inner)
}

fn fixed_or_computed(inner: Box<Expression>) -> Index {
    match inner.node {
        // In range and whole: the cast is exact.
        Node::Number { value, whole: true } if (0.0..=f64::from(MAX_NUMBER)).contains(&value) => {
            Index::Fixed(value as u32)
        }
        _ => Index::Computed(inner),
    }
}

/// A frame: BF, RF, TF, MTF, UF#(n).
pub(super) fn frame(lexer: &mut Lexer<'_>) -> Parsed<FrameTag> {
    const EXPECTED: &str = "a coordinate system: BF, RF, TF, UF#(n) or MTF";
    let TokenKind::Word(word) = lexer.peek().kind else { return Err(lexer.unexpected(EXPECTED)) };
    let frame = match word {
        "BF" => FrameTag::Base,
        "RF" => FrameTag::Robot,
        "TF" => FrameTag::Tool,
        "MTF" => FrameTag::MasterTool,
        "UF" => {
            lexer.next();
            return Ok(FrameTag::User(hash_number(lexer)?));
        }
        _ => return Err(lexer.unexpected(EXPECTED)),
    };
    lexer.next();
    Ok(frame)
}

/// Flags (`FL010`), timer flags (`TF001`), timers (`TM000`) and registers (`MREG#(5)`).
pub(super) fn is_system(word: &str) -> bool {
    let digits =
        |rest: Option<&str>| rest.is_some_and(|r| !r.is_empty() && r.bytes().all(|b| b.is_ascii_digit()));
    matches!(word, "MREG" | "IARG" | "FL")
        || digits(word.strip_prefix("FL"))
        || digits(word.strip_prefix("TF"))
        || digits(word.strip_prefix("TM"))
}

pub(super) fn system(lexer: &mut Lexer<'_>) -> Node {
    Node::System(system_name(lexer))
}

/// The name of a system variable with its number in brackets, as written.
pub(super) fn system_name(lexer: &mut Lexer<'_>) -> String {
    let chunk = lexer.clone().name();
    let TokenKind::Text(bytes) = chunk.kind else { return String::new() };
    // The name ends before an operator: letters and digits, then perhaps `#(…)` or `[…]`.
    let word = lexer.next();
    let length = word.end - word.start;
    let rest = bytes.get(length..).unwrap_or_default();
    let close = match rest.first() {
        Some(b'#') => Some(b')'),
        Some(b'[') => Some(b']'),
        _ => None,
    };
    let extra = close.and_then(|c| rest.iter().position(|b| *b == c)).map_or(0, |i| i + 1);
    lexer.move_to(word.end + extra);
    printable(bytes.get(..length + extra).unwrap_or_default())
}
