//! Tests of the kinematics from outside, against what they did not make themselves.

// A test may panic, and so may what it calls.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod chain;
mod differential;
mod golden;
mod identity;
mod joint_jet;
mod scara;
mod spherical_wrist;
mod structure;
mod support;
mod three_parallel;
