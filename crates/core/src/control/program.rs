//! Tier 2: where the program stands, and how far programme time goes on in this cycle.

use super::block::{Block, Command};
use super::history::{Done, History};
use super::instant::{At, along_path, joint_motion, joints_on, way_on};
use super::lookahead::{AlongPath, JointMotion, Lookahead};
use super::rails::{OnRails, Rails};
use super::rate::{Rate, RateLimits};
use super::seam::{Fade, SeamGuide};
use super::trail::{Mark, Way};
use crate::geometry::Pose;
use crate::kinematics::{JointJet, Kinematics};
use crate::safety::Fault;

/// Commands held between the queue and the motion.
const PENDING: usize = 32;
/// Samples by which the look-ahead may grow in one cycle; one is used up.
const SAMPLES_PER_CYCLE: usize = 3;

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
    pub(super) count: usize,
    /// Programme time now, and when the first pending move begins. The motion is in the moves done while it is before that.
    pub(super) now: f64,
    pub(super) move_start: f64,
    /// Path covered before the first pending move.
    pub(super) way_before: Way,
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
    pub(super) fade: Option<Fade<N>>,
    /// Differences that faded before it, as a number: with the share of it that has gone it changes in motion only.
    pub(super) faded: f64,
    /// Where on the way it begins.
    pub(super) fades_from: f64,
    /// The share of full speed that was last asked for.
    pub(super) speed: f64,
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
            faded: 0.0,
            fades_from: 0.0,
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
            faded,
            fades_from,
            speed,
        } = self;
        (*first, *count, *arriving, *backward, *dwell_left) = (0, 0, false, None, None);
        (*now, *move_start, *arc_way, *speed) = (0.0, 0.0, 0.0, 0.0);
        (*faded, *fades_from) = (0.0, 0.0);
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
            Some(Command::TrackOver) => {
                if !self.join_move(kinematics, limits)? {
                    return Ok(false);
                }
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

    pub(super) fn nth(&self, k: usize) -> &Command<N> {
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
                self.begin_to_fade();
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

    /// Programme time from the first pending move to where the arm next comes to rest, as far as it is known.
    pub(super) fn time_to_rest(&self) -> f64 {
        let mut time = 0.0;
        for k in 0..self.count {
            let Command::Move(block) = self.nth(k) else { continue };
            time += block.duration();
            if block.ends_at_rest {
                break;
            }
        }
        time
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
