//! The control cycle: modes, blocks of motion, the rate of programme time, and the four tiers that make a command.

mod lookahead;
mod mode;
mod rate;

pub use mode::{Event, Mode};
