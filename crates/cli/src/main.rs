//! The program `seamline`.

#[cfg_attr(not(test), expect(dead_code, reason = "the subcommand `run` is its only user"))]
mod report;

fn main() {}
