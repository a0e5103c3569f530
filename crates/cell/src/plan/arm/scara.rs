//! A SCARA: the elbow's side is its configuration, and its flange stands upright always.

use seamline::geometry::{Pose, Rotation};
use seamline::kinematics::{Handedness, InverseError, Kinematics, ScaraArm};

use super::PlanningArm;
use crate::job;
use crate::robot::{ArmDescription, ArmError};

/// A tilt of the flange up to this (radians) is rounding: jobs have four decimals of a degree in each of three angles.
const ROUNDING: f64 = 0.001 * std::f64::consts::PI / 180.0;

impl PlanningArm<4> for ScaraArm {
    fn from_description(description: &ArmDescription) -> Result<Self, ArmError> {
        description.scara()
    }

    /// The second flag of `RCONF` says to which side the arm is bent: 0 like a right arm, 1 like a left one. Turns are the nearest.
    fn in_configuration(
        &self,
        base_from_flange: &Pose,
        configuration: &job::Configuration,
        reference: &[f64; 4],
    ) -> Result<[f64; 4], InverseError> {
        let asked = if configuration.lower_arm { Handedness::Left } else { Handedness::Right };
        self.inverse_bent(base_from_flange, asked, reference)
    }

    fn same_branch(&self, base_from_flange: &Pose, seed: &[f64; 4]) -> Result<[f64; 4], InverseError> {
        match self.inverse_bent(base_from_flange, self.handedness(seed), seed) {
            // The branch leaves the limits: the nearest joints show by how much the arm would have to jump.
            Err(InverseError::PositionLimit { .. }) => self.inverse_nearest(base_from_flange, seed),
            result => result,
        }
    }

    fn configuration(&self, q: &[f64; 4]) -> job::Configuration {
        job::Configuration { lower_arm: self.handedness(q) == Handedness::Left, ..Default::default() }
    }

    fn taken_orientation(&self, base_from_flange: &Rotation) -> Rotation {
        let upright = self.upright(base_from_flange);
        if upright.angle_to(base_from_flange) <= ROUNDING { upright } else { *base_from_flange }
    }

    fn in_own_words(&self, error: &InverseError) -> Option<String> {
        let mm = |metres: f64| metres * 1000.0;
        match error {
            InverseError::OutOfReach { distance, least, greatest } => Some(format!(
                "axis 4 would be {:.1} mm from axis 1, the arm reaches from {:.1} to {:.1} mm",
                mm(*distance),
                mm(*least),
                mm(*greatest)
            )),
            InverseError::OutOfOrientation { angle } => Some(format!(
                "the flange would be tilted by {:.3} deg, and this arm holds it upright",
                angle.to_degrees()
            )),
            InverseError::NotFollowed { .. } => {
                Some("the path tilts the flange, and this arm holds it upright".into())
            }
            _ => None,
        }
    }
}
