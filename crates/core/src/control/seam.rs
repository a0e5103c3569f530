//! Seam tracking in the cycle: readings come in, the lane is frozen ahead of the torch, and the joints follow the corrected path.
//!
//! A tracked weld is planned on the taught path somewhat faster than programmed; programme time then runs just so fast that the torch travels
//! along the *tracked* seam as programmed. Where the tracking ends, the arm stands beside the taught path: it goes from there, and the
//! difference fades out of the joints on the moves that follow.

use super::block::{Block, Motion, PathMotion};
use super::rate::RateLimits;
use crate::drive::JointCommand;
use crate::geometry::{Pose, PoseJet, Vector3};
use crate::kinematics::JointJet;
use crate::math::float::cbrt;
use crate::math::taylor::Taylor;
use crate::path::{Path, PathState, SeamFrame};
use crate::safety::Fault;
use crate::seam::{
    Counts, Instant, Lane, LaneJet, LaneKey, LaneMemory, LaneRecord, Offset, Pass, PathChain, RecordedWeld,
    SeamSensor, SeamTracker, Settings, TaughtPath, corrected, speed_factor,
};

/// Paths of the weld that are known ahead of the torch, at most.
pub const TAUGHT_PATHS: usize = 48;
/// Readings that are taken in one cycle; more wait for the next.
const READINGS: usize = 16;
/// The taught path is kept so far behind the torch, in metres.
const KEPT: f64 = 0.05;
/// So near to the end of what the lane remembers, backing up ends; metres.
const LANE_END: f64 = 0.02;
/// While a difference fades, programme time runs at this rate at most: what moves follow then leaves this much of the limits ...
const FADE_RATE: f64 = 0.75;
/// ... of velocity, acceleration and jerk to the difference.
const FADE_SHARES: [f64; 3] = [0.24, 0.42, 0.56];
/// The same for a difference that is small enough to fade within a time, in seconds: on a tracked seam time does not run faster anyway.
const GENTLE_RATE: f64 = 0.99;
const GENTLE_SHARES: [f64; 3] = [0.008, 0.015, 0.025];
const GENTLE_LONGEST: f64 = 0.3;
/// Shortest fade, in seconds.
const FADE_LEAST: f64 = 0.1;
/// Greatest derivatives of 10x³ − 15x⁴ + 6x⁵.
const FADE_PEAKS: [f64; 3] = [1.875, 5.774, 60.0];
/// Rounding of programme time, which is put together from a move's start and the time since then; in seconds.
const ROUNDING: f64 = 1e-10;
/// A difference of the joints up to this is none, in radians or metres.
const SAME: f64 = 1e-9;
/// What is travelled is told as what was asked for if it differs by less than this share: beyond, the rate is changing.
const STEADY: f64 = 0.02;

/// How a seam is tracked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tracking {
    /// Sensor, filter, bounds.
    pub settings: Settings,
    /// Coordinate of the weld at which it begins, in metres.
    pub start: f64,
    /// Tool centre point in the flange frame.
    pub flange_from_tcp: Pose,
    /// So far beyond the last place where the seam was seen the torch stops, in metres; `None` where it goes on.
    pub stop_after: Option<f64>,
    /// Where its lane is kept, and what it is kept of.
    pub record: Option<(LaneKey, RecordedWeld)>,
}

/// A pass that is welded from the record of an earlier one, in place of tracking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Playing {
    /// The record.
    pub key: LaneKey,
    /// How this pass lies from it.
    pub pass: Pass,
    /// Coordinate of the weld at which it begins, in metres.
    pub start: f64,
    /// Tool centre point in the flange frame.
    pub flange_from_tcp: Pose,
}

/// That a path of a block follows the tracked seam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tracked {
    /// Coordinate of the weld at which the path begins, in metres.
    pub start: f64,
    /// By which factor the planned speed is above the programmed one.
    pub headroom: f64,
}

/// What the cycle tells of the tracking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeamStatus {
    /// Coordinate of the weld, in metres.
    pub s: f64,
    /// The correction in effect.
    pub offset: Offset,
    /// What became of the readings.
    pub counts: Counts,
    /// The seam is out of sight.
    pub lost: bool,
    /// The torch moves along the tracked seam.
    pub on_seam: bool,
    /// The correction is that of an earlier pass.
    pub from_record: bool,
}

/// Where the correction comes from.
#[derive(Debug, Clone, Copy)]
pub(super) enum Correction<'a> {
    /// The lane of the seam that is tracked.
    Lane(&'a Lane),
    /// That of an earlier pass, from the coordinate at which the weld begins.
    Record(LaneRecord<'a>, Pass, f64),
}

impl Correction<'_> {
    /// At a coordinate: as frozen, ahead of that as it would go on.
    fn at(&self, s: f64) -> LaneJet {
        match self {
            Self::Lane(lane) => lane.at(s).or_else(|| lane.expected(s)).unwrap_or(LaneJet::TAUGHT),
            Self::Record(record, pass, start) => record.of_pass(pass, s - start),
        }
    }
}

/// What takes the joints off the planned motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corrections<'a, const N: usize> {
    pub(super) seam: Option<Correction<'a>>,
    pub(super) fade: Option<&'a Fade<N>>,
}

/// A difference of the joints that fades out in programme time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fade<const N: usize> {
    difference: [f64; N],
    /// From here on the arm stands beside the plan.
    from: f64,
    /// Where the fade begins: with the first moves from rest that take as long. Until then the difference stays.
    start: Option<f64>,
    duration: f64,
    /// The greatest rate of programme time meanwhile.
    rate: f64,
}

/// The tracker with the taught path ahead of the torch.
#[derive(Debug, Clone)]
pub(super) struct SeamGuide {
    tracker: Option<SeamTracker>,
    tracking: Option<Tracking>,
    /// The pass that is welded from a record; nothing is tracked then.
    playing: Option<Playing>,
    memory: LaneMemory,
    taught: PathChain<TAUGHT_PATHS>,
    /// Coordinate of the taught path's end; `None` where the next path begins another one.
    taught_to: Option<f64>,
    /// Where the torch stopped last without the seam: told to go on, it may go as far again.
    stopped: f64,
    /// Readings are taken.
    on: bool,
    s: f64,
}

impl SeamGuide {
    /// Nothing is tracked.
    pub(super) fn new() -> Self {
        Self {
            tracker: None,
            tracking: None,
            playing: None,
            memory: LaneMemory::new(),
            taught: PathChain::new(0.0),
            taught_to: None,
            stopped: f64::NEG_INFINITY,
            on: false,
            s: 0.0,
        }
    }

    /// Nothing is tracked any more. The memory stays.
    pub(super) fn clear(&mut self) {
        self.end();
        (self.tracker, self.tracking, self.playing, self.s) = (None, None, None, 0.0);
    }

    pub(super) fn memory(&self) -> &LaneMemory {
        &self.memory
    }

    pub(super) fn memory_mut(&mut self) -> &mut LaneMemory {
        &mut self.memory
    }

    /// The taught path goes on from a coordinate. A path that the planner should not have sent is left out: the seam is not seen there.
    pub(super) fn teach(&mut self, path: &Path, start: f64) {
        if self.taught_to.is_none_or(|end| (start - end).abs() > SAME) {
            self.taught = PathChain::new(start);
        }
        if self.taught.push(path).is_ok() {
            self.taught_to = Some(start + path.length());
        }
    }

    /// Tracking begins with the tool centre point at a place: gives the motion of the corrected path there.
    pub(super) fn begin(&mut self, tracking: &Tracking, tcp: &Vector3) -> PoseJet {
        let jet = self.taught.jet(tracking.start);
        let off = tcp - jet.pose.translation.vector;
        let offset = SeamFrame::of(&jet)
            .map_or_else(Offset::zeros, |frame| Offset::new(off.dot(&frame.y), off.dot(&frame.z)));
        self.tracker = SeamTracker::try_new(&tracking.settings, tracking.start, offset).ok();
        if let (Some(tracker), Some((key, weld))) = (&self.tracker, &tracking.record) {
            if key.weld == 0 {
                self.memory.forget(key.file);
            }
            // What finds no room has no record, and no pass is welded from it.
            let _ = self.memory.open(*key, tracker.lane(), weld);
        }
        (self.tracking, self.playing, self.on, self.s) = (Some(*tracking), None, true, tracking.start);
        self.motion_at(tracking.start)
    }

    /// A pass begins: gives the motion of the corrected path there.
    ///
    /// # Errors
    /// [`Fault::NoRecord`].
    pub(super) fn play(&mut self, playing: &Playing) -> Result<PoseJet, Fault> {
        let LaneKey { file, weld } = playing.key;
        if !self.memory.record(playing.key).is_some_and(|record| record.is_whole()) {
            return Err(Fault::NoRecord { file, weld });
        }
        (self.tracker, self.tracking, self.playing) = (None, None, Some(*playing));
        (self.on, self.s) = (true, playing.start);
        Ok(self.motion_at(playing.start))
    }

    /// The motion of the corrected path at a coordinate of the taught path ahead.
    fn motion_at(&self, s: f64) -> PoseJet {
        correct(&self.taught.jet(s), self.correction(), s)
    }

    /// Readings are taken no longer; the lane stays for the way back.
    pub(super) fn end(&mut self) {
        self.memory.close();
        (self.on, self.taught_to) = (false, None);
    }

    pub(super) fn is_on(&self) -> bool {
        self.on
    }

    pub(super) fn correction(&self) -> Option<Correction<'_>> {
        match &self.playing {
            Some(Playing { key, pass, start, .. }) => {
                self.memory.record(*key).map(|record| Correction::Record(record, *pass, *start))
            }
            None => self.lane().map(Correction::Lane),
        }
    }

    fn lane(&self) -> Option<&Lane> {
        self.tracker.as_ref().map(SeamTracker::lane)
    }

    /// The lane's memory ends here, going back.
    pub(super) fn is_at_memory_end(&self) -> bool {
        let start = self.tracking.map_or(0.0, |tracking| tracking.start);
        self.lane().is_some_and(|lane| lane.known_from() > start && self.s - lane.known_from() < LANE_END)
    }

    /// One cycle: the torch is where the measurement says. Takes what the sensor has.
    pub(super) fn sense(&mut self, torch: &Instant, sensor: &mut impl SeamSensor) {
        if !self.on {
            return;
        }
        self.s = torch.s;
        self.taught.drop_before(torch.s - KEPT);
        let (Some(tracker), Some(tracking)) = (&mut self.tracker, &self.tracking) else { return };
        let path_end = self.taught_to.unwrap_or(torch.s);
        if let Some(frozen) = tracker.step(torch.time, torch.s, &torch.base_from_tcp, path_end) {
            let _ = self.memory.keep(&frozen);
        }
        for _ in 0..READINGS {
            let Some(reading) = sensor.poll(torch, &tracking.settings.sensor, &self.taught) else { break };
            // What is wrong with it is counted.
            let _ = tracker.take(&self.taught, &reading);
        }
    }

    /// The fault of a seam that is out of sight, once the torch has come as far without it as it may.
    pub(super) fn lost(&mut self) -> Option<Fault> {
        let (tracker, tracking) = (self.tracker.as_ref()?, self.tracking.filter(|_| self.on)?);
        let (lost, after) = (tracker.lost()?, tracking.stop_after?);
        if self.s < tracker.seen_to().max(self.stopped) + after {
            return None;
        }
        self.stopped = self.s;
        Some(Fault::SeamLost { seen_to: lost.seen_to, dropped: tracker.last_rejection() })
    }

    /// The rate of programme time at which the torch travels as programmed; 1 off the seam.
    pub(super) fn rate<const N: usize>(&self, block: &Block<N>, time: f64) -> f64 {
        let Motion::Path(motion) = &block.motion else { return 1.0 };
        let Some(tracked) = motion.tracked else { return 1.0 };
        let s = motion.state(time).position;
        let (factor, _) =
            speed_factor(&correct(&motion.path.seam_jet(s), self.correction(), tracked.start + s));
        (1.0 / (tracked.headroom * factor)).min(1.0)
    }

    pub(super) fn status(&self, s: f64, on_seam: bool) -> Option<SeamStatus> {
        let offset = self.correction().filter(|_| self.on)?.at(s).offset;
        let tracker = self.tracker.as_ref();
        let counts = tracker.map_or(Counts::default(), |tracker| *tracker.counts());
        let lost = tracker.is_some_and(|tracker| tracker.lost().is_some());
        Some(SeamStatus { s, offset, counts, lost, on_seam, from_record: self.playing.is_some() })
    }

    /// The coordinate where the torch was last.
    pub(super) fn coordinate(&self) -> f64 {
        self.s
    }
}

fn correct(taught: &PoseJet, correction: Option<Correction<'_>>, s: f64) -> PoseJet {
    correction.and_then(|correction| corrected(taught, &correction.at(s))).unwrap_or(*taught)
}

/// What the tool moves along, and how the flange goes with it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rail {
    path: Path,
    tracked: Option<Tracked>,
    tcp_from_flange: Pose,
}

impl Rail {
    pub(super) fn of(motion: &PathMotion) -> Self {
        Self { path: motion.path, tracked: motion.tracked, tcp_from_flange: motion.tcp_from_flange }
    }

    /// Length of the path.
    pub(super) fn length(&self) -> f64 {
        self.path.length()
    }

    /// The flange's motion in a state of the path, corrected where the path is tracked.
    pub(super) fn flange(&self, state: &PathState, correction: Option<Correction<'_>>) -> PoseJet {
        on_seam(&self.path, self.tracked.as_ref(), state, correction).attached(&self.tcp_from_flange)
    }
}

/// The motion of the tool centre point in a state of a path, corrected where the path is tracked.
fn on_seam(
    path: &Path,
    tracked: Option<&Tracked>,
    state: &PathState,
    correction: Option<Correction<'_>>,
) -> PoseJet {
    let s = state.position;
    let tcp = match tracked {
        None => path.jet(s),
        Some(tracked) => path.weave_about(&correct(&path.seam_jet(s), correction, tracked.start + s), s),
    };
    tcp.in_time([state.velocity, state.acceleration, state.jerk])
}

impl PathMotion {
    /// The flange's motion in programme time at a time since the block's start, corrected where the path is tracked.
    pub(super) fn flange_on(&self, time: f64, correction: Option<Correction<'_>>) -> PoseJet {
        on_seam(&self.path, self.tracked.as_ref(), &self.state(time), correction)
            .attached(&self.tcp_from_flange)
    }
}

impl<const N: usize> Fade<N> {
    /// A difference from a programme time on, that will fade so slowly that it takes its share of the limits. `None` where there is none.
    pub(super) fn new(difference: [f64; N], from: f64, limits: &RateLimits<N>) -> Option<Self> {
        if difference.iter().all(|q| q.abs() <= SAME) {
            return None;
        }
        let gentle = fade_time(&difference, &GENTLE_SHARES, limits);
        let (rate, duration) = if gentle <= GENTLE_LONGEST {
            (GENTLE_RATE, gentle)
        } else {
            (FADE_RATE, fade_time(&difference, &FADE_SHARES, limits))
        };
        Some(Self { difference, from, start: None, duration, rate })
    }

    /// Moves begin from rest, and take so long to the next: the fade begins with them if it ends before they do. True if it does.
    pub(super) fn begin(&mut self, time: f64, to_rest: f64) -> bool {
        let begins = self.start.is_none() && to_rest >= self.duration;
        if begins {
            self.start = Some(time);
        }
        begins
    }

    /// Nothing is left of it at a time.
    pub(super) fn is_over(&self, time: f64) -> bool {
        self.start.is_some_and(|start| time >= start + self.duration)
    }

    /// The greatest rate of programme time at a time.
    pub(super) fn rate(&self, time: f64) -> f64 {
        let fades = self.start.is_some_and(|start| time >= start) && !self.is_over(time);
        if fades { self.rate } else { 1.0 }
    }

    /// The share of the difference that has gone at a programme time: 0 before, 1 afterwards.
    pub(super) fn gone(&self, time: f64) -> Taylor {
        let x = self.start.map_or(0.0, |start| (time - start) / self.duration);
        if x > 0.0 && x < 1.0 {
            Taylor::smooth_step(x, 1.0 / self.duration)
        } else {
            Taylor::constant(if x >= 1.0 { 1.0 } else { 0.0 })
        }
    }

    /// Adds what is left of the difference at a programme time.
    pub(super) fn add(&self, jet: &mut JointJet<N>, time: f64) {
        if time < self.from - ROUNDING || self.is_over(time) {
            return;
        }
        let gone = self.gone(time);
        let [d1, d2, d3] = gone.derivatives();
        for (axis, q) in self.difference.iter().enumerate() {
            jet.position[axis] += q * (1.0 - gone.value());
            jet.velocity[axis] -= q * d1;
            jet.acceleration[axis] -= q * d2;
            jet.jerk[axis] -= q * d3;
        }
    }

    /// What is left of the difference when so much has gone, with its first two derivatives.
    pub(super) fn left(&self, [gone, rate, slope]: [f64; 3]) -> JointCommand<N> {
        let times = |share: f64| self.difference.map(|q| q * share);
        JointCommand { position: times(1.0 - gone), velocity: times(-rate), acceleration: times(-slope) }
    }
}

/// How long a difference takes to fade within shares of the limits, in seconds.
fn fade_time<const N: usize>(difference: &[f64; N], shares: &[f64; 3], limits: &RateLimits<N>) -> f64 {
    let [v, a, j] = [0, 1, 2].map(|order| FADE_PEAKS[order] / shares[order]);
    let time = |axis: usize| {
        let q = difference[axis].abs();
        let RateLimits { velocity, acceleration, jerk } = limits;
        let slow = q * v / velocity[axis];
        let gentle = crate::math::float::sqrt(q * a / acceleration[axis]);
        slow.max(gentle).max(cbrt(q * j / jerk[axis]))
    };
    (0..N).map(time).fold(FADE_LEAST, f64::max)
}

/// The rate as the operator knows it: what share of full speed it is.
pub(super) fn shown_rate(rate: f64, full: f64, asked: f64) -> f64 {
    let share = rate / full;
    if (share - asked).abs() <= STEADY * asked { asked } else { share.min(1.0) }
}
