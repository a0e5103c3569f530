//! The values of variables.

use std::collections::BTreeMap;

use super::super::error::Mistake;
use super::super::expression::VariableKind;
use super::super::position::JobPosition;

/// What an argument or a return value holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Number(f64),
    Text(Vec<u8>),
}

/// Variables of one scope: those of the controller, or those of one call. Numbers are 0 until they are set.
#[derive(Debug, Clone, Default)]
pub(super) struct Variables {
    /// B, I, D and R: all their values are exact in an `f64`.
    numbers: BTreeMap<(VariableKind, u32), f64>,
    texts: BTreeMap<u32, Vec<u8>>,
    positions: BTreeMap<(VariableKind, u32), JobPosition>,
}

impl Variables {
    pub(super) fn number(&self, kind: VariableKind, index: u32) -> f64 {
        self.numbers.get(&(kind, index)).copied().unwrap_or(0.0)
    }

    /// Sets a number; integers take the whole part.
    ///
    /// A result that misses a whole number by rounding only (3 / 0.1 is 29.999…) counts as that number.
    pub(super) fn set_number(&mut self, kind: VariableKind, index: u32, value: f64) -> Result<(), Mistake> {
        const ROUNDING: f64 = 1e-9;
        let Some((what, min, max)) = kind.range() else { return Ok(()) };
        let stored = if kind == VariableKind::R {
            value
        } else {
            let near = value.round();
            if (value - near).abs() <= ROUNDING * value.abs().max(1.0) { near } else { value.trunc() }
        };
        // Not a number fails this comparison too.
        if !(min..=max).contains(&stored) {
            return Err(Mistake::OutOfRange { what, value, min, max });
        }
        self.numbers.insert((kind, index), stored);
        Ok(())
    }

    pub(super) fn text(&self, index: u32) -> &[u8] {
        self.texts.get(&index).map_or(&[], Vec::as_slice)
    }

    pub(super) fn set_text(&mut self, index: u32, text: Vec<u8>) {
        self.texts.insert(index, text);
    }

    pub(super) fn position(&self, kind: VariableKind, index: u32) -> Option<&JobPosition> {
        self.positions.get(&(robot_for_all(kind), index))
    }

    pub(super) fn set_position(&mut self, kind: VariableKind, index: u32, position: JobPosition) {
        self.positions.insert((robot_for_all(kind), index), position);
    }

    /// CLEAR: `count` variables from `index` on, or all of them. Positions are then unset.
    pub(super) fn clear(&mut self, kind: VariableKind, index: u32, count: Option<u32>) {
        let end = count.map_or(u32::MAX, |n| index.saturating_add(n));
        let keep = |i: u32| i < index || i >= end;
        let kind = robot_for_all(kind);
        self.numbers.retain(|(k, i), _| *k != kind || keep(*i));
        self.positions.retain(|(k, i), _| *k != kind || keep(*i));
        if kind == VariableKind::S {
            self.texts.retain(|i, _| keep(*i));
        }
    }
}

/// PX is P where there is neither track nor station.
fn robot_for_all(kind: VariableKind) -> VariableKind {
    if kind == VariableKind::Px { VariableKind::P } else { kind }
}
