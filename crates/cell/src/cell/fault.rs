//! Faults that the simulated cell has at given times.

use super::error::CellError;
use super::section::{Section, Unit};

/// What goes wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// The drives no longer answer.
    DriveSilent,
    /// A joint's drive reports an alarm.
    DriveAlarm,
    /// A joint no longer moves.
    JointStuck,
    /// A joint's encoder jumps.
    EncoderJump,
    /// A joint's encoder gives no number.
    EncoderNan,
    /// The emergency stop is pressed.
    EmergencyStop,
    /// All cycles are late from then on.
    LateCycles,
    /// The planner hands out nothing more.
    PlannerSilent,
    /// No strike lights the arc.
    NoIgnition,
    /// The arc goes out.
    ArcLoss,
    /// The seam sensor gives no readings.
    SensorSilent,
    /// The seam sensor gives no numbers.
    SensorNan,
    /// The seam sensor's readings jump aside.
    SensorJump,
}

/// A fault with its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScriptedFault {
    /// What goes wrong.
    pub kind: FaultKind,
    /// When, in seconds from the start of the run.
    pub time: f64,
    /// At which joint, from 0, where it is one joint's.
    pub joint: usize,
}

impl FaultKind {
    /// All kinds with their words in cell files and on the command line.
    pub const ALL: [(&'static str, Self); 13] = [
        ("drive-silent", Self::DriveSilent),
        ("drive-alarm", Self::DriveAlarm),
        ("joint-stuck", Self::JointStuck),
        ("encoder-jump", Self::EncoderJump),
        ("encoder-nan", Self::EncoderNan),
        ("emergency-stop", Self::EmergencyStop),
        ("late-cycles", Self::LateCycles),
        ("planner-silent", Self::PlannerSilent),
        ("no-ignition", Self::NoIgnition),
        ("arc-loss", Self::ArcLoss),
        ("sensor-silent", Self::SensorSilent),
        ("sensor-nan", Self::SensorNan),
        ("sensor-jump", Self::SensorJump),
    ];

    /// The kind with this word.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind)
    }
}

impl ScriptedFault {
    /// By ascending time.
    pub(super) fn read_all(section: &mut Section<'_>, joints: usize) -> Result<Vec<Self>, CellError> {
        let read = |(_, table)| Self::read(table, joints);
        let mut faults =
            section.numbered("fault", 1..=9999)?.into_iter().map(read).collect::<Result<Vec<_>, _>>()?;
        faults.sort_by(|a, b| a.time.total_cmp(&b.time));
        Ok(faults)
    }

    fn read(mut table: Section<'_>, joints: usize) -> Result<Self, CellError> {
        // A robot has fewer joints than a u32 can count.
        let joint =
            if table.has("joint") { table.integer("joint", 1..=joints as u32)? as usize - 1 } else { 0 };
        let fault = Self {
            kind: table.choice("kind", &FaultKind::ALL)?,
            time: table.number("time_s", Unit::Plain, 0.0..=1e6)?,
            joint,
        };
        table.finish()?;
        Ok(fault)
    }
}
