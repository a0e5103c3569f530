//! The SCARA experiment of Yeh & You (2026), section 5, in simulation: vibration of a flexible tool along a path with sharp corners, for
//! each prefilter and corner error.
//!
//! | module | holds |
//! |---|---|
//! | `blend` | segments that overlap in time: where the tool is commanded to be |
//! | `plant` | a flexible tool that follows the command |

mod blend;
mod plant;

use nalgebra::Vector3;
use seamline::geometry::Pose;
use seamline::path::{ArcError, Path};
use seamline::vibration::{KernelError, Mode, Prefilter, Ramp, RampError};

pub use blend::{Blend, PlannedCorner};
pub use plant::Plant;

use crate::identify::Signal;

/// What stays the same over all runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// The tool's flexible mode, in x and in y.
    pub plant: Mode,
    /// Feedrate along the path, in m/s.
    pub feedrate: f64,
    /// Cycle, in seconds.
    pub period: f64,
    /// How long the tool is watched after the last command, in seconds.
    pub watched: f64,
}

/// One run, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Time until the last command, in seconds.
    pub path_time: f64,
    /// Greatest acceleration of the tool while it moves and while it is watched, in m/s².
    pub acceleration_max: f64,
    /// Root mean square of the acceleration until the last command, in m/s².
    pub acceleration_rms: f64,
    /// Greatest acceleration after the last command, in m/s².
    pub residual_max: f64,
    /// The corners as planned, with the error that the curved path has.
    pub corners: Vec<PlannedCorner>,
    /// Acceleration in x after the last command: what an accelerometer sees but for its noise.
    pub residual: Signal,
}

/// The document's test path: a quarter of a circle and four lines, with changes of direction of 66.038, 47.925, 158.963 and 90 degrees.
///
/// # Errors
/// None: the arc's points lie on a circle. The type is that of the call.
pub fn test_path() -> Result<Vec<Path>, ArcError> {
    let pose = |[x, y]: [f64; 2]| Pose::translation(1e-3 * x, 1e-3 * y, 0.0);
    // Half way round the quarter of 40 mm about (180, 40).
    let half = 40.0 * std::f64::consts::FRAC_1_SQRT_2;
    let via = pose([180.0 - half, 40.0 - half]);
    let corners = [[140.0, 40.0], [275.0, 100.0], [410.0, 40.0], [360.0, 90.0], [270.0, 0.0]].map(pose);
    let mut segments = vec![Path::arc(&pose([180.0, 0.0]), &via, &corners[0])?];
    segments.extend(corners.windows(2).map(|pair| Path::line(&pair[0], &pair[1])));
    Ok(segments)
}

/// Runs a path with a prefilter made for the modelled mode, on a plant that may differ from it.
///
/// # Errors
/// A kernel or ramp with too many pieces: none for one mode.
pub fn run(
    setup: &Setup,
    path: &[Path],
    prefilter: Prefilter,
    modelled: &Mode,
    permitted: f64,
) -> Result<Run, RampError> {
    let kernel = prefilter.kernel(modelled).map_err(|error: KernelError| RampError::from(error))?;
    let ramp = Ramp::from_kernel(&kernel)?;
    let blend = Blend::plan(path, &ramp, setup.feedrate, permitted);
    Ok(simulate(setup, &blend))
}

fn simulate(setup: &Setup, blend: &Blend<'_>) -> Run {
    let path_time = blend.duration();
    let cycles = ((path_time + setup.watched) / setup.period).ceil() as u64;
    let mut plant = Plant::at_rest(setup.plant, blend.position(0.0));
    let (mut acceleration_max, mut residual_max) = (0.0_f64, 0.0_f64);
    let (mut squares, mut moving) = (0.0, 0.0_f64);
    let mut residual = Signal { times: Vec::new(), values: Vec::new() };
    for cycle in 1..=cycles {
        let time = setup.period * cycle as f64;
        let acceleration: Vector3<f64> = plant.step(blend.position(time), setup.period);
        let size = acceleration.norm();
        acceleration_max = acceleration_max.max(size);
        if time <= path_time {
            squares += size * size;
            moving += 1.0;
        } else {
            residual_max = residual_max.max(size);
            residual.times.push(time);
            residual.values.push(acceleration.x);
        }
    }
    Run {
        path_time,
        acceleration_max,
        acceleration_rms: (squares / moving.max(1.0)).sqrt(),
        residual_max,
        corners: blend.corners().to_vec(),
        residual,
    }
}
