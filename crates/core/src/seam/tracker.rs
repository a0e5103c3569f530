//! Seam tracking, one cycle at a time.

use core::mem::discriminant;

use super::Offset;
use super::bins::Bins;
use super::estimate::{Estimate, Trend, estimate};
use super::fade::Fade;
use super::gate::{Gate, Sighting};
use super::guard::{Bounds, Guard};
use super::lane::Lane;
use super::mean::MovingMean;
use super::measurement::{Counts, Reading, Rejection};
use super::poses::{Instant, PoseRing};
use super::regression::Polynomial;
use super::settings::{Design, Filter, LostLane, Settings, SettingsError};
use super::tack::{TackWatch, Verdict};
use super::taught::{TaughtPath, foot};
use crate::geometry::{Pose, is_finite};

/// Without a reading for this many of the sensor's periods, the gate waits for no more neighbours.
const PERIODS: f64 = 4.0;
/// The seam's first readings are met this far after the first one at the earliest, in metres.
const MEETING: f64 = 8e-3;
/// A jump of what is wanted up to this is left to the lane's smoothness, in metres.
const SMALL: f64 = 0.1e-3;
/// A seam goes aside by no more than this at once, in metres, and by no more than this share of the way: plates are misaligned by less, and
/// what leads away faster is another edge.
const JUMP: f64 = 3e-3;
const SLANT: f64 = 0.2;
/// Shares of the jerk: what a fade takes, and from where on what is wanted is faded to.
const FADE_SHARE: f64 = 0.9;
const ROUGH_SHARE: f64 = 0.9;

/// A control point of the lane that has just frozen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlPoint {
    /// Its number k: it stands at s = kΔ.
    pub number: i64,
    /// What it is.
    pub offset: Offset,
}

/// The seam is not seen any more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lost {
    /// The last good reading's path coordinate: a bead that shall end on the seam ends there.
    pub seen_to: f64,
}

/// What the lane follows at the moment.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Course {
    Seen,
    /// On from the last readings; ever the same trend until there are new ones.
    Lost(Trend),
    /// Towards readings ahead, to meet the seam at this coordinate.
    Ahead {
        meet: f64,
    },
    /// No readings at all yet, or after a lost trend.
    Still(Offset),
}

/// The readings, gathered for one of the filters.
#[derive(Debug, Clone)]
#[allow(clippy::large_enum_variant, reason = "without a heap there is no place for it but here")]
enum Gathered {
    Regression(Bins),
    Mean(MovingMean),
}

/// Seam tracking along one weld.
///
/// In each cycle [`SeamTracker::step`] is called with where the torch is, and [`SeamTracker::take`] with each reading
/// that has arrived; the [`Lane`] then says where to go. It is about 25 kB, lives where it is put, and neither call allocates.
#[derive(Debug, Clone)]
pub struct SeamTracker {
    settings: Settings,
    design: Design,
    poses: PoseRing,
    gate: Gate,
    tacks: Option<TackWatch>,
    gathered: Gathered,
    lane: Lane,
    guard: Guard,
    course: Course,
    fade: Option<Fade>,
    counts: Counts,
    /// The last reading that was let to the filter: its place and offset.
    last_good: Option<(f64, Offset)>,
    /// Why the last reading was dropped, if it was.
    dropped: Option<Rejection>,
    /// Time of the last reading that was let to the gate.
    last_reading: Option<f64>,
    /// To where readings could be expected from the start.
    expected_from: f64,
    lost: Option<Lost>,
}

impl SeamTracker {
    /// Tracking that begins with the torch at the coordinate `s`, where the seam is taken to lie at `offset` from the taught path.
    ///
    /// # Errors
    /// [`SettingsError`], see [`Settings::check`].
    pub fn try_new(settings: &Settings, s: f64, offset: Offset) -> Result<Self, SettingsError> {
        settings.check()?;
        let design = settings.design();
        let bound = settings.bound;
        let offset =
            offset.map(|component| if component.is_finite() { component.clamp(-bound, bound) } else { 0.0 });
        Ok(Self {
            poses: PoseRing::new(settings.sensor.age_max),
            gate: Gate::new(),
            tacks: settings.tacks.map(TackWatch::new),
            gathered: match settings.filter {
                Filter::Regression => Gathered::Regression(Bins::new(design.bin)),
                Filter::Mean { readings } => Gathered::Mean(MovingMean::new(readings)),
            },
            lane: Lane::new(design.spacing, s, offset),
            guard: Guard::at_rest(design.bounds, offset),
            course: Course::Still(offset),
            fade: None,
            counts: Counts::default(),
            last_good: None,
            dropped: None,
            last_reading: None,
            expected_from: s + settings.sensor.look_ahead(),
            lost: None,
            settings: *settings,
            design,
        })
    }

    /// The lane: where the torch is to be, as far as it is frozen.
    #[must_use]
    pub fn lane(&self) -> &Lane {
        &self.lane
    }

    /// What became of the readings.
    #[must_use]
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// Why the last reading was dropped; `None` where it was believed, or there was none.
    #[must_use]
    pub fn last_rejection(&self) -> Option<Rejection> {
        self.dropped
    }

    /// Set while the seam is lost.
    #[must_use]
    pub fn lost(&self) -> Option<Lost> {
        self.lost
    }

    /// Path coordinate of the farthest reading that is believed; minus infinity before the first one.
    #[must_use]
    pub fn seen_to(&self) -> f64 {
        match &self.gathered {
            Gathered::Regression(bins) => bins.seen_to(),
            Gathered::Mean(mean) => mean.seen_to(),
        }
    }

    /// One cycle: the torch is at the path coordinate `s` at `time` (seconds), its *measured* tool centre point at
    /// `base_from_tcp`; the path is known up to `path_end`. Freezes one control point of the lane at most, and gives it back.
    ///
    /// From cycle to cycle s moves by less than the lane's spacing.
    ///
    /// Cost: some 20 ns; where a control point freezes, one fit over 128 bins at most: 1.5 µs.
    pub fn step(&mut self, time: f64, s: f64, base_from_tcp: &Pose, path_end: f64) -> Option<ControlPoint> {
        if !(time + s).is_finite() || !is_finite(base_from_tcp) {
            return None;
        }
        self.poses.push(Instant { time, s, base_from_tcp: *base_from_tcp });
        let silent = self.last_reading.map_or(0.0, |last| time - last);
        if silent > PERIODS / self.settings.sensor.rate {
            self.judge_one(true);
        }
        self.watch(s, silent, path_end);
        self.freeze(s)
    }

    /// Takes a reading that has arrived. An error says why it was dropped at once; the gate and the tack mask count what they drop later.
    ///
    /// # Errors
    /// [`Rejection`].
    ///
    /// Cost: the foot of a point on the path, and eleven numbers sorted a few times: 0.5 µs on an arc, 1.3 µs on a spline.
    pub fn take(&mut self, path: &impl TaughtPath, reading: &Reading) -> Result<(), Rejection> {
        self.counts.taken += 1;
        let taken = self.sighting(path, reading).and_then(|sighting| self.gate.insert(sighting));
        self.dropped = taken.err();
        match taken {
            Ok(()) => self.last_reading = self.poses.now(),
            Err(rejection) => self.counts.count(rejection),
        }
        self.judge_one(false);
        taken
    }

    /// The point of the seam that a reading shows, in the path frame.
    fn sighting(&self, path: &impl TaughtPath, reading: &Reading) -> Result<Sighting, Rejection> {
        let sensor = &self.settings.sensor;
        sensor.judge(reading)?;
        let now = self.poses.now().ok_or(Rejection::TooOld)?;
        if now - reading.exposure > sensor.age_max {
            return Err(Rejection::TooOld);
        }
        let torch = self.poses.at(reading.exposure)?;
        let point = sensor.point(reading, &torch.base_from_tcp);
        let foot = foot(path, &point, torch.s + sensor.look_ahead()).ok_or(Rejection::OffPath)?;
        if foot.offset.amax() > self.settings.bound {
            return Err(Rejection::BeyondBound);
        }
        let tack = self.settings.tacks.is_some_and(|mask| mask.shown_by(reading));
        Ok(Sighting { exposure: reading.exposure, s: foot.s, offset: foot.offset, tack })
    }

    /// One reading from the gate to the filter.
    fn judge_one(&mut self, flush: bool) {
        let Some((sighting, good)) = self.gate.judge(flush) else { return };
        if !good {
            self.dropped = Some(Rejection::Spike);
            return self.counts.count(Rejection::Spike);
        }
        if self.last_good.is_some_and(|last| jumps(last, &sighting)) {
            self.dropped = Some(Rejection::Jump);
            return self.counts.count(Rejection::Jump);
        }
        if let Some(tacks) = &mut self.tacks
            && let Verdict::Tack { flank_from } = tacks.judge(&sighting)
        {
            self.counts.count(Rejection::Tack);
            if let (Some(from), Gathered::Regression(bins)) = (flank_from, &mut self.gathered) {
                bins.clear(from, sighting.s);
            }
            return;
        }
        self.last_good = Some((sighting.s, sighting.offset));
        match &mut self.gathered {
            Gathered::Regression(bins) => bins.add(sighting.s, sighting.offset),
            Gathered::Mean(mean) => mean.add(sighting.s, sighting.offset),
        }
    }

    /// Whether the seam is lost.
    fn watch(&mut self, s: f64, silent: f64, path_end: f64) {
        let seen_to = self.seen_to().max(self.expected_from);
        let expected = (s + self.settings.sensor.look_ahead()).min(path_end);
        let missing = expected - seen_to;
        let lost = missing > self.settings.lost_distance
            || (missing > self.design.gap && silent > self.settings.lost_time);
        self.lost = lost.then_some(Lost { seen_to });
    }

    /// Freezes the next control point, if it can be known or must be.
    fn freeze(&mut self, s: f64) -> Option<ControlPoint> {
        let number = self.lane.next();
        let knot = number as f64 * self.design.spacing;
        let due = s >= knot - self.design.lead;
        let (curve, course) = self.wanted(knot, due)?;
        let asked = self.approach(knot, &curve, course);
        let bound = self.design.bounds.offset;
        let (offset, as_asked) = self.guard.next(asked.map(|component| component.clamp(-bound, bound)));
        if !as_asked && self.fade.is_none() {
            self.fade = Some(Fade::over(0.0));
        }
        self.course = course;
        self.lane.push(offset);
        Some(ControlPoint { number, offset })
    }

    /// The next control point on the way from where the lane is to the curve it is to follow.
    fn approach(&mut self, knot: f64, curve: &Curve, course: Course) -> Offset {
        let Bounds { third, step, .. } = self.design.bounds;
        let spacing = self.design.spacing;
        let wanted = curve.at(knot, spacing);
        let rests = self.rests(knot, curve);
        let jumps = discriminant(&course) != discriminant(&self.course) && rests[0].norm() > SMALL;
        let rough = self.guard.third(&wanted).norm() > ROUGH_SHARE * third
            || (wanted - self.guard.points()[0]).amax() > step;
        if self.fade.is_none() && (jumps || rough) {
            let length = if let Course::Ahead { meet } = course { meet - (knot - spacing) } else { 0.0 };
            self.fade = Some(Fade::over(length));
        }
        let rest = self.fade.as_mut().and_then(|fade| fade.next(&rests, spacing, FADE_SHARE * third, step));
        if rest.is_none() {
            self.fade = None;
        }
        wanted + rest.unwrap_or_default()
    }

    /// How far the last three control points lie from a curve.
    fn rests(&self, knot: f64, curve: &Curve) -> [Offset; 3] {
        let spacing = self.design.spacing;
        let points = self.guard.points();
        core::array::from_fn(|back| points[back] - curve.at(knot - (back + 1) as f64 * spacing, spacing))
    }

    /// What the lane is to follow around a knot; `None` where it is worth waiting.
    fn wanted(&self, knot: f64, due: bool) -> Option<(Curve, Course)> {
        let bins = match &self.gathered {
            Gathered::Regression(bins) => bins,
            Gathered::Mean(mean) => {
                if !due && mean.seen_to() < knot {
                    return None;
                }
                return Some(match mean.at(knot) {
                    Some(offset) => (Curve::Constant(offset), Course::Seen),
                    None => self.still(),
                });
            }
        };
        Some(match estimate(bins, &self.design, knot, due)? {
            Estimate::Seen(polynomial) => (Curve::Polynomial(polynomial), Course::Seen),
            Estimate::Ahead { trend, firm } => self.ahead(trend, firm, knot),
            Estimate::Lost(trend) => match self.course {
                // One and the same trend until there are new readings.
                Course::Lost(before) if before.from == trend.from => self.lost_on(before, knot),
                _ => self.lost_on(trend, knot),
            },
            Estimate::Nothing => self.as_before(knot),
        })
    }

    /// Towards readings ahead: at once where their course is known well or the way is needed, later where it may become clearer.
    fn ahead(&self, trend: Trend, firm: bool, knot: f64) -> (Curve, Course) {
        let curve = Curve::Trend(trend);
        if let Course::Ahead { .. } = self.course {
            return (curve, self.course);
        }
        let Bounds { third, step, .. } = self.design.bounds;
        let spacing = self.design.spacing;
        let meet = trend.from + MEETING;
        let needed = || Fade::needed(&self.rests(knot, &curve), spacing, FADE_SHARE * third, step);
        if firm || needed() + spacing > meet - knot {
            return (curve, Course::Ahead { meet });
        }
        self.as_before(knot)
    }

    fn as_before(&self, knot: f64) -> (Curve, Course) {
        match self.course {
            Course::Lost(before) => self.lost_on(before, knot),
            _ => self.still(),
        }
    }

    fn lost_on(&self, trend: Trend, knot: f64) -> (Curve, Course) {
        if trend.is_over(knot) && self.settings.lost == LostLane::Taught {
            return (Curve::Constant(Offset::zeros()), Course::Still(Offset::zeros()));
        }
        (Curve::Trend(trend), Course::Lost(trend))
    }

    fn still(&self) -> (Curve, Course) {
        let offset = match self.course {
            Course::Still(offset) => offset,
            _ => self.guard.points()[0],
        };
        (Curve::Constant(offset), Course::Still(offset))
    }
}

/// Whether the seam cannot have gone from one place to another.
fn jumps((s, offset): (f64, Offset), to: &Sighting) -> bool {
    (to.offset - offset).amax() > JUMP + SLANT * (to.s - s).abs()
}

/// What the lane is to follow.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Curve {
    Polynomial(Polynomial),
    Trend(Trend),
    Constant(Offset),
}

impl Curve {
    /// The control point that has the lane on the curve at `s`: a cubic B-spline lies at d + d″Δ²/6.
    fn at(&self, s: f64, spacing: f64) -> Offset {
        match self {
            Self::Polynomial(of) => of.at(s) - of.curvature(s) * (spacing * spacing / 6.0),
            Self::Trend(of) => of.at(s),
            Self::Constant(of) => *of,
        }
    }
}
