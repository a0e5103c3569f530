//! Joint derivatives of any arm, from its axes: the Jacobian solved once per order.

use nalgebra::{SVector, Vector6};

use super::{InverseError, JointAxes, JointJet, Singularity};
use crate::geometry::{PoseJet, Vector3};
use crate::math::linear::OrthogonalFactors;

/// A column of the Jacobian within this part of its length of the others' span is in it but for rounding.
const DEPENDENT: f64 = 1e-12;
/// A motion that misses what the joints can do by less than this part of it is rounding.
const FOLLOWED: f64 = 1e-9;

/// The joints' derivatives for a moving flange: with J·q⁽ᵏ⁾ = (flange's k-th derivative) − (what it is where the
/// joints' k-th derivative is zero), order by order. More than six joints move by the least squares of each order.
pub(super) fn inverse_jet<const N: usize>(
    axes: &JointAxes<N>,
    motion: &PoseJet,
    q: &[f64; N],
) -> Result<JointJet<N>, InverseError> {
    if !(motion.is_finite() && q.iter().sum::<f64>().is_finite()) {
        return Err(InverseError::NotFinite);
    }
    let demanded = [0, 1, 2].map(|order| stacked(&motion.linear[order], &motion.angular[order]));
    if demanded.iter().all(|twist| *twist == Vector6::zeros()) {
        return Ok(JointJet::at_rest(*q));
    }
    let jacobian = axes.jacobian();
    let lost = |distance| InverseError::Singular { singularity: Singularity::Rank, distance };
    if N <= 6 {
        let factors = OrthogonalFactors::new(&jacobian, DEPENDENT).map_err(lost)?;
        by_order(axes, &demanded, q, |missing| factors.least_squares(missing))
    } else {
        let factors = OrthogonalFactors::new(&jacobian.transpose(), DEPENDENT).map_err(lost)?;
        by_order(axes, &demanded, q, |missing| factors.least_norm_of_transposed(&(*missing).into()).into())
    }
}

fn by_order<const N: usize>(
    axes: &JointAxes<N>,
    demanded: &[Vector6<f64>; 3],
    q: &[f64; N],
    solve: impl Fn(&Vector6<f64>) -> [f64; N],
) -> Result<JointJet<N>, InverseError> {
    let jacobian = axes.jacobian();
    let mut jet = JointJet::at_rest(*q);
    for (order, twist) in demanded.iter().enumerate() {
        let so_far = axes.forward_jet(&jet);
        let bias = stacked(&so_far.linear[order], &so_far.angular[order]);
        let missing = twist - bias;
        let solved = solve(&missing);
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
