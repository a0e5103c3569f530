//! The cycle: four tiers from the measured joints to the next command, with the prefilters between the third and the fourth.

use super::arc::{Arc, ArcRules};
use super::feedback::{Observer, ServoModel};
use super::instant::joints_of;
use super::mode::{Event, Mode};
use super::off_path::OffPath;
use super::prefilter::{ActsOn, CommandPrefilter, PrefilterEntry, Progress};
use super::program::{Arm, CommandSource, Follows, Program};
use super::rails::{OnRails, RAIL_MOVES};
use super::rate::RateLimits;
use super::resume::Resume;
use super::telemetry::{CycleOutput, StageClock, Status};
use super::trail::Mark;
use crate::arc::ArcCommand;
use crate::drive::{DriveFault, JointCommand};
use crate::geometry::Pose;
use crate::kinematics::{JointJet, Kinematics};
use crate::safety::{Envelope, Fault, MotionLimits, StopCategory, WorkspaceBox};
use crate::seam::{LaneMemory, SeamSensor};

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
    /// How the arc is handled.
    pub arc: ArcRules,
}

/// What comes into a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleInput<const N: usize> {
    /// The drives' answer to the last command: joint positions.
    pub measured: Result<[f64; N], DriveFault>,
    /// Speed override, 0 … 1.
    pub speed_override: f64,
    /// What the operator wants; what only the cycle itself may cause is refused.
    pub event: Option<Event>,
    /// A fault found outside: emergency stop, sensor, arc.
    pub fault: Option<Fault>,
    /// This cycle began late.
    pub late: bool,
    /// Whether the arc burns, as the power source says ([`crate::arc::ArcSource`]).
    pub arc_burning: Option<bool>,
}

/// The controller's state from cycle to cycle. `M` is the memory of its prefilters.
#[derive(Debug, Clone)]
pub struct Cycle<const N: usize, K, M = [PrefilterEntry<N>; 0]> {
    pub(super) config: CycleConfig<N>,
    pub(super) kinematics: K,
    pub(super) mode: Mode,
    fault: Option<Fault>,
    /// The severest stop that the faults demand.
    stop: Option<StopCategory>,
    /// There is a job that has begun and can go on.
    job: bool,
    /// The arm stands or moves on the job's path.
    pub(super) on_path: bool,
    pub(super) program: Program<N>,
    prefilter: CommandPrefilter<N, M>,
    /// The place of the program that the arm has come to, the way of the tool up to there, and the rate at which it goes on.
    mark: Mark,
    tool_way: f64,
    rate: f64,
    pub(super) off_path: Option<OffPath<N>>,
    /// Where the resumption stands, in [`Mode::Resuming`].
    pub(super) resume: Resume,
    pub(super) arc: Arc,
    /// Way of the tool at which the arc was last seen to burn.
    pub(super) bead_end: f64,
    observer: Observer<N>,
    envelope: Envelope<N>,
    pub(super) command: JointCommand<N>,
    base_from_tcp: Pose,
    /// The joints as last measured.
    measured: [f64; N],
    /// Cycles so far: the clock that a seam sensor's readings are on.
    cycles: u64,
    overruns: u64,
    overruns_in_row: u32,
}

impl<const N: usize, K: Kinematics<N>> Cycle<N, K> {
    /// A disabled controller whose arm stands at `position`, without prefilters.
    #[must_use]
    pub fn new(config: CycleConfig<N>, kinematics: K, position: [f64; N]) -> Self {
        Self::with_prefilter(config, kinematics, CommandPrefilter::none(), position)
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
        mut prefilter: CommandPrefilter<N, M>,
        position: [f64; N],
    ) -> Self {
        let CycleConfig { period, limits, workspace, flange_from_tcp, servo, .. } = config;
        prefilter.reset(position, &Progress::default());
        // A whole number of periods, so that a recovery of the rate ends with a cycle.
        let spacing = period * crate::math::float::ceil(SAMPLE_SPACING / period - 1e-9).max(1.0);
        Self {
            config,
            mode: Mode::Disabled,
            fault: None,
            stop: None,
            job: false,
            on_path: false,
            program: Program::at_rest(position, flange_from_tcp, spacing),
            prefilter,
            mark: Mark::default(),
            tool_way: 0.0,
            rate: 0.0,
            off_path: None,
            resume: Resume::Settle,
            arc: Arc::Out,
            bead_end: 0.0,
            observer: Observer::at_rest(position, servo, period),
            envelope: Envelope::at_rest(position, limits, workspace, period),
            command: JointCommand::at_rest(position),
            base_from_tcp: kinematics.forward(&position) * flange_from_tcp,
            kinematics,
            measured: position,
            cycles: 0,
            overruns: 0,
            overruns_in_row: 0,
        }
    }

    /// The operating mode.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The memory of passes: what was recorded, and stays over the ends of jobs.
    #[must_use]
    pub fn memory(&self) -> &LaneMemory {
        self.program.guide.memory()
    }

    /// The memory of passes, for records of earlier runs: before a job that is to find them.
    pub fn memory_mut(&mut self) -> &mut LaneMemory {
        self.program.guide.memory_mut()
    }

    /// One cycle: takes what was measured, gives the next command. Always answers; a fault stops the arm as its
    /// category says and stays until it is reset.
    ///
    /// The seam sensor is asked where a seam is tracked, before the command is made: what has arrived counts in this cycle. Its clock counts the
    /// cycles from the first.
    ///
    /// Cost: two inverse kinematics with derivatives; during a change of the rate, and on a tracked seam, its search in addition.
    pub fn step(
        &mut self,
        input: &CycleInput<N>,
        source: &mut impl CommandSource<N>,
        sensor: &mut impl SeamSensor,
        clock: &mut impl StageClock,
    ) -> CycleOutput<N> {
        let t0 = clock.now_ns();
        let refused = input.event.filter(|event| !(event.is_operators() && self.apply(*event)));
        self.feedback(input);
        self.sense(sensor);
        let t1 = clock.now_ns();
        let advanced = self.target(input.speed_override, source);
        let t2 = clock.now_ns();
        let joints = advanced.and_then(|()| self.program.joints(&self.kinematics));
        let t3 = clock.now_ns();
        self.command(joints);
        self.arc(input.arc_burning);
        let t4 = clock.now_ns();
        // A clock that jumps back must not stop the cycle: such a stage took no time.
        let stage = |from: u64, to: u64| u32::try_from(to.saturating_sub(from)).unwrap_or(u32::MAX);
        let stage_ns = [stage(t0, t1), stage(t1, t2), stage(t2, t3), stage(t3, t4)];
        self.output(refused, stage_ns)
    }

    /// Takes an event; false where it means nothing now.
    pub(super) fn apply(&mut self, event: Event) -> bool {
        let refused = match event {
            Event::Reset | Event::Disable => !self.is_at_rest(),
            // A stop off the path is carried out first; backing needs the path.
            Event::Resume | Event::BackUp if !self.on_path => event == Event::BackUp || !self.is_at_rest(),
            _ => false,
        };
        if refused {
            return false;
        }
        let Some(next) = self.mode.after(event, self.job) else { return false };
        match (self.mode, next) {
            (Mode::Disabled, Mode::Standstill) => self.restart(),
            (Mode::Fault, Mode::Standstill | Mode::Holding) => self.reset(next),
            (Mode::Holding, Mode::Disabled) | (Mode::Running | Mode::Stopping, Mode::Standstill) => {
                self.restart()
            }
            (Mode::Standstill, Mode::Running) => (self.job, self.on_path) = (true, true),
            (Mode::Holding, Mode::Resuming) => self.begin_to_resume(),
            (Mode::Holding, Mode::Backing) => self.resume = Resume::Settle,
            (Mode::Resuming, Mode::Holding | Mode::Stopping) if self.off_path.is_some() => {
                self.off_path = Some(OffPath::stop(&self.command, &self.config.limits));
            }
            _ => {}
        }
        self.mode = next;
        true
    }

    /// A fault is acknowledged.
    fn reset(&mut self, next: Mode) {
        if self.stop == Some(StopCategory::Category0) {
            // Without power the arm may have moved: the command goes on from where it is.
            self.command = JointCommand::at_rest(self.measured);
            self.envelope.restart(self.command.position);
        }
        (self.fault, self.stop) = (None, None);
        self.overruns_in_row = 0;
        self.observer.restart(self.command.position);
        if next == Mode::Standstill {
            self.restart();
        }
    }

    /// No program; everything starts anew from where the arm was last commanded to be.
    fn restart(&mut self) {
        let position = self.command.position;
        self.off_path = None;
        (self.job, self.on_path) = (false, false);
        self.program.clear(position);
        self.bead_end = 0.0;
        self.meet_program(position);
        self.envelope.restart(position);
        self.observer.restart(position);
    }

    /// The arm is at rest where the program is.
    fn meet_program(&mut self, position: [f64; N]) {
        let progress = self.progress();
        let Progress { mark, tool_way, rate, .. } = progress;
        (self.mark, self.tool_way, self.rate) = (mark, tool_way, rate);
        self.prefilter.reset(position, &progress);
    }

    /// The power source: struck where the program wants an arc and the arm is where it belongs.
    fn arc(&mut self, burning: Option<bool>) {
        let here = match self.mode {
            Mode::Running => true,
            Mode::Resuming => self.resume.wants_arc(),
            _ => false,
        };
        let wanted = here && self.mark.arc;
        if let Err(fault) = self.arc.step(wanted, burning, &self.config.arc, self.config.period) {
            self.raise(fault);
        }
        if self.arc.is_seen() {
            self.bead_end = self.bead_end.max(self.tool_way);
        }
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
                if measured.iter().all(|q| q.is_finite()) {
                    self.measured = measured;
                }
                if let Err(fault) = self.observer.update(&self.command.position, &measured) {
                    self.raise(fault);
                }
            }
        }
    }

    /// Tier 2: programme time.
    fn target(&mut self, speed_override: f64, source: &mut impl CommandSource<N>) -> Result<(), Fault> {
        match self.mode {
            Mode::Resuming => self.resume()?,
            Mode::Backing => self.settle_to_back(),
            _ => {}
        }
        if self.off_path.is_some() || !self.on_path {
            return Ok(());
        }
        let speed = self.speed(speed_override);
        match self.mode {
            Mode::Running => self.advance(speed, source),
            Mode::Backing if self.resume == Resume::Back => self.back_up(speed),
            Mode::Resuming if self.resume == Resume::Back => self.back_along_the_bead(speed),
            _ if self.program.runs_backward() => self.retreat(0.0),
            _ => self.advance(0.0, source),
        }
    }

    /// The rate that is asked for: 0 … 1.
    fn speed(&self, speed_override: f64) -> f64 {
        if self.config.arc.lock_override && self.arc.burns() {
            1.0
        } else if speed_override.is_finite() {
            speed_override.clamp(0.0, 1.0)
        } else {
            // A wrong override is none.
            0.0
        }
    }

    fn rate_limits(&self) -> RateLimits<N> {
        let MotionLimits { velocity, acceleration, jerk, .. } = self.config.limits;
        RateLimits { velocity, acceleration, jerk }
    }

    /// Where a seam is tracked, its sensor.
    fn sense(&mut self, sensor: &mut impl SeamSensor) {
        let time = self.cycles as f64 * self.config.period;
        self.cycles += 1;
        if !self.program.guide.is_on() {
            return;
        }
        let tcp = self.kinematics.forward(&self.measured) * self.program.place().flange_from_tcp;
        self.program.sense(time, tcp, sensor);
        if let (Mode::Running, Some(fault)) = (self.mode, self.program.guide.lost()) {
            self.raise(fault);
        }
    }

    fn advance(&mut self, goal: f64, source: &mut impl CommandSource<N>) -> Result<(), Fault> {
        let (limits, period) = (self.rate_limits(), self.config.period);
        let arm = self.arm(self.arc.burns());
        self.program.advance(goal, source, &self.kinematics, &limits, period, arm)
    }

    pub(super) fn retreat(&mut self, goal: f64) -> Result<(), Fault> {
        let (limits, arm) = (self.rate_limits(), self.arm(false));
        self.program.retreat(goal, &self.kinematics, &limits, self.config.period, arm)
    }

    /// How the arm follows the program.
    fn arm(&self, arc_burns: bool) -> Arm {
        let motion = match (self.prefilter.is_none(), self.prefilter.is_drained()) {
            (true, _) => Follows::AtOnce,
            (false, true) => Follows::Arrived,
            (false, false) => Follows::Behind,
        };
        Arm { motion, arc_burns }
    }

    /// Programme time runs backward from here on, or forward again.
    pub(super) fn turn(&mut self, backward: bool) {
        self.program.turn(backward);
        self.meet_program(self.command.position);
    }

    /// The arm is back where the program is, after a way off the path.
    pub(super) fn come_back(&mut self) {
        (self.off_path, self.on_path) = (None, true);
        self.meet_program(self.command.position);
    }

    /// Tier 4, after the joints of tier 3: the command, if the envelope lets it pass; otherwise a stop off the path.
    fn command(&mut self, joints: Result<JointJet<N>, Fault>) {
        if self.mode == Mode::Disabled || self.stop == Some(StopCategory::Category0) {
            self.command = JointCommand::at_rest(self.command.position);
            return;
        }
        let wanted = match &mut self.off_path {
            None if self.on_path => joints.and_then(|jet| self.shaped(&jet)),
            None => Ok(JointCommand::at_rest(self.command.position)),
            Some(way) => Ok(way.step(self.config.period)),
        };
        let stops = self.off_path.is_some_and(|way| !way.returns());
        let judged = wanted.and_then(|command| {
            let tcp = self.kinematics.forward(&command.position) * self.program.place().flange_from_tcp;
            // A stop is the last resort.
            let last = || {
                let tcp =
                    self.kinematics.forward(self.envelope.last()) * self.program.place().flange_from_tcp;
                tcp.translation.vector
            };
            let judged = self.envelope.judge(&command.position, &tcp.translation.vector, last);
            if stops { Ok((command, tcp)) } else { judged.map(|()| (command, tcp)) }
        });
        match judged {
            Ok((command, tcp)) => self.accept(command, tcp),
            Err(fault) => {
                self.raise(fault);
                let Some(stop) = &mut self.off_path else { return };
                let command = stop.step(self.config.period);
                let tcp = self.kinematics.forward(&command.position) * self.program.place().flange_from_tcp;
                self.accept(command, tcp);
            }
        }
        self.after_motion();
    }

    fn accept(&mut self, command: JointCommand<N>, tcp: Pose) {
        self.envelope.accept(command.position);
        self.command = command;
        self.base_from_tcp = tcp;
    }

    /// The command in real time, as the prefilters let it through.
    fn shaped(&mut self, jet: &JointJet<N>) -> Result<JointCommand<N>, Fault> {
        let command = in_time(jet, self.program.time_rate());
        let shaped = self.prefilter.update(&command, &self.progress());
        (self.mark, self.tool_way, self.rate) = (shaped.mark, shaped.tool_way, shaped.rate);
        if self.prefilter.acts_on() != Some(ActsOn::Feedrate) {
            return Ok(shaped.command);
        }
        match self.program.on_course(shaped.course) {
            OnRails::Joints => Ok(shaped.command),
            OnRails::Path(flange) => {
                let JointJet { position, velocity, acceleration, .. } =
                    joints_of(&flange, &self.command.position, &self.kinematics)?;
                let mut command = JointCommand { position, velocity, acceleration };
                if let Some(aside) = self.program.aside(shaped.course[0], shaped.gone) {
                    add(&mut command, &aside);
                }
                Ok(command)
            }
            OnRails::Forgotten => Err(Fault::PathForgotten { moves: RAIL_MOVES }),
        }
    }

    /// Where the program is.
    fn progress(&self) -> Progress {
        let (course, since) = self.program.course();
        let (mark, rate) = (self.program.place().mark, self.program.shown_rate());
        let gone = self.program.gone();
        Progress { mark, since, course, tool_way: self.program.way().tool, rate, gone }
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
            self.program.stand_still();
            self.rate = 0.0;
        }
        let stopping = self.off_path.is_some_and(|way| !way.returns());
        let leaves = category == StopCategory::Category1 || self.off_path.is_some();
        if category == StopCategory::Category0 {
            // The drives are gone: nothing is left to carry out.
            self.off_path = None;
        } else if leaves && !stopping && self.stop != Some(StopCategory::Category0) {
            self.off_path = Some(OffPath::stop(&self.command, &self.config.limits));
        }
    }

    pub(super) fn is_at_rest(&self) -> bool {
        match &self.off_path {
            Some(way) => way.is_done(),
            None => !self.on_path || self.program.is_at_rest() && self.prefilter.is_drained(),
        }
    }

    fn output(&self, refused: Option<Event>, stage_ns: [u32; 4]) -> CycleOutput<N> {
        let Mark { line, segment, marker, setting, .. } = self.mark;
        let welds = matches!(self.mode, Mode::Running | Mode::Resuming) && !self.config.arc.dry;
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
            seam: self.program.seam_status(),
            overruns: self.overruns,
            stage_ns,
        };
        let arc = ArcCommand { on: welds && self.arc.has_current(), setting };
        let power = self.mode != Mode::Disabled && !cut;
        CycleOutput { command: self.command, power, arc, status }
    }
}

/// Joint motion in real time: programme time runs at a rate with its derivative.
fn in_time<const N: usize>(jet: &JointJet<N>, (rate, slope): (f64, f64)) -> JointCommand<N> {
    let mut command = JointCommand::at_rest(jet.position);
    for axis in 0..N {
        command.velocity[axis] = jet.velocity[axis] * rate;
        command.acceleration[axis] = jet.acceleration[axis] * rate * rate + jet.velocity[axis] * slope;
    }
    command
}

fn add<const N: usize>(command: &mut JointCommand<N>, other: &JointCommand<N>) {
    for axis in 0..N {
        command.position[axis] += other.position[axis];
        command.velocity[axis] += other.velocity[axis];
        command.acceleration[axis] += other.acceleration[axis];
    }
}
