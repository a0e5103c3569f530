//! The experiment whole.

use std::f64::consts::TAU;

use seamline::path::Path;
use seamline::vibration::{Mode, Prefilter};

use super::{ExperimentError, Run, Setup, run, test_path};
use crate::identify::{IdentifiedMode, IdentifyError, Signal, identify};
use crate::sim::random::Random;

/// The document's prefilters, the bare command first.
pub const PREFILTERS: [Prefilter; 6] =
    [Prefilter::None, Prefilter::Zv, Prefilter::Zvd, Prefilter::Fir, Prefilter::FirZv, Prefilter::FirZvd];
/// The document's permitted corner errors, in metres.
pub const CORNER_ERRORS: [f64; 2] = [0.0, 500e-6];

/// Standard deviation of the accelerometer's noise, in m/s²: half a hundredth of g.
const NOISE: f64 = 0.05;
const SEED: u64 = 900;
/// 9600 mm/min.
pub(super) const FEEDRATE: f64 = 0.16;

/// What the experiment found.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The mode, from the vibration that the bare command left.
    pub identified: IdentifiedMode,
    /// That vibration, as the accelerometer saw it.
    pub measured: Signal,
    /// Each prefilter with each corner error.
    pub runs: Vec<ScaraRun>,
}

/// One run with what it was made for.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaraRun {
    /// The prefilter.
    pub prefilter: Prefilter,
    /// Permitted corner error, in metres.
    pub permitted: f64,
    /// What happened.
    pub run: Run,
}

impl Outcome {
    /// The run with the bare command and the same corner error: what reductions refer to.
    #[must_use]
    pub fn bare(&self, permitted: f64) -> Option<&Run> {
        let bare = |run: &&ScaraRun| run.prefilter == Prefilter::None && run.permitted == permitted;
        self.runs.iter().find(bare).map(|found| &found.run)
    }
}

/// Identifies the mode from a run without prefilter, designs all prefilters for it, and runs them on a plant whose frequency has
/// since changed by `drift` (0.15: 15 % higher).
///
/// The plant is the document's mode, 6.340 Hz and ζ = 0.022.
///
/// # Errors
/// [`ExperimentError::Mode`] where the drift leaves no frequency.
pub fn scara(drift: f64) -> Result<Outcome, ExperimentError> {
    let path = test_path().map_err(|_| ExperimentError::Path)?;
    let Found { measured, identified, modelled } = find_mode(&path)?;
    let drifted = setup(plant(1.0 + drift)?);
    let mut runs = Vec::new();
    for permitted in CORNER_ERRORS {
        for prefilter in PREFILTERS {
            let run = run(&drifted, &path, prefilter, &modelled, permitted)?;
            runs.push(ScaraRun { prefilter, permitted, run });
        }
    }
    Ok(Outcome { identified, measured, runs })
}

/// The plant's mode as the experiment finds it.
pub(super) struct Found {
    pub(super) measured: Signal,
    pub(super) identified: IdentifiedMode,
    /// What prefilters are made for.
    pub(super) modelled: Mode,
}

pub(super) fn find_mode(path: &[Path]) -> Result<Found, ExperimentError> {
    let measured = measure(&setup(plant(1.0)?), path)?;
    let identified = *identify(&measured)?.modes.first().ok_or(IdentifyError::NoVibration)?;
    let modelled = Mode::try_new(TAU * identified.frequency_hz, identified.damping.max(0.0))?;
    Ok(Found { measured, identified, modelled })
}

/// The document's mode at a factor of its frequency.
pub(super) fn plant(factor: f64) -> Result<Mode, ExperimentError> {
    Ok(Mode::try_new(factor * TAU * 6.34, 0.022)?)
}

pub(super) fn setup(plant: Mode) -> Setup {
    Setup { plant, feedrate: FEEDRATE, period: 1e-3, watched: 3.0 }
}

/// What the accelerometer sees after a run without prefilter.
fn measure(setup: &Setup, path: &[Path]) -> Result<Signal, ExperimentError> {
    let mut signal = run(setup, path, Prefilter::None, &setup.plant, 0.0)?.residual();
    let mut noise = Random::new(SEED);
    for value in &mut signal.values {
        *value += NOISE * noise.normal();
    }
    Ok(signal)
}
