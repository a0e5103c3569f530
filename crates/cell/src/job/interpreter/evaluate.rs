//! Values of operands, expressions and conditions.

use super::super::condition::{Condition, Side, compare};
use super::super::error::Mistake;
use super::super::expression::{Expression, Index, Node, Operator, SignalReference, Variable, VariableKind};
use super::super::lexer::{Fault, printable};
use super::super::position::{JobPosition, PositionKind, PositionName};
use super::super::step::Target;
use super::super::world::World;
use super::Interpreter;
use super::variables::{Value, Variables};

type Evaluated<T> = Result<T, Fault>;

/// Greatest number of a variable or signal.
const MAX_NUMBER: f64 = 99_999.0;

/// Whether a condition's signals are read at once, or stay in it for somebody who waits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Signals {
    Now,
    Later,
}

impl Interpreter {
    /// The scope that a variable lives in.
    fn scope(&self, variable: &Variable) -> &Variables {
        match self.calls.last() {
            Some(call) if variable.local => &call.locals,
            _ => &self.globals,
        }
    }

    pub(super) fn scope_mut(&mut self, variable: &Variable) -> &mut Variables {
        match self.calls.last_mut() {
            Some(call) if variable.local => &mut call.locals,
            _ => &mut self.globals,
        }
    }

    pub(super) fn index(&self, index: &Index, world: &mut impl World) -> Evaluated<u32> {
        match index {
            Index::Fixed(number) => Ok(*number),
            Index::Computed(expression) => self.natural(expression, "the number", MAX_NUMBER, world),
        }
    }

    /// A whole number from 0 to `max`.
    pub(super) fn natural(
        &self,
        expression: &Expression,
        what: &'static str,
        max: f64,
        world: &mut impl World,
    ) -> Evaluated<u32> {
        let value = self.number(expression, world)?;
        if (0.0..=max).contains(&value) && value.fract() == 0.0 {
            // In range and whole: the cast is exact.
            return Ok(value as u32);
        }
        let mistake = Mistake::OutOfRange { what, value, min: 0.0, max };
        Err(Fault { column: expression.column, mistake })
    }

    /// The value of an expression that yields a number; ON is 1, OFF is 0, and so is a condition.
    pub(super) fn number(&self, expression: &Expression, world: &mut impl World) -> Evaluated<f64> {
        match &expression.node {
            Node::Number { value, .. } => Ok(*value),
            Node::State(on) => Ok(f64::from(u8::from(*on))),
            Node::Variable(variable) => {
                let index = self.index(&variable.index, world)?;
                Ok(self.scope(variable).number(variable.kind, index))
            }
            Node::Signal(signal) => Ok(f64::from(self.signal(signal, world)?)),
            Node::Negated(inner) => Ok(-self.number(inner, world)?),
            Node::Binary { operator, left, right } if operator.is_arithmetic() => {
                let (a, b) = (self.number(left, world)?, self.number(right, world)?);
                match operator {
                    Operator::Add => Ok(a + b),
                    Operator::Subtract => Ok(a - b),
                    Operator::Multiply => Ok(a * b),
                    _ if b == 0.0 => Err(Fault { column: right.column, mistake: Mistake::DivisionByZero }),
                    _ => Ok(a / b),
                }
            }
            Node::Not(_) | Node::Binary { .. } => Ok(f64::from(u8::from(self.holds(expression, world)?))),
            Node::System(name) => Err(unavailable(expression.column, name)),
            Node::Text(text) => Err(unavailable(expression.column, &printable(text))),
        }
    }

    /// A number or a text.
    pub(super) fn value(&self, expression: &Expression, world: &mut impl World) -> Evaluated<Value> {
        match &expression.node {
            Node::Text(text) => Ok(Value::Text(text.clone())),
            Node::Variable(variable) if variable.kind == VariableKind::S => {
                let index = self.index(&variable.index, world)?;
                Ok(Value::Text(self.scope(variable).text(index).to_vec()))
            }
            _ => self.number(expression, world).map(Value::Number),
        }
    }

    /// A text, for people.
    pub(super) fn text(&self, expression: &Expression, world: &mut impl World) -> Evaluated<String> {
        Ok(match self.value(expression, world)? {
            Value::Text(text) => printable(&text),
            Value::Number(number) => number.to_string(),
        })
    }

    /// What a signal is now: outputs as the job set them, anything else as the world says.
    pub(super) fn signal(&self, signal: &SignalReference, world: &mut impl World) -> Evaluated<u32> {
        let number = self.index(&signal.number, world)?;
        Ok(if signal.kind.is_output() {
            self.outputs.get(signal.kind, number)
        } else {
            world.input(signal.kind, number)
        })
    }

    /// Whether a condition holds now.
    pub(super) fn holds(&self, expression: &Expression, world: &mut impl World) -> Evaluated<bool> {
        // With every signal read, what is left is a constant.
        Ok(self.condition(expression, Signals::Now, world)? == Condition::Constant(true))
    }

    /// A condition with all variables replaced by their values. What decides it from the left leaves the right
    /// unread.
    pub(super) fn condition(
        &self,
        expression: &Expression,
        signals: Signals,
        world: &mut impl World,
    ) -> Evaluated<Condition> {
        match &expression.node {
            Node::Not(inner) => Ok(match self.condition(inner, signals, world)? {
                Condition::Constant(value) => Condition::Constant(!value),
                other => Condition::Not(Box::new(other)),
            }),
            Node::Binary { operator: Operator::And, left, right } => {
                match self.condition(left, signals, world)? {
                    Condition::Constant(false) => Ok(Condition::Constant(false)),
                    Condition::Constant(true) => self.condition(right, signals, world),
                    left => {
                        Ok(Condition::And(Box::new(left), Box::new(self.condition(right, signals, world)?)))
                    }
                }
            }
            Node::Binary { operator: Operator::Or, left, right } => {
                match self.condition(left, signals, world)? {
                    Condition::Constant(true) => Ok(Condition::Constant(true)),
                    Condition::Constant(false) => self.condition(right, signals, world),
                    left => {
                        Ok(Condition::Or(Box::new(left), Box::new(self.condition(right, signals, world)?)))
                    }
                }
            }
            Node::Binary { operator, left, right } if !operator.is_arithmetic() => {
                self.comparison(left, *operator, right, signals, world)
            }
            _ => Ok(Condition::Constant(self.number(expression, world)? != 0.0)),
        }
    }

    fn comparison(
        &self,
        left: &Expression,
        operator: Operator,
        right: &Expression,
        signals: Signals,
        world: &mut impl World,
    ) -> Evaluated<Condition> {
        let sides = (self.side(left, signals, world)?, self.side(right, signals, world)?);
        if let (Some(left), Some(right)) = sides {
            return Ok(match (left, right) {
                (Side::Value(a), Side::Value(b)) => Condition::Constant(compare(a, operator, b)),
                _ => Condition::Comparison { left, operator, right },
            });
        }
        let texts = (self.value(left, world)?, self.value(right, world)?);
        let (Value::Text(a), Value::Text(b)) = texts else { return Ok(Condition::Constant(false)) };
        Ok(Condition::Constant(compare(a, operator, b)))
    }

    /// One side of a comparison; `None` where it is a text.
    fn side(
        &self,
        expression: &Expression,
        signals: Signals,
        world: &mut impl World,
    ) -> Evaluated<Option<Side>> {
        match &expression.node {
            Node::Text(_) => Ok(None),
            Node::Variable(variable) if variable.kind == VariableKind::S => Ok(None),
            Node::Signal(signal) if signals == Signals::Later && !signal.kind.is_output() => {
                let number = self.index(&signal.number, world)?;
                Ok(Some(Side::Signal { kind: signal.kind, number }))
            }
            _ => Ok(Some(Side::Value(self.number(expression, world)?))),
        }
    }

    /// A position variable with its name.
    pub(super) fn position(&self, variable: &Variable, world: &mut impl World) -> Evaluated<Target> {
        let number = self.index(&variable.index, world)?;
        let kind = match variable.kind {
            VariableKind::Bp => PositionKind::Bp,
            VariableKind::Ex => PositionKind::Ex,
            _ => PositionKind::P,
        };
        let name = PositionName { local: variable.local, kind, number };
        let position: Option<&JobPosition> = self.scope(variable).position(variable.kind, number);
        let position = position.cloned().ok_or_else(|| Fault {
            column: variable.column,
            mistake: Mistake::UnsetPosition { name: name.to_string() },
        })?;
        Ok(Target { name: Some(name), position })
    }
}

pub(super) fn unavailable(column: u32, what: &str) -> Fault {
    Fault { column, mistake: Mistake::Unavailable { what: what.to_owned() } }
}
