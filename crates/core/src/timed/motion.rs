//! The state chart at work: targets in, motion out.

use super::activity::{Activity, Event};
use super::error::{Error, Quantity};
use super::profile::{TimedProfile, at_rest, check_timing, finite};
use super::takeover::{self, Takeover};
use crate::otg::{Limits, Sample, State, Trajectory};

/// A new target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command<const N: usize> {
    /// Where the axes are to come to rest.
    pub target: [f64; N],
    /// Seconds from the command to the arrival: T.
    pub duration: f64,
    /// Time-scale factor n, above 0 and at most 1/2.
    pub n: f64,
}

/// What a new target has led to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planned<const N: usize> {
    /// Seconds until the axes are at rest in the target.
    pub duration: f64,
    /// What the motion keeps: |V|, |A| and |J| of a profile from rest; more where a motion is taken over.
    pub limits: Limits<N>,
    /// By how much the velocity jumps at once: zero but for [`Takeover::RestartFromRest`].
    pub velocity_jump: [f64; N],
    /// By how much the acceleration jumps at once, likewise.
    pub acceleration_jump: [f64; N],
}

/// Axes that go to each new target in its time, and hold the last one.
///
/// Instants are in seconds on any one clock. They must not go back: the motion has no memory of what is over.
///
/// ```
/// use seamline::timed::{Activity, Command, Takeover, TimedMotion};
/// let mut motion = TimedMotion::new([0.0], Takeover::Continuous)?;
/// motion.set_target(0.0, &Command { target: [100.0], duration: 3.0, n: 1.0 / 3.0 })?;
/// let before = motion.at(1.2);
/// let planned = motion.set_target(1.2, &Command { target: [40.0], duration: 3.0, n: 1.0 / 3.0 })?;
/// assert_eq!(motion.at(1.2).state(), before.state());
/// assert!((planned.duration - 3.0).abs() < 1e-12);
/// assert_eq!(motion.at(5.0).position, [40.0]);
/// assert_eq!(motion.activity(), Activity::Holding);
/// # Ok::<(), seamline::timed::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedMotion<const N: usize> {
    takeover: Takeover,
    activity: Activity,
    plan: Plan<N>,
    /// When the plan began.
    began: f64,
}

/// What is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Plan<const N: usize> {
    Rest([f64; N]),
    Profile(TimedProfile<N>),
    Takeover { trajectory: Trajectory<N>, target: [f64; N] },
}

impl<const N: usize> TimedMotion<N> {
    /// At rest in a position, without a target.
    ///
    /// # Errors
    /// A position that is not finite.
    pub fn new(position: [f64; N], takeover: Takeover) -> Result<Self, Error> {
        finite(&position, Quantity::Start)?;
        Ok(Self { takeover, activity: Activity::Start, plan: Plan::Rest(position), began: 0.0 })
    }

    /// What the axes were doing at the last instant asked for.
    #[must_use]
    pub fn activity(&self) -> Activity {
        self.activity
    }

    /// The motion at an instant. The axes hold the last target when they have reached it. An instant before the last
    /// command is that of the command.
    #[must_use]
    pub fn at(&mut self, instant: f64) -> Sample<N> {
        let elapsed = instant - self.began;
        if elapsed >= self.plan.duration()
            && let Some(next) = self.activity.after(Event::Arrived)
        {
            self.activity = next;
            self.plan = Plan::Rest(self.plan.target());
        }
        self.plan.at_time(elapsed)
    }

    /// Plans anew to a target that comes at an instant, from where the axes are then.
    ///
    /// # Errors
    /// As [`TimedProfile::new`]; an instant that is not finite; no motion within the range of floats. The motion then
    /// goes on to the target it had.
    ///
    /// # Cost
    /// From rest some ten divisions an axis; out of motion one call of [`crate::otg::calculate`].
    pub fn set_target(&mut self, instant: f64, command: &Command<N>) -> Result<Planned<N>, Error> {
        if !instant.is_finite() {
            return Err(Error::BadInstant { value: instant });
        }
        let &Command { target, duration, n } = command;
        let current = self.at(instant).state();
        let moves = current.velocity.iter().chain(&current.acceleration).any(|&x| x != 0.0);
        let (plan, planned) = if moves && self.takeover == Takeover::Continuous {
            finite(&target, Quantity::Target)?;
            check_timing(duration, n)?;
            let limits = takeover::limits(&current, &target, duration, n);
            let trajectory = takeover::plan(&current, &target, duration, &limits)?;
            let planned = Planned {
                duration: trajectory.duration(),
                limits,
                velocity_jump: [0.0; N],
                acceleration_jump: [0.0; N],
            };
            (Plan::Takeover { trajectory, target }, planned)
        } else {
            let profile = TimedProfile::new(current.position, target, duration, n)?;
            (Plan::Profile(profile), from_rest(&profile, &current))
        };
        if let Some(next) = self.activity.after(Event::NewTarget) {
            (self.activity, self.plan, self.began) = (next, plan, instant);
        }
        Ok(planned)
    }
}

/// What a profile from rest does to axes in this state.
fn from_rest<const N: usize>(profile: &TimedProfile<N>, current: &State<N>) -> Planned<N> {
    let size = |x: [f64; N]| x.map(f64::abs);
    // Zero stays without a sign.
    let to_zero = |x: [f64; N]| x.map(|x| 0.0 - x);
    Planned {
        duration: profile.duration(),
        limits: Limits::symmetric(
            size(profile.velocity()),
            size(profile.acceleration()),
            size(profile.jerk()),
        ),
        velocity_jump: to_zero(current.velocity),
        acceleration_jump: to_zero(current.acceleration),
    }
}

impl<const N: usize> Plan<N> {
    fn duration(&self) -> f64 {
        match self {
            Self::Rest(_) => 0.0,
            Self::Profile(profile) => profile.duration(),
            Self::Takeover { trajectory, .. } => trajectory.duration(),
        }
    }

    fn target(&self) -> [f64; N] {
        match self {
            Self::Rest(position) => *position,
            Self::Profile(profile) => profile.target(),
            Self::Takeover { target, .. } => *target,
        }
    }

    fn at_time(&self, time: f64) -> Sample<N> {
        match self {
            Self::Rest(position) => at_rest(*position),
            Self::Profile(profile) => profile.at_time(time),
            Self::Takeover { trajectory, .. } => trajectory.at_time(time),
        }
    }
}
