//! Planning: everything that is decided before a motion starts.

pub mod timing;
