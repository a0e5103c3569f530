//! Seam tracking against a simulated torch and laser in space.

#![allow(
    clippy::panic,
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failing test says where"
)]

mod accuracy;
mod events;
mod geometry;
mod hostile;
mod lost;
mod memory;
mod naive;
mod paths;
#[path = "../otg_support/random.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the generator's tests, which use all of it")]
mod random;
mod readings;
#[allow(dead_code, reason = "shared with the examples")]
mod simulation;
mod standing;
