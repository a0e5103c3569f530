//! The last gate before the drives: the envelope every command must lie in, the faults, and how each one stops the arm.

mod envelope;
mod fault;

pub use envelope::{Envelope, MotionLimits, WorkspaceBox};
pub use fault::{Fault, StopCategory};
