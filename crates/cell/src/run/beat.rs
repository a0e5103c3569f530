//! What passes between the loop of cycles and its supervisor.

use seamline::control::{CycleOutput, Event, Mode};
use seamline::safety::Fault;
use seamline::seam::LaneMemory;

use super::clock::MonotonicClock;
use super::inject::FaultScript;
use super::machine::Machine;
use crate::plan::PlanningArm;
use crate::record::{Sample, TimeFigures};
use crate::sim::{SimulatedArc, SimulatedDrive};

/// What the supervisor needs to know of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beat {
    pub(super) time: f64,
    pub(super) mode: Mode,
    pub(super) at_rest: bool,
    pub(super) fault: Option<Fault>,
    pub(super) line: u32,
    pub(super) marker: u32,
}

impl Beat {
    /// Nothing follows after this cycle: the job is done, or a fault has brought the arm to rest.
    pub(super) fn ends_run(&self) -> bool {
        match self.mode {
            Mode::Standstill | Mode::Disabled => true,
            Mode::Fault => self.at_rest,
            Mode::Running | Mode::Holding | Mode::Resuming | Mode::Backing | Mode::Stopping => false,
        }
    }

    pub(super) fn new<const N: usize>(time: f64, output: &CycleOutput<N>) -> Self {
        let status = &output.status;
        Self {
            time,
            mode: status.mode,
            at_rest: status.at_rest,
            fault: status.fault,
            line: status.line,
            marker: status.marker,
        }
    }
}

/// What the loop of cycles knows in the end.
#[derive(Debug, Default)]
pub(super) struct LoopFigures {
    pub(super) stage_times: Vec<TimeFigures>,
    pub(super) lateness: Option<TimeFigures>,
    pub(super) overruns: u64,
    pub(super) remarks: Vec<String>,
    /// The memory of passes.
    pub(super) memory: Box<LaneMemory>,
}

/// A controller on simulated devices, and what goes wrong with them.
pub(super) struct Plant<const N: usize, K> {
    pub(super) machine: Machine<N, K, SimulatedDrive<N>, SimulatedArc, MonotonicClock>,
    pub(super) script: FaultScript,
}

impl<const N: usize, K: PlanningArm<N>> Plant<N, K> {
    /// The cycle with this number, from 0.
    pub(super) fn cycle(&mut self, number: u64) -> (Beat, Sample) {
        if let Some(event) = start_event(number) {
            self.machine.request(event);
        }
        self.script.act(&mut self.machine);
        let time = self.machine.time();
        let (output, sample) = self.machine.cycle();
        (Beat::new(time, &output), sample)
    }
}

/// Drives power up in the first cycle, and the job starts in the second.
fn start_event(cycle: u64) -> Option<Event> {
    match cycle {
        0 => Some(Event::Enable),
        1 => Some(Event::Start),
        _ => None,
    }
}
