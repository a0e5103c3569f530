//! The way that lies behind: moves that are done and may be run backward.

use super::block::Block;
use super::trail::Way;

/// Moves remembered.
const MOVES: usize = 16;

/// A move with where it begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Done<const N: usize> {
    /// Programme time at its start.
    pub(super) start: f64,
    /// Path covered up to there.
    pub(super) way: Way,
    pub(super) block: Block<N>,
}

/// The last moves, in a ring.
#[derive(Debug, Clone)]
pub(super) struct History<const N: usize> {
    moves: [Option<Done<N>>; MOVES],
    /// How many have been remembered so far.
    count: usize,
}

impl<const N: usize> History<N> {
    pub(super) fn new() -> Self {
        Self { moves: [None; MOVES], count: 0 }
    }

    /// Remembers a move; it began later than all others.
    pub(super) fn push(&mut self, done: Done<N>) {
        self.moves[self.count % MOVES] = Some(done);
        self.count += 1;
    }

    /// The move under way at a programme time; the later one where two meet. `None` before the oldest.
    pub(super) fn at(&self, time: f64) -> Option<&Done<N>> {
        self.latest_first().find(|done| done.start <= time)
    }

    /// The move under way before a programme time; the earlier one where two meet.
    pub(super) fn before(&self, time: f64) -> Option<&Done<N>> {
        self.latest_first().find(|done| done.start < time)
    }

    /// The oldest move that is remembered.
    pub(super) fn oldest(&self) -> Option<&Done<N>> {
        self.latest_first().last()
    }

    fn latest_first(&self) -> impl Iterator<Item = &Done<N>> {
        (1..=MOVES).filter_map(|back| self.moves[(self.count + MOVES - back) % MOVES].as_ref())
    }
}
