//! Identification: the flexible modes of an arm from the vibration it leaves behind.
//!
//! A measured, decaying vibration is Σ e^(−αt) (a cos ω_d t + b sin ω_d t) + offset + noise. Modes are found one at a time, the strongest
//! first: each starts from the peak of a spectrum (`spectrum`) and is then fitted together with all others (`fit`), so that
//! neither a bin's width nor a neighbour's skirt stays in the answer.

mod csv;
mod error;
mod fit;
mod spectrum;

use std::f64::consts::TAU;

use nalgebra::Matrix2;

pub use csv::read_signal;
pub use error::{CsvError, IdentifyError};
use fit::{Component, Fit};
pub use spectrum::amplitude_spectrum;

/// A sampled signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Signal {
    /// In seconds, rising in nearly equal steps.
    pub times: Vec<f64>,
    /// In any unit.
    pub values: Vec<f64>,
}

/// A mode that was found, each figure with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IdentifiedMode {
    /// Undamped natural frequency, in Hz.
    pub frequency_hz: f64,
    /// Standard deviation of the frequency, in Hz.
    pub frequency_std_hz: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Standard deviation of the damping ratio.
    pub damping_std: f64,
    /// Amplitude where the fit begins, in the signal's unit.
    pub amplitude: f64,
}

/// What was found in a signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// The modes, strongest first; at least one.
    pub modes: Vec<IdentifiedMode>,
    /// Where the fit begins: the first sample that the vibration has fully reached.
    pub start: f64,
    /// What the fit leaves: root mean square, in the signal's unit.
    pub residual_rms: f64,
    /// The fitted signal at the times from `start` on.
    pub fitted: Vec<f64>,
}

/// Fewer samples do not make a fit.
pub const MIN_SAMPLES: usize = 32;
/// Most modes that are looked for.
const MAX_MODES: usize = 6;
/// How far a peak must stand above the noise, as power: among 10⁵ places in the spectrum, noise alone comes this far once in 10⁶ signals.
const SIGNIFICANT: f64 = 25.0;
/// Modes weaker than this share of the strongest are what the model does not cover, not modes.
const LEAST_SHARE: f64 = 0.02;
/// The vibration has begun where the signal first reaches this share of its greatest value.
const BEGUN: f64 = 0.5;

/// Finds the modes in a decaying vibration.
///
/// The record may begin before the vibration does. Frequencies below 1.5 periods in the record are not looked for. Uncertainties are those of
/// the fit under white noise. Costs some ten milliseconds for 3 s at 1 kHz.
///
/// # Errors
/// [`IdentifyError`]: too few samples, times that do not rise evenly, nothing that stands out of the noise.
pub fn identify(signal: &Signal) -> Result<Identification, IdentifyError> {
    check(signal)?;
    let start = beginning(&signal.values);
    let origin = signal.times[start];
    let times: Vec<f64> = signal.times[start..].iter().map(|t| t - origin).collect();
    let fit = fit_modes(&times, &signal.values[start..])?;
    let mut modes: Vec<_> = (0..fit.components.len()).map(|index| identified(&fit, index)).collect();
    modes.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    Ok(Identification { modes, start: origin, residual_rms: fit.residual_rms, fitted: fit.values(&times) })
}

fn check(signal: &Signal) -> Result<(), IdentifyError> {
    let samples = signal.times.len().min(signal.values.len());
    if samples < MIN_SAMPLES {
        return Err(IdentifyError::TooShort { samples });
    }
    let all = signal.times.iter().chain(&signal.values);
    if let Some(index) = all.into_iter().position(|x| !x.is_finite()) {
        return Err(IdentifyError::NotFinite { sample: index % samples });
    }
    let period = (signal.times[samples - 1] - signal.times[0]) / (samples - 1) as f64;
    let uneven = |pair: &[f64]| {
        let step = pair[1] - pair[0];
        !(step > 0.5 * period && step < 1.5 * period)
    };
    match signal.times.windows(2).position(uneven) {
        Some(index) => Err(IdentifyError::Uneven {
            sample: index + 1,
            step: signal.times[index + 1] - signal.times[index],
            period,
        }),
        None => Ok(()),
    }
}

/// The sample where the vibration has begun; early enough to leave a fit's worth of samples.
fn beginning(values: &[f64]) -> usize {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let greatest = values.iter().fold(0.0_f64, |most, x| most.max((x - mean).abs()));
    let begun = values.iter().position(|x| (x - mean).abs() >= BEGUN * greatest).unwrap_or(0);
    begun.min(values.len() - MIN_SAMPLES)
}

/// One mode after the other, until what is left is noise.
fn fit_modes(times: &[f64], values: &[f64]) -> Result<Fit, IdentifyError> {
    let mut best: Option<Fit> = None;
    for _ in 0..MAX_MODES {
        let (left, found) = match &best {
            Some(fit) => (fit.residual(times, values), fit.components.as_slice()),
            None => (centred(values), [].as_slice()),
        };
        let peak = spectrum::strongest(times, &left);
        if peak.significance < SIGNIFICANT {
            break;
        }
        let start: Vec<_> = found.iter().copied().chain([peak.component]).collect();
        let Some(fit) = fit::refine(times, values, &start) else { break };
        if !plausible(&fit, times) {
            break;
        }
        best = Some(fit);
    }
    best.ok_or(IdentifyError::NoVibration)
}

fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|x| x - mean).collect()
}

/// Whether every component is a vibration of its own: it decays, it fits between drift and the sampling's limit, it is not a trace beside
/// the strongest.
fn plausible(fit: &Fit, times: &[f64]) -> bool {
    let duration = times[times.len() - 1];
    let nyquist = 0.5 * TAU * (times.len() - 1) as f64 / duration;
    let strongest = fit.components.iter().map(Component::amplitude).fold(0.0, f64::max);
    fit.components.iter().all(|c| {
        let decays = c.decay > -1.0 / duration && c.decay < c.omega;
        decays && c.omega > 0.0 && c.omega < nyquist && c.amplitude() >= LEAST_SHARE * strongest
    })
}

/// From ω_d and α to the undamped frequency and the damping ratio: ω² = ω_d² + α², ζ = α/ω, and the same for their covariance.
fn identified(fit: &Fit, index: usize) -> IdentifiedMode {
    let component = &fit.components[index];
    let (decay, damped) = (component.decay, component.omega);
    let omega = damped.hypot(decay);
    let cube = omega * omega * omega;
    let slopes = Matrix2::new(decay / omega, damped / omega, damped * damped / cube, -decay * damped / cube);
    let covariance = slopes * fit.covariance(index) * slopes.transpose();
    IdentifiedMode {
        frequency_hz: omega / TAU,
        frequency_std_hz: covariance.m11.max(0.0).sqrt() / TAU,
        damping: decay / omega,
        damping_std: covariance.m22.max(0.0).sqrt(),
        amplitude: component.amplitude(),
    }
}
