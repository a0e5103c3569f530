//! Jobs, cells, planning and simulation around the motion core.
//!
//! # Map
//! | module | holds |
//! |---|---|
//! | [`record`] | what a run leaves behind: recording, figures, data for plots |

pub mod record;
