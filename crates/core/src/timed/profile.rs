//! The timed profile: from rest to rest in a given time.

use super::error::{Error, Quantity};
use super::shape::Shape;
use crate::otg::Sample;

/// A motion from rest in S to rest in G that takes exactly the time T. N axes move on a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedProfile<const N: usize> {
    start: [f64; N],
    target: [f64; N],
    duration: f64,
    shape: Shape,
}

impl<const N: usize> TimedProfile<N> {
    /// The profile from `start` to `target` in `duration` seconds with the time-scale factor `n`, 0 < n ≤ 1/2: the share
    /// of the time that each of the two ramps takes.
    ///
    /// ```
    /// use seamline::timed::TimedProfile;
    /// let profile = TimedProfile::new([0.0], [100.0], 3.0, 1.0 / 3.0)?;
    /// let [v, a, j] = [profile.velocity(), profile.acceleration(), profile.jerk()].map(|[x]| x.round());
    /// assert_eq!((v, a, j), (50.0, 75.0, 225.0));
    /// assert_eq!(profile.at_time(3.0).position, [100.0]);
    /// # Ok::<(), seamline::timed::Error>(())
    /// ```
    ///
    /// # Errors
    /// A position that is not finite, a duration that is not positive, an n out of range, and velocities, accelerations
    /// or jerks that overflow.
    pub fn new(start: [f64; N], target: [f64; N], duration: f64, n: f64) -> Result<Self, Error> {
        finite(&start, Quantity::Start)?;
        finite(&target, Quantity::Target)?;
        check_timing(duration, n)?;
        let profile = Self { start, target, duration, shape: Shape::new(n) };
        let (v, a, j) = (profile.velocity(), profile.acceleration(), profile.jerk());
        match (0..N).find(|&axis| !(v[axis].is_finite() && a[axis].is_finite() && j[axis].is_finite())) {
            Some(axis) => Err(Error::OutOfRange { axis }),
            None => Ok(profile),
        }
    }

    /// The velocity of the cruise, V of equation (4), with its sign.
    #[must_use]
    pub fn velocity(&self) -> [f64; N] {
        self.mean_velocity().map(|mean| mean * self.shape.velocity)
    }

    /// The greatest acceleration, A of equation (5), with the sign of the displacement.
    #[must_use]
    pub fn acceleration(&self) -> [f64; N] {
        self.mean_velocity().map(|mean| mean / self.duration * self.shape.acceleration)
    }

    /// The jerk of the first phase, J of equation (6), with the sign of the displacement.
    #[must_use]
    pub fn jerk(&self) -> [f64; N] {
        self.mean_velocity().map(|mean| mean / self.duration / self.duration * self.shape.jerk)
    }

    /// The ends of the seven phases, in seconds; the last is the duration.
    #[must_use]
    pub fn switch_times(&self) -> [f64; 7] {
        self.shape.switches().map(|u| u * self.duration)
    }

    /// Seconds from start to target: T.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Where the motion ends.
    #[must_use]
    pub fn target(&self) -> [f64; N] {
        self.target
    }

    /// The motion at a time, in seconds from the start. Exactly the start before it; exactly the target, at rest, from T
    /// on. At a switch time the jerk is one of the two it has there.
    #[must_use]
    pub fn at_time(&self, time: f64) -> Sample<N> {
        if time >= self.duration {
            return at_rest(self.target);
        }
        let u = if time > 0.0 { time / self.duration } else { 0.0 };
        if u <= 0.5 {
            self.counted_from(&self.start, u, 1.0)
        } else {
            self.counted_from(&self.target, 1.0 - u, -1.0)
        }
    }

    /// The motion at the share `u` ≤ 1/2 of the time after the start (`side` = 1), or before the end (`side` = −1): so
    /// both ends are exact, and the motion is as good beside the one as beside the other.
    fn counted_from(&self, end: &[f64; N], u: f64, side: f64) -> Sample<N> {
        let point = self.shape.first_half(u);
        let (mean, t) = (self.mean_velocity(), self.duration);
        Sample {
            position: core::array::from_fn(|axis| {
                end[axis] + side * point.displacement * (self.target[axis] - self.start[axis])
            }),
            velocity: mean.map(|v| v * point.velocity),
            acceleration: mean.map(|v| side * (v / t * point.acceleration)),
            jerk: mean.map(|v| v / t / t * point.jerk),
        }
    }

    /// (G − S) / T.
    fn mean_velocity(&self) -> [f64; N] {
        core::array::from_fn(|axis| (self.target[axis] - self.start[axis]) / self.duration)
    }
}

/// No motion in this position.
pub(super) fn at_rest<const N: usize>(position: [f64; N]) -> Sample<N> {
    Sample { position, velocity: [0.0; N], acceleration: [0.0; N], jerk: [0.0; N] }
}

/// Refuses positions that are not finite.
pub(super) fn finite<const N: usize>(position: &[f64; N], quantity: Quantity) -> Result<(), Error> {
    match position.iter().enumerate().find(|(_, value)| !value.is_finite()) {
        Some((axis, &value)) => Err(Error::NotFinite { axis, quantity, value }),
        None => Ok(()),
    }
}

/// Refuses a duration or a time-scale factor that no profile has. Written so that NaN fails.
pub(super) fn check_timing(duration: f64, n: f64) -> Result<(), Error> {
    if !(duration > 0.0 && duration.is_finite()) {
        Err(Error::BadDuration { value: duration })
    } else if !(n > 0.0 && n <= 0.5) {
        Err(Error::BadTimeScale { value: n })
    } else {
        Ok(())
    }
}
