//! The seam sensor.

use super::error::CellError;
use super::section::{Section, Unit};

/// A laser seam sensor at the torch, and what becomes of its readings. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Readings per second.
    pub rate_hz: f64,
    /// Seconds from exposure to delivery.
    pub latency: f64,
    /// Distance from the tool centre point to the laser line along the travel.
    pub look_ahead: f64,
    /// Greatest lateral or height offset of a reading that counts.
    pub range: f64,
    /// Least quality (0 to 1) of a reading that counts.
    pub quality_min: f64,
    /// Greatest age in seconds of a reading that counts.
    pub age_max: f64,
    /// How readings become a correction.
    pub filter: SeamFilter,
    /// Greatest change of the correction in one cycle.
    pub change_per_cycle: f64,
    /// Greatest correction in all.
    pub correction_max: f64,
    /// Distance to go on along the last trend once readings stop.
    pub trend: f64,
    /// What comes after the trend.
    pub lost: LostSeam,
}

/// How readings become a correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeamFilter {
    /// Gated local regression over the path length.
    Regression,
    /// Mean of the last good readings.
    Mean {
        /// How many readings.
        readings: u32,
    },
}

/// What to do when the seam stays out of sight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LostSeam {
    /// Stop with the arc off.
    Stop,
    /// Go back to the taught path.
    TaughtPath,
}

impl Sensor {
    pub(super) fn read(mut section: Section<'_>) -> Result<Self, CellError> {
        let rate_hz = section.number("rate_hz", Unit::Plain, 1.0..=10_000.0)?;
        let latency = section.number("latency_ms", Unit::Milli, 0.0..=1000.0)?;
        let look_ahead = section.number("look_ahead_mm", Unit::Milli, 0.0..=500.0)?;
        let range = section.number("range_mm", Unit::Milli, 0.1..=500.0)?;
        let quality_min = section.number("quality_min", Unit::Plain, 0.0..=1.0)?;
        let age_max = section.number("age_max_ms", Unit::Milli, 1.0..=10_000.0)?;
        section.ordered(("latency_ms", latency), ("age_max_ms", age_max))?;
        let mean = section.integer("mean_readings", 1..=1000)?;
        let filters = [("regression", SeamFilter::Regression), ("mean", SeamFilter::Mean { readings: mean })];
        let sensor = Self {
            rate_hz,
            latency,
            look_ahead,
            range,
            quality_min,
            age_max,
            filter: section.choice("filter", &filters)?,
            change_per_cycle: section.number("change_per_cycle_mm", Unit::Milli, 1e-4..=100.0)?,
            correction_max: section.number("correction_max_mm", Unit::Milli, 0.0..=500.0)?,
            trend: section.number("trend_mm", Unit::Milli, 0.0..=1000.0)?,
            lost: section
                .choice("lost_seam", &[("stop", LostSeam::Stop), ("taught_path", LostSeam::TaughtPath)])?,
        };
        section.finish()?;
        Ok(sensor)
    }
}
