//! Tools and user frames.

use seamline::geometry::{EulerZyx, Pose, Vector3};

use super::error::CellError;
use super::section::{Section, Unit};

/// A tool at the flange.
#[derive(Debug, Clone, PartialEq)]
pub struct Tool {
    /// The number jobs call it by, 0–63.
    pub number: u32,
    /// The name that reports show; may be empty.
    pub name: String,
    /// Tool centre point in the flange frame; z is the wire's direction.
    pub flange_from_tcp: Pose,
}

/// A frame in the cell that jobs can be taught in.
#[derive(Debug, Clone, PartialEq)]
pub struct UserFrame {
    /// The number jobs call it by, 1–63.
    pub number: u32,
    /// The name that reports show; may be empty.
    pub name: String,
    /// The frame in the robot's base frame.
    pub base_from_user: Pose,
}

impl Tool {
    pub(super) fn read(number: u32, mut table: Section<'_>) -> Result<Self, CellError> {
        let (name, flange_from_tcp) = named_pose(&mut table)?;
        table.finish()?;
        Ok(Self { number, name, flange_from_tcp })
    }
}

impl UserFrame {
    pub(super) fn read(number: u32, mut table: Section<'_>) -> Result<Self, CellError> {
        let (name, base_from_user) = named_pose(&mut table)?;
        table.finish()?;
        Ok(Self { number, name, base_from_user })
    }
}

fn named_pose(table: &mut Section<'_>) -> Result<(String, Pose), CellError> {
    let name = table.optional_text("name")?.unwrap_or_default();
    let mut length = |key| table.number(key, Unit::Milli, -100_000.0..=100_000.0);
    let translation = Vector3::new(length("x_mm")?, length("y_mm")?, length("z_mm")?);
    let mut angle = |key| table.number(key, Unit::Degree, -360.0..=360.0);
    let rotation = EulerZyx { x: angle("rx_deg")?, y: angle("ry_deg")?, z: angle("rz_deg")? };
    Ok((name, Pose::from_parts(translation.into(), rotation.to_rotation())))
}
