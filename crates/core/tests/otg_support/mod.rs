//! What the generator's tests, sweeps and comparisons share: random problems, and the judge of trajectories.
#![allow(dead_code, unreachable_pub)] // each user takes what it needs

pub mod cases;
pub mod judge;
pub mod random;
