//! Tier 2: where the program stands, and how far programme time goes on in this cycle.

use super::block::{Block, Command, Motion};
use super::history::{Done, History};
use super::lookahead::{AlongPath, JointMotion, Lookahead};
use super::rails::{OnRails, Rails};
use super::rate::{Rate, RateLimits};
use super::seam::{Corrections, Fade, Playing, SeamGuide, SeamStatus, Tracking, shown_rate};
use super::trail::{Mark, Way};
use crate::geometry::{Pose, PoseJet};
use crate::kinematics::{JointJet, Kinematics};
use crate::path::{Measure, PathState};
use crate::safety::Fault;
use crate::seam::{Instant, SeamSensor};

/// Commands held between the queue and the motion.
const PENDING: usize = 32;
/// Samples by which the look-ahead may grow in one cycle; one is used up.
const SAMPLES_PER_CYCLE: usize = 3;

/// Samples of the look-ahead by which a rate lags its goal where that changes steadily.
const LEAD: f64 = 1.5;

/// Where the cycle takes its commands from: a queue that a planner fills.
pub trait CommandSource<const N: usize> {
    /// The next command, or `None` where there is none at the moment. Must not block.
    fn next(&mut self) -> Option<Command<N>>;
}

/// The commands under way and programme time.
#[derive(Debug, Clone)]
pub(super) struct Program<const N: usize> {
    pending: [Command<N>; PENDING],
    first: usize,
    count: usize,
    /// Programme time now, and when the first pending move begins. The motion is in the moves done while it is before that.
    pub(super) now: f64,
    pub(super) move_start: f64,
    /// Path covered before the first pending move.
    way_before: Way,
    /// A move has come to its end at rest, and the arm has yet to come to it.
    pub(super) arriving: bool,
    pub(super) done: History<N>,
    /// What the moves done ran along.
    rails: Rails,
    /// Programme time runs backward; the look-ahead then counts from the time given down.
    pub(super) backward: Option<f64>,
    /// Way of the tool at which the arc was last lit.
    arc_way: f64,
    /// What is left of a dwell that has begun.
    dwell_left: Option<f64>,
    pub(super) rate: Rate,
    pub(super) ahead: Lookahead<N>,
    /// Joint positions at the look-ahead's end, and now: the seeds of the inverse kinematics.
    pub(super) ahead_position: [f64; N],
    pub(super) position: [f64; N],
    place: Place,
    pub(super) guide: SeamGuide,
    /// What the joints still are beside the planned motion after a seam was tracked.
    fade: Option<Fade<N>>,
    /// The share of full speed that was last asked for.
    speed: f64,
}

/// What the program has reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) mark: Mark,
    pub(super) flange_from_tcp: Pose,
    pub(super) ended: bool,
}

/// What the program needs to know of the arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Arm {
    pub(super) motion: Follows,
    pub(super) arc_burns: bool,
}

/// How the arm follows the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Follows {
    /// It is where the program is.
    AtOnce,
    /// Part of the motion so far is still in the prefilter.
    Behind,
    /// All of it has come out of the prefilter.
    Arrived,
}

impl<const N: usize> Program<N> {
    /// No program, at rest at `position`.
    pub(super) fn at_rest(position: [f64; N], flange_from_tcp: Pose, sample_spacing: f64) -> Self {
        let place = Place { mark: Mark::default(), flange_from_tcp, ended: false };
        Self {
            pending: [Command::End; PENDING],
            first: 0,
            count: 0,
            now: 0.0,
            move_start: 0.0,
            way_before: Way::default(),
            arriving: false,
            done: History::new(),
            rails: Rails::new(),
            backward: None,
            arc_way: 0.0,
            dwell_left: None,
            rate: Rate::constant(0.0),
            ahead: Lookahead::new(sample_spacing),
            ahead_position: position,
            position,
            place,
            guide: SeamGuide::new(),
            fade: None,
            speed: 0.0,
        }
    }

    /// Forgets all commands; the arm is at rest at `position`.
    pub(super) fn clear(&mut self, position: [f64; N]) {
        // In place: with its memory of passes it is too large to be copied in each cycle without power. Every field is named.
        let Self {
            pending: _,
            first,
            count,
            now,
            move_start,
            way_before,
            arriving,
            done,
            rails,
            backward,
            arc_way,
            dwell_left,
            rate,
            ahead,
            ahead_position,
            position: here,
            place,
            guide,
            fade,
            speed,
        } = self;
        (*first, *count, *arriving, *backward, *dwell_left) = (0, 0, false, None, None);
        (*now, *move_start, *arc_way, *speed) = (0.0, 0.0, 0.0, 0.0);
        (*way_before, *done, *rails, *fade) = (Way::default(), History::new(), Rails::new(), None);
        (*rate, *ahead) = (Rate::constant(0.0), Lookahead::new(ahead.spacing()));
        (*here, *ahead_position) = (position, position);
        (place.mark.arc, place.ended) = (false, false);
        guide.clear();
    }

    pub(super) fn place(&self) -> &Place {
        &self.place
    }

    /// Nothing moves: time stands still, or there is nothing to move along.
    pub(super) fn is_at_rest(&self) -> bool {
        self.arriving || self.rate.is_stopped() || self.under_way(self.now).is_none()
    }

    /// Time stands still from now on: the arm has left the path.
    pub(super) fn stand_still(&mut self) {
        self.rate = Rate::constant(0.0);
    }

    /// One cycle on towards the rate `goal`. What follows a move that ends at rest waits until the arm stands there.
    ///
    /// # Errors
    /// [`Fault::Starved`] where a motion has no continuation; [`Fault::NoInverse`] where the path ahead has no joints.
    pub(super) fn advance<K: Kinematics<N>>(
        &mut self,
        goal: f64,
        source: &mut impl CommandSource<N>,
        kinematics: &K,
        limits: &RateLimits<N>,
        period: f64,
        arm: Arm,
    ) -> Result<(), Fault> {
        self.speed = goal;
        self.refill(source, goal);
        self.look_ahead(kinematics)?;
        if self.arriving {
            if arm.motion == Follows::Behind {
                return Ok(());
            }
            self.arriving = false;
            self.go_on(goal);
        }
        let before = self.now;
        if self.under_way(before).is_some() {
            let goal = self.goal(goal, Some(limits));
            self.now += self.rate.advance(goal, self.now, &self.ahead, limits, period);
        }
        self.stop_among_done(before, arm);
        if self.now < self.move_start {
            self.find_place();
            return Ok(());
        }
        if self.head_move().is_none() {
            self.now = self.move_start;
        }
        // Each turn removes a command, or is the last.
        for _ in 0..PENDING {
            if self.arriving || !self.finish_head(goal, kinematics, limits, period, arm)? {
                break;
            }
        }
        Ok(())
    }

    /// Removes the first pending command if it is done; false where it is not.
    fn finish_head<K: Kinematics<N>>(
        &mut self,
        goal: f64,
        kinematics: &K,
        limits: &RateLimits<N>,
        period: f64,
        arm: Arm,
    ) -> Result<bool, Fault> {
        let head = (self.count > 0).then(|| &self.pending[self.first]);
        match head {
            None => return Ok(false),
            Some(Command::Move(block)) => {
                let end = self.move_start + block.duration();
                if self.now < end {
                    return Ok(false);
                }
                let (rests, way) = (block.ends_at_rest, way_on(block, block.duration()));
                // Exactly where the move ends, however the cycles fell.
                let at = At { block, start: self.move_start, since: block.duration() };
                let position = joints_on(&at, &self.position, &self.corrections(), kinematics)?.position;
                let way_after = self.way_before.plus(way);
                self.done.push(Done { start: self.move_start, way: self.way_before, block: *block });
                self.rails.lay(block, self.way_before.path, way_after.path);
                (self.position, self.move_start, self.way_before) = (position, end, way_after);
                self.arriving = rests && arm.motion != Follows::AtOnce;
                self.pop(goal);
                if self.arriving || !self.moves_on() {
                    // Nothing to spend the rest of the period on.
                    self.now = end;
                    if !rests {
                        return Err(Fault::Starved);
                    }
                }
                return Ok(true);
            }
            Some(Command::Dwell { line, segment, duration }) => {
                let (line, segment, duration) = (*line, *segment, *duration);
                self.set_place(line, segment, self.place.flange_from_tcp);
                // It counts from the cycle after the one in which the arm has come to rest.
                let elapsed = if goal > 0.0 { period } else { 0.0 };
                let left = self.dwell_left.map_or(duration, |left| left - elapsed);
                // Half a period is as near to the duration as whole cycles can come.
                if left > period / 2.0 {
                    self.dwell_left = Some(left);
                    return Ok(false);
                }
                self.dwell_left = None;
            }
            Some(Command::Arc { on, setting }) => {
                let on = *on;
                (self.place.mark.arc, self.place.mark.setting) = (on, *setting);
                if on && !arm.arc_burns {
                    self.arc_way = self.way().tool;
                    return Ok(false);
                }
            }
            Some(Command::ArcSetting(setting)) => self.place.mark.setting = *setting,
            Some(Command::Marker(number)) => self.place.mark.marker = *number,
            Some(Command::Taught { path, start }) => self.guide.teach(path, *start),
            Some(Command::TrackOn(tracking)) => {
                let tracking = *tracking;
                self.track(&tracking, kinematics, limits)?;
            }
            Some(Command::PlayOn(playing)) => {
                let playing = *playing;
                self.play(&playing, kinematics, limits)?;
            }
            Some(Command::TrackOff) => self.leave_seam(kinematics, limits)?,
            Some(Command::End) => {
                self.place.ended = true;
                return Ok(false);
            }
        }
        self.pop(goal);
        Ok(true)
    }

    /// Joints in programme time where the program stands now.
    ///
    /// # Errors
    /// [`Fault::NoInverse`] where the path has no joint solution.
    pub(super) fn joints<K: Kinematics<N>>(&mut self, kinematics: &K) -> Result<JointJet<N>, Fault> {
        let jet = match self.under_way(self.now) {
            Some((start, block)) => {
                let at = At { block, start, since: self.now - start };
                joints_on(&at, &self.position, &self.corrections(), kinematics)?
            }
            None => JointJet::at_rest(self.position),
        };
        self.position = jet.position;
        Ok(jet)
    }

    /// The move under way at a programme time up to the first pending one, and when it begins.
    pub(super) fn under_way(&self, time: f64) -> Option<(f64, &Block<N>)> {
        if time < self.move_start {
            return self.done.at(time).map(|done| (done.start, &done.block));
        }
        self.head_move().map(|block| (self.move_start, block))
    }

    /// Path covered up to now.
    pub(super) fn way(&self) -> Way {
        let (before, _) = self.way_under_way();
        self.under_way(self.now).map_or(before, |(start, block)| before.plus(way_on(block, self.now - start)))
    }

    /// Path that runs on with real time, whichever way programme time runs, with its velocity and acceleration; and where what the
    /// place says began on it.
    pub(super) fn course(&self) -> ([f64; 3], f64) {
        let (way, (before, after)) = (self.way().path, self.way_under_way());
        let along = self
            .under_way(self.now)
            .map_or(AlongPath::NONE, |(start, block)| along_path(block, self.now - start));
        let (rate, slope) = self.time_rate();
        let way = [way, along.velocity * rate, along.acceleration * rate * rate + along.velocity * slope];
        if self.backward.is_some() { (way.map(|x| -x), -after.path) } else { (way, before.path) }
    }

    /// What the program has at a place of its course that it has passed, with the course's velocity and acceleration.
    pub(super) fn on_course(&self, course: [f64; 3]) -> OnRails {
        let way = if self.backward.is_some() { course.map(|x| -x) } else { course };
        // Also where the arm has yet to come to rest: going back, it comes from there.
        let head = match self.head() {
            Some(Command::Move(block)) => Some((self.way_before.path, block)),
            _ => None,
        };
        self.rails.at(way, head, self.guide.correction())
    }

    /// Path covered up to the start of the move under way, and up to its end.
    fn way_under_way(&self) -> (Way, Way) {
        let before = match self.done.at(self.now) {
            Some(done) if self.now < self.move_start => done.way,
            _ => self.way_before,
        };
        let move_way = self.under_way(self.now).map(|(_, block)| way_on(block, block.duration()));
        (before, before.plus(move_way.unwrap_or_default()))
    }

    /// Way of the tool since the arc was last lit, in metres.
    pub(super) fn bead(&self) -> f64 {
        self.way().tool - self.arc_way
    }

    pub(super) fn corrections(&self) -> Corrections<'_, N> {
        Corrections { seam: self.guide.correction(), fade: self.fade.as_ref() }
    }

    /// What takes the joints off the paths at a programme time, after a seam was tracked.
    pub(super) fn aside(&self, time: f64) -> Option<JointJet<N>> {
        let fade = self.fade.as_ref()?;
        let mut jet = JointJet::at_rest([0.0; N]);
        fade.add(&mut jet, time);
        Some(jet)
    }

    /// The rate at which a share of full speed is kept: on a tracked seam the torch's own speed along it counts.
    fn goal(&self, speed: f64, limits: Option<&RateLimits<N>>) -> f64 {
        let Some((start, block)) = self.under_way(self.now) else { return speed };
        // The rate is there after the look-ahead's next sample.
        let lead = LEAD * self.ahead.spacing() * self.rate.value();
        let full = self.full_rate(block, self.now + lead - start);
        let bearable = match limits {
            Some(limits) if full < 1.0 => self.ahead.bearable(limits),
            _ => 1.0,
        };
        (speed * full).min(bearable)
    }

    fn full_rate(&self, block: &Block<N>, since: f64) -> f64 {
        let fading = self.fade.as_ref().map_or(1.0, |fade| fade.rate(self.now));
        self.guide.rate(block, since).min(fading)
    }

    /// The share of full speed at which the program goes on.
    pub(super) fn shown_rate(&self) -> f64 {
        let full =
            self.under_way(self.now).map_or(1.0, |(start, block)| self.full_rate(block, self.now - start));
        if full < 1.0 { shown_rate(self.rate.value(), full, self.speed) } else { self.rate.value() }
    }

    /// The seam sensor is asked, with the measured tool centre point at the start of the cycle.
    pub(super) fn sense(&mut self, time: f64, measured: Pose, sensor: &mut impl SeamSensor) {
        let s = self.weld_coordinate();
        self.guide.sense(&Instant { time, s, base_from_tcp: measured }, sensor);
    }

    /// Coordinate of the weld at which the program stands.
    fn weld_coordinate(&self) -> f64 {
        let tracked = |block: &Block<N>, since: f64| match &block.motion {
            Motion::Path(motion) => motion.tracked.map(|on| on.start + motion.state(since).position),
            Motion::Joint(_) => None,
        };
        let here = self.under_way(self.now).and_then(|(start, block)| tracked(block, self.now - start));
        let behind = || self.done.at(self.now).and_then(|done| tracked(&done.block, done.block.duration()));
        here.or_else(behind).unwrap_or(self.guide.coordinate())
    }

    /// What is to be told of the tracking.
    pub(super) fn seam_status(&self) -> Option<SeamStatus> {
        self.guide.status(self.weld_coordinate(), self.is_on_seam())
    }

    /// Whether a tracked move is under way.
    pub(super) fn is_on_seam(&self) -> bool {
        self.under_way(self.now).is_some_and(
            |(_, block)| matches!(&block.motion, Motion::Path(motion) if motion.tracked.is_some()),
        )
    }

    /// Tracking begins where the arm stands. What lies behind is forgotten with the lane that led there.
    fn track<K: Kinematics<N>>(
        &mut self,
        tracking: &Tracking,
        kinematics: &K,
        limits: &RateLimits<N>,
    ) -> Result<(), Fault> {
        let tcp = kinematics.forward(&self.position) * tracking.flange_from_tcp;
        let seam = self.guide.begin(tracking, &tcp.translation.vector);
        self.enter_seam(&seam, &tracking.flange_from_tcp, kinematics, limits)
    }

    /// A pass begins where the arm stands.
    fn play<K: Kinematics<N>>(
        &mut self,
        playing: &Playing,
        kinematics: &K,
        limits: &RateLimits<N>,
    ) -> Result<(), Fault> {
        let seam = self.guide.play(playing)?;
        self.enter_seam(&seam, &playing.flange_from_tcp, kinematics, limits)
    }

    /// From where the arm stands on to the corrected path.
    fn enter_seam<K: Kinematics<N>>(
        &mut self,
        seam: &PoseJet,
        flange_from_tcp: &Pose,
        kinematics: &K,
        limits: &RateLimits<N>,
    ) -> Result<(), Fault> {
        let flange = seam.attached(&flange_from_tcp.inverse());
        let planned = joints_of(&flange, &self.position, kinematics)?.position;
        self.done = History::new();
        self.fade_from(&planned, limits);
        Ok(())
    }

    /// From the corrected path on to moves as they are planned.
    fn leave_seam<K: Kinematics<N>>(&mut self, kinematics: &K, limits: &RateLimits<N>) -> Result<(), Fault> {
        self.guide.end();
        if let Some(done) = self.done.at(self.now) {
            let at = At { block: &done.block, start: done.start, since: done.block.duration() };
            let none = Corrections { seam: None, fade: None };
            let planned = joints_on(&at, &self.position, &none, kinematics)?.position;
            if self.fade.is_some_and(|fade| fade.rate(self.now) < 1.0) {
                // Only one difference can be gone back through.
                self.done = History::new();
            }
            self.fade_from(&planned, limits);
        }
        Ok(())
    }

    /// The arm stands beside the plan: what is between fades out on the way from here.
    fn fade_from(&mut self, planned: &[f64; N], limits: &RateLimits<N>) {
        let difference = core::array::from_fn(|axis| self.position[axis] - planned[axis]);
        self.fade = Fade::new(difference, self.now, limits);
        self.ahead.forget_after(self.now);
        self.ahead_position = self.position;
    }

    /// Says where the program is, among the moves done.
    pub(super) fn find_place(&mut self) {
        if let Some((_, block)) = self.under_way(self.now) {
            let (line, segment, tool) = (block.line, block.segment, block.flange_from_tcp);
            self.set_place(line, segment, tool);
        }
    }

    fn set_place(&mut self, line: u32, segment: u32, tool: Pose) {
        (self.place.mark.line, self.place.mark.segment, self.place.flange_from_tcp) = (line, segment, tool);
    }

    /// The arm has come to where it had to be at rest.
    fn go_on(&mut self, goal: f64) {
        if self.now < self.move_start {
            self.rate = Rate::constant(self.goal(goal, None));
        } else {
            self.enter_head(goal);
        }
    }

    /// Where a move among those done ends at rest, the arm comes to that place before it goes on.
    fn stop_among_done(&mut self, before: f64, arm: Arm) {
        if before >= self.move_start || arm.motion == Follows::AtOnce {
            return;
        }
        let Some((start, block)) = self.under_way(before) else { return };
        let end = start + block.duration();
        if block.ends_at_rest && self.now >= end {
            (self.now, self.arriving) = (end, true);
        }
    }

    /// The look-ahead's time of a programme time: it always runs on.
    pub(super) fn ahead_time(&self, time: f64) -> f64 {
        self.backward.map_or(time, |from| from - time)
    }

    fn head(&self) -> Option<&Command<N>> {
        (self.count > 0).then(|| &self.pending[self.first])
    }

    /// The move at the head of the pending commands, unless the arm has yet to come to the end of the one before.
    pub(super) fn head_move(&self) -> Option<&Block<N>> {
        match self.head() {
            Some(Command::Move(block)) if !self.arriving => Some(block),
            _ => None,
        }
    }

    /// The next command that takes time is a move.
    fn moves_on(&self) -> bool {
        let at_once = |command: &&Command<N>| {
            matches!(
                command,
                Command::Marker(_)
                    | Command::Taught { .. }
                    | Command::Arc { on: false, .. }
                    | Command::ArcSetting(_)
            )
        };
        let next = (0..self.count).map(|k| self.nth(k)).find(|command| !at_once(command));
        matches!(next, Some(Command::Move(_)))
    }

    fn nth(&self, k: usize) -> &Command<N> {
        &self.pending[(self.first + k) % PENDING]
    }

    fn pop(&mut self, goal: f64) {
        self.first = (self.first + 1) % PENDING;
        self.count -= 1;
        self.enter_head(goal);
    }

    /// A move has come to the head: it says where the program is, and from rest the rate may start at once.
    fn enter_head(&mut self, goal: f64) {
        if let Some(block) = self.head_move() {
            let (line, segment, tool, from_rest) =
                (block.line, block.segment, block.flange_from_tcp, block.starts_at_rest);
            self.set_place(line, segment, tool);
            if from_rest && self.now >= self.move_start {
                self.rate = Rate::constant(self.goal(goal, None));
            }
        }
    }

    fn refill(&mut self, source: &mut impl CommandSource<N>, goal: f64) {
        while self.count < PENDING {
            let Some(command) = source.next() else { break };
            if matches!(command, Command::Move(_)) {
                // What was taken for rest after the last known move is motion now.
                self.ahead.forget_after(self.known_end());
            }
            self.pending[(self.first + self.count) % PENDING] = command;
            self.count += 1;
            if self.count == 1 {
                self.enter_head(goal);
            }
        }
    }

    /// Programme time at which the last pending move ends.
    fn known_end(&self) -> f64 {
        (0..self.count).fold(self.move_start, |end, k| match self.nth(k) {
            Command::Move(block) => end + block.duration(),
            _ => end,
        })
    }

    pub(super) fn look_ahead<K: Kinematics<N>>(&mut self, kinematics: &K) -> Result<(), Fault> {
        self.ahead.forget_before(self.ahead_time(self.now));
        for _ in 0..SAMPLES_PER_CYCLE {
            let Some(time) = self.ahead.wanted() else { break };
            let motion = match self.backward {
                Some(from) => self.sample_back(from - time, kinematics)?,
                None => self.sample(time, kinematics)?,
            };
            let Some(motion) = motion else { break };
            self.ahead.push(motion);
        }
        Ok(())
    }

    /// The joints' motion at a programme time; `None` where it is not known yet.
    fn sample<K: Kinematics<N>>(
        &mut self,
        time: f64,
        kinematics: &K,
    ) -> Result<Option<JointMotion<N>>, Fault> {
        if time < self.move_start
            && let Some((start, block)) = self.under_way(time)
        {
            let at = At { block, start, since: time - start };
            let (motion, position) =
                joint_motion(&at, &self.ahead_position, &self.corrections(), kinematics)?;
            self.ahead_position = position;
            return Ok(Some(motion));
        }
        let mut start = self.move_start;
        let mut rests = true;
        for k in 0..self.count {
            let Command::Move(block) = self.nth(k) else { continue };
            let end = start + block.duration();
            if time < end {
                let at = At { block, start, since: (time - start).max(0.0) };
                let (motion, position) =
                    joint_motion(&at, &self.ahead_position, &self.corrections(), kinematics)?;
                self.ahead_position = position;
                return Ok(Some(motion));
            }
            (start, rests) = (end, block.ends_at_rest);
        }
        Ok((rests && self.count < PENDING).then_some(JointMotion::REST))
    }
}

/// An instant of a block.
#[derive(Debug, Clone, Copy)]
pub(super) struct At<'a, const N: usize> {
    pub(super) block: &'a Block<N>,
    /// Programme time at which the block begins, and time since then.
    pub(super) start: f64,
    pub(super) since: f64,
}

/// The joints' motion and position at an instant of a block.
pub(super) fn joint_motion<const N: usize, K: Kinematics<N>>(
    at: &At<'_, N>,
    seed: &[f64; N],
    corrections: &Corrections<'_, N>,
    kinematics: &K,
) -> Result<(JointMotion<N>, [f64; N]), Fault> {
    let JointJet { position, velocity, acceleration, jerk } = joints_on(at, seed, corrections, kinematics)?;
    let path = along_path(at.block, at.since);
    Ok((JointMotion { velocity, acceleration, jerk, path }, position))
}

/// The path covered at a time since a block's start.
fn way_on<const N: usize>(block: &Block<N>, time: f64) -> Way {
    match &block.motion {
        Motion::Joint(_) => Way { path: time, tool: 0.0 },
        Motion::Path(motion) => {
            let path = motion.state(time).position - motion.state(0.0).position;
            let tool = if motion.path.measure() == Measure::Length { path } else { 0.0 };
            Way { path, tool }
        }
    }
}

/// The tool's motion along its path at a time since a block's start.
pub(super) fn along_path<const N: usize>(block: &Block<N>, time: f64) -> AlongPath {
    match &block.motion {
        Motion::Joint(_) => AlongPath::NONE,
        Motion::Path(motion) => {
            let PathState { velocity, acceleration, jerk, .. } = motion.state(time);
            let (acceleration_limit, jerk_limit) = (motion.acceleration, motion.jerk);
            AlongPath { velocity, acceleration, jerk, acceleration_limit, jerk_limit }
        }
    }
}

/// The joints at an instant of a block, in programme time, on the branch nearest to `seed`; with what takes them off the planned motion.
fn joints_on<const N: usize, K: Kinematics<N>>(
    at: &At<'_, N>,
    seed: &[f64; N],
    corrections: &Corrections<'_, N>,
    kinematics: &K,
) -> Result<JointJet<N>, Fault> {
    let mut jet = match &at.block.motion {
        Motion::Joint(motion) => {
            let state = motion.at_time(at.since);
            let (position, velocity) = (state.position, state.velocity);
            JointJet { position, velocity, acceleration: state.acceleration, jerk: state.jerk }
        }
        Motion::Path(motion) => joints_of(&motion.flange_on(at.since, corrections.seam), seed, kinematics)?,
    };
    if let Some(fade) = corrections.fade {
        fade.add(&mut jet, at.start + at.since);
    }
    Ok(jet)
}

/// The joints where the flange moves like this, on the branch nearest to `seed`.
pub(super) fn joints_of<const N: usize, K: Kinematics<N>>(
    flange: &PoseJet,
    seed: &[f64; N],
    kinematics: &K,
) -> Result<JointJet<N>, Fault> {
    let inverse = || {
        let q = kinematics.inverse_nearest(&flange.pose, seed)?;
        kinematics.joint_jet(flange, &q)
    };
    inverse().map_err(|_| Fault::NoInverse { position: flange.pose.translation.vector })
}
