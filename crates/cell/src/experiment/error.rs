//! Why there is no run.

use seamline::kinematics::InverseError;
use seamline::vibration::{KernelError, ModeError, RampError};
use thiserror::Error;

use crate::identify::IdentifyError;

/// What stopped an experiment.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ExperimentError {
    /// The path leaves the arm's reach.
    #[error("at {time:.3} s the arm does not reach the path: {error:?}")]
    Reach {
        /// In seconds.
        time: f64,
        /// As the arm says it.
        error: InverseError,
    },
    /// The test path has no arc.
    #[error("the points of the test path's arc lie on no circle")]
    Path,
    /// No motion keeps the vibration bound.
    #[error(
        "no motion keeps the tool's acceleration within {bound} m/s² on this path, and its root mean square within {rms} m/s²"
    )]
    Bound {
        /// In m/s².
        bound: f64,
        /// Root mean square in m/s², infinite where it is open.
        rms: f64,
    },
    /// The plant is no mode.
    #[error(transparent)]
    Mode(#[from] ModeError),
    /// The prefilter does not fit into a kernel.
    #[error(transparent)]
    Kernel(#[from] KernelError),
    /// The prefilter does not fit into a ramp.
    #[error(transparent)]
    Ramp(#[from] RampError),
    /// The mode could not be identified.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
}
