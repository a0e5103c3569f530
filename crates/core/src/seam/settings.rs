//! What the cell says about tracking, and whether the sensor's look-ahead suffices.

use core::fmt;

use super::gate::REACH;
use super::guard::Bounds;
use super::mean;
use super::measurement::Sensor;
use super::tack::TackMask;

/// How readings become the lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Filter {
    /// Robust local regression over path length.
    Regression,
    /// The source's: the mean of the last good readings, 10 to 20 of them as a rule (1 … 32).
    Mean {
        /// How many.
        readings: usize,
    },
}

/// Where the lane goes when the seam is lost, after its trend has faded out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LostLane {
    /// It keeps its last offset.
    Hold,
    /// It returns to the taught path.
    Taught,
}

/// All that seam tracking needs to know about a weld.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The sensor.
    pub sensor: Sensor,
    /// Travel speed of the weld at full override, in m/s; the greatest, where moves differ.
    pub speed: f64,
    /// Time between two cycles, in seconds.
    pub period: f64,
    /// How readings become the lane.
    pub filter: Filter,
    /// Greatest correction in each direction, in metres.
    pub bound: f64,
    /// Greatest change of the correction in one cycle at full speed, in each direction, in metres.
    pub saturation: f64,
    /// Jerk across the seam that the correction may cause at full speed, in m/s³.
    pub jerk: f64,
    /// Greatest curvature of the taught path, in 1/m.
    pub curvature: f64,
    /// How far ahead of the torch the lane must be frozen, in metres.
    pub frozen_ahead: f64,
    /// What the lane does when the seam is lost.
    pub lost: LostLane,
    /// Length without readings from which on the seam counts as lost, in metres.
    pub lost_distance: f64,
    /// Time without readings from which on it does, in seconds.
    pub lost_time: f64,
    /// Tack welds that are not to be followed.
    pub tacks: Option<TackMask>,
}

/// Why a weld cannot be tracked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SettingsError {
    /// A number that is not positive and finite.
    NotPositive {
        /// Which one.
        name: &'static str,
        /// As given, SI.
        value: f64,
    },
    /// The mean is over no reading, or over too many.
    Mean {
        /// As given.
        readings: usize,
    },
    /// The sensor does not look far enough ahead for this speed.
    LookAhead {
        /// What it would need, in metres.
        needed: f64,
        /// What it has.
        has: f64,
        /// Greatest speed with which it would do, in m/s; zero if none.
        speed: f64,
    },
}

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotPositive { name, value } => write!(f, "{name} {value}: expected a number above 0"),
            Self::Mean { readings } => {
                write!(f, "mean of {readings} readings: expected 1 to {}", mean::CAPACITY)
            }
            Self::LookAhead { needed, has, speed } => {
                write!(
                    f,
                    "the sensor looks {:.1} mm ahead: {:.1} mm are needed at this speed",
                    has * 1e3,
                    needed * 1e3
                )?;
                if *speed > 0.0 {
                    write!(f, "; {:.0} mm/s would do", speed * 1e3)?;
                }
                Ok(())
            }
        }
    }
}

impl core::error::Error for SettingsError {}

/// Where the look-ahead goes, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    /// How far the sensor looks ahead.
    pub look_ahead: f64,
    /// Half width h of the regression's window, or half the mean's length.
    pub filter: f64,
    /// Two knots of the lane, and what shall be frozen beyond.
    pub lane: f64,
    /// The gate's readings on the far side, and the one under way.
    pub gate: f64,
    /// Travel while a reading arrives.
    pub latency: f64,
}

impl Budget {
    /// What is left. Below zero the lane must freeze before all readings that belong to it are there.
    #[must_use]
    pub fn left(&self) -> f64 {
        self.look_ahead - self.filter - self.lane - self.gate - self.latency
    }
}

/// Speed above which the knots stand twice as far apart.
const FAST: f64 = 0.06;
/// Distance of the lane's knots, in metres.
const SPACING: f64 = 2e-3;
/// Readings wanted on either side of a knot, where the window's bounds permit.
const READINGS: f64 = 40.0;
/// Least and greatest half width of the window in metres, and its greatest share of the look-ahead.
const HALF_WIDTH: (f64, f64) = (4e-3, 14e-3);
const SHARE: f64 = 0.4;
/// Bins to a knot.
const BINS: f64 = 4.0;

/// What follows from the settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Design {
    /// Distance of the knots Δ, half width of the window h, width of the bins.
    pub(super) spacing: f64,
    pub(super) half: f64,
    pub(super) bin: f64,
    /// A control point freezes at the latest when the torch is this far before it.
    pub(super) lead: f64,
    /// Distance between neighbouring readings from which on there is a gap.
    pub(super) gap: f64,
    pub(super) bounds: Bounds,
}

impl Settings {
    /// Tracking with a sensor at a travel speed: 1 ms cycle, corrections up to 10 mm and 0.1 mm a cycle, jerk up to 20 m/s³, a path with
    /// radii from 50 mm on, no tacks; the seam counts as lost after 25 mm or 2 s without a reading, and the lane then holds.
    #[must_use]
    pub fn new(sensor: Sensor, speed: f64) -> Self {
        Self {
            sensor,
            speed,
            period: 1e-3,
            filter: Filter::Regression,
            bound: 10e-3,
            saturation: 0.1e-3,
            jerk: 20.0,
            curvature: 20.0,
            frozen_ahead: 0.0,
            lost: LostLane::Hold,
            lost_distance: 25e-3,
            lost_time: 2.0,
            tacks: None,
        }
    }

    /// Checks the settings, and says where the look-ahead goes.
    ///
    /// # Errors
    /// [`SettingsError`] with what is wrong, and the speed that would do where the look-ahead does not suffice.
    pub fn check(&self) -> Result<Budget, SettingsError> {
        let positive = [
            ("look-ahead", self.sensor.look_ahead()),
            ("sensor range", self.sensor.range.min()),
            ("sensor rate", self.sensor.rate),
            ("greatest age", self.sensor.age_max),
            ("speed", self.speed),
            ("period", self.period),
            ("bound", self.bound),
            ("saturation", self.saturation),
            ("jerk", self.jerk),
            ("lost distance", self.lost_distance),
            ("lost time", self.lost_time),
        ];
        let zero_or_more = [
            ("latency", self.sensor.latency),
            ("curvature", self.curvature),
            ("frozen ahead", self.frozen_ahead),
        ];
        let bad = |least_is_bad: bool| {
            move |(_, value): &&(&str, f64)| {
                !(value.is_finite() && (*value > 0.0 || (!least_is_bad && *value == 0.0)))
            }
        };
        let wrong = positive.iter().find(bad(true)).or_else(|| zero_or_more.iter().find(bad(false)));
        if let Some(&(name, value)) = wrong {
            return Err(SettingsError::NotPositive { name, value });
        }
        // On the inner side of a bend the torch would stand still, or run backwards.
        let inner = 1.0 - self.curvature * self.bound;
        if inner <= 0.0 {
            return Err(SettingsError::NotPositive {
                name: "radius less bound",
                value: inner / self.curvature,
            });
        }
        if let Filter::Mean { readings } = self.filter
            && !(1..=mean::CAPACITY).contains(&readings)
        {
            return Err(SettingsError::Mean { readings });
        }
        let budget = self.budget(self.speed);
        if budget.left() <= 0.0 {
            let has = budget.look_ahead;
            return Err(SettingsError::LookAhead {
                needed: has - budget.left(),
                has,
                speed: self.speed_that_would_do(),
            });
        }
        Ok(budget)
    }

    fn budget(&self, speed: f64) -> Budget {
        let apart = speed / self.sensor.rate;
        let filter = match self.filter {
            Filter::Regression => self.half_width(speed),
            Filter::Mean { readings } => 0.5 * readings as f64 * apart,
        };
        Budget {
            look_ahead: self.sensor.look_ahead(),
            filter,
            lane: 2.0 * spacing(speed) + self.frozen_ahead,
            gate: (REACH + 1) as f64 * apart,
            latency: speed * self.sensor.latency,
        }
    }

    /// The budget falls with the speed: the greatest speed that leaves something, by 40 halvings; zero where none does.
    fn speed_that_would_do(&self) -> f64 {
        let (mut slow, mut fast) = (0.0, self.speed);
        for _ in 0..40 {
            let middle = 0.5 * (slow + fast);
            if self.budget(middle).left() > 0.0 {
                slow = middle;
            } else {
                fast = middle;
            }
        }
        // Rounded down to what is written.
        crate::math::float::floor(slow * 1e3) * 1e-3
    }

    fn half_width(&self, speed: f64) -> f64 {
        let (least, most) = HALF_WIDTH;
        (READINGS * speed / self.sensor.rate).max(least).min(most.min(SHARE * self.sensor.look_ahead()))
    }

    pub(super) fn design(&self) -> Design {
        let spacing = spacing(self.speed);
        let along = self.speed / (1.0 - self.curvature * self.bound);
        let per_spacing = spacing / along;
        Design {
            spacing,
            half: self.half_width(self.speed),
            bin: spacing / BINS,
            lead: 2.0 * spacing + self.frozen_ahead + 2.0 * along * self.period,
            gap: (5.0 * self.speed / self.sensor.rate).max(3e-3),
            bounds: Bounds {
                offset: self.bound,
                step: self.saturation / self.period * per_spacing,
                third: self.jerk * per_spacing * per_spacing * per_spacing,
            },
        }
    }
}

fn spacing(speed: f64) -> f64 {
    if speed > FAST { 2.0 * SPACING } else { SPACING }
}
