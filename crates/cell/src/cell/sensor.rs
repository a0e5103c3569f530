//! The seam sensor.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use super::error::CellError;
use super::section::{Section, Unit};

/// A laser seam sensor at the torch, and what becomes of its readings. SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Where readings come from.
    pub source: SensorSource,
    /// Addresses for readings over EGM.
    pub egm: EgmAddresses,
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
    /// What tells a tack weld from the seam.
    pub tack: Tack,
}

/// Where readings come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SensorSource {
    /// There is no sensor.
    None,
    /// A simulated laser on a simulated seam.
    Simulated,
    /// A recording.
    Replay(PathBuf),
    /// A client that speaks EGM.
    Egm,
}

/// Addresses for readings over EGM.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EgmAddresses {
    /// What the controller binds.
    pub listen: SocketAddr,
    /// Where the client is.
    pub client: SocketAddr,
}

/// What tells a tack weld from the seam. Zero never does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tack {
    /// Rise of the height above its trend.
    pub rise: f64,
    /// Gap below this.
    pub gap: f64,
    /// Quality below this.
    pub quality: f64,
    /// What lasts longer is the seam.
    pub longest: f64,
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
    pub(super) fn read(mut section: Section<'_>, folder: &Path) -> Result<Self, CellError> {
        let source = read_source(&mut section, folder)?;
        let egm =
            EgmAddresses { listen: section.address("egm_listen")?, client: section.address("egm_client")? };
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
            source,
            egm,
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
            tack: Tack {
                rise: section.number("tack_rise_mm", Unit::Milli, 0.0..=100.0)?,
                gap: section.number("tack_gap_mm", Unit::Milli, 0.0..=100.0)?,
                quality: section.number("tack_quality", Unit::Plain, 0.0..=1.0)?,
                longest: section.number("tack_longest_mm", Unit::Milli, 0.1..=500.0)?,
            },
        };
        section.finish()?;
        Ok(sensor)
    }
}

fn read_source(section: &mut Section<'_>, folder: &Path) -> Result<SensorSource, CellError> {
    /// As the file names them.
    #[derive(Clone, Copy, PartialEq)]
    enum Kind {
        None,
        Simulated,
        Replay,
        Egm,
    }
    let kinds =
        [("none", Kind::None), ("simulated", Kind::Simulated), ("replay", Kind::Replay), ("egm", Kind::Egm)];
    let kind = section.choice("source", &kinds)?;
    // A file may name a recording that is not used at the moment.
    let file = section.optional_text("replay_file")?;
    Ok(match (kind, file) {
        (Kind::None, _) => SensorSource::None,
        (Kind::Simulated, _) => SensorSource::Simulated,
        (Kind::Egm, _) => SensorSource::Egm,
        (Kind::Replay, Some(file)) => SensorSource::Replay(folder.join(file)),
        (Kind::Replay, None) => return Err(section.missing("replay_file", "the recording that is replayed")),
    })
}
