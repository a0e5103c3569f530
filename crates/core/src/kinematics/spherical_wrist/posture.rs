//! The branches of the inverse by name.

use core::f64::consts::PI;

use super::SphericalWristArm;
use crate::math::float::{sin, sin_cos};

/// Which side of axis 1 the wrist centre is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shoulder {
    /// On the side that the arm faces at θ₁.
    Front,
    /// Behind: the arm reaches over its head.
    Rear,
}

/// On which side of the line from shoulder to wrist the elbow is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Elbow {
    /// Above the line, as the arm stands upright.
    Upper,
    /// Below it.
    Lower,
}

/// To which side of its pole the wrist is bent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wrist {
    /// The maker's fifth joint is negative (between its two poles).
    NoFlip,
    /// The maker's fifth joint is positive, or at a pole.
    Flip,
}

/// One of the eight branches of the inverse. Along a motion it changes only at singularities: each flag at its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Posture {
    /// Front or rear.
    pub shoulder: Shoulder,
    /// Upper or lower arm.
    pub elbow: Elbow,
    /// No-flip or flip.
    pub wrist: Wrist,
}

/// A posture with the turn of the three joints that may turn further than half way: the content of INFORM's
/// `///RCONF` (digits in this order: flip, upper/lower arm, front/rear, R, T, S).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Configuration {
    /// The branch.
    pub posture: Posture,
    /// Whether axis 4 (R) stands at half a turn or further.
    pub far_turn_4: bool,
    /// Whether axis 6 (T) does.
    pub far_turn_6: bool,
    /// Whether axis 1 (S) does.
    pub far_turn_1: bool,
}

impl Configuration {
    /// From the first six digits of an `RCONF` line: 0 flip, upper arm, front, below 180°; 1 no-flip, lower arm,
    /// rear, 180° or more. Nothing for other digits.
    #[must_use]
    pub fn from_rconf(digits: [u8; 6]) -> Option<Self> {
        if digits.iter().any(|&digit| digit > 1) {
            return None;
        }
        let [flip, elbow, shoulder, r, t, s] = digits.map(|digit| digit == 1);
        let posture = Posture {
            shoulder: if shoulder { Shoulder::Rear } else { Shoulder::Front },
            elbow: if elbow { Elbow::Lower } else { Elbow::Upper },
            wrist: if flip { Wrist::NoFlip } else { Wrist::Flip },
        };
        Some(Self { posture, far_turn_4: r, far_turn_6: t, far_turn_1: s })
    }

    /// The first six digits of an `RCONF` line.
    #[must_use]
    pub fn to_rconf(self) -> [u8; 6] {
        let Posture { shoulder, elbow, wrist } = self.posture;
        [
            wrist == Wrist::NoFlip,
            elbow == Elbow::Lower,
            shoulder == Shoulder::Rear,
            self.far_turn_4,
            self.far_turn_6,
            self.far_turn_1,
        ]
        .map(u8::from)
    }
}

impl SphericalWristArm {
    /// The posture of the arm at joint positions `q`.
    #[must_use]
    pub fn posture(&self, q: &[f64; 6]) -> Posture {
        let theta = self.thetas(q);
        let out = self.wrist_radius(&theta);
        let elbow = sin(theta[2] + self.elbow_angle);
        Posture::new(out >= 0.0, elbow >= 0.0, self.geometry.signs[4] * sin(theta[4]) >= 0.0)
    }

    /// The posture and turns of the arm at joint positions `q`.
    #[must_use]
    pub fn configuration(&self, q: &[f64; 6]) -> Configuration {
        let far = |axis: usize| q[axis].abs() >= PI;
        Configuration { posture: self.posture(q), far_turn_4: far(3), far_turn_6: far(5), far_turn_1: far(0) }
    }

    /// The wrist centre's coordinate along the arm's plane, from axis 1: negative behind. Metres.
    pub(super) fn wrist_radius(&self, theta: &[f64; 6]) -> f64 {
        let g = &self.geometry;
        let (sin23, cos23) = sin_cos(theta[1] + theta[2]);
        g.shoulder_offset + g.upper_arm * sin(theta[1]) + g.elbow_offset * cos23 + g.forearm * sin23
    }
}

impl Posture {
    /// From the signs: the wrist centre in front of axis 1, the forearm bent to the front of the upper arm, the
    /// maker's fifth joint positive. Seen from the rear, an arm bent to its front is a lower one.
    #[inline]
    pub(super) fn new(front: bool, bent_forward: bool, wrist_positive: bool) -> Self {
        Self {
            shoulder: if front { Shoulder::Front } else { Shoulder::Rear },
            elbow: if front == bent_forward { Elbow::Upper } else { Elbow::Lower },
            wrist: if wrist_positive { Wrist::Flip } else { Wrist::NoFlip },
        }
    }
}
