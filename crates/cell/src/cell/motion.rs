//! Limits of the tool's motion, the cycle, safety and the drive back end.

use seamline::geometry::Vector3;

use super::error::CellError;
use super::section::{Section, Unit};

/// Limits of the tool centre point's motion along a path. m, rad, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CartesianLimits {
    /// Greatest speed.
    pub speed: f64,
    /// Greatest acceleration along the path.
    pub acceleration: f64,
    /// Greatest jerk along the path.
    pub jerk: f64,
    /// Greatest speed of turning.
    pub rotation_speed: f64,
    /// Greatest acceleration of turning.
    pub rotation_acceleration: f64,
    /// Greatest jerk of turning.
    pub rotation_jerk: f64,
    /// Greatest jerk of a weave pattern, across the path.
    pub weave_jerk: f64,
    /// Greatest jerk of a seam correction, across the path.
    pub correction_jerk: f64,
}

impl CartesianLimits {
    pub(super) fn read(mut section: Section<'_>) -> Result<Self, CellError> {
        let (speed, acceleration, jerk) = (0.001..=1e5, 0.001..=1e6, 0.001..=1e9);
        let limits = Self {
            speed: section.number("speed_mm_s", Unit::Milli, speed.clone())?,
            acceleration: section.number("acceleration_mm_s2", Unit::Milli, acceleration.clone())?,
            jerk: section.number("jerk_mm_s3", Unit::Milli, jerk.clone())?,
            rotation_speed: section.number("rotation_speed_deg_s", Unit::Degree, speed)?,
            rotation_acceleration: section.number(
                "rotation_acceleration_deg_s2",
                Unit::Degree,
                acceleration,
            )?,
            rotation_jerk: section.number("rotation_jerk_deg_s3", Unit::Degree, jerk.clone())?,
            weave_jerk: section.number("weave_jerk_mm_s3", Unit::Milli, jerk.clone())?,
            correction_jerk: section.number("correction_jerk_mm_s3", Unit::Milli, jerk)?,
        };
        section.finish()?;
        Ok(limits)
    }
}

/// The control cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// Seconds from one command to the next, 0.1–20 ms.
    pub period: f64,
}

impl Cycle {
    pub(super) fn read(mut section: Section<'_>) -> Result<Self, CellError> {
        let cycle = Self { period: section.number("period_ms", Unit::Milli, 0.1..=20.0)? };
        section.finish()?;
        Ok(cycle)
    }
}

/// Where the tool centre point may be: an axis-aligned box in the robot's base frame, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Safety {
    /// Corner with the least coordinates.
    pub workspace_min: Vector3,
    /// Corner with the greatest coordinates.
    pub workspace_max: Vector3,
}

impl Safety {
    pub(super) fn read(mut section: Section<'_>) -> Result<Self, CellError> {
        let min: [f64; 3] = section.array("workspace_min_mm", Unit::Milli, -100_000.0..=100_000.0)?;
        let max: [f64; 3] = section.array("workspace_max_mm", Unit::Milli, -100_000.0..=100_000.0)?;
        for (low, high) in min.into_iter().zip(max) {
            section.ordered(("workspace_min_mm", low), ("workspace_max_mm", high))?;
        }
        section.finish()?;
        Ok(Self { workspace_min: min.into(), workspace_max: max.into() })
    }
}

/// What takes the joint commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveBackend {
    /// Servo drives and encoders in software.
    Simulated,
}

impl DriveBackend {
    pub(super) fn read(mut section: Section<'_>) -> Result<Self, CellError> {
        let backend = section.choice("backend", &[("simulated", Self::Simulated)])?;
        section.finish()?;
        Ok(backend)
    }
}
