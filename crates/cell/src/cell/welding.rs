//! Arc and weave conditions, and what the cell allows while the arc is on.

use seamline::arc::ArcVoltage;

use super::error::CellError;
use super::section::{Section, Unit};

/// The arc voltage as welders set it: in volts, or as a share of the synergic value.
fn voltage(table: &mut Section<'_>) -> Result<ArcVoltage, CellError> {
    if table.alternative("voltage_v", "voltage_percent")? == "voltage_v" {
        table.number("voltage_v", Unit::Plain, 5.0..=100.0).map(ArcVoltage::Volts)
    } else {
        table.number("voltage_percent", Unit::Percent, 50.0..=150.0).map(ArcVoltage::Synergic)
    }
}

/// Arc start condition, ASF#(number).
#[derive(Debug, Clone, PartialEq)]
pub struct ArcStart {
    /// The number jobs call it by.
    pub number: u32,
    /// The name that reports show; may be empty.
    pub name: String,
    /// Welding current in A.
    pub current: f64,
    /// Arc voltage.
    pub voltage: ArcVoltage,
    /// Welding speed in m/s.
    pub speed: f64,
    /// Seconds of gas before the arc is struck.
    pub gas_preflow: f64,
    /// Seconds the torch stands still after the arc is lit.
    pub dwell: f64,
}

/// Arc end condition, AEF#(number).
#[derive(Debug, Clone, PartialEq)]
pub struct ArcEnd {
    /// The number jobs call it by.
    pub number: u32,
    /// The name that reports show; may be empty.
    pub name: String,
    /// Crater current in A.
    pub current: f64,
    /// Crater voltage.
    pub voltage: ArcVoltage,
    /// Seconds the torch stands still to fill the crater.
    pub crater_dwell: f64,
    /// Seconds of gas after the arc is out.
    pub gas_postflow: f64,
}

const CONDITION_CURRENT_A: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

impl ArcStart {
    pub(super) fn read(number: u32, mut table: Section<'_>) -> Result<Self, CellError> {
        let condition = Self {
            number,
            name: table.optional_text("name")?.unwrap_or_default(),
            current: table.number("current_a", Unit::Plain, CONDITION_CURRENT_A)?,
            voltage: voltage(&mut table)?,
            speed: table.number("speed_mm_s", Unit::Milli, 0.1..=500.0)?,
            gas_preflow: table.number("gas_preflow_s", Unit::Plain, 0.0..=60.0)?,
            dwell: table.number("dwell_s", Unit::Plain, 0.0..=60.0)?,
        };
        table.finish()?;
        Ok(condition)
    }
}

impl ArcEnd {
    pub(super) fn read(number: u32, mut table: Section<'_>) -> Result<Self, CellError> {
        let condition = Self {
            number,
            name: table.optional_text("name")?.unwrap_or_default(),
            current: table.number("current_a", Unit::Plain, CONDITION_CURRENT_A)?,
            voltage: voltage(&mut table)?,
            crater_dwell: table.number("crater_dwell_s", Unit::Plain, 0.0..=60.0)?,
            gas_postflow: table.number("gas_postflow_s", Unit::Plain, 0.0..=60.0)?,
        };
        table.finish()?;
        Ok(condition)
    }
}

/// Shape of a weave seen along the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeavePattern {
    /// Sine across the seam.
    Sine,
    /// Straight swings across the seam.
    Triangle,
    /// Figure of eight.
    FigureEight,
    /// Circle.
    Circular,
}

/// How often a weave repeats.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WeaveRate {
    /// Periods per second at the programmed speed.
    Frequency(f64),
    /// Metres of travel per period.
    Wavelength(f64),
}

/// To which side a weave swings first, looking along the travel with the wire pointing down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeaveSide {
    /// Left first.
    Left,
    /// Right first.
    Right,
}

/// Weave condition, WEV#(number).
#[derive(Debug, Clone, PartialEq)]
pub struct Weave {
    /// The number jobs call it by.
    pub number: u32,
    /// The name that reports show; may be empty.
    pub name: String,
    /// The shape.
    pub pattern: WeavePattern,
    /// Greatest distance from the seam to either side, in metres.
    pub amplitude: f64,
    /// How often it repeats.
    pub rate: WeaveRate,
    /// Seconds at the left edge.
    pub dwell_left: f64,
    /// Seconds in the middle.
    pub dwell_centre: f64,
    /// Seconds at the right edge.
    pub dwell_right: f64,
    /// Tilt of the weaving plane about the travel direction, in radians.
    pub angle: f64,
    /// How much higher the edges lie than the middle, in metres.
    pub elevation: f64,
    /// The first swing's side.
    pub first_side: WeaveSide,
}

impl Weave {
    pub(super) fn read(number: u32, mut table: Section<'_>) -> Result<Self, CellError> {
        let patterns = [
            ("sine", WeavePattern::Sine),
            ("triangle", WeavePattern::Triangle),
            ("figure_eight", WeavePattern::FigureEight),
            ("circular", WeavePattern::Circular),
        ];
        let name = table.optional_text("name")?.unwrap_or_default();
        let pattern = table.choice("pattern", &patterns)?;
        let amplitude = table.number("amplitude_mm", Unit::Milli, 0.1..=50.0)?;
        let rate = if table.alternative("frequency_hz", "wavelength_mm")? == "frequency_hz" {
            table.number("frequency_hz", Unit::Plain, 0.1..=20.0).map(WeaveRate::Frequency)?
        } else {
            table.number("wavelength_mm", Unit::Milli, 0.1..=1000.0).map(WeaveRate::Wavelength)?
        };
        let mut dwell = |key| table.number(key, Unit::Plain, 0.0..=10.0);
        let weave = Self {
            number,
            name,
            pattern,
            amplitude,
            rate,
            dwell_left: dwell("dwell_left_s")?,
            dwell_centre: dwell("dwell_centre_s")?,
            dwell_right: dwell("dwell_right_s")?,
            angle: table.number("angle_deg", Unit::Degree, -90.0..=90.0)?,
            elevation: table.number("elevation_mm", Unit::Milli, -50.0..=50.0)?,
            first_side: table
                .choice("first_side", &[("left", WeaveSide::Left), ("right", WeaveSide::Right)])?,
        };
        table.finish()?;
        Ok(weave)
    }
}

/// What the cell allows while the arc is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcPolicy {
    /// Refuse a weld that the arm cannot follow at its programmed speed (otherwise the slowdown is reported).
    pub refuse_slowdown: bool,
    /// How far, as a fraction of the programmed speed, a slowdown may go before it counts as one.
    pub speed_tolerance: f64,
    /// Hold the override at 100 % while the arc is on.
    pub lock_override: bool,
    /// Nothing is lit: jobs run dry.
    pub dry_run: bool,
    /// Seconds that a strike may take.
    pub strike: f64,
    /// How often the arc is struck before it counts as not lit.
    pub strikes: u32,
    /// Seconds between two strikes.
    pub strike_pause: f64,
    /// Seconds without arc that count as its loss.
    pub loss: f64,
    /// How far the torch goes back along the bead after an interruption, in metres.
    pub overlap: f64,
    /// How fast it goes back, in m/s.
    pub back_speed: f64,
    /// Seconds to stand after the arc is lit again.
    pub restart_dwell: f64,
}

impl ArcPolicy {
    pub(super) fn read(mut section: Section<'_>) -> Result<Self, CellError> {
        let policy = Self {
            refuse_slowdown: section.boolean("refuse_slowdown")?,
            speed_tolerance: section.number("speed_tolerance_percent", Unit::Percent, 0.0..=50.0)?,
            lock_override: section.boolean("lock_override")?,
            dry_run: section.boolean("dry_run")?,
            strike: section.number("strike_time_s", Unit::Plain, 0.01..=60.0)?,
            strikes: section.integer("strikes", 1..=20)?,
            strike_pause: section.number("strike_pause_s", Unit::Plain, 0.0..=60.0)?,
            loss: section.number("loss_time_ms", Unit::Milli, 0.0..=10_000.0)?,
            overlap: section.number("overlap_mm", Unit::Milli, 0.0..=100.0)?,
            back_speed: section.number("back_speed_mm_s", Unit::Milli, 1.0..=200.0)?,
            restart_dwell: section.number("restart_dwell_s", Unit::Plain, 0.0..=60.0)?,
        };
        section.finish()?;
        Ok(policy)
    }
}
