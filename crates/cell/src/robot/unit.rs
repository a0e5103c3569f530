//! The units that people read joints' coordinates in.

use seamline::kinematics::JointKind;

/// Degrees for a joint that turns, millimetres for one that slides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointUnit {
    /// `deg` or `mm`.
    pub name: &'static str,
    /// How many of them are in a radian or a metre.
    pub per_si: f64,
}

impl JointUnit {
    /// The unit of a kind of joint.
    #[must_use]
    pub fn of(kind: JointKind) -> Self {
        match kind {
            JointKind::Revolute => Self { name: "deg", per_si: 1_f64.to_degrees() },
            JointKind::Prismatic => Self { name: "mm", per_si: 1000.0 },
        }
    }
}
