//! The controller with its drives, and what goes in and out once per period.

use rtrb::Consumer;
use seamline::arc::ArcSource;
use seamline::control::{
    ArcRules, Command, CommandPrefilter, CommandSource, Cycle, CycleConfig, CycleInput, CycleOutput, Event,
    PrefilterEntry, STAGES, ServoModel, StageClock,
};
use seamline::drive::Drive;
use seamline::geometry::Pose;
use seamline::safety::{Fault, WorkspaceBox};
use seamline::seam::LaneMemory;
use seamline::vibration::{Kernel, StageEntry, StageError, stage_entries};

use super::clock::thread_cpu_ns;
use super::readings::Readings;
use crate::cell::Cell;
use crate::plan::{Arm, PlanningArm};
use crate::record::{MAX_JOINTS, Sample, TimeFigures, TimeHistogram};
use crate::sensor::CellSensor;

/// Late cycles in a row after which the arm stops.
const OVERRUNS_IN_ROW: u32 = 20;

/// The cycle's end of the queue.
#[derive(Debug)]
struct Queue<const N: usize> {
    commands: Consumer<Command<N>>,
    silent: bool,
}

impl<const N: usize> CommandSource<N> for Queue<N> {
    fn next(&mut self) -> Option<Command<N>> {
        if self.silent { None } else { self.commands.pop().ok() }
    }
}

/// Computing times of the stages and of the whole cycle.
#[derive(Debug, Clone)]
struct Times {
    stages: [TimeHistogram; STAGES.len()],
    /// By the thread's processor clock.
    whole: TimeHistogram,
}

/// What the controller is connected to.
#[derive(Debug)]
pub struct Devices<D, A> {
    /// The servo drives.
    pub drive: D,
    /// The welding power source.
    pub arc: A,
    /// The seam sensor.
    pub seam: CellSensor,
}

/// Memory of the prefilters, from the heap before the first cycle.
type Memory<const N: usize> = Box<[PrefilterEntry<N>]>;

/// The prefilters of a cell.
///
/// # Errors
/// [`StageError`] where a kernel does not suit the period.
pub fn command_prefilter<const N: usize>(cell: &Cell) -> Result<CommandPrefilter<N, Memory<N>>, StageError> {
    let period = cell.cycle.period;
    let stage =
        |kernel: &Kernel| (*kernel, vec![StageEntry::ZERO; stage_entries(kernel, period)].into_boxed_slice());
    let prefilter = CommandPrefilter::try_new(cell.vibration.kernels().iter().map(stage), period)?;
    Ok(prefilter.acting_on(cell.vibration.acts_on()))
}

/// A controller, its devices and its queue. [`Machine::cycle`] neither allocates nor locks.
#[derive(Debug)]
pub struct Machine<const N: usize, K, D, A, C> {
    /// It holds all that a cycle may need, and is not to be moved about.
    cycle: Box<Cycle<N, K, Memory<N>>>,
    devices: Devices<D, A>,
    clock: C,
    queue: Queue<N>,
    input: CycleInput<N>,
    period: f64,
    count: u64,
    last_tcp: Pose,
    times: Times,
    readings: Readings,
}

impl<const N: usize, K: PlanningArm<N>, D: Drive<N>, A: ArcSource, C: StageClock> Machine<N, K, D, A, C> {
    /// A disabled controller whose arm stands at home, on a queue that a planner fills.
    ///
    /// # Errors
    /// [`StageError`] where the cell's prefilters do not suit its cycle.
    pub fn new(
        cell: &Cell,
        arm: &Arm<N, K>,
        devices: Devices<D, A>,
        clock: C,
        queue: Consumer<Command<N>>,
    ) -> Result<Self, StageError> {
        let flange_from_tcp = cell.tool(0).map_or_else(Pose::identity, |tool| tool.flange_from_tcp);
        let lag = |joint| cell.simulation.servo_lag.get(joint).copied().unwrap_or(0.0);
        let config = CycleConfig {
            period: cell.cycle.period,
            limits: arm.limits,
            workspace: WorkspaceBox { low: cell.safety.workspace_min, high: cell.safety.workspace_max },
            flange_from_tcp,
            servo: ServoModel {
                lag: std::array::from_fn(lag),
                feed_forward: [cell.simulation.velocity_feed_forward; N],
                following_error: arm.following_error,
            },
            overruns_in_row: OVERRUNS_IN_ROW,
            arc: arc_rules(cell),
        };
        let prefilter = command_prefilter(cell)?;
        Ok(Self {
            cycle: Box::new(Cycle::with_prefilter(config, arm.kinematics.clone(), prefilter, arm.home)),
            devices,
            clock,
            queue: Queue { commands: queue, silent: false },
            input: CycleInput {
                measured: Ok(arm.home),
                speed_override: 1.0,
                event: None,
                fault: None,
                late: false,
                arc_burning: Some(false),
            },
            period: cell.cycle.period,
            count: 0,
            last_tcp: arm.kinematics.forward(&arm.home) * flange_from_tcp,
            times: Times { stages: Default::default(), whole: TimeHistogram::new() },
            readings: Readings::default(),
        })
    }

    /// Speed override from the next cycle on, 0 … 1.
    pub fn set_override(&mut self, rate: f64) {
        self.input.speed_override = rate;
    }

    /// An operator's event for the next cycle.
    pub fn request(&mut self, event: Event) {
        self.input.event = Some(event);
    }

    /// A fault from outside for the next cycle.
    pub fn raise(&mut self, fault: Fault) {
        self.input.fault = Some(fault);
    }

    /// Whether the planner's commands come no longer.
    pub fn silence_planner(&mut self, silent: bool) {
        self.queue.silent = silent;
    }

    /// Whether the next cycle begins late.
    pub fn set_late(&mut self, late: bool) {
        self.input.late = late;
    }

    /// The memory of passes.
    #[must_use]
    pub fn memory(&self) -> &LaneMemory {
        self.cycle.memory()
    }

    /// The memory of passes, for records of earlier runs: before a job that is to find them.
    pub fn memory_mut(&mut self) -> &mut LaneMemory {
        self.cycle.memory_mut()
    }

    /// What it is connected to.
    pub fn devices_mut(&mut self) -> &mut Devices<D, A> {
        &mut self.devices
    }

    /// Time between two cycles in seconds.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Time of the next cycle in seconds since the first.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.count as f64 * self.period
    }

    /// One period: command, exchange with the drives, and the sample of it.
    pub fn cycle(&mut self) -> (CycleOutput<N>, Sample) {
        let before = thread_cpu_ns();
        let output = self.cycle.step(&self.input, &mut self.queue, &mut self.devices.seam, &mut self.clock);
        self.times.whole.record(thread_cpu_ns().saturating_sub(before));
        for (histogram, ns) in self.times.stages.iter_mut().zip(output.status.stage_ns) {
            histogram.record(u64::from(ns));
        }
        if let Some(seam) = &output.status.seam {
            self.readings.push(&seam.counts);
        }
        self.input.event = None;
        self.input.fault = None;
        self.input.measured = self.devices.drive.exchange(&output.command, self.period);
        self.input.arc_burning = self.devices.arc.exchange(&output.arc, self.period);
        let sample = self.sample(&output);
        self.count += 1;
        self.last_tcp = output.status.base_from_tcp;
        (output, sample)
    }

    fn sample(&self, output: &CycleOutput<N>) -> Sample {
        let status = &output.status;
        let travelled = status.base_from_tcp.translation.vector - self.last_tcp.translation.vector;
        let mut sample = Sample {
            time: self.time(),
            mode: status.mode,
            line: status.line,
            segment: status.segment,
            override_rate: status.rate,
            tcp: status.base_from_tcp,
            tcp_speed: travelled.norm() / self.period,
            arc: output.arc.on,
            ..Sample::at_rest()
        };
        if let Some(seam) = status.seam {
            (sample.seam_lateral, sample.seam_height) = (seam.offset.x, seam.offset.y);
            let truth = self.devices.seam.true_seam(seam.s).filter(|_| seam.on_seam && !seam.from_record);
            sample.seam_error = truth.map_or(f64::NAN, |truth| (seam.offset - truth).norm());
        }
        let joints = N.min(MAX_JOINTS);
        let measured = self.input.measured.unwrap_or([f64::NAN; N]);
        sample.command[..joints].copy_from_slice(&output.command.position[..joints]);
        sample.measured[..joints].copy_from_slice(&measured[..joints]);
        sample
    }

    /// What became of the seam sensor's readings so far, in words.
    #[must_use]
    pub fn seam_remarks(&self) -> Vec<String> {
        self.readings.remarks(&self.devices.seam)
    }

    /// Computing times so far: each stage by the clock given, the whole cycle by the thread's processor clock.
    #[must_use]
    pub fn stage_times(&self) -> Vec<TimeFigures> {
        let stages = self.times.stages.iter().zip(STAGES).map(|(histogram, name)| histogram.figures(name));
        stages.chain([self.times.whole.figures("cycle")]).collect()
    }
}

/// How the cell wants the arc handled.
#[must_use]
pub fn arc_rules(cell: &Cell) -> ArcRules {
    let policy = &cell.arc;
    ArcRules {
        dry: policy.dry_run,
        strike: policy.strike,
        strikes: policy.strikes,
        pause: policy.strike_pause,
        loss: policy.loss,
        overlap: policy.overlap,
        back_speed: policy.back_speed,
        restart_dwell: policy.restart_dwell,
        lock_override: policy.lock_override,
    }
}
