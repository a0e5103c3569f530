//! The subcommands that take questions as JSON lines, run as programs.

#![expect(clippy::unwrap_used, reason = "tests may panic")]

mod bad_questions;
mod inverse;
mod otg;
mod otg_profiles;
mod program;
mod random;
mod robots;
mod urdf;
