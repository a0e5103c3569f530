//! Conditions on signals, with every variable replaced by its value.

use super::expression::{Operator, SignalKind};

/// A condition that only signals can still change.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// Known already.
    Constant(bool),
    /// A comparison.
    Comparison {
        /// Left side.
        left: Side,
        /// A comparing operator.
        operator: Operator,
        /// Right side.
        right: Side,
    },
    /// NOT.
    Not(Box<Condition>),
    /// Both.
    And(Box<Condition>, Box<Condition>),
    /// Either.
    Or(Box<Condition>, Box<Condition>),
}

/// One side of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    /// A number; ON is 1, OFF is 0.
    Value(f64),
    /// A signal's value.
    Signal {
        /// Its kind.
        kind: SignalKind,
        /// Its number.
        number: u32,
    },
}

impl Condition {
    /// Whether it holds, where `signal` answers for the signals (0 or 1, or a group's bits).
    pub fn holds(&self, signal: &mut impl FnMut(SignalKind, u32) -> u32) -> bool {
        match self {
            Self::Constant(value) => *value,
            Self::Comparison { left, operator, right } => {
                compare(left.value(signal), *operator, right.value(signal))
            }
            Self::Not(inner) => !inner.holds(signal),
            Self::And(left, right) => left.holds(signal) && right.holds(signal),
            Self::Or(left, right) => left.holds(signal) || right.holds(signal),
        }
    }
}

impl Side {
    fn value(self, signal: &mut impl FnMut(SignalKind, u32) -> u32) -> f64 {
        match self {
            Self::Value(value) => value,
            Self::Signal { kind, number } => f64::from(signal(kind, number)),
        }
    }
}

/// A comparison of two values that have an order; false for operators that do not compare.
pub(super) fn compare<T: PartialOrd>(left: T, operator: Operator, right: T) -> bool {
    match operator {
        Operator::Equal => left == right,
        Operator::NotEqual => left != right,
        Operator::Less => left < right,
        Operator::LessEqual => left <= right,
        Operator::Greater => left > right,
        Operator::GreaterEqual => left >= right,
        _ => false,
    }
}
