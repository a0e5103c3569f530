//! The program `seamline`.
fn main() {}
