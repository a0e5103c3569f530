//! Elementary functions and small numeric tools.

pub mod float;
pub mod linear;
pub mod taylor;
