//! Joint derivatives of any arm, from its axes: the Jacobian solved once per order.

use nalgebra::{SVector, Vector6};

use super::{InverseError, JointAxes, JointJet, Singularity};
use crate::geometry::{PoseJet, Vector3};
use crate::math::linear::OrthogonalFactors;

/// A column of the Jacobian within this part of its length of the others' span is in it but for rounding.
const DEPENDENT: f64 = 1e-12;
/// A motion that misses what the joints can do by less than this part of it is rounding.
const FOLLOWED: f64 = 1e-9;

/// The Jacobian's factors: of itself up to six joints, of its transpose beyond.
enum Factors<const N: usize> {
    Tall(OrthogonalFactors<6, N>),
    Wide(OrthogonalFactors<N, 6>),
}

/// The joints' derivatives for a moving flange: with J·q⁽ᵏ⁾ = (flange's k-th derivative) − (what it is where the
/// joints' k-th derivative is zero), order by order. More than six joints move by the least squares of each order.
pub(super) fn inverse_jet<const N: usize>(
    axes: &JointAxes<N>,
    motion: &PoseJet,
    q: &[f64; N],
) -> Result<JointJet<N>, InverseError> {
    let mut jet = JointJet::at_rest(*q);
    let demanded = [0, 1, 2].map(|order| stacked(&motion.linear[order], &motion.angular[order]));
    if demanded.iter().all(|twist| *twist == Vector6::zeros()) {
        return Ok(jet);
    }
    let jacobian = axes.jacobian();
    let lost = |distance| InverseError::Singular { singularity: Singularity::Rank, distance };
    let factors = if N <= 6 {
        Factors::Tall(OrthogonalFactors::new(&jacobian, DEPENDENT).map_err(lost)?)
    } else {
        Factors::Wide(OrthogonalFactors::new(&jacobian.transpose(), DEPENDENT).map_err(lost)?)
    };
    for (order, twist) in demanded.iter().enumerate() {
        let so_far = axes.forward_jet(&jet);
        let bias = stacked(&so_far.linear[order], &so_far.angular[order]);
        let missing = twist - bias;
        let solved: [f64; N] = match &factors {
            Factors::Tall(factors) => factors.least_squares(&missing),
            Factors::Wide(factors) => factors.least_norm_of_transposed(&missing.into()).into(),
        };
        let rest = (jacobian * SVector::<f64, N>::from(solved) - missing).norm();
        if N < 6 && rest > FOLLOWED * (twist.norm() + bias.norm()) {
            return Err(InverseError::NotFollowed { missing: rest });
        }
        match order {
            0 => jet.velocity = solved,
            1 => jet.acceleration = solved,
            _ => jet.jerk = solved,
        }
    }
    Ok(jet)
}

fn stacked(linear: &Vector3, angular: &Vector3) -> Vector6<f64> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
