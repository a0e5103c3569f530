//! How jobs are read: units, position levels, speeds that a move leaves out, inputs.

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

/// Inputs of the cell while it is simulated, and what to do about the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Io {
    /// The value of an input that no script names.
    pub unscripted: UnscriptedInput,
    /// What a WAIT without time limit does when the scripts never meet its condition.
    pub unmet_wait: UnmetWait,
    /// The scripted inputs, by ascending number.
    pub inputs: Vec<ScriptedInput>,
}

/// The value of an input that no script names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnscriptedInput {
    /// Reads as off.
    Off,
    /// Reads as on.
    On,
    /// A job that reads it is refused with its line.
    Refuse,
}

/// What a WAIT without time limit does when the scripts never meet its condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnmetWait {
    /// Goes on at once; the run reports it.
    Pass,
    /// Stops the job with an error that names the line.
    Stop,
}

/// An input that changes at given times.
#[derive(Debug, Clone, PartialEq)]
pub struct ScriptedInput {
    /// Number n of IN#(n), from 1.
    pub number: u32,
    /// The value from the start.
    pub initial: bool,
    /// Times in seconds from the start of the job at which the value changes over, ascending.
    pub toggles: Vec<f64>,
}

impl ScriptedInput {
    /// The value at a time in seconds from the start of the job; a change shows from its own instant on.
    #[must_use]
    pub fn at(&self, time: f64) -> bool {
        let changes = self.toggles.iter().filter(|&&toggle| toggle <= time).count();
        self.initial ^ (changes % 2 == 1)
    }
}

impl Io {
    /// The script of IN#(number), if it has one.
    #[must_use]
    pub fn input(&self, number: u32) -> Option<&ScriptedInput> {
        self.inputs.iter().find(|input| input.number == number)
    }

    /// The value of IN#(number) at a time in seconds from the start of the job; none where the cell refuses inputs
    /// without a script.
    #[must_use]
    pub fn at(&self, number: u32, time: f64) -> Option<bool> {
        match (self.input(number), self.unscripted) {
            (Some(input), _) => Some(input.at(time)),
            (None, UnscriptedInput::Off) => Some(false),
            (None, UnscriptedInput::On) => Some(true),
            (None, UnscriptedInput::Refuse) => None,
        }
    }

    pub(super) fn read(mut section: Section<'_>) -> Result<Self, CellError> {
        let unscripted =
            [("off", UnscriptedInput::Off), ("on", UnscriptedInput::On), ("refuse", UnscriptedInput::Refuse)];
        let io = Self {
            unscripted: section.choice("unscripted_input", &unscripted)?,
            unmet_wait: section
                .choice("unmet_wait", &[("pass", UnmetWait::Pass), ("stop", UnmetWait::Stop)])?,
            inputs: section
                .numbered("input", 1..=4096)?
                .into_iter()
                .map(|(number, table)| ScriptedInput::read(number, table))
                .collect::<Result<_, _>>()?,
        };
        section.finish()?;
        Ok(io)
    }
}

impl ScriptedInput {
    fn read(number: u32, mut table: Section<'_>) -> Result<Self, CellError> {
        let initial = table.boolean("value")?;
        let toggles = if table.has("toggle_at_s") {
            table.numbers("toggle_at_s", Unit::Plain, 0.0..=1e6, 0..=10_000)?
        } else {
            Vec::new()
        };
        if !toggles.is_sorted() {
            return Err(table.unexpected("toggle_at_s", "times in ascending order"));
        }
        table.finish()?;
        Ok(Self { number, initial, toggles })
    }
}
