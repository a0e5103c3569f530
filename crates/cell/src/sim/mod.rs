//! Simulated stand-ins for the machine: deterministic, without clock and thread.

mod drive;

pub use drive::{DriveError, InjectedFault, Servo, SetupError, SimulatedDrive};
