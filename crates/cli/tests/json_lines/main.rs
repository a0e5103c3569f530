//! The subcommands that take questions as JSON lines, run as programs.

mod bad_questions;
mod inverse;
mod otg;
mod otg_profiles;
mod program;
mod random;
mod robots;
mod urdf;
