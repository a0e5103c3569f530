//! Seamline's motion core: everything that runs in a robot's control cycle, and all the mathematics behind it.
//!
//! # Map
//! | module | holds |
//! |---|---|
//! | [`control`] | the cycle: modes, blocks of motion, rate of programme time |
//! | [`arc`] | what stands between the cycle and the welding power source |
//! | [`drive`] | what stands between the cycle and the motors |
//! | [`math`] | elementary functions with or without std |
//! | [`geometry`] | poses, Euler angles, poses with their derivatives along a path |
//! | [`safety`] | the envelope every command must lie in, faults and stops |
//! | [`kinematics`] | arm models: forward, inverse, Jacobian, joint derivatives along a path, singularities |
//! | [`otg`] | the trajectory generator: any state to any state in the least time, jerk-limited, N axes |
//! | [`path`] | lines, arcs, blends and splines with orientation, as functions of the path coordinate; corners |
//! | [`seam`] | seam tracking: from a sensor's readings to a lane planned ahead of the torch |
//! | [`timed`] | motion of third order in a given time, and what a new target does to it |
//! | [`weave`] | periodic motion of the torch about the seam |
//! | [`vibration`] | prefilters against a flexible mode; corners that keep their error under them |
//!
//! # Units and frames
//! SI throughout: metre, radian, second. A pose is named by its two frames, and neighbouring frames cancel:
//! `base_from_tcp = base_from_flange * flange_from_tcp`.
//!
//! # What is not here
//! No heap, no clock, no file, no thread, no log, no string formatting, no `unsafe`: time is an argument, and
//! every call has a bounded cost.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(any(feature = "std", test))]
extern crate std;

pub mod arc;
pub mod control;
pub mod drive;
pub mod geometry;
pub mod kinematics;
pub mod math;
pub mod otg;
pub mod path;
pub mod safety;
pub mod seam;
pub mod timed;
pub mod vibration;
pub mod weave;
