//! Simulated stand-ins for the machine: deterministic, without clock and thread.

mod arc;
mod drive;
pub(crate) mod random;

pub use arc::{ArcFault, SimulatedArc};
pub use drive::{DriveError, InjectedFault, Servo, SetupError, SimulatedDrive};

use seamline::drive::{Drive, DriveFault, JointCommand};

impl<const N: usize> Drive<N> for SimulatedDrive<N> {
    fn exchange(&mut self, command: &JointCommand<N>, period: f64) -> Result<[f64; N], DriveFault> {
        SimulatedDrive::exchange(self, &command.position, period).map_err(DriveFault::from)
    }
}

impl From<DriveError> for DriveFault {
    fn from(error: DriveError) -> Self {
        match error {
            DriveError::Silent => Self::Silent,
            DriveError::Alarm { joint, code } => Self::Axis(joint, code),
            // A drive would answer a command that is no number with an alarm of its own.
            DriveError::NotFinite { joint } => Self::Axis(joint, 0),
        }
    }
}
