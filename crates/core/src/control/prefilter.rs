//! The prefilters between kinematics and safety: joint commands, or a feedrate, that do not make the arm ring.

use super::trail::{Mark, Trail};
use crate::drive::JointCommand;
use crate::vibration::{Kernel, PrefilterStage, Signal, StageEntry, StageError};

/// Most flexible modes, each with a stage of its own.
pub const MODES_MAX: usize = 3;

/// One cycle in the memory of a prefilter's stage.
pub type PrefilterEntry<const N: usize> = StageEntry<CommandSignal<N>>;

/// What goes through the prefilters together.
///
/// Velocity and acceleration take the same weights as the position, and are therefore the derivatives of what comes out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommandSignal<const N: usize> {
    position: [f64; N],
    velocity: [f64; N],
    acceleration: [f64; N],
    /// Path that runs on with real time, its velocity and acceleration.
    course: [f64; 3],
    /// Way of the tool along its paths since the program's start.
    tool_way: f64,
    /// Rate of programme time that is told.
    rate: f64,
    /// What has gone of differences that fade, with two derivatives.
    gone: [f64; 3],
}

impl<const N: usize> Signal for CommandSignal<N> {
    const ZERO: Self = Self {
        position: [0.0; N],
        velocity: [0.0; N],
        acceleration: [0.0; N],
        course: [0.0; 3],
        tool_way: 0.0,
        rate: 0.0,
        gone: [0.0; 3],
    };

    #[inline]
    fn add(&mut self, share: f64, other: &Self) {
        self.position.add(share, &other.position);
        self.velocity.add(share, &other.velocity);
        self.acceleration.add(share, &other.acceleration);
        self.course.add(share, &other.course);
        self.tool_way += share * other.tool_way;
        self.rate += share * other.rate;
        self.gone.add(share, &other.gone);
    }
}

/// Prefilters on joint commands or on the feedrate ([`ActsOn`]), one stage a flexible mode.
///
/// | | |
/// |---|---|
/// | gain | 1 at zero frequency: the arm comes to rest where the program does |
/// | delay | the sum of the kernels' delays at a constant rate; of their lengths until the last of it has come out |
/// | limits | on joint commands: position, velocity, acceleration and jerk that hold before hold after: means with positive weights |
/// | path | on joint commands: left where it is curved in the joints, by ½ σ² · \|q″\| · ṡ² at most; see `docs/vibration.md` |
///
/// `M` is the memory of one stage; [`stage_entries`](crate::vibration::stage_entries) says how much it needs.
#[derive(Debug, Clone)]
pub struct CommandPrefilter<const N: usize, M> {
    stages: [Option<PrefilterStage<CommandSignal<N>, M>>; MODES_MAX],
    acts_on: ActsOn,
    trail: Trail,
}

/// What prefilters act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ActsOn {
    /// The joint commands: they keep all joint limits by themselves, and leave paths that are curved in the joints.
    #[default]
    Joints,
    /// The feedrate: the tool stays on its path. That joint limits hold then is the planner's task: what a block permits along its path
    /// must suit every place that the tool is at while the program is in the block. A move of the joints is as on the joint commands.
    Feedrate,
}

/// What comes out of the prefilters in a cycle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shaped<const N: usize> {
    pub(super) command: JointCommand<N>,
    /// How far the course has come, and what has gone of differences that fade, with their first two derivatives.
    pub(super) course: [f64; 3],
    pub(super) gone: [f64; 3],
    /// The place of the program that the arm has come to, the way of the tool up to there, and the rate at which it goes on.
    pub(super) mark: Mark,
    pub(super) tool_way: f64,
    pub(super) rate: f64,
}

/// Where the program is in a cycle.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Progress {
    pub(super) mark: Mark,
    /// Course at which the mark was set, and now, with its velocity and acceleration.
    pub(super) since: f64,
    pub(super) course: [f64; 3],
    pub(super) tool_way: f64,
    pub(super) rate: f64,
    /// What has gone of differences that fade, with two derivatives ([`super::program::Program::gone`]).
    pub(super) gone: [f64; 3],
}

impl<const N: usize, M> CommandPrefilter<N, M> {
    /// None: the commands stay as they are.
    #[must_use]
    pub fn none() -> Self {
        let trail = Trail::at(Mark::default());
        Self { stages: [const { None }; MODES_MAX], acts_on: ActsOn::Joints, trail }
    }
}

impl<const N: usize, M: AsRef<[PrefilterEntry<N>]> + AsMut<[PrefilterEntry<N>]>> CommandPrefilter<N, M> {
    /// Stages with these kernels and memories, one after the other, for commands every `period` seconds. Those beyond [`MODES_MAX`] are
    /// left out.
    ///
    /// # Errors
    /// The first stage that there cannot be.
    pub fn try_new(stages: impl IntoIterator<Item = (Kernel, M)>, period: f64) -> Result<Self, StageError> {
        let mut prefilter = Self::none();
        for (slot, (kernel, memory)) in prefilter.stages.iter_mut().zip(stages) {
            *slot = Some(PrefilterStage::try_new(memory, &kernel, period, &CommandSignal::ZERO)?);
        }
        Ok(prefilter)
    }

    /// The same on something else.
    #[must_use]
    pub fn acting_on(self, acts_on: ActsOn) -> Self {
        Self { acts_on, ..self }
    }

    /// What they act on; `None` where there are none.
    pub(super) fn acts_on(&self) -> Option<ActsOn> {
        (!self.is_none()).then_some(self.acts_on)
    }

    /// Nothing is held back.
    pub(super) fn is_none(&self) -> bool {
        self.stages.iter().all(Option::is_none)
    }

    /// All that went in has come out.
    pub(super) fn is_drained(&self) -> bool {
        self.stages.iter().flatten().all(PrefilterStage::is_drained)
    }

    /// At rest at a position, where the program is.
    pub(super) fn reset(&mut self, position: [f64; N], progress: &Progress) {
        let Progress { mark, course, tool_way, rate, gone, .. } = *progress;
        let [course, gone] = [course, gone].map(|of| [of[0], 0.0, 0.0]);
        let signal = CommandSignal { position, course, tool_way, rate, gone, ..CommandSignal::ZERO };
        self.stages.iter_mut().flatten().for_each(|stage| stage.reset(&signal));
        self.trail.reset(mark);
    }

    /// One cycle.
    pub(super) fn update(&mut self, command: &JointCommand<N>, progress: &Progress) -> Shaped<N> {
        let Progress { mark, since, course, tool_way, rate, gone } = *progress;
        if self.is_none() {
            return Shaped { command: *command, course, gone, mark, tool_way, rate };
        }
        let JointCommand { position, velocity, acceleration } = *command;
        let mut signal = CommandSignal { position, velocity, acceleration, course, tool_way, rate, gone };
        for stage in self.stages.iter_mut().flatten() {
            signal = stage.update(&signal);
        }
        let CommandSignal { position, velocity, acceleration, course, tool_way, rate, gone } = signal;
        let command = JointCommand { position, velocity, acceleration };
        Shaped { command, course, gone, mark: self.trail.pass(mark, since, course[0]), tool_way, rate }
    }
}
