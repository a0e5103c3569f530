//! The source's filter: the mean of the last readings, here each mean standing where its readings stand on average.

use super::Offset;

/// Most readings in a mean.
pub(super) const CAPACITY: usize = 32;

/// A mean and its place.
type Mean = (f64, Offset);

/// A ring of the last readings, and the last two means.
#[derive(Debug, Clone)]
pub(super) struct MovingMean {
    ring: [(f64, Offset); CAPACITY],
    length: usize,
    taken: u64,
    last: Option<Mean>,
    before: Option<Mean>,
}

impl MovingMean {
    pub(super) fn new(length: usize) -> Self {
        Self {
            ring: [(0.0, Offset::zeros()); CAPACITY],
            length: length.clamp(1, CAPACITY),
            taken: 0,
            last: None,
            before: None,
        }
    }

    pub(super) fn add(&mut self, s: f64, offset: Offset) {
        self.ring[(self.taken % self.length as u64) as usize] = (s, offset);
        self.taken += 1;
        let held = &self.ring[..self.length.min(usize::try_from(self.taken).unwrap_or(CAPACITY))];
        let share = 1.0 / held.len() as f64;
        let mean = held
            .iter()
            .fold((0.0, Offset::zeros()), |sum, one| (sum.0 + one.0 * share, sum.1 + one.1 * share));
        // A torch that stands still, or backs up, moves the mean but not its place.
        if self.last.is_none_or(|(at, _)| mean.0 > at + 1e-6) {
            self.before = self.last;
        }
        self.last = Some(mean);
    }

    /// Where the newest mean stands.
    pub(super) fn seen_to(&self) -> f64 {
        self.last.map_or(f64::NEG_INFINITY, |(at, _)| at)
    }

    /// The mean at a coordinate: between the last two a straight line, beyond them the nearer one.
    pub(super) fn at(&self, s: f64) -> Option<Offset> {
        let last = self.last?;
        let Some(before) = self.before else { return Some(last.1) };
        let fraction = (s - before.0) / (last.0 - before.0);
        Some(before.1 + (last.1 - before.1) * fraction.clamp(0.0, 1.0))
    }
}
