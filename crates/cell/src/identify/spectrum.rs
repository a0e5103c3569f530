//! The strongest decaying vibration in a signal, to the width of a bin.

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::Signal;
use super::fit::Component;

/// Decays that are tried, as αT over the record's duration T. A vibration in between loses a tenth of its power at most.
const DECAYS: [f64; 9] = [0.0, 0.6, 1.6, 4.0, 10.0, 25.0, 60.0, 150.0, 400.0];
/// Fewer periods in the record than this are drift.
const LEAST_PERIODS: f64 = 1.5;

/// A peak of the spectrum.
#[derive(Debug, Clone, Copy)]
pub(super) struct Peak {
    pub(super) component: Component,
    /// Power over that of the noise.
    pub(super) significance: f64,
}

/// The place (ω, α) where e^(−αt) e^(jωt) has most of the signal: |Σ y e^(−αt) e^(−jωt)|² / Σ e^(−2αt), which white noise of variance σ²
/// fills with σ² everywhere.
pub(super) fn strongest(times: &[f64], values: &[f64]) -> Peak {
    let samples = times.len();
    let duration = times[samples - 1];
    let period = duration / (samples - 1) as f64;
    // Twice the length, so that a peak between two bins loses little.
    let bins = (2 * samples).next_power_of_two();
    let transform = FftPlanner::new().plan_fft_forward(bins);
    let mut buffer = vec![Complex::default(); bins];
    let step = TAU / (bins as f64 * period);
    let mut best = (0.0, Component::default());
    let mut noise = 0.0;
    for decay in DECAYS.map(|decay| decay / duration) {
        buffer.fill(Complex::default());
        let mut weight = 0.0;
        for ((slot, value), time) in buffer.iter_mut().zip(values).zip(times) {
            let window = (-decay * time).exp();
            weight += window * window;
            slot.re = value * window;
        }
        transform.process(&mut buffer);
        if decay == 0.0 {
            noise = median_power(&buffer[1..bins / 2]) / weight;
        }
        // Above drift, and above the component's own width.
        let lowest = (LEAST_PERIODS * TAU / duration).max(decay);
        for (bin, value) in buffer.iter().enumerate().take(bins / 2) {
            let omega = step * bin as f64;
            let power = value.norm_sqr() / weight;
            if omega >= lowest && power > best.0 {
                let scaled = value * (2.0 / weight);
                best = (power, Component { cosine: scaled.re, sine: -scaled.im, decay, omega });
            }
        }
    }
    let significance = if noise > 0.0 { best.0 / noise } else { f64::INFINITY };
    // Silence has neither power nor noise.
    Peak { component: best.1, significance: if best.0 > 0.0 { significance } else { 0.0 } }
}

/// Amplitude spectrum of a signal less its mean: frequencies in Hz, and the amplitude of a vibration that would last the whole record.
#[must_use]
pub fn amplitude_spectrum(signal: &Signal) -> Vec<(f64, f64)> {
    let samples = signal.values.len();
    let (Some(first), Some(last)) = (signal.times.first(), signal.times.last()) else { return Vec::new() };
    let mean = signal.values.iter().sum::<f64>() / samples as f64;
    let bins = (2 * samples).next_power_of_two();
    let mut buffer = vec![Complex::default(); bins];
    for (slot, value) in buffer.iter_mut().zip(&signal.values) {
        slot.re = value - mean;
    }
    FftPlanner::new().plan_fft_forward(bins).process(&mut buffer);
    let rate = (samples.max(2) - 1) as f64 / (last - first);
    let at = |(bin, value): (usize, &Complex<f64>)| {
        (bin as f64 * rate / bins as f64, value.norm() * 2.0 / samples as f64)
    };
    buffer.iter().take(bins / 2).enumerate().map(at).collect()
}

/// The mean power of noise, from the median: a few peaks do not move it. Power of white noise is exponentially distributed.
fn median_power(bins: &[Complex<f64>]) -> f64 {
    let mut powers: Vec<f64> = bins.iter().map(Complex::norm_sqr).collect();
    let middle = powers.len() / 2;
    let (_, median, _) = powers.select_nth_unstable_by(middle, f64::total_cmp);
    *median / std::f64::consts::LN_2
}
