//! Seam sensors: what answers the cycle's question for readings (docs/seam.md).
//!
//! | module | holds |
//! |---|---|
//! | `cell_sensor` | the one that a cell asks for |
//! | [`csv`] | readings as a CSV file |
//! | `replay` | readings of an earlier run once more |
//! | [`passes`] | records of earlier passes as a CSV file |
//! | `table` | what such files have in common |
//! | `laser`, `seam` | a simulated laser on a simulated seam |
//! | [`egm`] | readings over UDP: ABB's EGM path correction |

mod cell_sensor;
pub mod csv;
pub mod egm;
mod laser;
pub mod passes;
mod replay;
mod seam;
mod table;

pub use cell_sensor::{CellSensor, SensorError, SensorFault};
pub use laser::SimulatedLaser;
pub use replay::Replay;
pub use seam::{SeamFeature, SimulatedSeam};
pub use table::{Columns, TableError};
