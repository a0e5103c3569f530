//! Jobs, cells, planning and simulation around the motion core.
//!
//! | module | holds |
//! |---|---|
//! | [`job`] | INFORM job files: reader, checks, interpreter |

pub mod job;
