//! What a run leaves behind: the recording of every cycle, the figures of the run, and the data of its plots.
//!
//! The cycle pushes one [`Sample`] a cycle into a ring ([`SampleSender`]), which neither waits nor allocates. A thread
//! ([`Recorder`]) takes them out, writes `recording.csv` and hands them to an [`Analysis`]. That is a plain struct,
//! which takes a [`Recording`] that is read back just as well. [`Summary`] holds its figures against their bounds.

mod atomic;
mod csv;
mod envelope;
mod figures;
mod info;
pub(crate) mod number;
mod plot;
mod recorder;
mod recording;
mod sample;
mod summary;
mod table;
#[cfg(test)]
mod testing;
mod times;

pub use atomic::write_whole;
pub use envelope::{TRACE_POINTS, Trace};
pub use figures::{Analysis, Findings, JointFigures, MoveFigures, Peak, SeamFigures, Travel};
pub use info::{Acceptance, Event, EventKind, JointInfo, OnSeam, RunInfo, SegmentInfo, SegmentKind};
pub use plot::{JointTraces, PathPoint, PlotData};
pub use recorder::{Recorder, SampleSender};
pub use recording::{Recording, RecordingError};
pub use sample::{MAX_JOINTS, Sample};
pub use summary::{Check, Incident, Outcome, Summary, Verdict};
pub use table::rounded;
pub use times::{TimeFigures, TimeHistogram};
