//! INFORM jobs from outside: what is read, what is refused, what runs.

// Helpers of tests may fail as tests do.
#![allow(clippy::unwrap_used, clippy::panic)]

mod forms;
mod mistakes;
mod mutation;
mod run;
mod samples;
mod support;
