//! The SCARA experiment with the motion of least time, beside the bare command and FIR-ZVD, whose vibration is its bound.

use seamline::vibration::{Mode, Prefilter};

use super::super::scara::{FEEDRATE, Found, find_mode, plant, setup};
use super::super::{ExperimentError, Run, Setup, follow, run, test_path};
use super::{Quiet, QuietMotion, trade_off};
use crate::identify::IdentifiedMode;

/// Share of FIR-ZVD's vibration that is planned for: the identified mode is not quite the plant's.
const BELOW: f64 = 0.999;

/// Greatest acceleration of the command, in m/s²: near the robot's column, at (140, 40) mm, joint 1 turns with 6.9 rad/s² for each m/s², and the
/// SCARA cell gives it 42 rad/s².
const COMMAND: f64 = 5.5;

/// What is run.
#[derive(Debug, Clone, PartialEq)]
pub struct AutoOptions {
    /// Change of the plant's frequency after the identification: 0.15 is 15 % higher.
    pub plant_drift: f64,
    /// Permitted corner errors, in metres.
    pub corner_errors: Vec<f64>,
    /// Greatest acceleration of the tool, in m/s². If not given, that of FIR-ZVD with the same corner error, on the mode as identified.
    pub acceleration: Option<f64>,
    /// Root mean square of the tool's acceleration, in m/s²; open if not given.
    pub acceleration_rms: Option<f64>,
    /// How fast the command's acceleration may change, in m/s³; open if not given.
    pub jerk: Option<f64>,
    /// By how much the mode may drift with little left after the last command: see [`Quiet::drift`].
    pub safe_drift: f64,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct AutoOutcome {
    /// The mode, from the vibration that the bare command left.
    pub identified: IdentifiedMode,
    /// One for each corner error.
    pub compared: Vec<Compared>,
    modelled: Mode,
    /// What every motion keeps, whatever its bound and corner error.
    common: Quiet,
}

/// Runs with the same corner error on the same plant.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Permitted corner error, in metres.
    pub permitted: f64,
    /// Greatest acceleration that the motion was planned for, in m/s².
    pub bound: f64,
    /// The bare command.
    pub bare: Run,
    /// The same through FIR-ZVD.
    pub fir_zvd: Run,
    /// The motion of least time.
    pub auto: Run,
}

/// Identifies the mode from a run without prefilter, plans the motion of least time for it with each corner error, and runs it.
///
/// # Errors
/// [`ExperimentError::Bound`] where no motion keeps a bound, [`ExperimentError::Mode`] where the drift leaves no frequency.
pub fn scara_auto(options: &AutoOptions) -> Result<AutoOutcome, ExperimentError> {
    let path = test_path().map_err(|_| ExperimentError::Path)?;
    let Found { identified, modelled, .. } = find_mode(&path)?;
    let plant = setup(plant(1.0 + options.plant_drift)?);
    let common = Quiet {
        acceleration: 0.0,
        acceleration_rms: f64::INFINITY,
        command: COMMAND,
        jerk: options.jerk.unwrap_or(f64::INFINITY),
        corner_error: 0.0,
        drift: options.safe_drift,
    };
    let compare = |permitted: &f64| {
        let with = |on: &Setup, prefilter| run(on, &path, prefilter, &modelled, *permitted);
        let bound = match options.acceleration {
            Some(given) => given,
            None => BELOW * with(&setup(modelled), Prefilter::FirZvd)?.acceleration_max,
        };
        let quiet = Quiet {
            acceleration: bound,
            acceleration_rms: options.acceleration_rms.unwrap_or(f64::INFINITY),
            corner_error: *permitted,
            ..common
        };
        let motion = QuietMotion::plan(&path, &modelled, FEEDRATE, &quiet)?;
        let auto = follow(&plant, motion.duration(), &|time| motion.position(time), motion.corners())?;
        Ok(Compared {
            permitted: *permitted,
            bound,
            bare: with(&plant, Prefilter::None)?,
            fir_zvd: with(&plant, Prefilter::FirZvd)?,
            auto,
        })
    };
    let compared = options.corner_errors.iter().map(compare).collect::<Result<_, ExperimentError>>()?;
    Ok(AutoOutcome { identified, compared, modelled, common })
}

impl AutoOutcome {
    /// Path time against vibration with a corner error, for each bound: see [`trade_off`].
    ///
    /// # Errors
    /// None: the test path is fixed. The type is that of the path.
    pub fn trade_off(&self, permitted: f64, bounds: &[f64]) -> Result<Vec<[f64; 2]>, ExperimentError> {
        let path = test_path().map_err(|_| ExperimentError::Path)?;
        let quiet = Quiet { corner_error: permitted, ..self.common };
        Ok(trade_off(&path, &self.modelled, FEEDRATE, &quiet, bounds))
    }
}
