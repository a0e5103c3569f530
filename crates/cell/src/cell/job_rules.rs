//! How jobs are read: units, position levels, speeds that a move leaves out.

use super::error::CellError;
use super::section::{Section, Unit};

/// What a job leaves to its cell.
#[derive(Debug, Clone, PartialEq)]
pub struct JobRules {
    /// The unit of V in moves.
    pub speed_unit: SpeedUnit,
    /// Corner error in metres of a move without PL.
    pub corner_error: f64,
    /// Corner error in metres of PL 0 (always 0, exact) to PL 8.
    pub position_levels: [f64; 9],
    /// VJ of a joint move where no rule of the job gives one, as a fraction of the joints' speed limits.
    pub joint_speed: f64,
    /// V of a straight or circular move where no rule of the job gives one, in m/s.
    pub speed: f64,
    /// Where a move without V between ARCON and ARCOF takes its speed from.
    pub weld_speed: WeldSpeedRule,
}

/// The unit of V in moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeedUnit {
    /// mm/s, as controllers write it.
    MillimetrePerSecond,
    /// cm/min, as some scripts write it.
    CentimetrePerMinute,
}

impl SpeedUnit {
    /// A speed as written in the job, in m/s.
    #[must_use]
    pub fn to_si(self, value: f64) -> f64 {
        match self {
            Self::MillimetrePerSecond => value / 1000.0,
            Self::CentimetrePerMinute => value / 6000.0,
        }
    }
}

/// Where a move without V between ARCON and ARCOF takes its speed from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeldSpeedRule {
    /// From the ASF condition the arc was lit with.
    Condition,
    /// From the move before.
    LastMove,
}

impl JobRules {
    pub(super) fn read(mut section: Section<'_>) -> Result<Self, CellError> {
        let units = [("mm/s", SpeedUnit::MillimetrePerSecond), ("cm/min", SpeedUnit::CentimetrePerMinute)];
        let rules = [("condition", WeldSpeedRule::Condition), ("last_move", WeldSpeedRule::LastMove)];
        let job = Self {
            speed_unit: section.choice("speed_unit", &units)?,
            corner_error: section.number("corner_error_mm", Unit::Milli, 0.0..=1000.0)?,
            position_levels: read_levels(&mut section)?,
            joint_speed: section.number("joint_speed_percent", Unit::Percent, 0.01..=100.0)?,
            speed: section.number("speed_mm_s", Unit::Milli, 0.1..=10_000.0)?,
            weld_speed: section.choice("missing_weld_speed", &rules)?,
        };
        section.finish()?;
        Ok(job)
    }
}

fn read_levels(section: &mut Section<'_>) -> Result<[f64; 9], CellError> {
    let coarse: [f64; 8] = section.array("position_level_mm", Unit::Milli, 0.0..=1000.0)?;
    if !coarse.is_sorted() {
        return Err(section
            .unexpected("position_level_mm", "8 corner errors (PL 1 to 8), none less than the one before"));
    }
    let mut levels = [0.0; 9];
    levels[1..].copy_from_slice(&coarse);
    Ok(levels)
}
