//! Path-true speed: how fast a tool may follow its path so that every joint keeps its limits at every
//! instant.
//!
//! The tool follows a path x(s), s from 0 to L, and the joints follow q(s). Only s(t) is chosen, from rest to
//! rest: near time-optimal under |q̇| ≤ V, |q̈| ≤ A, |q⃛| ≤ J of every joint and ṡ, s̈, s⃛ within the path's
//! own limits. The tool never leaves the path; where a joint cannot follow, the tool slows down beforehand.
//!
//! # Units
//! SI: radians or metres for joints; the path coordinate is what the path makes it (metres, or radians for a
//! turn on the spot), and the path limits are given in the same unit.
//!
//! # How
//! 1. The course's stretches give a plain motion: their limits alone, a backward and a forward pass over the
//!    speeds where they meet (`plain`). It is judged (`check`). If every joint can follow, it is the answer.
//!    Where only ramps ask too much, by little, there is less acceleration and jerk in their stretches (`gentler`).
//! 2. Around what the joints cannot follow, windows are laid, wide enough to brake in, from and to places where the
//!    plain motion has no acceleration. Outside them it stays, at exactly the programmed speeds (`assemble`).
//! 3. In each window a first guess of the motion (`crude`) gives a coordinate w close to time: s(w), a smooth
//!    spline (`coordinate`). In w the fastest motion is nearly a convex program for β = ẇ² (`program`),
//!    solved by an interior-point method (`interior_point`), roughly at first; then with that motion as the
//!    new coordinate (`window`), a long window split where the rough motion is nearly without acceleration
//!    (`anchor`).
//! 4. The motion is written as pieces of degree five in t, one from knot to knot (5 ms), that agree in
//!    position, velocity and acceleration. These pieces, not the program, are judged; where they pass a limit
//!    between knots, that limit is lowered there and the program is solved again from where it stood. What is
//!    left, below 0.05 % of time as a rule, is taken away by slowing the window down all along, smoothly in and
//!    out at ends in motion. A window that asks for more is laid wider.
//! 5. If all that fails, the stretches that ask too much are run slower; and if that fails too, the plain motion from rest is stretched as
//!    a whole until it fits. [`Timing::kind`] tells.
//!
//! # A path that goes on
//! With [`Course::open`] the path ends at rest only until more of it is known. [`Timing::settled`] tells which
//! pieces do not depend on that; the next call starts behind them, in motion. The rest of the motion stays the way
//! out: it ends at rest within all limits, whatever comes. With 1 s known ahead, 95 % of 300 chains, most of them beside a singularity, took
//! up to 6 % longer than timed whole, the slowest 13 %; with 2 s 4 % and 8 %. It may happen that no motion is found from a start in motion just before a
//! singularity: then the tool stops, with 1 s in 64 of these chains, with 2 s in 29.
//!
//! # What is sure
//! Every timing that is returned has been judged with exact derivatives of the path at samples, 1.25 ms apart
//! or closer where it was optimized, and between them as `check` describes: by prediction from sample to
//! sample, not by interval arithmetic. From a start in motion a limit may be passed by 0.15 % (of the jerk; less of
//! the others) where slowing down would come too late. The last bit of optimality is not proved; measured against
//! TOPP-RA, which knows no jerk limit, motions take 0.4 % more time in the median. Resolution ends where rounding does: a wrist that passes its
//! singularity at less than about 10⁻⁹ rad is no longer told from one that flips; the result is then an error
//! or a stretched S-curve of absurd length.
//!
//! # The path's part
//! The joints must stay on one branch of the inverse kinematics and be three times differentiable along the
//! path: beside a singularity they turn fast, and the nearest solution to the last one may be another branch.
//! Where curvature jumps (a line that runs into an arc) no speed but zero will do, and
//! [`TimingError::Discontinuous`] says so.

mod anchor;
mod assemble;
mod banded;
mod check;
mod coordinate;
mod course;
mod crude;
mod gentler;
mod interior_point;
mod motion;
mod plain;
mod program;
mod slowdown;
mod window;

use course::Limits;
pub(super) use course::least;
use seamline::kinematics::JointJet;

pub use course::{Course, Stretch};
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

/// Shares of the acceleration and jerk limits of joints that planned motion uses, with [room](TimingLimits::with_room).
const JOINT_SHARES: (f64, f64) = (0.98, 0.97);
/// The same along the path: its limits are used up by every start and stop.
const PATH_SHARES: (f64, f64) = (0.97, 0.95);

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

impl<const N: usize> TimingLimits<N> {
    /// A little less of acceleration and jerk, so that override, pause and stop have room everywhere.
    ///
    /// Where a plan uses a limit up, the rate of its time cannot be changed against that limit until the plan lets go.
    /// It costs 0.3 % of the time near singularities (95 %; next to nothing in the median), and takes a third off the
    /// longest waits.
    #[must_use]
    pub fn with_room(&self) -> Self {
        Self {
            velocity: self.velocity,
            acceleration: self.acceleration.map(|limit| limit * JOINT_SHARES.0),
            jerk: self.jerk.map(|limit| limit * JOINT_SHARES.1),
        }
    }
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

impl PathLimits {
    /// Of the speed only; the others are infinite.
    #[must_use]
    pub fn of_speed(speed: f64) -> Self {
        Self { speed, acceleration: f64::INFINITY, jerk: f64::INFINITY }
    }

    /// The lesser ones of both.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            speed: self.speed.min(other.speed),
            acceleration: self.acceleration.min(other.acceleration),
            jerk: self.jerk.min(other.jerk),
        }
    }

    /// As [of joints](TimingLimits::with_room); the speed stays.
    #[must_use]
    pub fn with_room(&self) -> Self {
        Self {
            speed: self.speed,
            acceleration: self.acceleration * PATH_SHARES.0,
            jerk: self.jerk * PATH_SHARES.1,
        }
    }
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
    /// A stretch of the path ends before it begins, or the last one does not end with the path.
    Stretch {
        /// Which one, counted from 0.
        index: usize,
        /// Where it ends.
        to: f64,
    },
    /// The path cannot be entered at this speed: its limits do not allow it, or leave no way to stop.
    Start {
        /// The speed.
        speed: f64,
        /// The highest that would do.
        limit: f64,
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
    /// A joint's position, velocity or acceleration along the path jumps, or is not a number: no speed but
    /// zero would do.
    Discontinuous {
        /// Path coordinate.
        position: f64,
        /// The joint, counted from 0.
        joint: usize,
    },
    /// Not even 10¹⁷ times slower than programmed would the joints keep their limits; or, from a start in motion,
    /// no motion was found. The way to rest that was planned up to there then stands.
    NoSpeed,
}

/// The near time-optimal motion along `path` to rest at its end, within all limits at every instant.
///
/// Where the joints can follow the programmed speeds all the way, it is the motion of the path limits alone.
/// Costs a few per cent of the motion's duration where it is not, on one core, next to nothing where it is;
/// both are linear in the length and in the number of stretches.
///
/// # Errors
/// [`TimingError`] where a limit, the length or the start is unusable, or where no speed but zero keeps the joints'
/// limits.
///
/// # Example
/// A joint that turns through one radian along a path of one metre, slower than the path alone would have
/// it:
/// ```
/// use seamline::kinematics::JointJet;
/// use seamline_cell::plan::timing::{
///     Course, JointPath, PathLimits, Stretch, TimingKind, TimingLimits, time_path,
/// };
///
/// struct Swing;
/// impl JointPath<1> for Swing {
///     type Error = ();
///     fn length(&self) -> f64 {
///         1.0
///     }
///     fn jet(&mut self, s: f64) -> Result<JointJet<1>, ()> {
///         Ok(JointJet { position: [s], velocity: [1.0], acceleration: [0.0], jerk: [0.0] })
///     }
/// }
/// let joints = TimingLimits { velocity: [0.5], acceleration: [5.0], jerk: [250.0] };
/// let limits = PathLimits { speed: 1.0, acceleration: 10.0, jerk: 500.0 };
/// let stretches = [Stretch { to: 1.0, limits }];
/// let timing = time_path(&mut Swing, &joints, &Course::whole(&stretches)).unwrap();
/// assert_eq!(timing.kind(), TimingKind::Optimized);
/// let middle = timing.at(timing.duration() / 2.0);
/// assert!(middle.velocity <= 0.5 && middle.velocity > 0.498);
/// assert_eq!(timing.slowdowns()[0].joint, 0);
/// ```
pub fn time_path<const N: usize, P: JointPath<N>>(
    path: &mut P,
    joints: &TimingLimits<N>,
    course: &Course<'_>,
) -> Result<Timing, TimingError<P::Error>> {
    validate(path.length(), joints)?;
    let limits = &Limits::new(course.stretches, path.length())?;
    if path.length() == 0.0 {
        return Ok(Timing::new(Vec::new(), TimingKind::Plain, Vec::new()));
    }
    assemble::Task { path, joints, limits, start: course.start, open: course.open }.timing()
}

fn validate<const N: usize, E>(length: f64, joints: &TimingLimits<N>) -> Result<(), TimingError<E>> {
    let usable = |value: f64| value > 0.0 && value.is_finite();
    if !(length >= 0.0 && length.is_finite()) {
        return Err(TimingError::Length(length));
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
