//! What the job has set the outputs to, so that it can read them back.

use std::collections::{BTreeMap, BTreeSet};

use super::super::expression::SignalKind;

/// The outputs that are on. Groups are eight or four single outputs in a row: OG#(1) is OT#(1) to OT#(8).
#[derive(Debug, Clone, Default)]
pub(super) struct Outputs {
    on: BTreeSet<u32>,
    user_groups: BTreeMap<u32, u32>,
}

impl Outputs {
    pub(super) fn get(&self, kind: SignalKind, number: u32) -> u32 {
        match width(kind) {
            Some(width) => points(number, width)
                .enumerate()
                .filter(|(_, point)| self.on.contains(point))
                .fold(0, |bits, (bit, _)| bits | 1 << bit),
            None => self.user_groups.get(&number).copied().unwrap_or(0),
        }
    }

    pub(super) fn set(&mut self, kind: SignalKind, number: u32, value: u32) {
        let Some(width) = width(kind) else {
            self.user_groups.insert(number, value);
            return;
        };
        for (bit, point) in points(number, width).enumerate() {
            if value >> bit & 1 == 1 {
                self.on.insert(point);
            } else {
                self.on.remove(&point);
            }
        }
    }
}

/// How many single outputs a signal stands for; `None` where the controller's settings say so.
fn width(kind: SignalKind) -> Option<u32> {
    match kind {
        SignalKind::Output => Some(1),
        SignalKind::OutputGroup => Some(8),
        SignalKind::OutputHalfGroup => Some(4),
        _ => None,
    }
}

/// The bits that a value sets of a signal; what does not fit is left out, as on the controller.
pub(super) fn bits(kind: SignalKind, value: f64) -> u32 {
    let mask = width(kind).map_or(u32::MAX, |width| (1 << width) - 1);
    // The cast saturates: negative values are 0.
    value as u32 & mask
}

fn points(number: u32, width: u32) -> impl Iterator<Item = u32> {
    let first = number.saturating_sub(1).saturating_mul(width);
    (1..=width).map(move |i| first.saturating_add(i))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_and_points_are_the_same_outputs() {
        let mut outputs = Outputs::default();
        outputs.set(SignalKind::OutputGroup, 2, 0b1001_0001);
        assert_eq!(outputs.get(SignalKind::Output, 9), 1);
        assert_eq!(outputs.get(SignalKind::Output, 10), 0);
        assert_eq!(outputs.get(SignalKind::Output, 16), 1);
        assert_eq!(outputs.get(SignalKind::OutputHalfGroup, 4), 0b1001);
        outputs.set(SignalKind::Output, 10, 1);
        assert_eq!(outputs.get(SignalKind::OutputGroup, 2), 0b1001_0011);
        outputs.set(SignalKind::OutputUserGroup, 2, 77);
        assert_eq!(outputs.get(SignalKind::OutputUserGroup, 2), 77);
    }
}
