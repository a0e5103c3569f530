//! Variables and computing.

use super::super::error::Mistake;
use super::super::expression::{Expression, Node, SignalKind, Variable, VariableKind};
use super::super::instruction::{Arithmetic, Bitwise, Data, Function, Instruction};
use super::super::lexer::{Fault, Lexer, TokenKind};
use super::{expression, operand};

type Parsed<T> = Result<T, Fault>;

const VARIABLE: &str = "a variable such as B000 or LI010";
const POSITION: &str = "a position variable such as P000 or LP007";

/// The instruction that begins with this word, if it is one of computing.
pub(super) fn instruction(lexer: &mut Lexer<'_>, word: &str) -> Parsed<Option<Instruction>> {
    let data = match word {
        "SET" => return set(lexer).map(Some),
        "CLEAR" => return clear(lexer).map(Some),
        "ADD" => arithmetic(lexer, Arithmetic::Add)?,
        "SUB" => arithmetic(lexer, Arithmetic::Subtract)?,
        "MUL" => arithmetic(lexer, Arithmetic::Multiply)?,
        "DIV" => arithmetic(lexer, Arithmetic::Divide)?,
        "INC" => Data::Step { variable: operand::counter(lexer)?, by: 1 },
        "DEC" => Data::Step { variable: operand::counter(lexer)?, by: -1 },
        "SQRT" => function(lexer, Function::Sqrt)?,
        "SIN" => function(lexer, Function::Sin)?,
        "COS" => function(lexer, Function::Cos)?,
        "ATAN" => function(lexer, Function::Atan)?,
        "AND" => bitwise(lexer, Bitwise::And)?,
        "OR" => bitwise(lexer, Bitwise::Or)?,
        "XOR" => bitwise(lexer, Bitwise::Xor)?,
        "NOT" => bitwise(lexer, Bitwise::Not)?,
        "SETE" => set_element(lexer)?,
        "GETE" => get_element(lexer)?,
        "GETS" => get_system(lexer)?,
        "CNVRT" => convert(lexer)?,
        "GETARG" => get_argument(lexer)?,
        _ => return Ok(None),
    };
    Ok(Some(Instruction::Data(data)))
}

fn set(lexer: &mut Lexer<'_>) -> Parsed<Instruction> {
    let is_signal =
        |word: &str| SignalKind::NAMES.iter().any(|(name, kind)| *name == word && kind.is_output());
    match lexer.peek().kind {
        TokenKind::Word(word) if is_signal(word) => {
            let signal = operand::signal(lexer, "an output")?;
            operand::eat_word(lexer, &["LOGICEXP"]);
            let value = expression::number_or_condition(lexer)?;
            Ok(Instruction::Data(Data::SetSignal { signal, value }))
        }
        TokenKind::Word(word) if operand::is_system(word) => Ok(Instruction::Other { word: "SET".into() }),
        _ => {
            let variable = operand::variable(lexer, VARIABLE)?;
            operand::eat_word(lexer, &["EXPRESS"]);
            let value = expression::value_for(lexer, variable.kind)?;
            check_fits(&variable, &value)?;
            Ok(Instruction::Data(Data::Set { variable, value }))
        }
    }
}

/// A literal that does not fit its variable is found before the job runs.
fn check_fits(variable: &Variable, value: &Expression) -> Parsed<()> {
    match variable.kind.range() {
        Some((what, min, max)) => operand::check_range(value, what, min, max),
        None => Ok(()),
    }
}

fn clear(lexer: &mut Lexer<'_>) -> Parsed<Instruction> {
    match lexer.peek().kind {
        TokenKind::Word("STACK") => {
            lexer.next();
            Ok(Instruction::Data(Data::ClearStack))
        }
        TokenKind::Word(word) if operand::is_variable(word) => {
            let variable = operand::variable(lexer, VARIABLE)?;
            let count =
                if operand::eat_word(lexer, &["ALL"]) { None } else { Some(expression::number(lexer)?) };
            Ok(Instruction::Data(Data::Clear { variable, count }))
        }
        TokenKind::End => Err(lexer.unexpected("a variable, or STACK")),
        _ => Ok(Instruction::Other { word: "CLEAR".into() }),
    }
}

fn arithmetic(lexer: &mut Lexer<'_>, operation: Arithmetic) -> Parsed<Data> {
    let place = lexer.clone();
    let variable = operand::variable(lexer, VARIABLE)?;
    if variable.kind == VariableKind::S {
        return Err(place.unexpected("a variable that holds a number or a position"));
    }
    let scales = matches!(operation, Arithmetic::Multiply | Arithmetic::Divide);
    let has_element = lexer.peek().kind == TokenKind::Symbol(b"(");
    let element = if variable.kind.is_position() && (has_element || scales) {
        Some(operand::parenthesised(lexer)?)
    } else {
        None
    };
    let kind = if element.is_some() { VariableKind::D } else { variable.kind };
    let value = expression::value_for(lexer, kind)?;
    if operation == Arithmetic::Divide && matches!(value.node, Node::Number { value: 0.0, .. }) {
        return Err(Fault { column: value.column, mistake: Mistake::DivisionByZero });
    }
    Ok(Data::Arithmetic { operation, variable, element, value })
}

fn function(lexer: &mut Lexer<'_>, function: Function) -> Parsed<Data> {
    let variable = operand::numeric_variable(lexer)?;
    let value = expression::number(lexer)?;
    match (function, &value.node) {
        (Function::Sqrt, Node::Number { value: v, .. }) if *v < 0.0 => {
            Err(Fault { column: value.column, mistake: Mistake::NegativeRoot { value: *v } })
        }
        _ => Ok(Data::Function { function, variable, value }),
    }
}

fn bitwise(lexer: &mut Lexer<'_>, operation: Bitwise) -> Parsed<Data> {
    let place = lexer.clone();
    let variable = operand::variable(lexer, "a byte variable such as B000")?;
    if variable.kind != VariableKind::B {
        return Err(place.unexpected("a byte variable such as B000"));
    }
    let value = expression::number(lexer)?;
    check_fits(&variable, &value)?;
    Ok(Data::Bitwise { operation, variable, value })
}

fn set_element(lexer: &mut Lexer<'_>) -> Parsed<Data> {
    let variable = position_variable(lexer)?;
    if operand::eat_word(lexer, &["TL"]) {
        return Ok(Data::SetTool { variable, tool: operand::hash_expression(lexer)? });
    }
    let element = element(lexer)?;
    Ok(Data::SetElement { variable, element, value: expression::number(lexer)? })
}

fn get_element(lexer: &mut Lexer<'_>) -> Parsed<Data> {
    let variable = operand::numeric_variable(lexer)?;
    let source = position_variable(lexer)?;
    Ok(Data::GetElement { variable, source, element: element(lexer)? })
}

/// `(n)`: one coordinate of a position, from 1.
fn element(lexer: &mut Lexer<'_>) -> Parsed<Expression> {
    let element = operand::parenthesised(lexer)?;
    operand::check_range(&element, "the element", 1.0, 8.0)?;
    Ok(element)
}

fn get_system(lexer: &mut Lexer<'_>) -> Parsed<Data> {
    let variable = operand::variable(lexer, VARIABLE)?;
    match lexer.peek().kind {
        TokenKind::Word(word) if word.starts_with('$') => {
            Ok(Data::GetSystem { variable, source: operand::system_name(lexer) })
        }
        _ => Err(lexer.unexpected("a system variable such as $PX000")),
    }
}

fn convert(lexer: &mut Lexer<'_>) -> Parsed<Data> {
    let variable = position_variable(lexer)?;
    let source = position_variable(lexer)?;
    let frame = operand::frame(lexer)?;
    let tool = if operand::eat_word(lexer, &["TL"]) { Some(operand::hash_expression(lexer)?) } else { None };
    Ok(Data::Convert { variable, source, frame, tool })
}

fn get_argument(lexer: &mut Lexer<'_>) -> Parsed<Data> {
    let variable = operand::variable(lexer, VARIABLE)?;
    if !operand::eat_word(lexer, &["IARG"]) {
        return Err(lexer.unexpected("IARG#(n)"));
    }
    Ok(Data::GetArgument { variable, number: operand::hash_expression(lexer)? })
}

fn position_variable(lexer: &mut Lexer<'_>) -> Parsed<Variable> {
    if operand::is_position_variable(lexer) {
        operand::variable(lexer, POSITION)
    } else {
        Err(lexer.unexpected(POSITION))
    }
}
