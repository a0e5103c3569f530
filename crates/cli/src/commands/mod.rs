//! The subcommands, one module each.

pub(crate) mod cell;
pub(crate) mod fk;
pub(crate) mod ik;
pub(crate) mod otg;
