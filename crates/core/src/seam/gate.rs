//! Spikes, found among their neighbours on both sides: a Hampel filter.
//!
//! Of the five readings before and after one, the common slope is removed, and the reading is a spike if it lies farther from their
//! median than four standard deviations, told from the median deviation. A real step in the seam has neighbours on its side and passes; a
//! gate that knew only what came before would hold it back. The price is five readings of look-ahead.

use super::Offset;
use super::measurement::Rejection;

/// Readings looked at on either side.
pub(super) const REACH: usize = 5;
const WINDOW: usize = 2 * REACH + 1;
/// A deviation up to this is no spike, in metres: noise of a good sensor has nothing to be gated.
const LEAST: f64 = 0.3e-3;
/// Standard deviation of normal noise over its median deviation.
const NORMAL: f64 = 1.48;
/// Neighbours farther along the path than this say nothing, in metres.
const NEIGHBOURHOOD: f64 = 0.02;

/// A reading as a point of the seam.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Sighting {
    pub(super) exposure: f64,
    pub(super) s: f64,
    pub(super) offset: Offset,
    /// The sensor's other signals say that it shows a tack weld.
    pub(super) tack: bool,
}

/// The last readings in the order of their exposure.
#[derive(Debug, Clone)]
pub(super) struct Gate {
    held: [Sighting; WINDOW],
    count: usize,
    /// How many of them, from the oldest on, have been judged.
    judged: usize,
}

impl Gate {
    pub(super) fn new() -> Self {
        Self { held: [Sighting::default(); WINDOW], count: 0, judged: 0 }
    }

    /// Takes a reading at its place in time.
    pub(super) fn insert(&mut self, sighting: Sighting) -> Result<(), Rejection> {
        let held = &self.held[..self.count];
        let place = held.partition_point(|other| other.exposure < sighting.exposure);
        if held.get(place).is_some_and(|other| other.exposure == sighting.exposure) {
            return Err(Rejection::Repeated);
        }
        if place < self.judged {
            return Err(Rejection::OutOfOrder);
        }
        // There is room: `judge` leaves less than a window behind.
        self.held[place..].rotate_right(1);
        self.held[place] = sighting;
        self.count += 1;
        Ok(())
    }

    /// The oldest reading not judged yet, and whether it is good; `None` where neighbours are still to come. With `flush` none are.
    pub(super) fn judge(&mut self, flush: bool) -> Option<(Sighting, bool)> {
        let pending = self.count - self.judged;
        if pending == 0 || (!flush && pending <= REACH) {
            return None;
        }
        let sighting = self.held[self.judged];
        let from = self.judged.saturating_sub(REACH);
        let to = (self.judged + REACH + 1).min(self.count);
        let good = fits(&sighting, &self.held[from..to]);
        self.judged += 1;
        if self.judged > REACH {
            self.held.rotate_left(1);
            (self.count, self.judged) = (self.count - 1, self.judged - 1);
        }
        Some((sighting, good))
    }
}

fn fits(sighting: &Sighting, window: &[Sighting]) -> bool {
    let mut near = [Sighting::default(); WINDOW];
    let mut count = 0;
    for other in window.iter().filter(|other| (other.s - sighting.s).abs() <= NEIGHBOURHOOD) {
        near[count] = *other;
        count += 1;
    }
    let near = &near[..count];
    // Of three or four, two bad ones would outvote the good.
    count < REACH || (0..2).all(|axis| fits_on_axis(sighting, near, axis))
}

fn fits_on_axis(sighting: &Sighting, near: &[Sighting], axis: usize) -> bool {
    let half = near.len() / 2;
    let mut values = [0.0; WINDOW];
    // The median of slopes over half the window each.
    let slopes = &mut values[..near.len() - half];
    for (slope, (early, late)) in slopes.iter_mut().zip(near.iter().zip(&near[half..])) {
        let way = late.s - early.s;
        // A torch that stands still shows no slope.
        *slope = if way.abs() > 1e-6 { (late.offset[axis] - early.offset[axis]) / way } else { 0.0 };
    }
    let slope = median(slopes);
    let level = |other: &Sighting| other.offset[axis] - slope * (other.s - sighting.s);
    let values = &mut values[..near.len()];
    for (value, other) in values.iter_mut().zip(near) {
        *value = level(other);
    }
    let middle = median(values);
    for value in values.iter_mut() {
        *value = (*value - middle).abs();
    }
    let spread = median(values);
    (sighting.offset[axis] - middle).abs() <= (4.0 * NORMAL * spread).max(LEAST)
}

/// The middle one of some numbers, the upper of two; zero of none. Leaves them in another order.
pub(super) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
