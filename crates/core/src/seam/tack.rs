//! Tack welds, told from the seam.
//!
//! A tack stands out of the joint, closes its gap and scatters the laser. A torch that followed it would climb it, so its readings are
//! dropped, with a margin on either side, and it is bridged like a gap.

use super::gate::Sighting;
use super::measurement::Reading;
use crate::math::float::exp;

/// Length over which the height's trend forgets, in metres.
const TREND: f64 = 6e-3;
/// Readings that make a trend.
const FEWEST: f64 = 5.0;
/// A torch that stands still adds up no more than this many.
const MOST: f64 = 200.0;

/// What tells a tack weld. A criterion that is infinite, or zero for the gap and quality, never does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TackMask {
    /// Rise of the height above its trend, in metres.
    pub rise: f64,
    /// Gap below this, in metres.
    pub gap_below: f64,
    /// Quality below this (and not below what the sensor's readings must have at all).
    pub quality_below: f64,
    /// Masked on either side as well, in metres: the tack's flanks.
    pub margin: f64,
    /// What lasts longer is no tack but the seam, in metres.
    pub longest: f64,
}

impl TackMask {
    /// Tacks of up to 30 mm that rise 0.8 mm, with flanks of 2 mm; gap and quality do not count.
    pub const BY_HEIGHT: Self =
        Self { rise: 0.8e-3, gap_below: 0.0, quality_below: 0.0, margin: 2e-3, longest: 30e-3 };

    /// Whether gap and quality say that a reading shows a tack.
    pub(super) fn shown_by(&self, reading: &Reading) -> bool {
        reading.quality < self.quality_below || reading.gap.is_some_and(|gap| gap < self.gap_below)
    }
}

/// What is to be done with a reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Verdict {
    /// It shows the seam.
    Seam,
    /// It shows a tack. Where one begins, what was seen from here on is the tack's flank.
    Tack { flank_from: Option<f64> },
}

/// Watches the readings that come along.
#[derive(Debug, Clone)]
pub(super) struct TackWatch {
    mask: TackMask,
    trend: Trend,
    /// Where the present tack began, and its greatest rise so far.
    present: Option<(f64, f64)>,
    /// To where the last one's flank goes.
    flank_to: f64,
    /// Where the last reading lay.
    seen: f64,
}

impl TackWatch {
    pub(super) fn new(mask: TackMask) -> Self {
        Self {
            mask,
            trend: Trend::default(),
            present: None,
            flank_to: f64::NEG_INFINITY,
            seen: f64::NEG_INFINITY,
        }
    }

    pub(super) fn judge(&mut self, sighting: &Sighting) -> Verdict {
        let (s, height) = (sighting.s, sighting.offset.y);
        // Behind a gap the height may be another one.
        if self.present.is_none() && s - self.seen > TREND {
            self.trend = Trend::default();
        }
        self.seen = s;
        let rise = self.trend.at(s).map_or(0.0, |level| height - level);
        match self.present {
            None if sighting.tack || rise > self.mask.rise => {
                self.present = Some((s, rise));
                return Verdict::Tack { flank_from: Some(s - self.mask.margin) };
            }
            // Its end is half its height down: the trend from before it may be off by then.
            Some((began, top)) if sighting.tack || (rise > 0.5 * top && top > self.mask.rise) => {
                if s - began <= self.mask.longest {
                    self.present = Some((began, top.max(rise)));
                    return Verdict::Tack { flank_from: None };
                }
                *self = Self { seen: s, ..Self::new(self.mask) };
            }
            Some(_) => {
                let flank_to = s + self.mask.margin;
                *self = Self { flank_to, seen: s, ..Self::new(self.mask) };
            }
            None => {}
        }
        if s < self.flank_to {
            return Verdict::Tack { flank_from: None };
        }
        self.trend.add(s, height);
        Verdict::Seam
    }
}

/// A straight line through the last readings' heights, weighted exp(−distance/TREND).
#[derive(Debug, Clone, Copy, Default)]
struct Trend {
    /// Where the newest reading lies; moments count from there.
    at: f64,
    moments: [f64; 3],
    heights: [f64; 2],
}

impl Trend {
    fn add(&mut self, s: f64, height: f64) {
        let way = s - self.at;
        if way > 0.0 {
            let [m0, m1, m2] = self.moments;
            let [h0, h1] = self.heights;
            let keep = exp(-way / TREND);
            self.moments = [m0, m1 - way * m0, m2 + way * (way * m0 - 2.0 * m1)].map(|m| m * keep);
            self.heights = [h0, h1 - way * h0].map(|h| h * keep);
            self.at = s;
        }
        if self.moments[0] > MOST {
            return;
        }
        let x = s - self.at;
        self.moments = [self.moments[0] + 1.0, self.moments[1] + x, self.moments[2] + x * x];
        self.heights = [self.heights[0] + height, self.heights[1] + x * height];
    }

    fn at(&self, s: f64) -> Option<f64> {
        let [m0, m1, m2] = self.moments;
        if m0 < FEWEST {
            return None;
        }
        let [h0, h1] = self.heights;
        let spread = m0 * m2 - m1 * m1;
        // Readings on one spot, to a tenth of a millimetre, have no slope.
        let slope = if spread > m0 * m0 * 1e-8 { (m0 * h1 - m1 * h0) / spread } else { 0.0 };
        Some((h0 - slope * m1) / m0 + slope * (s - self.at))
    }
}
