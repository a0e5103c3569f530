//! What a run leaves behind: the recording of every cycle, the figures of the run, and the data of its plots.

mod info;
mod sample;

pub use info::{Acceptance, Event, EventKind, JointInfo, RunInfo, SegmentInfo, SegmentKind};
pub use sample::{MAX_JOINTS, RunMode, Sample};
