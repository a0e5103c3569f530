//! Inputs of the cell.

use super::error::CellError;
use super::section::{Section, Unit};

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
