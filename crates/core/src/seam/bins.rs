//! Readings gathered by path length, so that what a fit costs depends neither on the sensor's rate nor on how long the torch stands.

use super::Offset;
use crate::math::float::floor;

/// Bins held.
const CAPACITY: usize = 256;
/// A bin that has this many readings lets old ones fade.
const MEMORY: f64 = 16.0;
/// No bin.
const NONE: i64 = i64::MIN;

/// The mean of the readings on a short piece of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bin {
    number: i64,
    pub(super) count: f64,
    pub(super) s: f64,
    pub(super) offset: Offset,
}

/// A ring of bins, each `width` metres of the path.
#[derive(Debug, Clone)]
pub(super) struct Bins {
    ring: [Bin; CAPACITY],
    width: f64,
    /// Where the farthest reading lies; minus infinity before the first one.
    seen_to: f64,
}

impl Bins {
    pub(super) fn new(width: f64) -> Self {
        let empty = Bin { number: NONE, count: 0.0, s: 0.0, offset: Offset::zeros() };
        Self { ring: [empty; CAPACITY], width, seen_to: f64::NEG_INFINITY }
    }

    /// Where the farthest reading lies.
    pub(super) fn seen_to(&self) -> f64 {
        self.seen_to
    }

    pub(super) fn add(&mut self, s: f64, offset: Offset) {
        let number = self.number(s);
        let bin = &mut self.ring[slot(number)];
        if bin.number > number {
            // Long behind the torch.
            return;
        }
        if bin.number < number {
            *bin = Bin { number, count: 0.0, s, offset };
        }
        bin.count = (bin.count + 1.0).min(MEMORY);
        bin.s += (s - bin.s) / bin.count;
        bin.offset += (offset - bin.offset) / bin.count;
        self.seen_to = self.seen_to.max(s);
    }

    /// Forgets the readings between two coordinates.
    pub(super) fn clear(&mut self, from: f64, to: f64) {
        let (first, last) = (self.number(from), self.number(to));
        for number in first..=last.min(first + CAPACITY as i64 - 1) {
            let bin = &mut self.ring[slot(number)];
            if bin.number == number {
                bin.count = 0.0;
            }
        }
        if self.seen_to >= from && self.seen_to <= to {
            self.seen_to = self
                .nearest_before(from, from - CAPACITY as f64 * self.width)
                .map_or(f64::NEG_INFINITY, |bin| bin.s);
        }
    }

    /// The bins with readings from one coordinate to another, in order; the last 256 bins' length at most.
    pub(super) fn between(&self, from: f64, to: f64) -> impl Iterator<Item = &Bin> {
        let (first, last) = (self.number(from), self.number(to));
        let first = first.max(last - CAPACITY as i64 + 1);
        (first..=last).filter_map(|number| self.bin(number)).filter(move |bin| from <= bin.s && bin.s <= to)
    }

    /// The bin nearest to `s` with readings at or before it, not before `least`.
    pub(super) fn nearest_before(&self, s: f64, least: f64) -> Option<&Bin> {
        let (first, last) = (self.number(least), self.number(s));
        let first = first.max(last - CAPACITY as i64 + 1);
        (first..=last).rev().filter_map(|number| self.bin(number)).find(|bin| bin.s <= s)
    }

    /// The bin nearest to `s` with readings after it, not after `greatest`.
    pub(super) fn nearest_after(&self, s: f64, greatest: f64) -> Option<&Bin> {
        let (first, last) = (self.number(s), self.number(greatest));
        let last = last.min(first + CAPACITY as i64 - 1);
        (first..=last).filter_map(|number| self.bin(number)).find(|bin| bin.s > s)
    }

    fn bin(&self, number: i64) -> Option<&Bin> {
        let bin = &self.ring[slot(number)];
        (bin.number == number && bin.count > 0.0).then_some(bin)
    }

    fn number(&self, s: f64) -> i64 {
        floor(s / self.width) as i64
    }
}

fn slot(number: i64) -> usize {
    number.rem_euclid(CAPACITY as i64) as usize
}
