//! A rotation given by a rotation vector that moves: the exact angular velocity and its derivatives.
//!
//! The quaternion of the rotation vector ρ is (cos(√x/2), S(x)·ρ) with x = ρ·ρ and S(x) = sin(√x/2)/√x. S is smooth
//! at x = 0, and S, S′, S″, S‴ follow from one another: 2xS′ = C/2 − S, and each derivative of that.

use nalgebra::Quaternion;

use crate::geometry::{Rotation, Vector3};
use crate::math::float::{cos, sin, sqrt};

/// A rotation vector with its first three derivatives.
pub(super) struct RotationVectorJet {
    pub(super) vector: Vector3,
    pub(super) first: Vector3,
    pub(super) second: Vector3,
    pub(super) third: Vector3,
}

/// Below this x the recursion for S′, S″, S‴ loses digits to cancellation, and four terms of the series are exact.
const SERIES_BELOW: f64 = 0.05;

/// S(x) and its first three derivatives.
fn half_sinc(x: f64) -> [f64; 4] {
    if x < SERIES_BELOW {
        // S = Σ (−x)^k / (2^(2k+1) (2k+1)!)
        const C: [f64; 7] = [
            0.5,
            -1.0 / 48.0,
            1.0 / 3_840.0,
            -1.0 / 645_120.0,
            1.0 / 185_794_560.0,
            -1.0 / 81_749_606_400.0,
            1.0 / 51_011_754_393_600.0,
        ];
        let mut derivatives = [0.0; 4];
        for (order, value) in derivatives.iter_mut().enumerate() {
            for k in (order..C.len()).rev() {
                let falling: f64 = (0..order).map(|i| (k - i) as f64).product();
                *value = *value * x + C[k] * falling;
            }
        }
        return derivatives;
    }
    let angle = sqrt(x);
    let s = sin(angle / 2.0) / angle;
    let s1 = (cos(angle / 2.0) / 2.0 - s) / (2.0 * x);
    let s2 = -(s / 8.0 + 3.0 * s1) / (2.0 * x);
    let s3 = -(s1 / 8.0 + 5.0 * s2) / (2.0 * x);
    [s, s1, s2, s3]
}

impl RotationVectorJet {
    /// The rotation, and the angular velocity with its first two derivatives.
    pub(super) fn rotation(&self) -> (Rotation, [Vector3; 3]) {
        let (r, r1, r2, r3) = (self.vector, self.first, self.second, self.third);
        let x = [
            r.dot(&r),
            2.0 * r.dot(&r1),
            2.0 * (r1.dot(&r1) + r.dot(&r2)),
            2.0 * (3.0 * r1.dot(&r2) + r.dot(&r3)),
        ];
        let s = half_sinc(x[0]);
        // Scalar part C(x) with C′ = −S/4; both by Faà di Bruno's rule along the parameter.
        let c = [cos(sqrt(x[0]) / 2.0), -s[0] / 4.0, -s[1] / 4.0, -s[2] / 4.0];
        let along = |f: [f64; 4]| {
            [
                f[0],
                f[1] * x[1],
                f[2] * x[1] * x[1] + f[1] * x[2],
                f[3] * x[1] * x[1] * x[1] + 3.0 * f[2] * x[1] * x[2] + f[1] * x[3],
            ]
        };
        let (c, s) = (along(c), along(s));
        let quaternion = |w: f64, v: Vector3| Quaternion::from_parts(w, v);
        let q = quaternion(c[0], r * s[0]);
        let q1 = quaternion(c[1], r * s[1] + r1 * s[0]);
        let q2 = quaternion(c[2], r * s[2] + r1 * (2.0 * s[1]) + r2 * s[0]);
        let q3 = quaternion(c[3], r * s[3] + r1 * (3.0 * s[2]) + r2 * (3.0 * s[1]) + r3 * s[0]);
        let w = (q1 * q.conjugate()).imag() * 2.0;
        let w1 = (q2 * q.conjugate()).imag() * 2.0;
        let w2 = (q3 * q.conjugate() + q2 * q1.conjugate()).imag() * 2.0;
        (Rotation::new_normalize(q), [w, w1, w2])
    }
}

/// The rotation vector, less than half a turn, of a rotation with angular velocity ω and its derivative, and the
/// vector's first two derivatives.
///
/// ω = J(ρ)·ρ′ with the left Jacobian J of the rotation group (Solà, Deray, Atchuthan, *A micro Lie theory for state
/// estimation in robotics*, arXiv 1812.01537, eq. 145), so ρ′ = J⁻¹ω; and ω′ = J·ρ″ + what ω′ is at ρ″ = 0.
pub(super) fn vector_jet(rotation: &Rotation, w: &Vector3, dw: &Vector3) -> [Vector3; 3] {
    let vector = rotation.scaled_axis();
    let first = without_jacobian(&vector, w);
    let zero = Vector3::zeros();
    let (_, [_, without_second, _]) =
        RotationVectorJet { vector, first, second: zero, third: zero }.rotation();
    [vector, first, without_jacobian(&vector, &(dw - without_second))]
}

/// J⁻¹(ρ)·w = w − ½ ρ×w + k ρ×(ρ×w), with k = (1 − (θ/2)·cot(θ/2))/θ², θ = |ρ| (ibid., eq. 146).
fn without_jacobian(r: &Vector3, w: &Vector3) -> Vector3 {
    let x = r.norm_squared();
    // (θ/2)·cot(θ/2) = C(x)/(2 S(x)); below the bound its series.
    let k = if x < SERIES_BELOW {
        1.0 / 12.0 + x * (1.0 / 720.0 + x * (1.0 / 30_240.0 + x * (1.0 / 1_209_600.0 + x / 47_900_160.0)))
    } else {
        let half = sqrt(x) / 2.0;
        (1.0 - half * cos(half) / sin(half)) / x
    };
    let across = r.cross(w);
    w - across * 0.5 + r.cross(&across) * k
}
