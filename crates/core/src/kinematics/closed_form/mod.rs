//! The pieces that closed-form arms are made of: the arm's plane, two links in it, and a wrist of three turns.

mod arm_plane;
mod polar;
mod three_turns;
mod two_link;

pub(super) use arm_plane::ArmPlane;
pub(super) use polar::Polar;
pub(super) use three_turns::{ThreeTurns, unturned_y, unturned_z};
pub(super) use two_link::{Bend, ON_AXIS, STILL, TwoLink};
