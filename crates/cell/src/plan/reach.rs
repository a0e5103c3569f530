//! Why an arm does not reach a pose, in words.

use seamline::kinematics::{InverseError, Singularity};

use super::arm::{Arm, PlanningArm};

impl<const N: usize, K: PlanningArm<N>> Arm<N, K> {
    /// An inverse error in words, with the joints' names and units.
    pub(super) fn in_words(&self, error: &InverseError) -> String {
        self.kinematics.in_own_words(error).unwrap_or_else(|| self.in_common_words(error))
    }

    fn in_common_words(&self, error: &InverseError) -> String {
        let mm = |metres: f64| metres * 1000.0;
        match *error {
            InverseError::NotFinite => "a coordinate is not a number".into(),
            InverseError::OutOfReach { distance, least, greatest } => format!(
                "the wrist centre is {:.1} mm from the shoulder, the arm reaches from {:.1} to {:.1} mm",
                mm(distance),
                mm(least),
                mm(greatest)
            ),
            InverseError::InsideLateralOffset { radius, offset } => format!(
                "the wrist centre is {:.1} mm from axis 1, expected at least {:.1} mm",
                mm(radius),
                mm(offset)
            ),
            InverseError::OutOfOrientation { angle } => {
                format!("the orientation is {:.2} deg beyond what the arm can turn", angle.to_degrees())
            }
            InverseError::NotFollowed { .. } => {
                "the path asks for a direction of motion that the arm's joints do not have".into()
            }
            InverseError::NotConverged { iterations, position_residual, .. } => format!(
                "the numeric inverse ends {:.4} mm off after {iterations} iterations",
                mm(position_residual)
            ),
            InverseError::PositionLimit { axis, value, min, max } => {
                let unit = self.unit(axis);
                let [value, min, max] = [value, min, max].map(|si| si * unit.per_si);
                let (joint, unit) = (&self.joint_names[axis], unit.name);
                format!(
                    "joint {joint} would stand at {value:.2} {unit}, outside {min:.1} … {max:.1} {unit}, in the \
                     configuration asked for"
                )
            }
            InverseError::Singular { singularity, .. } => {
                let name = match singularity {
                    Singularity::Wrist => "wrist (axes 4 and 6 in line)",
                    Singularity::Elbow => "elbow (arm stretched or folded)",
                    Singularity::Shoulder => "shoulder (wrist centre on axis 1)",
                    Singularity::Rank => "arm (no motion in some direction)",
                };
                format!("the path leads through a singularity of the {name}")
            }
        }
    }
}
