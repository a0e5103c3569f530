//! Elementary functions and small numeric tools.

pub mod float;
pub mod taylor;
