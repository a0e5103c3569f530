//! The subcommands, one module each.

pub(crate) mod cell;
pub(crate) mod check;
pub(crate) mod fk;
pub(crate) mod ik;
mod inputs;
pub(crate) mod otg;
pub(crate) mod profile;
pub(crate) mod run;
