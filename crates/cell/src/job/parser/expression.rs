//! Expressions and conditions, by precedence: OR, AND, NOT, comparison, sum, product, sign.

use super::super::error::Mistake;
use super::super::expression::{Expression, Node, Operator, SignalKind, VariableKind};
use super::super::lexer::{Fault, Lexer, TokenKind, column};
use super::operand::{decimal, eat, eat_word, expect, is_system, signal, system, variable};

type Parsed<T> = Result<T, Fault>;

/// What an expression yields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Number,
    Text,
    Position,
    Condition,
    /// A system variable: known only when it is read.
    Any,
}

/// An expression that yields a number.
pub(super) fn number(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    typed(lexer, &[Kind::Number], "a number")
}

/// An expression that yields a number, or a condition (1 where it holds).
pub(super) fn number_or_condition(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    typed(lexer, &[Kind::Number, Kind::Condition], "a state or a condition")
}

/// An expression that yields a number or a text.
pub(super) fn number_or_text(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    typed(lexer, &[Kind::Number, Kind::Text], "a number or text")
}

/// An expression that yields a text.
pub(super) fn text(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    typed(lexer, &[Kind::Text], "a text in quotes or a string variable")
}

/// A condition.
pub(super) fn condition(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    typed(lexer, &[Kind::Condition], "a comparison such as B000=1")
}

/// An expression that fits a variable of this kind.
pub(super) fn value_for(lexer: &mut Lexer<'_>, kind: VariableKind) -> Parsed<Expression> {
    match kind {
        VariableKind::S => text(lexer),
        _ if kind.is_position() => typed(lexer, &[Kind::Position], "a position variable"),
        _ => number(lexer),
    }
}

fn typed(lexer: &mut Lexer<'_>, kinds: &[Kind], expected: &'static str) -> Parsed<Expression> {
    let parsed = disjunction(lexer)?;
    require(&parsed, kinds, expected)?;
    Ok(parsed)
}

/// The expression must be consistent in itself and yield one of these kinds.
pub(super) fn require(expression: &Expression, kinds: &[Kind], expected: &'static str) -> Parsed<()> {
    let kind = kind_of(expression)?;
    if kind == Kind::Any || kinds.contains(&kind) {
        return Ok(());
    }
    let mistake = Mistake::WrongType { found: name_of(kind), expected };
    Err(Fault { column: expression.column, mistake })
}

fn kind_of(expression: &Expression) -> Parsed<Kind> {
    match &expression.node {
        Node::Number { .. } | Node::State(_) | Node::Signal(_) => Ok(Kind::Number),
        Node::Text(_) => Ok(Kind::Text),
        Node::System(_) => Ok(Kind::Any),
        Node::Variable(variable) => Ok(match variable.kind {
            VariableKind::S => Kind::Text,
            kind if kind.is_position() => Kind::Position,
            _ => Kind::Number,
        }),
        Node::Negated(inner) => require(inner, &[Kind::Number], "a number").map(|()| Kind::Number),
        Node::Not(inner) => require(inner, &[Kind::Condition], "a condition").map(|()| Kind::Condition),
        Node::Binary { operator, left, right } if operator.is_arithmetic() => {
            require(left, &[Kind::Number], "a number")?;
            require(right, &[Kind::Number], "a number")?;
            Ok(Kind::Number)
        }
        Node::Binary { operator, left, right } if operator.is_logical() => {
            require(left, &[Kind::Condition], "a condition")?;
            require(right, &[Kind::Condition], "a condition")?;
            Ok(Kind::Condition)
        }
        Node::Binary { left, right, .. } => {
            require(left, &[Kind::Number, Kind::Text], "a number or text")?;
            match kind_of(left)? {
                Kind::Number => require(right, &[Kind::Number], "a number")?,
                Kind::Text => require(right, &[Kind::Text], "a text")?,
                _ => require(right, &[Kind::Number, Kind::Text], "a number or text")?,
            }
            Ok(Kind::Condition)
        }
    }
}

fn name_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Number => "a number",
        Kind::Text => "a text",
        Kind::Position => "a position",
        Kind::Condition => "a condition",
        Kind::Any => "a system variable",
    }
}

fn disjunction(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let mut left = conjunction(lexer)?;
    while eat_word(lexer, &["OR", "OREXP", "ORIF", "ORIFEXP"]) {
        left = binary(left, Operator::Or, conjunction(lexer)?);
    }
    Ok(left)
}

fn conjunction(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let mut left = negation(lexer)?;
    while eat_word(lexer, &["AND", "ANDEXP", "ANDIF", "ANDIFEXP"]) {
        left = binary(left, Operator::And, negation(lexer)?);
    }
    Ok(left)
}

fn negation(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let column = lexer.column();
    if !eat_word(lexer, &["NOT"]) {
        return comparison(lexer);
    }
    lexer.enter()?;
    let inner = negation(lexer)?;
    lexer.leave();
    Ok(Expression { column, node: Node::Not(Box::new(inner)) })
}

fn comparison(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let left = sum(lexer)?;
    let operator = match lexer.peek().kind {
        TokenKind::Symbol(b"=") => Operator::Equal,
        TokenKind::Symbol(b"<>") => Operator::NotEqual,
        TokenKind::Symbol(b"<") => Operator::Less,
        TokenKind::Symbol(b"<=") => Operator::LessEqual,
        TokenKind::Symbol(b">") => Operator::Greater,
        TokenKind::Symbol(b">=") => Operator::GreaterEqual,
        _ => return Ok(left),
    };
    lexer.next();
    Ok(binary(left, operator, sum(lexer)?))
}

fn sum(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let mut left = product(lexer)?;
    loop {
        let operator = match lexer.peek().kind {
            TokenKind::Symbol(b"+") if !is_second_group(lexer) => Operator::Add,
            TokenKind::Symbol(b"-") => Operator::Subtract,
            _ => return Ok(left),
        };
        lexer.next();
        left = binary(left, operator, product(lexer)?);
    }
}

/// `+MOVJ` behind a condition is no sum.
fn is_second_group(lexer: &Lexer<'_>) -> bool {
    let mut ahead = lexer.clone();
    ahead.next();
    matches!(ahead.peek().kind, TokenKind::Word(word) if super::moves::interpolation(word).is_some())
}

fn product(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let mut left = unary(lexer)?;
    loop {
        let operator = match lexer.peek().kind {
            TokenKind::Symbol(b"*") => Operator::Multiply,
            TokenKind::Symbol(b"/") => Operator::Divide,
            _ => return Ok(left),
        };
        lexer.next();
        let right = unary(lexer)?;
        if operator == Operator::Divide && matches!(right.node, Node::Number { value: 0.0, .. }) {
            return Err(Fault { column: right.column, mistake: Mistake::DivisionByZero });
        }
        left = binary(left, operator, right);
    }
}

fn unary(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let column = lexer.column();
    if !eat(lexer, b"-") {
        return primary(lexer);
    }
    lexer.enter()?;
    let inner = unary(lexer)?;
    lexer.leave();
    let node = match inner.node {
        Node::Number { value, whole } => Node::Number { value: -value, whole },
        _ => Node::Negated(Box::new(inner)),
    };
    Ok(Expression { column, node })
}

fn primary(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    const EXPECTED: &str = "a number, a variable, a signal or `(`";
    let token = lexer.peek();
    let column = column(token.start);
    let node = match token.kind {
        TokenKind::Number(_) => {
            let (value, whole) = decimal(lexer, "a number")?;
            Node::Number { value, whole }
        }
        TokenKind::Text(bytes) => {
            lexer.next();
            Node::Text(bytes.to_vec())
        }
        TokenKind::Symbol(b"(") => {
            lexer.next();
            lexer.enter()?;
            let inner = disjunction(lexer)?;
            lexer.leave();
            expect(lexer, b")", "`)` or an operator")?;
            return Ok(inner);
        }
        TokenKind::Word("ON" | "OFF") => {
            lexer.next();
            Node::State(token.kind == TokenKind::Word("ON"))
        }
        TokenKind::Word(word) if SignalKind::NAMES.iter().any(|(name, _)| *name == word) => {
            Node::Signal(signal(lexer, EXPECTED)?)
        }
        TokenKind::Word(word) if word.starts_with('$') || is_system(word) => system(lexer),
        _ => Node::Variable(variable(lexer, EXPECTED)?),
    };
    Ok(Expression { column, node })
}

fn binary(left: Expression, operator: Operator, right: Expression) -> Expression {
    let column = left.column;
    Expression { column, node: Node::Binary { operator, left: Box::new(left), right: Box::new(right) } }
}
