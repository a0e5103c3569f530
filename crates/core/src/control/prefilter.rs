//! The prefilters between kinematics and safety: joint commands that do not make the arm ring.

use super::trail::{Mark, Trail};
use crate::drive::JointCommand;
use crate::vibration::{Kernel, PrefilterStage, Signal, StageEntry, StageError};

/// Most flexible modes, each with a stage of its own.
pub const MODES_MAX: usize = 3;

/// One cycle in the memory of a joint prefilter's stage.
pub type PrefilterEntry<const N: usize> = StageEntry<JointSignal<N>>;

/// What goes through the prefilters together.
///
/// Velocity and acceleration take the same weights as the position, and are therefore the derivatives of what comes out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointSignal<const N: usize> {
    position: [f64; N],
    velocity: [f64; N],
    acceleration: [f64; N],
    /// Path that runs on with real time.
    course: f64,
    /// Way of the tool along its paths since the program's start.
    tool_way: f64,
    /// Rate of programme time.
    rate: f64,
}

impl<const N: usize> Signal for JointSignal<N> {
    const ZERO: Self = Self {
        position: [0.0; N],
        velocity: [0.0; N],
        acceleration: [0.0; N],
        course: 0.0,
        tool_way: 0.0,
        rate: 0.0,
    };

    #[inline]
    fn add(&mut self, share: f64, other: &Self) {
        self.position.add(share, &other.position);
        self.velocity.add(share, &other.velocity);
        self.acceleration.add(share, &other.acceleration);
        self.course += share * other.course;
        self.tool_way += share * other.tool_way;
        self.rate += share * other.rate;
    }
}

/// Prefilters on joint commands, one stage a flexible mode.
///
/// | | |
/// |---|---|
/// | gain | 1 at zero frequency: the arm comes to rest where the program does |
/// | delay | the sum of the kernels' delays at a constant rate; of their lengths until the last of it has come out |
/// | limits | joint position, velocity, acceleration and jerk that hold before hold after: means with positive weights |
/// | path | left where it is curved in the joints, by ½ σ² · \|q″\| · ṡ² at most; see `docs/vibration.md` |
///
/// `M` is the memory of one stage; [`stage_entries`](crate::vibration::stage_entries) says how much it needs.
#[derive(Debug, Clone)]
pub struct JointPrefilter<const N: usize, M> {
    stages: [Option<PrefilterStage<JointSignal<N>, M>>; MODES_MAX],
    trail: Trail,
}

/// What comes out of the prefilters in a cycle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shaped<const N: usize> {
    pub(super) command: JointCommand<N>,
    /// The place of the program that the arm has come to, the way of the tool up to there, and the rate at which it goes on.
    pub(super) mark: Mark,
    pub(super) tool_way: f64,
    pub(super) rate: f64,
}

/// Where the program is in a cycle.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Progress {
    pub(super) mark: Mark,
    /// Course at which the mark was set, and now.
    pub(super) since: f64,
    pub(super) course: f64,
    pub(super) tool_way: f64,
    pub(super) rate: f64,
}

impl<const N: usize, M> JointPrefilter<N, M> {
    /// None: the commands stay as they are.
    #[must_use]
    pub fn none() -> Self {
        Self { stages: [const { None }; MODES_MAX], trail: Trail::at(Mark::default()) }
    }
}

impl<const N: usize, M: AsRef<[PrefilterEntry<N>]> + AsMut<[PrefilterEntry<N>]>> JointPrefilter<N, M> {
    /// Stages with these kernels and memories, one after the other, for commands every `period` seconds. Those beyond [`MODES_MAX`] are
    /// left out.
    ///
    /// # Errors
    /// The first stage that there cannot be.
    pub fn try_new(stages: impl IntoIterator<Item = (Kernel, M)>, period: f64) -> Result<Self, StageError> {
        let mut prefilter = Self::none();
        for (slot, (kernel, memory)) in prefilter.stages.iter_mut().zip(stages) {
            *slot = Some(PrefilterStage::try_new(memory, &kernel, period, &JointSignal::ZERO)?);
        }
        Ok(prefilter)
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
        let Progress { mark, course, tool_way, rate, .. } = *progress;
        let signal = JointSignal { position, course, tool_way, rate, ..JointSignal::ZERO };
        self.stages.iter_mut().flatten().for_each(|stage| stage.reset(&signal));
        self.trail.reset(mark);
    }

    /// One cycle.
    pub(super) fn update(&mut self, command: &JointCommand<N>, progress: &Progress) -> Shaped<N> {
        let Progress { mark, since, course, tool_way, rate } = *progress;
        if self.is_none() {
            return Shaped { command: *command, mark, tool_way, rate };
        }
        let JointCommand { position, velocity, acceleration } = *command;
        let mut signal = JointSignal { position, velocity, acceleration, course, tool_way, rate };
        for stage in self.stages.iter_mut().flatten() {
            signal = stage.update(&signal);
        }
        let JointSignal { position, velocity, acceleration, course, tool_way, rate } = signal;
        let command = JointCommand { position, velocity, acceleration };
        Shaped { command, mark: self.trail.pass(mark, since, course), tool_way, rate }
    }
}
