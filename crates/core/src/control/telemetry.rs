//! What the cycle says about itself.

use super::mode::{Event, Mode};
use super::seam::SeamStatus;
use crate::arc::ArcCommand;
use crate::drive::JointCommand;
use crate::geometry::Pose;
use crate::safety::Fault;

/// A clock for measuring the stages. The core has none of its own.
pub trait StageClock {
    /// A running time in nanoseconds.
    fn now_ns(&mut self) -> u64;
}

/// No measurement: every stage takes zero.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoClock;

impl StageClock for NoClock {
    fn now_ns(&mut self) -> u64 {
        0
    }
}

/// The four tiers, in their order.
pub const STAGES: [&str; 4] = ["feedback", "target", "kinematics", "safety"];

/// What one cycle gives out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleOutput<const N: usize> {
    /// For the drives.
    pub command: JointCommand<N>,
    /// The drives may be powered. False when disabled and after a stop of category 0 or 1.
    pub power: bool,
    /// For the power source.
    pub arc: ArcCommand,
    /// Where the controller is.
    pub status: Status<N>,
}

/// The controller's state after a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Status<const N: usize> {
    /// Operating mode.
    pub mode: Mode,
    /// The latched fault.
    pub fault: Option<Fault>,
    /// An event of this cycle that meant nothing in its mode.
    pub refused: Option<Event>,
    /// Line of the job. This, the segment and the marker are where the arm is, behind a prefilter as well.
    pub line: u32,
    /// Running number of the segment.
    pub segment: u32,
    /// The last marker passed; 0 before the first.
    pub marker: u32,
    /// Rate of programme time, 0 … 1, as the prefilters let it through: what the arm's speed has in it.
    pub rate: f64,
    /// Nothing moves, and nothing is left in a prefilter.
    pub at_rest: bool,
    /// Commanded tool centre point in the base frame.
    pub base_from_tcp: Pose,
    /// Filtered measured joint positions.
    pub estimated: [f64; N],
    /// Tool centre point at the filtered measured joints.
    pub measured_base_from_tcp: Pose,
    /// Where a seam is tracked. It is where the program is: ahead of the arm, with a prefilter.
    pub seam: Option<SeamStatus>,
    /// Late cycles so far.
    pub overruns: u64,
    /// Time each of the [`STAGES`] took, in nanoseconds.
    pub stage_ns: [u32; 4],
}
