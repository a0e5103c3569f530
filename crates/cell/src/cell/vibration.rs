//! What is done about the arm's vibrations: its flexible modes, and the prefilter on the joint commands or the feedrate.

use std::f64::consts::TAU;

use seamline::control::{ActsOn, MODES_MAX};
use seamline::vibration::{Kernel, KernelError, Mode, ModeError, Prefilter};
use thiserror::Error;

use super::error::CellError;
use super::section::{Section, Unit};

/// Longest time that the prefilters may hold a command back, all modes together, in seconds.
const LENGTH_MAX: f64 = 2.0;

/// A vibration of the arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlexibleMode {
    /// Undamped natural frequency in Hz.
    pub frequency_hz: f64,
    /// Damping ratio ζ, 0 ≤ ζ < 0.95.
    pub damping: f64,
}

/// Prefilters on the joint commands or the feedrate, one a flexible mode; none by default.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    prefilter: Prefilter,
    acts_on: ActsOn,
    path_error: f64,
    modes: Vec<FlexibleMode>,
    kernels: Vec<Kernel>,
}

/// Why a prefilter cannot be used in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum VibrationError {
    /// There is nothing to make it for.
    #[error("a [[flexible_mode]] to make the prefilter for")]
    NoMode,
    /// More modes than the cycle has stages.
    #[error("at most {MODES_MAX} [[flexible_mode]] tables with a prefilter, not {0}")]
    TooManyModes(usize),
    /// It would hold commands back too long.
    #[error("a prefilter of at most {LENGTH_MAX} s: for these modes it takes {0:.2} s")]
    TooLong(f64),
    /// A mode that is none.
    #[error("{0}")]
    Mode(#[from] ModeError),
    /// A kernel that there cannot be.
    #[error("{0}")]
    Kernel(#[from] KernelError),
}

impl FlexibleMode {
    pub(super) fn read(mut table: Section<'_>) -> Result<Self, CellError> {
        let mode = Self {
            frequency_hz: table.number("frequency_hz", Unit::Plain, 0.1..=500.0)?,
            damping: table.number("damping", Unit::Plain, 0.0..=0.94)?,
        };
        table.finish()?;
        Ok(mode)
    }
}

impl Vibration {
    /// How far the prefilters may turn the tool off a path, in radians: 0.2°, as at corners.
    pub const TURN_ERROR: f64 = 3.5e-3;

    /// A prefilter on the joint commands for modes, with the distance in metres that it may take the tool off its path.
    ///
    /// # Errors
    /// [`VibrationError`] where this prefilter cannot be made for these modes.
    pub fn try_new(
        prefilter: Prefilter,
        path_error: f64,
        modes: Vec<FlexibleMode>,
    ) -> Result<Self, VibrationError> {
        let mut kernels = Vec::new();
        if prefilter != Prefilter::None {
            match modes.len() {
                0 => return Err(VibrationError::NoMode),
                1..=MODES_MAX => {}
                count => return Err(VibrationError::TooManyModes(count)),
            }
            for mode in &modes {
                kernels.push(prefilter.kernel(&Mode::try_new(TAU * mode.frequency_hz, mode.damping)?)?);
            }
        }
        let length = kernels.iter().map(Kernel::length).sum();
        if length > LENGTH_MAX {
            return Err(VibrationError::TooLong(length));
        }
        Ok(Self { prefilter, acts_on: ActsOn::Joints, path_error, modes, kernels })
    }

    pub(super) fn read(modes: Vec<FlexibleMode>, mut section: Section<'_>) -> Result<Self, CellError> {
        let names = Prefilter::ALL.map(|prefilter| (prefilter.name().to_lowercase(), prefilter));
        let prefilter =
            section.choice("prefilter", &names.each_ref().map(|(name, of)| (name.as_str(), *of)))?;
        let acts_on = section.choice("on", &[("joints", ActsOn::Joints), ("feedrate", ActsOn::Feedrate)])?;
        let path_error = section.number("path_error_mm", Unit::Milli, 0.01..=100.0)?;
        let vibration = Self::try_new(prefilter, path_error, modes)
            .map_err(|error| section.unexpected("prefilter", &error.to_string()))?
            .acting_on(acts_on);
        section.finish()?;
        Ok(vibration)
    }

    /// The same modes with another prefilter.
    ///
    /// # Errors
    /// As [`Vibration::try_new`].
    pub fn with_prefilter(&self, prefilter: Prefilter) -> Result<Self, VibrationError> {
        Ok(Self::try_new(prefilter, self.path_error, self.modes.clone())?.acting_on(self.acts_on))
    }

    /// The same prefilter on something else.
    #[must_use]
    pub fn acting_on(self, acts_on: ActsOn) -> Self {
        Self { acts_on, ..self }
    }

    /// What the prefilter acts on.
    #[must_use]
    pub fn acts_on(&self) -> ActsOn {
        self.acts_on
    }

    /// The prefilter.
    #[must_use]
    pub fn prefilter(&self) -> Prefilter {
        self.prefilter
    }

    /// How far prefilters on the joints may take the tool off a path, in metres.
    #[must_use]
    pub fn path_error(&self) -> f64 {
        self.path_error
    }

    /// The arm's modes.
    #[must_use]
    pub fn modes(&self) -> &[FlexibleMode] {
        &self.modes
    }

    /// The prefilters, one a mode; none where there is no prefilter.
    #[must_use]
    pub fn kernels(&self) -> &[Kernel] {
        &self.kernels
    }
}
