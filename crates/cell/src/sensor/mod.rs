//! Seam sensors: what answers the cycle's question for readings (docs/seam.md).
//!
//! | module | holds |
//! |---|---|
//! | [`csv`] | readings as a CSV file |
//! | `replay` | readings of an earlier run once more |
//! | `laser`, `seam` | a simulated laser on a simulated seam |
//! | [`egm`] | readings over UDP: ABB's EGM path correction |

pub mod csv;
pub mod egm;
mod laser;
mod replay;
mod seam;

pub use laser::SimulatedLaser;
pub use replay::Replay;
pub use seam::{SeamFeature, SimulatedSeam};
