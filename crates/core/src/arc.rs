//! What stands between the cycle and the welding power source.

/// The arc voltage as welders set it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ArcVoltage {
    /// Volts.
    Volts(f64),
    /// Fraction of the power source's own (synergic) value; 1 is that value.
    Synergic(f64),
}

/// What the power source is set to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcSetting {
    /// Welding current in A.
    pub current: f64,
    /// Arc voltage.
    pub voltage: ArcVoltage,
}

impl Default for ArcSetting {
    fn default() -> Self {
        Self::NONE
    }
}

impl ArcSetting {
    /// Nothing set: before a job sets anything.
    pub const NONE: Self = Self { current: 0.0, voltage: ArcVoltage::Synergic(1.0) };
}

/// What the cycle wants of the power source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcCommand {
    /// The arc shall burn.
    pub on: bool,
    /// How.
    pub setting: ArcSetting,
}

/// A welding power source, simulated or real.
pub trait ArcSource {
    /// Hands over the command of this cycle; returns whether the arc burns, as the source's current relay says. `None` where the source gives
    /// no such signal: the arc is then believed to burn whenever it shall.
    ///
    /// Called once per period (seconds); neither allocates nor blocks.
    fn exchange(&mut self, command: &ArcCommand, period: f64) -> Option<bool>;
}
