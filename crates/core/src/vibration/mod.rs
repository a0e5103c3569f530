//! Vibration: prefilters that do not excite a flexible mode, and corners that keep their error under any of them.
//!
//! | module | holds |
//! |---|---|
//! | `mode` | a flexible mode, and what it does with a step |
//! | `kernel` | impulses ∗ rectangles in continuous time: what a prefilter is |
//! | `prefilter` | the table of prefilters: ZV, ZVD, MZV, EI, FIR and their convolutions |
//! | `response` | frequency response, residual vibration, response of the mode |
//! | `ramp` | a feedrate that rises from 0 to 1, as a piecewise polynomial with its integral |
//! | `stage` | a prefilter as a stage of the cycle, on N axes or on the path coordinate |
//! | `corner` | how far two segments may overlap in time for a permitted corner error |
//!
//! Source: Yeh & You, *Integration of Hybrid Prefilter and Corner Trajectory Planning …*, Electronics 2026, 15(4), 900.
//! The derivations are in `docs/vibration.md`.

mod corner;
mod kernel;
mod mode;
mod prefilter;
mod ramp;
mod response;
mod stage;

pub use corner::{Corner, Overlap, angle_between, reachable_feedrate, trapezoid_overlap};
pub use kernel::{Impulse, Kernel, KernelError, MAX_IMPULSES, MAX_RECTANGLES};
pub use mode::{Mode, ModeError};
pub use prefilter::Prefilter;
pub use ramp::{MAX_PIECES, Ramp, RampError, RampPiece};
pub use stage::{PrefilterStage, Signal, StageEntry, StageError, stage_entries};
