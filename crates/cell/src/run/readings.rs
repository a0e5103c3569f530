//! What became of a seam sensor's readings over a run.

use seamline::seam::{Counts, Rejection};

use crate::sensor::CellSensor;
use crate::sensor::egm::DropReason;

/// Readings by their fate. Each weld counts anew.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Readings {
    taken: u64,
    dropped: [u64; Rejection::ALL.len()],
    /// Of the weld under way.
    present: Counts,
}

impl Readings {
    /// Takes a cycle's counts.
    pub(super) fn push(&mut self, counts: &Counts) {
        if counts.taken < self.present.taken {
            self.close();
        }
        self.present = *counts;
    }

    fn close(&mut self) {
        self.taken += self.present.taken;
        for (sum, rejection) in self.dropped.iter_mut().zip(Rejection::ALL) {
            *sum += self.present.of(rejection);
        }
        self.present = Counts::default();
    }

    /// In words, one line for the readings and one for the datagrams that were none; nothing where there were none.
    pub(super) fn remarks(mut self, sensor: &CellSensor) -> Vec<String> {
        self.close();
        let mut remarks = Vec::new();
        if self.taken > 0 {
            let of =
                Rejection::ALL.iter().zip(self.dropped).map(|(rejection, count)| (rejection.name(), count));
            remarks.push(format!("seam sensor: {} readings, {}", self.taken, dropped(of)));
        }
        if let Some(counts) = sensor.egm().map(|egm| egm.counts()).filter(|counts| counts.dropped() > 0) {
            let of = DropReason::ALL.iter().map(|reason| (reason.name(), counts.of(*reason)));
            remarks.push(format!("EGM: {} datagrams accepted, {}", counts.accepted, dropped(of)));
        }
        remarks
    }
}

fn dropped<'a>(of: impl Iterator<Item = (&'a str, u64)>) -> String {
    let all: Vec<String> =
        of.filter(|(_, count)| *count > 0).map(|(name, count)| format!("{count} {name}")).collect();
    if all.is_empty() { "none dropped".into() } else { format!("dropped: {}", all.join(", ")) }
}
