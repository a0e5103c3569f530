//! Path-true speed: how fast a tool may follow its path so that every joint keeps its limits at every instant.
//!
//! The tool follows a path x(s), s from 0 to L, and the joints follow q(s). Only s(t) is chosen, from rest to rest:
//! near time-optimal under |q̇| ≤ V, |q̈| ≤ A, |q⃛| ≤ J of every joint and ṡ, s̈, s⃛ within the path's own limits. The tool
//! never leaves the path; where a joint cannot follow, the tool slows down beforehand.
//!
//! # Units
//! SI: radians or metres for joints; the path coordinate is what the path makes it (metres, or radians for a turn on
//! the spot), and the path limits are given in the same unit.

mod assemble;
mod banded;
mod check;
mod coordinate;
mod crude;
mod interior_point;
mod motion;
mod program;
mod s_curve;
mod slowdown;
mod window;

use seamline::kinematics::JointJet;

pub use motion::{Order, PathState, Slowdown, Timing, TimingKind, TimingPiece};

/// A path as the joints see it.
pub trait JointPath<const N: usize> {
    /// Why a place on the path has no joint positions or no derivatives.
    type Error: Copy + core::fmt::Debug;

    /// Length L of the path.
    fn length(&self) -> f64;

    /// Joints and their exact derivatives at `s` in [0, L]. Places are asked for in any order.
    ///
    /// # Errors
    /// Where the path is out of reach or crosses a singularity.
    fn jet(&mut self, s: f64) -> Result<JointJet<N>, Self::Error>;
}

/// Limits of each joint, symmetric about zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimingLimits<const N: usize> {
    /// Highest |q̇|.
    pub velocity: [f64; N],
    /// Highest |q̈|.
    pub acceleration: [f64; N],
    /// Highest |q⃛|.
    pub jerk: [f64; N],
}

/// Limits of the motion along the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathLimits {
    /// Programmed speed: highest ṡ.
    pub speed: f64,
    /// Highest |s̈|.
    pub acceleration: f64,
    /// Highest |s⃛|.
    pub jerk: f64,
}

/// Why there is no timing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimingError<E> {
    /// The length of the path is negative or not finite.
    Length(f64),
    /// A limit of the path is not positive and finite.
    PathLimit {
        /// Which one.
        order: Order,
        /// Its value.
        value: f64,
    },
    /// A limit of a joint is not positive and finite.
    JointLimit {
        /// The joint, counted from 0.
        joint: usize,
        /// Which one.
        order: Order,
        /// Its value.
        value: f64,
    },
    /// The joints cannot follow the path at this place.
    Path {
        /// Path coordinate.
        position: f64,
        /// What the path says about it.
        error: E,
    },
    /// A joint's position, velocity or acceleration along the path jumps, or is not a number: no speed but zero would do.
    Discontinuous {
        /// Path coordinate.
        position: f64,
        /// The joint, counted from 0.
        joint: usize,
    },
}

/// The near time-optimal motion along `path`, from rest to rest, within all limits at every instant.
///
/// Where the joints can follow the programmed speed all the way, it is the S-curve of the path limits alone.
///
/// # Errors
/// [`TimingError`] where a limit or the length is unusable, or where no speed but zero keeps the joints' limits.
pub fn time_path<const N: usize, P: JointPath<N>>(
    path: &mut P,
    joints: &TimingLimits<N>,
    limits: &PathLimits,
) -> Result<Timing, TimingError<P::Error>> {
    validate(path.length(), joints, limits)?;
    if path.length() == 0.0 {
        return Ok(Timing::new(Vec::new(), TimingKind::Plain, Vec::new()));
    }
    assemble::Task { path, joints, limits }.timing()
}

fn validate<const N: usize, E>(
    length: f64,
    joints: &TimingLimits<N>,
    limits: &PathLimits,
) -> Result<(), TimingError<E>> {
    let usable = |value: f64| value > 0.0 && value.is_finite();
    if !(length >= 0.0 && length.is_finite()) {
        return Err(TimingError::Length(length));
    }
    let path_limits = [
        (Order::Velocity, limits.speed),
        (Order::Acceleration, limits.acceleration),
        (Order::Jerk, limits.jerk),
    ];
    for (order, value) in path_limits {
        if !usable(value) {
            return Err(TimingError::PathLimit { order, value });
        }
    }
    let joint_limits = [
        (Order::Velocity, &joints.velocity),
        (Order::Acceleration, &joints.acceleration),
        (Order::Jerk, &joints.jerk),
    ];
    for (order, values) in joint_limits {
        for (joint, &value) in values.iter().enumerate() {
            if !usable(value) {
                return Err(TimingError::JointLimit { joint, order, value });
            }
        }
    }
    Ok(())
}
