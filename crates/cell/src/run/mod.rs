//! One job in one cell: checked first, then run cycle by cycle, and recorded.
//!
//! ```text
//! Interpreter ─▶ Planner ─▶ queue ─▶ Cycle ─▶ drives ─▶ Recorder
//!  └──── Walk ────┘   Feeder          └─ Machine ─┘
//! ```
//!
//! [`check()`] walks the whole job without moving anything; [`run()`] does the same first and refuses a job that would
//! fail on the way.

mod announcement;
mod beat;
mod cell_arm;
mod check;
mod clock;
mod error;
mod faults;
mod feeder;
mod inject;
mod machine;
mod passes;
mod program;
mod readings;
mod realtime;
mod session;
mod supervisor;
mod walk;
mod world;

pub use check::{CheckReport, Finding, check};
pub use clock::{MonotonicClock, thread_cpu_ns};
pub use error::{Place, RunError};
pub use faults::describe;
pub use inject::FaultScript;
pub use machine::{Devices, Machine, arc_rules, command_prefilter};
pub use program::Program;
pub use session::{Progress, RunOptions, RunReport, run};
