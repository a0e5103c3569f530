//! The control cycle with planned moves and simulated drives, judged by an independent arm model.

mod bench;
mod cycle;
mod faults;
mod no_alloc;
