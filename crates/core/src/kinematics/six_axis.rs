//! Any six-axis arm, with the best inverse that its structure allows.

use super::branches::{Branches, distance_squared};
use super::limits::nearest_turn;
use super::{
    InverseError, JointAxes, JointJet, JointLimits, Kinematics, SerialChain, SolverSettings,
    SphericalWristArm, ThreeParallelArm,
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

/// Joint positions closer than this (radians) are one branch.
const SAME: f64 = 1e-8;

/// The structures with a closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is no heap to put the larger one on")]
pub enum ClosedForm {
    /// Parallel shoulder and elbow axes, spherical wrist.
    SphericalWrist(SphericalWristArm),
    /// Axes 2, 3 and 4 parallel.
    ThreeParallel(ThreeParallelArm),
}

/// How the inverse of an arm is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InverseMethod {
    /// In closed form.
    Exact(ClosedForm),
    /// The arm has a structure but for calibration, or for rounded numbers in its description: the closed form of the
    /// nominal arm, then Newton steps on the real one.
    Polished(ClosedForm),
    /// Numeric from the seed.
    Numeric,
}

/// A six-axis arm of any structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SixAxisArm {
    chain: SerialChain<6>,
    method: InverseMethod,
}

impl ClosedForm {
    /// The structure of a chain, if it has one to within `tolerance` (metres, radians).
    #[must_use]
    pub fn of_chain(chain: &SerialChain<6>, tolerance: f64) -> Option<Self> {
        let spherical_wrist = chain.spherical_wrist(tolerance).map(Self::SphericalWrist);
        spherical_wrist.or_else(|| chain.three_parallel(tolerance).map(Self::ThreeParallel))
    }

    /// All branches, limits left aside.
    fn inverse(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<Branches<[f64; 6], 8>, InverseError> {
        match self {
            Self::SphericalWrist(arm) => Ok(arm.inverse(base_from_flange, reference)?.map(|s| s.q)),
            Self::ThreeParallel(arm) => arm.inverse(base_from_flange, reference),
        }
    }
}

impl SixAxisArm {
    /// The arm that a chain is: its structure is found from its axes, whatever frames described them.
    #[must_use]
    pub fn from_chain(chain: SerialChain<6>) -> Self {
        let exact = ClosedForm::of_chain(&chain, EXACT).map(InverseMethod::Exact);
        let near = || ClosedForm::of_chain(&chain, NEAR).map(InverseMethod::Polished);
        let method = exact.or_else(near).unwrap_or(InverseMethod::Numeric);
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

    /// The nominal arm's branches, nearest to the reference first, each brought onto the real arm and within the
    /// limits.
    fn polished(
        &self,
        nominal: &ClosedForm,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> impl Iterator<Item = [f64; 6]> {
        let turned = |q: [f64; 6]| core::array::from_fn(|i| nearest_turn(q[i], reference[i]));
        // Where the nominal arm fails, at the edge of its reach, the reference is as good a start.
        let mut starts = nominal
            .inverse(base_from_flange, reference)
            .map_or_else(|_| Branches::one(*reference), |all| all.map(turned));
        let distance = |q: &[f64; 6]| distance_squared(q, reference);
        starts.as_mut_slice().sort_unstable_by(|a, b| distance(a).total_cmp(&distance(b)));
        let (chain, pose) = (self.chain, *base_from_flange);
        starts.into_iter().filter_map(move |q| chain.solve(&pose, &q, &POLISH).ok().map(|found| found.q))
    }
}

impl From<SphericalWristArm> for SixAxisArm {
    /// The same arm, its branches keeping their names.
    fn from(arm: SphericalWristArm) -> Self {
        let chain = SerialChain::of_unit_axes(&arm.axes(&[0.0; 6]), *arm.limits());
        Self { chain, method: InverseMethod::Exact(ClosedForm::SphericalWrist(arm)) }
    }
}

impl Kinematics<6> for SixAxisArm {
    fn forward(&self, q: &[f64; 6]) -> Pose {
        match &self.method {
            InverseMethod::Exact(ClosedForm::SphericalWrist(arm)) => arm.forward(q),
            _ => self.chain.forward(q),
        }
    }

    fn axes(&self, q: &[f64; 6]) -> JointAxes<6> {
        match &self.method {
            InverseMethod::Exact(ClosedForm::SphericalWrist(arm)) => arm.axes(q),
            _ => self.chain.axes(q),
        }
    }

    fn inverse_nearest(&self, base_from_flange: &Pose, seed: &[f64; 6]) -> Result<[f64; 6], InverseError> {
        match &self.method {
            InverseMethod::Exact(ClosedForm::SphericalWrist(arm)) => {
                arm.inverse_nearest(base_from_flange, seed)
            }
            InverseMethod::Exact(ClosedForm::ThreeParallel(arm)) => {
                arm.inverse_nearest(base_from_flange, seed)
            }
            InverseMethod::Polished(nominal) => self
                .polished(nominal, base_from_flange, seed)
                .next()
                .map_or_else(|| self.chain.inverse_nearest(base_from_flange, seed), Ok),
            InverseMethod::Numeric => self.chain.inverse_nearest(base_from_flange, seed),
        }
    }

    fn inverse_branches(
        &self,
        base_from_flange: &Pose,
        reference: &[f64; 6],
    ) -> Result<Branches<[f64; 6], 8>, InverseError> {
        match &self.method {
            InverseMethod::Exact(ClosedForm::SphericalWrist(arm)) => {
                arm.inverse_branches(base_from_flange, reference)
            }
            InverseMethod::Exact(ClosedForm::ThreeParallel(arm)) => {
                arm.inverse_branches(base_from_flange, reference)
            }
            InverseMethod::Polished(nominal) => {
                let mut found = Branches::none(*reference);
                for q in self.polished(nominal, base_from_flange, reference) {
                    // Beside a singularity two nominal branches may lead to one.
                    if found.as_slice().iter().all(|other| distance_squared(other, &q) > SAME * SAME) {
                        found.push(q);
                    }
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
            InverseMethod::Exact(ClosedForm::SphericalWrist(arm)) => arm.joint_jet(base_from_flange, q),
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
