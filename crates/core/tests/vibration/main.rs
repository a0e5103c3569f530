//! Prefilters, their streaming stage and corners in time, judged by integration and by the printed tables.
//!
//! The long sweep of corners: `cargo test --release -p seamline --features std --test vibration -- --ignored --nocapture`.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a failing test says where")]

mod corner;
mod prefilter;
#[path = "../otg_support/random.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the generator's tests, which use all of it")]
mod random;
mod stage;
mod tables;
