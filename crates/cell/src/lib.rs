//! Jobs, cells, planning and simulation around the motion core.
//!
//! # Map
//! | module | holds |
//! |---|---|
//! | [`plan`] | from steps to blocks; the speed along a path that keeps every joint limit |

pub mod plan;
