//! The subcommands, one module each.

pub(crate) mod cell;
pub(crate) mod check;
mod inputs;
pub(crate) mod run;
