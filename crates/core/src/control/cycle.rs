//! The cycle: four tiers from the measured joints to the next command, with the prefilters between the third and the fourth.

use super::feedback::{Observer, ServoModel};
use super::halt::Halt;
use super::mode::{Event, Mode};
use super::prefilter::{JointPrefilter, PrefilterEntry, Progress};
use super::program::{Arm, CommandSource, Program};
use super::rate::RateLimits;
use super::telemetry::{CycleOutput, StageClock, Status};
use super::trail::Mark;
use crate::drive::{DriveFault, JointCommand};
use crate::geometry::Pose;
use crate::kinematics::{JointJet, Kinematics};
use crate::safety::{Envelope, Fault, MotionLimits, StopCategory, WorkspaceBox};

/// Least distance of the look-ahead's samples in seconds.
const SAMPLE_SPACING: f64 = 1e-3;

/// What a cycle needs to know beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleConfig<const N: usize> {
    /// Time between two cycles, in seconds.
    pub period: f64,
    /// Limits of the joints.
    pub limits: MotionLimits<N>,
    /// Where the tool centre point may be.
    pub workspace: WorkspaceBox,
    /// The tool until a block brings its own.
    pub flange_from_tcp: Pose,
    /// How the drives follow.
    pub servo: ServoModel<N>,
    /// Late cycles in a row that are borne; one more is a fault.
    pub overruns_in_row: u32,
}

/// What comes into a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleInput<const N: usize> {
    /// The drives' answer to the last command: joint positions.
    pub measured: Result<[f64; N], DriveFault>,
    /// Speed override, 0 … 1.
    pub speed_override: f64,
    /// What the operator wants.
    pub event: Option<Event>,
    /// A fault found outside: emergency stop, sensor, arc.
    pub fault: Option<Fault>,
    /// This cycle began late.
    pub late: bool,
}

/// The controller's state from cycle to cycle. `M` is the memory of its prefilters.
#[derive(Debug, Clone)]
pub struct Cycle<const N: usize, K, M = [PrefilterEntry<N>; 0]> {
    config: CycleConfig<N>,
    kinematics: K,
    mode: Mode,
    fault: Option<Fault>,
    /// The severest stop that the faults demand.
    stop: Option<StopCategory>,
    /// The job can go on from where the arm stands.
    on_path: bool,
    program: Program<N>,
    prefilter: JointPrefilter<N, M>,
    /// The place of the program that the arm has come to, and the rate at which it goes on.
    mark: Mark,
    rate: f64,
    halt: Option<Halt<N>>,
    observer: Observer<N>,
    envelope: Envelope<N>,
    command: JointCommand<N>,
    base_from_tcp: Pose,
    overruns: u64,
    overruns_in_row: u32,
}

impl<const N: usize, K: Kinematics<N>> Cycle<N, K> {
    /// A disabled controller whose arm stands at `position`, without prefilters.
    #[must_use]
    pub fn new(config: CycleConfig<N>, kinematics: K, position: [f64; N]) -> Self {
        Self::with_prefilter(config, kinematics, JointPrefilter::none(), position)
    }
}

impl<const N: usize, K, M> Cycle<N, K, M>
where
    K: Kinematics<N>,
    M: AsRef<[PrefilterEntry<N>]> + AsMut<[PrefilterEntry<N>]>,
{
    /// A disabled controller whose arm stands at `position`, with prefilters on its joint commands.
    #[must_use]
    pub fn with_prefilter(
        config: CycleConfig<N>,
        kinematics: K,
        mut prefilter: JointPrefilter<N, M>,
        position: [f64; N],
    ) -> Self {
        prefilter.reset(position, Mark::default());
        let CycleConfig { period, limits, workspace, flange_from_tcp, servo, .. } = config;
        // A whole number of periods, so that a recovery of the rate ends with a cycle.
        let spacing = period * crate::math::float::ceil(SAMPLE_SPACING / period - 1e-9).max(1.0);
        Self {
            config,
            mode: Mode::Disabled,
            fault: None,
            stop: None,
            on_path: false,
            program: Program::at_rest(position, flange_from_tcp, spacing),
            prefilter,
            mark: Mark::default(),
            rate: 0.0,
            halt: None,
            observer: Observer::at_rest(position, servo, period),
            envelope: Envelope::at_rest(position, limits, workspace, period),
            command: JointCommand::at_rest(position),
            base_from_tcp: kinematics.forward(&position) * flange_from_tcp,
            kinematics,
            overruns: 0,
            overruns_in_row: 0,
        }
    }

    /// The operating mode.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// One cycle: takes what was measured, gives the next command. Always answers; a fault stops the arm as its
    /// category says and stays until it is reset.
    ///
    /// Cost: two inverse kinematics with derivatives; during a change of the rate, its search in addition.
    pub fn step(
        &mut self,
        input: &CycleInput<N>,
        source: &mut impl CommandSource<N>,
        clock: &mut impl StageClock,
    ) -> CycleOutput<N> {
        let t0 = clock.now_ns();
        let refused = input.event.filter(|event| !self.apply(*event));
        self.feedback(input);
        let t1 = clock.now_ns();
        let advanced = self.target(input.speed_override, source);
        let t2 = clock.now_ns();
        let joints = advanced.and_then(|()| self.program.joints(&self.kinematics));
        let t3 = clock.now_ns();
        self.command(joints);
        let t4 = clock.now_ns();
        // A clock that jumps back must not stop the cycle: such a stage took no time.
        let stage = |from: u64, to: u64| u32::try_from(to.saturating_sub(from)).unwrap_or(u32::MAX);
        let stage_ns = [stage(t0, t1), stage(t1, t2), stage(t2, t3), stage(t3, t4)];
        self.output(refused, stage_ns)
    }

    /// Takes an event; false where it means nothing now.
    fn apply(&mut self, event: Event) -> bool {
        if event == Event::Reset && !self.is_at_rest() {
            return false;
        }
        let Some(next) = self.mode.after(event, self.on_path) else { return false };
        match (self.mode, next) {
            (Mode::Disabled, Mode::Standstill) => self.restart(),
            (Mode::Fault, Mode::Standstill | Mode::Holding) => {
                (self.fault, self.stop) = (None, None);
                self.overruns_in_row = 0;
                self.observer.restart(self.command.position);
                if next == Mode::Standstill {
                    self.restart();
                }
            }
            (Mode::Holding, Mode::Disabled) | (Mode::Running | Mode::Stopping, Mode::Standstill) => {
                self.restart()
            }
            (_, Mode::Running) => self.on_path = true,
            _ => {}
        }
        self.mode = next;
        true
    }

    /// No program; everything starts anew from where the arm was last commanded to be.
    fn restart(&mut self) {
        let position = self.command.position;
        self.halt = None;
        self.on_path = false;
        self.program.clear(position);
        (self.mark, self.rate) = (self.program.place().mark, 0.0);
        self.prefilter.reset(position, self.mark);
        self.envelope.restart(position);
        self.observer.restart(position);
    }

    /// Tier 1: drives, overruns and faults from outside.
    fn feedback(&mut self, input: &CycleInput<N>) {
        self.overruns += u64::from(input.late);
        self.overruns_in_row = if input.late { self.overruns_in_row + 1 } else { 0 };
        if self.overruns_in_row > self.config.overruns_in_row {
            self.raise(Fault::Overrun { count: self.overruns_in_row });
        }
        if let Some(fault) = input.fault {
            self.raise(fault);
        }
        match input.measured {
            Err(drive) => self.raise(Fault::Drive(drive)),
            Ok(measured) if self.mode == Mode::Disabled => {
                // Without power the arm may be moved by hand: the command follows it.
                if measured.iter().all(|q| q.is_finite()) {
                    self.command = JointCommand::at_rest(measured);
                    self.restart();
                }
            }
            Ok(measured) => {
                if let Err(fault) = self.observer.update(&self.command.position, &measured) {
                    self.raise(fault);
                }
            }
        }
    }

    /// Tier 2: programme time.
    fn target(&mut self, speed_override: f64, source: &mut impl CommandSource<N>) -> Result<(), Fault> {
        if self.halt.is_some() || !self.on_path {
            return Ok(());
        }
        // A wrong override is none: NaN stops.
        let speed_override = if speed_override.is_finite() { speed_override.clamp(0.0, 1.0) } else { 0.0 };
        let goal = if self.mode == Mode::Running { speed_override } else { 0.0 };
        let MotionLimits { acceleration, jerk, .. } = self.config.limits;
        let limits = RateLimits { acceleration, jerk };
        let arm = match (self.prefilter.is_none(), self.prefilter.is_drained()) {
            (true, _) => Arm::AtOnce,
            (false, true) => Arm::Arrived,
            (false, false) => Arm::Behind,
        };
        self.program.advance(goal, source, &self.kinematics, &limits, self.config.period, arm)
    }

    /// Tier 4, after the joints of tier 3: the command, if the envelope lets it pass; otherwise a halt.
    fn command(&mut self, joints: Result<JointJet<N>, Fault>) {
        if self.mode == Mode::Disabled || self.stop == Some(StopCategory::Category0) {
            self.command = JointCommand::at_rest(self.command.position);
            return;
        }
        if self.halt.is_none() {
            let command = joints.map(|jet| self.shaped(&jet)).and_then(|command| {
                let tcp = self.kinematics.forward(&command.position) * self.program.place().flange_from_tcp;
                self.envelope.judge(&command.position, &tcp.translation.vector).map(|()| (command, tcp))
            });
            match command {
                Ok((command, tcp)) => {
                    self.accept(command, tcp);
                    return self.after_motion();
                }
                Err(fault) => self.raise(fault),
            }
        }
        let Some(halt) = &mut self.halt else { return };
        let command = halt.step(self.config.period);
        let tcp = self.kinematics.forward(&command.position) * self.program.place().flange_from_tcp;
        self.accept(command, tcp);
    }

    fn accept(&mut self, command: JointCommand<N>, tcp: Pose) {
        self.envelope.accept(command.position);
        self.command = command;
        self.base_from_tcp = tcp;
    }

    /// The command in real time, as the prefilters let it through.
    fn shaped(&mut self, jet: &JointJet<N>) -> JointCommand<N> {
        let command = self.in_time(jet);
        let (way, since) = self.program.way();
        let (mark, rate) = (self.program.place().mark, self.program.rate().value());
        let shaped = self.prefilter.update(&command, &Progress { mark, since, way, rate });
        (self.mark, self.rate) = (shaped.mark, shaped.rate);
        shaped.command
    }

    /// Joint motion in real time: programme time runs at the rate.
    fn in_time(&self, jet: &JointJet<N>) -> JointCommand<N> {
        let (r, c) = (self.program.rate().value(), self.program.rate().slope());
        let mut command = JointCommand::at_rest(jet.position);
        for axis in 0..N {
            command.velocity[axis] = jet.velocity[axis] * r;
            command.acceleration[axis] = jet.acceleration[axis] * r * r + jet.velocity[axis] * c;
        }
        command
    }

    /// Events that the motion itself causes.
    fn after_motion(&mut self) {
        match self.mode {
            Mode::Running if self.program.place().ended => self.apply(Event::JobDone),
            Mode::Stopping if self.is_at_rest() => self.apply(Event::AtRest),
            _ => false,
        };
    }

    /// Latches a fault; the first one stays, the severest stop counts.
    fn raise(&mut self, fault: Fault) {
        if self.mode == Mode::Disabled {
            return;
        }
        let category = fault.category();
        self.fault = self.fault.or(Some(fault));
        self.stop = self.stop.max(Some(category));
        self.mode = Mode::Fault;
        if category != StopCategory::Category2 {
            self.on_path = false;
        }
        if category == StopCategory::Category1 && self.halt.is_none() {
            self.halt = Some(Halt::new(&self.command, &self.config.limits));
        }
    }

    fn is_at_rest(&self) -> bool {
        match &self.halt {
            Some(halt) => halt.is_done(),
            None => !self.on_path || self.program.is_at_rest() && self.prefilter.is_drained(),
        }
    }

    fn output(&self, refused: Option<Event>, stage_ns: [u32; 4]) -> CycleOutput<N> {
        let Mark { line, segment, marker, arc } = self.mark;
        let moving = self.mode == Mode::Running;
        let cut = match self.stop {
            Some(StopCategory::Category0) => true,
            Some(StopCategory::Category1) => self.is_at_rest(),
            Some(StopCategory::Category2) | None => false,
        };
        let estimated = *self.observer.estimated();
        let status = Status {
            mode: self.mode,
            fault: self.fault,
            refused,
            line,
            segment,
            marker,
            rate: self.rate,
            at_rest: self.is_at_rest(),
            base_from_tcp: self.base_from_tcp,
            estimated,
            measured_base_from_tcp: self.kinematics.forward(&estimated)
                * self.program.place().flange_from_tcp,
            overruns: self.overruns,
            stage_ns,
        };
        let power = self.mode != Mode::Disabled && !cut;
        CycleOutput { command: self.command, power, arc: arc && moving, status }
    }
}
