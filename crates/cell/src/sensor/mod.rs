//! Seam sensors: what answers the cycle's question for readings (docs/seam.md).
//!
//! | module | holds |
//! |---|---|
//! | [`csv`] | readings as a CSV file |
//! | `replay` | readings of an earlier run once more |
//! | [`egm`] | readings over UDP: ABB's EGM path correction |

pub mod csv;
pub mod egm;
mod replay;

pub use replay::Replay;
