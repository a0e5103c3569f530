//! The subcommands, one module each.

pub(crate) mod cell;
pub(crate) mod check;
pub(crate) mod corner;
pub(crate) mod experiment;
pub(crate) mod fk;
pub(crate) mod identify;
pub(crate) mod ik;
mod inputs;
mod modes;
pub(crate) mod otg;
pub(crate) mod profile;
pub(crate) mod run;
pub(crate) mod shaper;
