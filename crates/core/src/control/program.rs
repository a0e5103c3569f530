//! Tier 2: where the program stands, and how far programme time goes on in this cycle.

use super::block::{Block, Command, Motion};
use super::lookahead::{AlongPath, JointMotion, Lookahead};
use super::rate::{Rate, RateLimits};
use super::trail::Mark;
use crate::geometry::Pose;
use crate::kinematics::{JointJet, Kinematics};
use crate::path::PathState;
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
    count: usize,
    /// Programme time now, and when the first pending move begins.
    now: f64,
    move_start: f64,
    /// Path covered before the first pending move.
    way_before: f64,
    /// A move has ended at rest, and the arm has yet to come to where it ended.
    arriving: bool,
    /// What is left of a dwell that has begun.
    dwell_left: Option<f64>,
    rate: Rate,
    ahead: Lookahead<N>,
    /// Joint positions at the look-ahead's end, and now: the seeds of the inverse kinematics.
    ahead_position: [f64; N],
    position: [f64; N],
    place: Place,
}

/// What the program has reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) mark: Mark,
    pub(super) flange_from_tcp: Pose,
    pub(super) ended: bool,
}

/// How the arm follows the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arm {
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
            way_before: 0.0,
            arriving: false,
            dwell_left: None,
            rate: Rate::constant(0.0),
            ahead: Lookahead::new(sample_spacing),
            ahead_position: position,
            position,
            place,
        }
    }

    /// Forgets all commands; the arm is at rest at `position`.
    pub(super) fn clear(&mut self, position: [f64; N]) {
        let place = Place { mark: Mark { arc: false, ..self.place.mark }, ended: false, ..self.place };
        *self = Self { place, ..Self::at_rest(position, self.place.flange_from_tcp, self.ahead.spacing()) };
    }

    pub(super) fn place(&self) -> &Place {
        &self.place
    }

    pub(super) fn rate(&self) -> &Rate {
        &self.rate
    }

    /// Path covered since the start, and by the moves that are done: where what the place says began. Its unit is that of each path, and
    /// seconds for a move of the joints.
    pub(super) fn way(&self) -> (f64, f64) {
        let here = self.head_move().map_or(0.0, |block| way_on(block, self.now - self.move_start));
        (self.way_before + here, self.way_before)
    }

    /// Nothing moves: time stands still, or there is nothing to move along.
    pub(super) fn is_at_rest(&self) -> bool {
        self.rate.is_stopped() || self.head_move().is_none()
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
        self.refill(source, goal);
        self.look_ahead(kinematics)?;
        if self.arriving && arm != Arm::Behind {
            self.arriving = false;
            self.enter_head(goal);
        }
        if self.head_move().is_some() {
            self.now += self.rate.advance(goal, self.now, &self.ahead, limits, period);
        }
        // Each turn removes a command, or is the last.
        for _ in 0..PENDING {
            if self.arriving || !self.finish_head(goal, kinematics, period, arm)? {
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
        period: f64,
        arm: Arm,
    ) -> Result<bool, Fault> {
        match self.head() {
            None => return Ok(false),
            Some(Command::Move(block)) => {
                let end = self.move_start + block.duration();
                if self.now < end {
                    return Ok(false);
                }
                let (rests, way) = (block.ends_at_rest, way_on(block, block.duration()));
                // Exactly where the move ends, however the cycles fell.
                self.position = joints_on(block, block.duration(), &self.position, kinematics)?.position;
                self.move_start = end;
                self.way_before += way;
                self.arriving = rests && arm != Arm::AtOnce;
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
                (self.place.mark.line, self.place.mark.segment) = (line, segment);
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
            Some(Command::Arc { on }) => self.place.mark.arc = *on,
            Some(Command::Marker(number)) => self.place.mark.marker = *number,
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
        let jet = match self.head_move() {
            Some(block) => joints_on(block, self.now - self.move_start, &self.position, kinematics)?,
            None => JointJet::at_rest(self.position),
        };
        self.position = jet.position;
        Ok(jet)
    }

    fn head(&self) -> Option<&Command<N>> {
        (self.count > 0).then(|| &self.pending[self.first])
    }

    /// The move under way.
    fn head_move(&self) -> Option<&Block<N>> {
        match self.head() {
            Some(Command::Move(block)) if !self.arriving => Some(block),
            _ => None,
        }
    }

    /// The next command that takes time is a move.
    fn moves_on(&self) -> bool {
        let at_once = |command: &&Command<N>| matches!(command, Command::Marker(_) | Command::Arc { .. });
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
            (self.place.mark.line, self.place.mark.segment, self.place.flange_from_tcp) =
                (line, segment, tool);
            if from_rest {
                self.rate = Rate::constant(goal);
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

    fn look_ahead<K: Kinematics<N>>(&mut self, kinematics: &K) -> Result<(), Fault> {
        self.ahead.forget_before(self.now);
        for _ in 0..SAMPLES_PER_CYCLE {
            let Some(time) = self.ahead.wanted() else { break };
            let Some(motion) = self.sample(time, kinematics)? else { break };
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
        let mut start = self.move_start;
        let mut rests = true;
        for k in 0..self.count {
            let Command::Move(block) = self.nth(k) else { continue };
            let end = start + block.duration();
            if time < end {
                let since = (time - start).max(0.0);
                let jet = joints_on(block, since, &self.ahead_position, kinematics)?;
                let JointJet { position, velocity, acceleration, jerk } = jet;
                let path = along_path(block, since);
                self.ahead_position = position;
                return Ok(Some(JointMotion { velocity, acceleration, jerk, path }));
            }
            (start, rests) = (end, block.ends_at_rest);
        }
        Ok((rests && self.count < PENDING).then_some(JointMotion::REST))
    }
}

/// The path covered at a time since a block's start.
fn way_on<const N: usize>(block: &Block<N>, time: f64) -> f64 {
    match &block.motion {
        Motion::Joint(_) => time,
        Motion::Path(motion) => motion.state(time).position - motion.state(0.0).position,
    }
}

/// The tool's motion along its path at a time since a block's start.
fn along_path<const N: usize>(block: &Block<N>, time: f64) -> AlongPath {
    match &block.motion {
        Motion::Joint(_) => AlongPath::NONE,
        Motion::Path(motion) => {
            let PathState { velocity, acceleration, jerk, .. } = motion.state(time);
            let (acceleration_limit, jerk_limit) = (motion.acceleration, motion.jerk);
            AlongPath { velocity, acceleration, jerk, acceleration_limit, jerk_limit }
        }
    }
}

/// The joints at a time since a block's start, in programme time, on the branch nearest to `seed`.
fn joints_on<const N: usize, K: Kinematics<N>>(
    block: &Block<N>,
    time: f64,
    seed: &[f64; N],
    kinematics: &K,
) -> Result<JointJet<N>, Fault> {
    match &block.motion {
        Motion::Joint(trajectory) => {
            let state = trajectory.at_time(time);
            let (position, velocity) = (state.position, state.velocity);
            Ok(JointJet { position, velocity, acceleration: state.acceleration, jerk: state.jerk })
        }
        Motion::Path(motion) => {
            let flange = motion.flange(time);
            let inverse = |flange: &crate::geometry::PoseJet| {
                let q = kinematics.inverse_nearest(&flange.pose, seed)?;
                kinematics.joint_jet(flange, &q)
            };
            inverse(&flange).map_err(|_| Fault::NoInverse { position: flange.pose.translation.vector })
        }
    }
}
