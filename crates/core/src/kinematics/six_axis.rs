//! Any six-axis arm, with the best inverse that its structure allows.

use super::limits::{distance_squared, nearest_turn};
use super::{
    Branches, InverseError, JointAxes, JointJet, JointLimits, Kinematics, SerialChain, SolverSettings,
    SphericalWristArm,
};
use crate::geometry::{Pose, PoseJet};

/// Axes that meet, and are parallel or square, to within this (metres, radians) give an exact closed form.
const EXACT: f64 = 1e-10;
/// A calibrated arm's axes: its closed form leads near enough for a few Newton steps.
const NEAR: f64 = 0.02;

/// From the nominal arm to the real one: a start so near is met to rounding in two or three iterations.
const POLISH: SolverSettings = SolverSettings {
    position_tolerance: 1e-12,
    rotation_tolerance: 1e-12,
    iterations_per_start: 12,
    starts: 1,
};

/// How the inverse of an arm is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InverseMethod {
    /// The arm has a spherical wrist.
    ClosedForm(SphericalWristArm),
    /// The arm has one but for calibration, or for rounded numbers in its description: the closed form of the nominal
    /// arm, then Newton steps on the real one.
    Polished(SphericalWristArm),
    /// Numeric from the seed.
    Numeric,
}

/// A six-axis arm of any structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SixAxisArm {
    chain: SerialChain<6>,
    method: InverseMethod,
}

impl SixAxisArm {
    /// The arm that a chain is: its structure is found from its axes, whatever frames described them.
    #[must_use]
    pub fn from_chain(chain: SerialChain<6>) -> Self {
        let method = if let Some(arm) = chain.spherical_wrist(EXACT) {
            InverseMethod::ClosedForm(arm)
        } else if let Some(nominal) = chain.spherical_wrist(NEAR) {
            InverseMethod::Polished(nominal)
        } else {
            InverseMethod::Numeric
        };
        Self { chain, method }
    }

    /// How this arm's inverse is found.
    #[must_use]
    pub fn method(&self) -> &InverseMethod {
        &self.method
    }

    /// The arm as a chain.
    #[must_use]
    pub fn chain(&self) -> &SerialChain<6> {
        &self.chain
    }

    /// The arm's limits.
    #[must_use]
    pub fn limits(&self) -> &JointLimits<6> {
        self.chain.limits()
    }

    /// The nominal arm's branches, nearest to the reference first, each brought onto the real arm.
    fn polished(
        &self,
        nominal: &SphericalWristArm,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<impl Iterator<Item = [f64; 6]>, InverseError> {
        let all = nominal.inverse(base_from_flange, reference)?;
        let mut starts = [[0.0; 6]; 8];
        let mut count = 0;
        for (start, solution) in starts.iter_mut().zip(all.as_slice()) {
            *start = core::array::from_fn(|i| nearest_turn(solution.q[i], reference[i]));
            count += 1;
        }
        starts[..count].sort_unstable_by(|a, b| {
            distance_squared(a, reference).total_cmp(&distance_squared(b, reference))
        });
        let (chain, pose) = (self.chain, *base_from_flange);
        let polish = move |start: [f64; 6]| chain.solve(&pose, &start, &POLISH).ok().map(|found| found.q);
        Ok(starts.into_iter().take(count).filter_map(polish))
    }
}

impl Kinematics<6> for SixAxisArm {
    fn forward(&self, q: &[f64; 6]) -> Pose {
        match &self.method {
            InverseMethod::ClosedForm(arm) => arm.forward(q),
            _ => self.chain.forward(q),
        }
    }

    fn axes(&self, q: &[f64; 6]) -> JointAxes<6> {
        match &self.method {
            InverseMethod::ClosedForm(arm) => arm.axes(q),
            _ => self.chain.axes(q),
        }
    }

    fn inverse_nearest(&self, base_from_flange: &Pose, seed: &[f64; 6]) -> Result<[f64; 6], InverseError> {
        match &self.method {
            InverseMethod::ClosedForm(arm) => arm.inverse_nearest(base_from_flange, seed),
            InverseMethod::Polished(nominal) => {
                let nearest =
                    self.polished(nominal, base_from_flange, seed).ok().and_then(|mut all| all.next());
                // At the edge of the reach the nominal arm may fail where the real one does not.
                nearest.map_or_else(|| self.chain.inverse_nearest(base_from_flange, seed), Ok)
            }
            InverseMethod::Numeric => self.chain.inverse_nearest(base_from_flange, seed),
        }
    }

    fn inverse_branches(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<Branches<[f64; 6], 8>, InverseError> {
        match &self.method {
            InverseMethod::ClosedForm(arm) => arm.inverse_branches(base_from_flange, reference),
            InverseMethod::Polished(nominal) => {
                let mut found = Branches::none(*reference);
                if let Ok(all) = self.polished(nominal, base_from_flange, reference) {
                    all.for_each(|q| found.push(q));
                }
                if found.as_slice().is_empty() {
                    found.push(self.chain.inverse_nearest(base_from_flange, reference)?);
                }
                Ok(found)
            }
            InverseMethod::Numeric => self.chain.inverse_branches(base_from_flange, reference),
        }
    }

    fn joint_jet(&self, base_from_flange: &PoseJet, q: &[f64; 6]) -> Result<JointJet<6>, InverseError> {
        match &self.method {
            InverseMethod::ClosedForm(arm) => arm.joint_jet(base_from_flange, q),
            _ => self.chain.joint_jet(base_from_flange, q),
        }
    }

    fn position_limits(&self) -> &[(f64, f64); 6] {
        self.chain.position_limits()
    }

    fn velocity_limits(&self) -> &[f64; 6] {
        self.chain.velocity_limits()
    }
}
