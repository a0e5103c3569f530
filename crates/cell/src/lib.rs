//! Jobs, cells, planning and simulation around the motion core.

pub mod cell;
pub mod sim;
