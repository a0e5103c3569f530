//! The control cycle with planned moves and simulated drives, judged by an independent arm model.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::needless_range_loop,
    clippy::print_stdout,
    reason = "tests may; joints are counted"
)]

mod bench;
mod chain;
mod cycle;
mod fault_matrix;
mod faults;
mod feedrate;
mod joint_chain;
mod no_alloc;
mod passes;
mod pause;
mod prefilter;
mod recorded;
mod seam;
mod seam_moves;
mod seam_sensors;
mod seam_stops;
mod weave;
mod weld;
