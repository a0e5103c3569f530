//! Keeps the cycle's queue filled: steps become commands as early as the program allows.

use std::collections::VecDeque;

use rtrb::Producer;
use seamline::control::Command;

use super::announcement::{Announcement, announcement};
use super::error::RunError;
use super::walk::{WAIT_MAX, Walk};
use crate::cell::UnmetWait;
use crate::job::{Action, Condition, Location};
use crate::plan::{Planned, PlanningArm};
use crate::record::{EventKind, SegmentInfo};

/// A WAIT under way.
#[derive(Debug)]
struct Waiting {
    condition: Condition,
    timeout: Option<f64>,
    at: Location,
    /// When the robot arrived and the waiting began.
    since: Option<f64>,
}

/// The planner's end of the queue.
#[derive(Debug)]
pub(super) struct Feeder<'a, const N: usize, K> {
    walk: Walk<'a, N, K>,
    queue: Producer<Command<N>>,
    backlog: VecDeque<Command<N>>,
    announcements: VecDeque<Announcement>,
    /// The last marker handed out.
    marker: u32,
    waiting: Option<Waiting>,
    /// The program reads inputs: each step waits until the robot has done the one before.
    in_step: bool,
    ended: bool,
    /// Why the program ended early.
    failure: Option<RunError>,
}

impl<'a, const N: usize, K: PlanningArm<N>> Feeder<'a, N, K> {
    pub(super) fn new(walk: Walk<'a, N, K>, queue: Producer<Command<N>>, in_step: bool) -> Self {
        Self {
            walk,
            queue,
            backlog: VecDeque::new(),
            announcements: VecDeque::new(),
            marker: 0,
            waiting: None,
            in_step,
            ended: false,
            failure: None,
        }
    }

    /// Fills the queue as far as program and room allow. `passed` is the last marker that the cycle has passed, `time`
    /// the time since the start. Every new segment goes to `segment` before its commands go to the queue.
    pub(super) fn feed(&mut self, time: f64, passed: u32, mut segment: impl FnMut(SegmentInfo)) {
        // Ends: each turn sends commands, begins to wait, or takes a step; the queue has room for so many.
        while self.send_backlog() && !self.ended {
            let arrived = passed == self.marker;
            if self.waiting.is_some() {
                if !arrived || !self.wait_is_over(time) {
                    return;
                }
                self.waiting = None;
            } else if self.in_step && !self.walk.goes_on_ahead() {
                // The robot can arrive only by what is held back.
                if self.walk.holds_back() {
                    self.finish(&mut segment);
                    continue;
                }
                if !arrived {
                    return;
                }
            }
            self.take_step(time, &mut segment);
        }
    }

    /// The reports that the program has come to.
    pub(super) fn reached(&mut self, passed: u32) -> impl Iterator<Item = Announcement> + '_ {
        let count =
            self.announcements.iter().take_while(|announcement| announcement.marker <= passed).count();
        self.announcements.drain(..count)
    }

    /// Why the program ended before its end.
    pub(super) fn failure(&mut self) -> Option<RunError> {
        self.failure.take()
    }

    /// Hands over what waits; false where the queue is full.
    fn send_backlog(&mut self) -> bool {
        while let Some(command) = self.backlog.pop_front() {
            if let Err(rtrb::PushError::Full(command)) = self.queue.push(command) {
                self.backlog.push_front(command);
                return false;
            }
        }
        true
    }

    fn take_step(&mut self, time: f64, segment: &mut impl FnMut(SegmentInfo)) {
        let mut parts = Vec::new();
        let (ends, result) = match self.walk.next(time) {
            Ok(Some(step)) => (false, self.walk.plan(&step, &mut parts)),
            Ok(None) => (true, Ok(())),
            Err(error) => (true, Err(error)),
        };
        // At the program's end the robot arrives.
        let result = if ends { result.and_then(|()| self.walk.finish(&mut parts)) } else { result };
        self.send_all(parts, segment);
        if (ends || result.is_err()) && !self.ended {
            self.end(result.err());
        }
    }

    /// Sends what the planner holds back.
    fn finish(&mut self, segment: &mut impl FnMut(SegmentInfo)) {
        let mut parts = Vec::new();
        let result = self.walk.finish(&mut parts);
        self.send_all(parts, segment);
        if let (Err(error), false) = (result, self.ended) {
            self.end(Some(error));
        }
    }

    fn send_all(&mut self, parts: Vec<Planned<N>>, segment: &mut impl FnMut(SegmentInfo)) {
        for part in parts {
            self.send(part, segment);
        }
    }

    /// Puts what a step became into the queue, and what it says to the operator beside it.
    fn send(&mut self, part: Planned<N>, segment: &mut impl FnMut(SegmentInfo)) {
        let Planned { at, action, commands, segment: info, notices, .. } = part;
        for notice in notices {
            self.announce(at.line, EventKind::Notice, Some(notice));
        }
        if let Some(action) = &action {
            let outputs = matches!(action, Action::Output(_) | Action::Message { .. });
            let kind = if outputs { EventKind::Output } else { EventKind::Notice };
            self.announce(at.line, kind, announcement(action));
        }
        if let Some(info) = info {
            segment(info);
        }
        self.backlog.extend(commands);
        match action {
            Some(Action::Wait { condition, timeout_seconds }) => {
                self.announce(at.line, EventKind::Notice, None);
                self.waiting = Some(Waiting { condition, timeout: timeout_seconds, at, since: None });
            }
            Some(Action::Alarm { stops: true, .. } | Action::End) => self.end(None),
            _ => self.announce(at.line, EventKind::Notice, None),
        }
    }

    /// Sends a marker, with a text where there is something to say when it is passed.
    fn announce(&mut self, line: u32, kind: EventKind, text: Option<String>) {
        self.marker += 1;
        self.backlog.push_back(Command::Marker(self.marker));
        if let Some(text) = text {
            let marker = self.marker;
            self.announcements.push_back(Announcement { marker, line, kind, text });
        }
    }

    fn end(&mut self, failure: Option<RunError>) {
        self.backlog.push_back(Command::End);
        self.ended = true;
        self.failure = failure;
        self.send_backlog();
    }

    fn wait_is_over(&mut self, time: f64) -> bool {
        let Some(waiting) = &mut self.waiting else { return true };
        let waited = time - *waiting.since.get_or_insert(time);
        if self.walk.holds(&waiting.condition, time)
            || waiting.timeout.is_some_and(|timeout| waited >= timeout)
        {
            return true;
        }
        if waiting.timeout.is_some()
            || waited < WAIT_MAX && self.walk.may_still_hold(&waiting.condition, time)
        {
            return false;
        }
        let at = waiting.at.clone();
        if self.walk.cell().io.unmet_wait == UnmetWait::Stop {
            self.waiting = None;
            let at = self.walk.place(&at);
            self.end(Some(RunError::UnmetWait { at }));
            return false;
        }
        self.announce(
            at.line,
            EventKind::Notice,
            Some("WAIT is never met by the scripted inputs: goes on".into()),
        );
        true
    }
}
