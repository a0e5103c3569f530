//! Beside the cycle: feeds its queue, and reports what happens.

use std::io;

use rtrb::Producer;
use seamline::control::{Command, Mode};

use super::beat::Beat;
use super::faults::describe;
use super::feeder::Feeder;
use super::walk::Walk;
use crate::plan::PlanningArm;
use crate::record::{Event, EventKind, Findings, JointInfo, Recorder, SampleSender};

/// The side of a run that may wait, allocate and write.
#[derive(Debug)]
pub(super) struct Supervisor<'a, const N: usize, K> {
    feeder: Feeder<'a, N, K>,
    recorder: Recorder,
    joints: Vec<JointInfo>,
    fault_reported: bool,
}

impl<'a, const N: usize, K: PlanningArm<N>> Supervisor<'a, N, K> {
    pub(super) fn new(
        walk: Walk<'a, N, K>,
        queue: Producer<Command<N>>,
        in_step: bool,
        recorder: Recorder,
        joints: Vec<JointInfo>,
    ) -> Self {
        let feeder = Feeder::new(walk, queue, in_step);
        Self { feeder, recorder, joints, fault_reported: false }
    }

    /// Fills the queue before the first cycle.
    pub(super) fn feed(&mut self, time: f64) {
        let recorder = &self.recorder;
        self.feeder.feed(time, 0, |info| recorder.segment(info));
    }

    /// Takes note of a cycle and feeds the queue for the next.
    pub(super) fn observe(&mut self, beat: &Beat) {
        let recorder = &self.recorder;
        for announcement in self.feeder.reached(beat.marker) {
            recorder.event(announcement.event(beat.time));
        }
        if let Some(fault) = beat.fault.filter(|_| !self.fault_reported) {
            self.fault_reported = true;
            let text = describe(&fault, &self.joints);
            recorder.event(Event { time: beat.time, line: beat.line, kind: EventKind::Fault, text });
        }
        self.feeder.feed(beat.time, beat.marker, |info| recorder.segment(info));
        if beat.mode == Mode::Standstill
            && let Some(error) = self.feeder.failure()
        {
            let text = error.to_string();
            self.recorder.event(Event { time: beat.time, line: beat.line, kind: EventKind::Fault, text });
        }
    }

    /// Waits until everything is written.
    pub(super) fn finish(self, samples: SampleSender) -> io::Result<Findings> {
        self.recorder.finish(samples)
    }
}
