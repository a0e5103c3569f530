//! What the kinematics tests share.

use seamline::geometry::{Pose, Vector3};

/// SplitMix64 (Steele, Lea, Flood 2014): the same sequence on every machine.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub(crate) fn uniform(&mut self, min: f64, max: f64) -> f64 {
        min + (max - min) * ((self.next() >> 11) as f64 / (1u64 << 53) as f64)
    }

    pub(crate) fn joints<const N: usize>(&mut self, limits: &[(f64, f64); N]) -> [f64; N] {
        limits.map(|(min, max)| self.uniform(min, max))
    }

    pub(crate) fn vector(&mut self, size: f64) -> Vector3 {
        Vector3::from_fn(|_, _| self.uniform(-size, size))
    }
}

/// Distance between the positions in metres, angle between the orientations in radians. From the rotation's vector
/// part: exact also for the smallest angles.
pub(crate) fn pose_error(a: &Pose, b: &Pose) -> (f64, f64) {
    let turn = a.rotation.inverse() * b.rotation;
    ((a.translation.vector - b.translation.vector).norm(), 2.0 * turn.imag().norm().min(1.0).asin())
}

/// Greatest difference between joint positions.
pub(crate) fn joint_error<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// Greatest difference modulo full turns.
pub(crate) fn joint_error_modulo_turns<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    use std::f64::consts::TAU;
    a.iter().zip(b).fold(0.0, |most, (a, b)| {
        let d = (a - b).rem_euclid(TAU);
        most.max(d.min(TAU - d))
    })
}
