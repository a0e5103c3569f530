//! The SCARA experiment of Yeh & You (2026), section 5, in simulation: vibration of a flexible tool along a path with sharp corners, for
//! each prefilter and corner error.
//!
//! | module | holds |
//! |---|---|
//! | `auto` | the motion of least time for a vibration bound and a corner error |
//! | `blend` | segments that overlap in time: where the tool is commanded to be |
//! | `error` | why there is no run |
//! | `plant` | a flexible tool that follows the command |
//! | `scara` | the experiment whole: identification, then a run for each prefilter and corner error |

mod auto;
mod blend;
mod error;
mod plant;
mod scara;

use nalgebra::Vector3;
use seamline::geometry::Pose;
use seamline::kinematics::{Kinematics, models};
use seamline::path::{ArcError, Path};
use seamline::vibration::{Mode, Prefilter, Ramp};

pub use auto::{AutoOptions, AutoOutcome, Compared, Quiet, QuietMotion, scara_auto, trade_off};
pub use blend::{Blend, PlannedCorner};
pub use error::ExperimentError;
pub use plant::Plant;
pub use scara::{CORNER_ERRORS, Outcome, PREFILTERS, ScaraRun, scara};

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
    /// Every cycle.
    pub trace: Vec<Sample>,
}

/// The tool at one cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// In seconds.
    pub time: f64,
    /// Where the arm is commanded to be, in metres.
    pub command: Vector3<f64>,
    /// How the tool accelerates, in m/s².
    pub acceleration: Vector3<f64>,
}

impl Run {
    /// Acceleration in x after the last command: what an accelerometer sees but for its noise.
    #[must_use]
    pub fn residual(&self) -> Signal {
        let after = self.trace.iter().filter(|sample| sample.time > self.path_time);
        let (times, values) = after.map(|sample| (sample.time, sample.acceleration.x)).unzip();
        Signal { times, values }
    }
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
/// The arm is the SCARA of 325 mm and 275 mm links; each command passes through its joints.
///
/// # Errors
/// [`ExperimentError`]: a path out of the arm's reach.
pub fn run(
    setup: &Setup,
    path: &[Path],
    prefilter: Prefilter,
    modelled: &Mode,
    permitted: f64,
) -> Result<Run, ExperimentError> {
    let ramp = Ramp::from_kernel(&prefilter.kernel(modelled)?)?;
    let blend = Blend::plan(path, &ramp, setup.feedrate, permitted);
    follow(setup, blend.duration(), &|time| blend.position(time), blend.corners())
}

/// Runs a commanded motion: its duration, where it is at a time, and its corners.
///
/// # Errors
/// [`ExperimentError::Reach`].
pub fn follow(
    setup: &Setup,
    duration: f64,
    position: &dyn Fn(f64) -> Vector3<f64>,
    corners: &[PlannedCorner],
) -> Result<Run, ExperimentError> {
    let trace = simulate(setup, duration, position)?;
    Ok(figures(duration, corners, trace))
}

fn simulate(
    setup: &Setup,
    duration: f64,
    position: &dyn Fn(f64) -> Vector3<f64>,
) -> Result<Vec<Sample>, ExperimentError> {
    let cycles = ((duration + setup.watched) / setup.period).ceil() as u64;
    let arm = models::scara600();
    let mut joints = [0.0; 4];
    let down = arm.forward(&joints).rotation;
    let mut plant = Plant::at_rest(setup.plant, position(0.0));
    let mut trace = Vec::with_capacity(cycles as usize);
    for cycle in 1..=cycles {
        let time = setup.period * cycle as f64;
        let pose = Pose::from_parts(position(time).into(), down);
        joints =
            arm.inverse_nearest(&pose, &joints).map_err(|error| ExperimentError::Reach { time, error })?;
        let command = arm.forward(&joints).translation.vector;
        let acceleration = plant.step(command, setup.period);
        trace.push(Sample { time, command, acceleration });
    }
    Ok(trace)
}

fn figures(path_time: f64, corners: &[PlannedCorner], trace: Vec<Sample>) -> Run {
    let greatest = |samples: &[Sample]| samples.iter().map(|s| s.acceleration.norm()).fold(0.0, f64::max);
    let (moving, after) = trace.split_at(trace.partition_point(|sample| sample.time <= path_time));
    let squares: f64 = moving.iter().map(|s| s.acceleration.norm_squared()).sum();
    Run {
        path_time,
        acceleration_max: greatest(&trace),
        acceleration_rms: (squares / moving.len().max(1) as f64).sqrt(),
        residual_max: greatest(after),
        corners: corners.to_vec(),
        trace,
    }
}
