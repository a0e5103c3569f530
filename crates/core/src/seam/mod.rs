//! Seam tracking: where the seam really runs, planned ahead of the torch as a function of path length.
//!
//! | module | holds |
//! |---|---|
//! | `taught` | what tracking asks of the taught path: poses along it, the foot of a point on it; chains of paths |
//! | `frame` | the motion of a path with the lane in it |
//! | `measurement` | a sensor's readings, where the sensor sits, and every reason not to believe one |
//! | `source` | what stands between the cycle and a sensor |
//! | `poses` | where the torch was when a reading was exposed |
//! | `gate` | spikes found among their neighbours on both sides |
//! | `tack` | tack welds, told from the seam |
//! | `bins`, `regression` | the default filter: a robust local parabola over path length |
//! | `estimate` | where the seam is at a knot: seen, bridged, or guessed |
//! | `mean` | the source's filter: the mean of the last readings |
//! | `lane` | the correction c(s): a cubic B-spline, with its record |
//! | `memory` | lanes of earlier passes, for passes over them |
//! | `guard` | control points that keep slope, third derivative and bound, whatever is asked |
//! | `fade` | the way from where the lane is to where the seam is |
//! | `settings` | what the cell says, and whether the look-ahead suffices |
//! | `tracker` | all of it, one cycle at a time |
//!
//! **Path frame**: x = the taught path's tangent T, y = T × (the wire's direction), normalized, z = T × y. Offsets are
//! (y, z): to the left, and up off the plate, seen along the travel with the wire pointing down.
//!
//! The correction is a lane c(s) planned ahead of the torch, not a target that moves under a time-optimal generator: that bows the path and lags.

mod bins;
mod estimate;
mod fade;
mod frame;
mod gate;
mod guard;
mod lane;
mod mean;
mod measurement;
mod memory;
mod poses;
mod regression;
mod settings;
mod source;
mod tack;
mod taught;
mod tracker;

pub use frame::{corrected, speed_factor};
pub use lane::{Lane, LaneJet, LanePeaks, LaneRecord, Pass, RecordedWeld};
pub use measurement::{Counts, Reading, Rejection, Sensor};
pub use memory::{LaneKey, LaneMemory, MEMORY_POINTS, MEMORY_WELDS, MemoryFull};
pub use poses::Instant;
pub use settings::{Budget, Filter, LostLane, Settings, SettingsError};
pub use source::{NoSensor, SeamSensor};
pub use tack::TackMask;
pub use taught::{ChainError, Foot, PathChain, TaughtPath, foot};
pub use tracker::{ControlPoint, Lost, SeamTracker};

/// An offset from the taught path in its frame, in metres: x is to the left (the frame's y), y is up (the frame's z).
pub type Offset = nalgebra::Vector2<f64>;
