//! The subcommands, one module each.

pub(crate) mod cell;
pub(crate) mod otg;
