//! What is not ideal in the simulated cell.

use super::error::CellError;
use super::fault::ScriptedFault;
use super::seam;
use super::section::{Section, Unit};
use crate::sensor::SeamFeature;

/// What the simulated drives and the simulated sensor add to the ideal. SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// Seed of all random numbers: equal seeds, equal runs.
    pub seed: u32,
    /// Time constant in seconds of each joint's servo loop; 0 follows exactly.
    pub servo_lag: Vec<f64>,
    /// Part of the commanded speed that the servo loops get as feed-forward, 0–1.
    pub velocity_feed_forward: f64,
    /// Step of the simulated encoders in the pulses of [`Joint`](super::Joint); 0 measures exactly.
    pub encoder_step_pulses: f64,
    /// Seconds from the power source's current to the arc.
    pub arc_ignition: f64,
    /// Probability that a strike does not light.
    pub arc_misfire: f64,
    /// The simulated laser's errors.
    pub laser: LaserErrors,
    /// What the simulated seam does beside the taught path.
    pub seam: Vec<SeamFeature>,
    /// What goes wrong in a run, by ascending time.
    pub faults: Vec<ScriptedFault>,
}

/// Errors of the simulated laser. Metres, and probabilities from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaserErrors {
    /// Standard deviation of a reading.
    pub noise: f64,
    /// Size of a spike.
    pub spike: f64,
    /// Probability of a spike.
    pub spike_probability: f64,
    /// Probability that a reading is missing.
    pub dropout_probability: f64,
}

impl Simulation {
    pub(super) fn read(mut section: Section<'_>, joints: usize) -> Result<Self, CellError> {
        let simulation = Self {
            seed: section.integer("seed", 0..=u32::MAX)?,
            servo_lag: section.per_joint("servo_lag_ms", Unit::Milli, 0.0..=1000.0, joints)?,
            velocity_feed_forward: section.number(
                "velocity_feed_forward_percent",
                Unit::Percent,
                0.0..=100.0,
            )?,
            encoder_step_pulses: section.number("encoder_step_pulses", Unit::Plain, 0.0..=1e6)?,
            arc_ignition: section.number("arc_ignition_ms", Unit::Milli, 0.0..=10_000.0)?,
            arc_misfire: section.number("arc_misfire_percent", Unit::Percent, 0.0..=100.0)?,
            laser: LaserErrors {
                noise: section.number("laser_noise_mm", Unit::Milli, 0.0..=10.0)?,
                spike: section.number("laser_spike_mm", Unit::Milli, 0.0..=100.0)?,
                spike_probability: section.number("laser_spike_percent", Unit::Percent, 0.0..=100.0)?,
                dropout_probability: section.number("laser_dropout_percent", Unit::Percent, 0.0..=100.0)?,
            },
            seam: seam::read_all(&mut section)?,
            faults: ScriptedFault::read_all(&mut section, joints)?,
        };
        section.finish()?;
        Ok(simulation)
    }
}
