//! Six axes: the flags of `RCONF` name the branches of a spherical wrist.

use seamline::geometry::Pose;
use seamline::kinematics::{
    ClosedForm, Configuration, InverseError, InverseMethod, Kinematics, SixAxisArm, SphericalWristArm,
};

use super::PlanningArm;
use crate::job;
use crate::robot::{ArmDescription, ArmError};

impl PlanningArm<6> for SixAxisArm {
    fn from_description(description: &ArmDescription) -> Result<Self, ArmError> {
        description.six_axis()
    }

    fn in_configuration(
        &self,
        base_from_flange: &Pose,
        configuration: &job::Configuration,
        reference: &[f64; 6],
    ) -> Result<[f64; 6], InverseError> {
        let c = configuration;
        let digits =
            [c.no_flip, c.lower_arm, c.rear, c.r_beyond_180, c.t_beyond_180, c.s_beyond_180].map(u8::from);
        match (spherical_wrist(self), Configuration::from_rconf(digits)) {
            (Some(arm), Some(configuration)) => {
                arm.inverse_in_configuration(base_from_flange, &configuration, reference)
            }
            // The flags name the branches of a spherical wrist; another arm goes to the nearest joints.
            _ => self.inverse_nearest(base_from_flange, reference),
        }
    }

    fn same_branch(&self, base_from_flange: &Pose, seed: &[f64; 6]) -> Result<[f64; 6], InverseError> {
        let Some(arm) = spherical_wrist(self) else { return self.inverse_nearest(base_from_flange, seed) };
        let posture = arm.posture(seed);
        let all = arm.inverse_within_limits(base_from_flange, seed)?;
        let same =
            all.as_slice().iter().find(|solution| solution.posture == posture || solution.at_wrist_pole);
        // The branch ends here, or leaves the limits: the nearest joints show by how much the arm would have to jump.
        same.map_or_else(|| self.inverse_nearest(base_from_flange, seed), |solution| Ok(solution.q))
    }

    fn configuration(&self, q: &[f64; 6]) -> job::Configuration {
        let Some(arm) = spherical_wrist(self) else { return job::Configuration::default() };
        let flags = arm.configuration(q).to_rconf().map(|digit| digit == 1);
        job::Configuration::from_flags(&flags)
    }
}

/// The closed form whose branches have the names of `RCONF`.
fn spherical_wrist(arm: &SixAxisArm) -> Option<&SphericalWristArm> {
    match arm.method() {
        InverseMethod::Exact(ClosedForm::SphericalWrist(arm)) => Some(arm),
        _ => None,
    }
}
