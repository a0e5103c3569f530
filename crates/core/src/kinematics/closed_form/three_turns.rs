//! A rotation as three turns, of which the first and the last are about the same axis of their frames.

use core::f64::consts::PI;

use nalgebra::Quaternion;

use crate::math::float::{atan2, sqrt};

/// The middle turn stands at a pole, and the first is free, if the tangent of half of it or its reciprocal is below
/// this: what is left out turns the flange by 2e-13 rad.
const POLE: f64 = 1e-13;

/// Angles with the middle one in [0, π].
#[derive(Debug, Clone, Copy)]
pub(crate) struct ThreeTurns {
    pub(crate) first: f64,
    pub(crate) middle: f64,
    pub(crate) last: f64,
    /// The first was free.
    pub(crate) at_pole: bool,
}

impl ThreeTurns {
    /// Of a rotation Rz·Ry·Rz; `free` is the first angle where it is free.
    #[inline]
    pub(crate) fn zyz(h: Quaternion<f64>, free: f64) -> Self {
        Self::of([h.w, h.k], [h.j, -h.i], free)
    }

    /// Of a rotation Ry·Rz·Ry.
    #[inline]
    pub(crate) fn yzy(h: Quaternion<f64>, free: f64) -> Self {
        Self::of([h.w, h.j], [h.k, h.i], free)
    }

    /// With σ and δ half the sum and half the difference of first and last angle, and μ half the middle one, the
    /// components of the rotation's quaternion are `straight` = cos μ·(cos σ, sin σ) and `bent` = sin μ·(cos δ, sin δ),
    /// to any common scale. Beside a pole one of σ, δ is uncertain and the other is not, so that the rotation is met all
    /// the same.
    #[inline]
    fn of(straight: [f64; 2], bent: [f64; 2], free: f64) -> Self {
        let length = |[a, b]: [f64; 2]| sqrt(a * a + b * b);
        let (cos_middle, sin_middle) = (length(straight), length(bent));
        let half_sum = atan2(straight[1], straight[0]);
        let half_difference = atan2(bent[1], bent[0]);
        if sin_middle <= POLE * cos_middle {
            Self { first: free, middle: 0.0, last: 2.0 * half_sum - free, at_pole: true }
        } else if cos_middle <= POLE * sin_middle {
            Self { first: free, middle: PI, last: free - 2.0 * half_difference, at_pole: true }
        } else {
            Self {
                first: half_sum + half_difference,
                middle: 2.0 * atan2(sin_middle, cos_middle),
                last: half_sum - half_difference,
                at_pole: false,
            }
        }
    }

    /// The same rotation with the middle angle negative.
    #[inline]
    pub(crate) fn flipped(self) -> Self {
        Self { first: self.first + PI, middle: -self.middle, last: self.last - PI, ..self }
    }
}

/// Rz(−α)·h for an angle with this (sin, cos), scaled: a quaternion of the half angle without a square root.
#[inline]
pub(crate) fn unturned_z(h: Quaternion<f64>, direction: (f64, f64)) -> Quaternion<f64> {
    let (v, w) = half(direction);
    Quaternion::new(w * h.w + v * h.k, w * h.i + v * h.j, w * h.j - v * h.i, w * h.k - v * h.w)
}

/// Ry(−α)·h, likewise.
#[inline]
pub(crate) fn unturned_y(h: Quaternion<f64>, direction: (f64, f64)) -> Quaternion<f64> {
    let (v, w) = half(direction);
    Quaternion::new(w * h.w + v * h.j, w * h.i - v * h.k, w * h.j - v * h.w, w * h.k + v * h.i)
}

/// (sin, cos) of half an angle, scaled by a common factor: (sin, 1 + cos) = 2 cos(α/2)·(sin(α/2), cos(α/2)), or
/// (1 − cos, sin) = 2 sin(α/2)·(sin(α/2), cos(α/2)), whichever is the longer.
#[inline]
fn half((sin, cos): (f64, f64)) -> (f64, f64) {
    if cos >= 0.0 { (sin, 1.0 + cos) } else { (1.0 - cos, sin) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Rotation, Vector3};

    #[test]
    fn both_orders_give_the_rotation_back() {
        let turn = |axis: Vector3, angle: f64| Rotation::from_scaled_axis(axis * angle);
        let (y, z) = (Vector3::y(), Vector3::z());
        for (first, middle, last) in [(0.3, 1.2, -2.0), (-3.0, 3.1, 1.0), (1.0, 1e-9, 1.5), (1.0, 0.0, 1.5)] {
            for (outer, inner) in [(z, y), (y, z)] {
                let rotation = turn(outer, first) * turn(inner, middle) * turn(outer, last);
                let h = rotation.into_inner();
                let found = if outer == z { ThreeTurns::zyz(h, 0.7) } else { ThreeTurns::yzy(h, 0.7) };
                assert_eq!(found.at_pole, middle == 0.0);
                for turns in [found, found.flipped()] {
                    let ThreeTurns { first, middle, last, .. } = turns;
                    let again = turn(outer, first) * turn(inner, middle) * turn(outer, last);
                    assert!(again.angle_to(&rotation) < 1e-15, "{turns:?}");
                }
            }
        }
    }

    #[test]
    fn at_a_pole_the_first_angle_is_free() {
        let half_turn =
            Rotation::from_scaled_axis(Vector3::y() * PI) * Rotation::from_scaled_axis(Vector3::z() * 0.4);
        let found = ThreeTurns::zyz(half_turn.into_inner(), 0.7);
        assert!(found.at_pole && found.middle == PI && found.first == 0.7);
        // Rz(a)·Ry(π)·Rz(c) depends on c − a alone.
        assert!((found.last - 1.1).abs() < 1e-15);
    }
}
