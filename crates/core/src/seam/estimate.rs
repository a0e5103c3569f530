//! Where the seam is at a knot, from the readings around it: seen, bridged, or guessed.

use super::Offset;
use super::bins::Bins;
use super::regression::{Polynomial, Window, fit};
use super::settings::Design;

/// A gap is bridged up to this length, in metres.
const LONGEST_BRIDGE: f64 = 30e-3;
/// Readings on either side of a gap that its bridge rests on, in metres.
const ABUTMENT: f64 = 14e-3;
/// With this much of the far side seen the bridge is a cubic, in metres, ...
const CUBIC: f64 = 9e-3;
/// ... and with this much it may be built.
const FAR_SIDE: f64 = 10e-3;
/// Least length of readings that a guess rests on, in metres.
const FOOTING: f64 = 2e-3;
/// Where the window has one side only, it is so much wider.
const ONE_SIDED: f64 = 1.6;
/// A trend is followed for this length, and fades out over the same again, in metres.
const TREND: f64 = 10e-3;

/// What is known about a knot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Estimate {
    /// Readings lie on both sides, or near enough.
    Seen(Polynomial),
    /// The seam was seen up to here, and then no more.
    Lost(Trend),
    /// The seam begins, or comes back, ahead; its course there is known well, or not yet.
    Ahead { trend: Trend, firm: bool },
    /// Nothing is known.
    Nothing,
}

/// A straight continuation beyond the last reading, or before the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Trend {
    pub(super) from: f64,
    offset: Offset,
    slope: Offset,
}

impl Trend {
    /// Straight on for 10 mm, then ever flatter over another 10.
    pub(super) fn at(&self, s: f64) -> Offset {
        let way = s - self.from;
        let far = way.abs();
        let bend = (far - TREND).clamp(0.0, TREND);
        let reach = far.min(TREND) + bend - 0.5 * bend * bend / TREND;
        self.offset + self.slope * if way < 0.0 { -reach } else { reach }
    }

    /// Whether it has come to an end before `s`.
    pub(super) fn is_over(&self, s: f64) -> bool {
        (s - self.from).abs() >= 2.0 * TREND
    }
}

/// The seam at the knot `s`; `None` where it is worth waiting for more readings. Once `due` there is no waiting.
///
/// Cost: one fit, at most.
pub(super) fn estimate(bins: &Bins, design: &Design, s: f64, due: bool) -> Option<Estimate> {
    let (half, seen_to) = (design.half, bins.seen_to());
    if !due && seen_to < s + half {
        return None;
    }
    let before = bins.nearest_before(s, s - LONGEST_BRIDGE).map(|bin| bin.s);
    let after = bins.nearest_after(s, s + LONGEST_BRIDGE).map(|bin| bin.s);
    let footed = after.is_some_and(|after| seen_to - after >= FOOTING);
    let estimate = match (before, after) {
        (Some(before), Some(after)) if after - before <= design.gap => {
            local(bins, s, half).map(Estimate::Seen)
        }
        (Some(before), Some(after)) if after - before <= LONGEST_BRIDGE && footed => {
            if !due && seen_to < after + FAR_SIDE {
                return None;
            }
            bridge(bins, before, after, seen_to).map(Estimate::Seen)
        }
        _ if !due => return None,
        (Some(before), Some(after)) if after - before > LONGEST_BRIDGE => ahead(bins, after, design),
        (Some(before), None) if s - before <= design.spacing => local(bins, s, half).map(Estimate::Seen),
        (Some(before), _) => trend(bins, before, design, half).map(Estimate::Lost),
        (None, Some(after)) => ahead(bins, after, design),
        (None, None) => None,
    };
    Some(estimate.unwrap_or(Estimate::Nothing))
}

fn local(bins: &Bins, s: f64, half: f64) -> Option<Polynomial> {
    let covered = bins.nearest_before(s - 0.6 * half, s - half).is_some()
        && bins.nearest_after(s + 0.6 * half, s + half).is_some();
    let half = if covered { half } else { ONE_SIDED * half };
    fit(bins, Window::Tricube { centre: s, half }, 2)
}

fn bridge(bins: &Bins, before: f64, after: f64, seen_to: f64) -> Option<Polynomial> {
    let degree = if seen_to - after > CUBIC { 3 } else { 2 };
    fit(bins, Window::Even { from: before - ABUTMENT, to: after + ABUTMENT }, degree)
}

fn ahead(bins: &Bins, after: f64, design: &Design) -> Option<Estimate> {
    let length = bins.seen_to() - after;
    let firm = length >= design.half;
    trend(bins, after, design, length).map(|trend| Estimate::Ahead { trend, firm })
}

/// The seam's course at the end of the readings, of which `length` is known there.
fn trend(bins: &Bins, at: f64, design: &Design, length: f64) -> Option<Trend> {
    let degree = match length {
        _ if length >= design.half => 2,
        _ if length >= FOOTING => 1,
        _ => 0,
    };
    let window = Window::Tricube { centre: at, half: ONE_SIDED * design.half };
    let course = fit(bins, window, degree)?;
    Some(Trend { from: at, offset: course.at(at), slope: course.slope(at) })
}
