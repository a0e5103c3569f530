//! Numeric inverse: damped Newton steps that turn into Taylor steps near the solution.
//!
//! Far away each step is Levenberg–Marquardt's with the damping of Sugihara, *Solvability-Unconcerned Inverse Kinematics
//! by the Levenberg–Marquardt Method* (IEEE T-RO 27, 2011): λ = c·|e|², so that it vanishes at the solution. Near it
//! the joints' first three derivatives along the straight way to the target are a Taylor polynomial, whose error is of
//! fourth order: a seed within 0.05 rad needs two steps. A start that does not get anywhere is given up for another one,
//! taken from a fixed sequence that fills the joint range evenly: the same question has the same answer on every run.

use core::f64::consts::{PI, TAU};

use nalgebra::{SMatrix, Vector6};

use super::SerialChain;
use crate::geometry::{Pose, Vector3};
use crate::kinematics::{InverseError, Jacobian, JointAxes, JointJet, Kinematics};
use crate::math::float::{atan2, floor, powf};
use crate::math::linear::Cholesky;

/// When the solver is content, and when it gives up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolverSettings {
    /// Distance in metres.
    pub position_tolerance: f64,
    /// Angle in radians.
    pub rotation_tolerance: f64,
    /// Iterations from one start.
    pub iterations_per_start: usize,
    /// Starts: the seed, then others.
    pub starts: usize,
}

impl SolverSettings {
    /// 1e-12 m, 1e-12 rad: what a control cycle needs, whose joints would show every change of a residual as
    /// acceleration.
    pub const TO_ROUNDING: Self =
        Self { position_tolerance: 1e-12, rotation_tolerance: 1e-12, iterations_per_start: 50, starts: 40 };
}

impl Default for SolverSettings {
    /// 1e-6 m, 1e-6 rad; 50 iterations from each of 40 starts.
    fn default() -> Self {
        Self { position_tolerance: 1e-6, rotation_tolerance: 1e-6, iterations_per_start: 50, starts: 40 }
    }
}

/// What the solver found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumericSolution<const N: usize> {
    /// Joint positions, within the limits, in the turn nearest to the seed.
    pub q: [f64; N],
    /// Iterations taken, over all starts.
    pub iterations: usize,
    /// Starts taken.
    pub starts: usize,
    /// Distance left, in metres.
    pub position_residual: f64,
    /// Angle left, in radians.
    pub rotation_residual: f64,
}

/// Damping λ = this · |e|².
const DAMPING: f64 = 0.3;
/// Damping of a Jacobian without full row rank, of its squared norm: changes a step by a part in 10⁴ at most.
const LEAST_DAMPING: f64 = 1e-12;
/// Steps longer than this in any joint (radians) are shortened to it.
const LONGEST_STEP: f64 = 1.0;
/// Taylor steps are taken where the undamped step stays below this in every joint.
const TAYLOR_STEP: f64 = 0.35;
/// … and the twist is shorter than this (metres and radians together).
const TAYLOR_TWIST: f64 = 1.0;
/// Nearer than this a step must bring the flange nearer still, or is taken back and tried with more damping.
const CAUTIOUS: f64 = 0.3;
/// So many times more.
const MORE_CAUTION: f64 = 30.0;
/// Damping, of the Jacobian's squared norm, above the rounding of J·Jᵀ.
const ROUNDING: f64 = 1e-14;
/// A start is given up if this many iterations have not halved the error.
const PATIENCE: usize = 8;

/// A place on the way.
struct Place<const N: usize> {
    q: [f64; N],
    axes: JointAxes<N>,
    /// What is left to go.
    twist: Vector6<f64>,
}

impl<const N: usize> Place<N> {
    #[inline]
    fn at(chain: &SerialChain<N>, q: [f64; N], target: &Pose) -> Self {
        let axes = chain.axes(&q);
        let twist = twist_to(&axes.base_from_flange, target);
        Self { q, axes, twist }
    }
}

/// Where one start has got to.
struct Descent<const N: usize> {
    q: [f64; N],
    iterations: usize,
    position_residual: f64,
    rotation_residual: f64,
    converged: bool,
}

impl<const N: usize> SerialChain<N> {
    /// Joint positions for a pose, within the limits.
    ///
    /// # Errors
    /// [`InverseError::NotConverged`]; [`InverseError::PositionLimit`] where solutions were found, all of them outside
    /// the limits; [`InverseError::NotFinite`].
    ///
    /// Cost: at most `starts · iterations_per_start` iterations, each of one pass through the chain and one or two 6 × 6
    /// factorizations.
    pub fn solve(
        &self,
        base_from_flange: &Pose,
        seed: &[f64; N],
        settings: &SolverSettings,
    ) -> Result<NumericSolution<N>, InverseError> {
        let sum = base_from_flange.translation.vector.sum()
            + base_from_flange.rotation.coords.sum()
            + seed.iter().sum::<f64>();
        if !sum.is_finite() {
            return Err(InverseError::NotFinite);
        }
        let kinds = self.links.map(|link| link.kind);
        let mut iterations = 0;
        let mut best: Option<Descent<N>> = None;
        let mut outside = None;
        for start in 0..settings.starts {
            let from = if start == 0 { *seed } else { self.start(start) };
            let descent = self.descend(base_from_flange, from, settings);
            iterations += descent.iterations;
            if descent.converged {
                if let Some(q) = self.limits.turned_within(&descent.q, seed, &kinds) {
                    let Descent { position_residual, rotation_residual, .. } = descent;
                    let starts = start + 1;
                    return Ok(NumericSolution {
                        q,
                        iterations,
                        starts,
                        position_residual,
                        rotation_residual,
                    });
                }
                outside = outside.or_else(|| Some(self.limits.worst_violation(&descent.q, &kinds)));
            }
            let error = |d: &Descent<N>| d.position_residual + d.rotation_residual;
            if best.as_ref().is_none_or(|best| error(&descent) < error(best)) {
                best = Some(descent);
            }
        }
        let (position_residual, rotation_residual) = best
            .map_or((f64::INFINITY, f64::INFINITY), |best| (best.position_residual, best.rotation_residual));
        let not_converged = InverseError::NotConverged { iterations, position_residual, rotation_residual };
        Err(outside.unwrap_or(not_converged))
    }

    /// From one start as far as it leads.
    fn descend(&self, target: &Pose, from: [f64; N], settings: &SolverSettings) -> Descent<N> {
        let mut here = Place::at(self, from, target);
        let (mut milestone, mut since_milestone) = (here.twist.norm(), 0);
        let (mut iterations, mut caution) = (0, 1.0);
        // At most `iterations_per_start` rounds.
        loop {
            let position_residual = here.twist.fixed_rows::<3>(0).norm();
            let rotation_residual = here.twist.fixed_rows::<3>(3).norm();
            let converged = position_residual <= settings.position_tolerance
                && rotation_residual <= settings.rotation_tolerance;
            if converged || iterations == settings.iterations_per_start || since_milestone == PATIENCE {
                return Descent { q: here.q, iterations, position_residual, rotation_residual, converged };
            }
            let step = step(&here.axes, &here.twist, caution);
            let there = Place::at(self, core::array::from_fn(|i| here.q[i] + step[i]), target);
            iterations += 1;
            since_milestone += 1;
            let (before, after) = (here.twist.norm(), there.twist.norm());
            if after >= before && before < CAUTIOUS {
                caution *= MORE_CAUTION;
                continue;
            }
            (here, caution) = (there, 1.0);
            if after < 0.5 * milestone {
                (milestone, since_milestone) = (after, 0);
            }
        }
    }

    /// The k-th start: an additive recurrence with the powers of the generalized golden ratio (the root of
    /// x^(N+1) = x + 1), which fills the joint range evenly for any number of points.
    fn start(&self, k: usize) -> [f64; N] {
        let mut ratio = 1.5;
        for _ in 0..30 {
            ratio = powf(1.0 + ratio, 1.0 / (N as f64 + 1.0));
        }
        let mut increment = 1.0;
        core::array::from_fn(|axis| {
            increment /= ratio;
            let x = 0.5 + k as f64 * increment;
            let (min, max) = self.limits.position()[axis];
            // Of a wider range, one turn about the place nearest to zero.
            let middle = 0.0_f64.max(min + PI).min(max - PI);
            let (min, max) = if max - min > TAU { (middle - PI, middle + PI) } else { (min, max) };
            min + (max - min) * (x - floor(x))
        })
    }
}

/// The straight way from one pose to another: translation and rotation vector, in the base frame.
#[inline]
fn twist_to(from: &Pose, to: &Pose) -> Vector6<f64> {
    let linear = to.translation.vector - from.translation.vector;
    let turn = to.rotation * from.rotation.inverse();
    let (imaginary, real) = (turn.imag(), turn.w);
    let sine = imaginary.norm();
    // The shorter way round: q and −q are one rotation.
    let angle = if real >= 0.0 { 2.0 * atan2(sine, real) } else { -2.0 * atan2(sine, -real) };
    let scale = if sine > 0.0 { angle / sine } else { 2.0 };
    let angular: Vector3 = imaginary * scale;
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}

/// Jᵀ·(J·Jᵀ + λ)⁻¹, the damped inverse of the Jacobian.
struct DampedInverse<const N: usize> {
    jacobian: Jacobian<N>,
    factor: Cholesky<6>,
}

impl<const N: usize> DampedInverse<N> {
    /// Nothing where J·Jᵀ + λ is singular.
    #[inline]
    fn new(jacobian: Jacobian<N>, damping: f64) -> Option<Self> {
        // With fewer than six joints J·Jᵀ is singular always.
        let least = if N < 6 { LEAST_DAMPING * jacobian.norm_squared() } else { 0.0 };
        let damping = SMatrix::identity() * damping.max(least);
        let factor = Cholesky::new(&(jacobian * jacobian.transpose() + damping))?;
        Some(Self { jacobian, factor })
    }

    #[inline]
    fn solve(&self, twist: &Vector6<f64>) -> [f64; N] {
        self.jacobian.tr_mul(&Vector6::from(self.factor.solve(&(*twist).into()))).into()
    }
}

/// The next step of the joints towards a flange displaced by `twist`.
#[inline]
fn step<const N: usize>(axes: &JointAxes<N>, twist: &Vector6<f64>, caution: f64) -> [f64; N] {
    let jacobian = axes.jacobian();
    if twist.norm() < TAYLOR_TWIST
        && caution == 1.0
        && let Some(inverse) = DampedInverse::new(jacobian, 0.0)
    {
        let velocity = inverse.solve(twist);
        if largest(&velocity) <= TAYLOR_STEP {
            return taylor_step(axes, velocity, &inverse);
        }
    }
    let damping = DAMPING * caution * twist.norm_squared() + ROUNDING * jacobian.norm_squared();
    // Positive definite: the damping is above the rounding.
    let Some(inverse) = DampedInverse::new(jacobian, damping) else { return [0.0; N] };
    let step = inverse.solve(twist);
    let scale = (LONGEST_STEP / largest(&step)).min(1.0);
    step.map(|s| s * scale)
}

/// q′ + ½ q″ + ⅙ q‴, the joints' derivatives along the straight way to the target.
#[inline]
fn taylor_step<const N: usize>(
    axes: &JointAxes<N>,
    velocity: [f64; N],
    inverse: &DampedInverse<N>,
) -> [f64; N] {
    let stacked = |linear: Vector3, angular: Vector3| {
        Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
    };
    let mut jet = JointJet { velocity, ..JointJet::at_rest([0.0; N]) };
    let bias = axes.forward_jet(&jet);
    jet.acceleration = inverse.solve(&-stacked(bias.linear[1], bias.angular[1]));
    let bias = axes.forward_jet(&jet);
    jet.jerk = inverse.solve(&-stacked(bias.linear[2], bias.angular[2]));
    core::array::from_fn(|i| jet.velocity[i] + jet.acceleration[i] / 2.0 + jet.jerk[i] / 6.0)
}

/// The largest magnitude.
#[inline]
fn largest<const N: usize>(values: &[f64; N]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}
