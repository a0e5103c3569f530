//! What a kernel does to frequencies, and what it leaves of a mode's vibration.

use nalgebra::Complex;

use super::kernel::{Kernel, MAX_RECTANGLES};
use super::mode::Mode;
use crate::math::float;

impl Kernel {
    /// The Laplace transform H(s) of the kernel: Σ wᵢ e^(−s tᵢ) · Π (1 − e^(−sT)) / (sT).
    #[must_use]
    pub fn transfer(&self, s: Complex<f64>) -> Complex<f64> {
        let mut sum = Complex::new(0.0, 0.0);
        for impulse in self.impulses() {
            sum += exponential(-s * impulse.time) * impulse.weight;
        }
        for &duration in self.rectangles() {
            sum *= mean_of_exponential(-s * duration);
        }
        sum
    }

    /// Gain at an angular frequency, rad/s: 1 at zero.
    #[must_use]
    pub fn gain(&self, omega: f64) -> f64 {
        let response = self.transfer(Complex::new(0.0, omega));
        float::hypot(response.re, response.im)
    }

    /// Vibration of a mode after a step of the command through this kernel, relative to that after the bare step: amplitudes just
    /// after the command has ended.
    ///
    /// With the pole p of the actual mode it is |H(p)| · exp(Re p · length). To see how a prefilter stands a wrong model, give the kernel of
    /// the modelled mode and the actual mode here.
    #[must_use]
    pub fn residual_vibration(&self, actual: &Mode) -> f64 {
        let pole = actual.pole();
        let response = self.transfer(pole);
        float::hypot(response.re, response.im) * float::exp(pole.re * self.length())
    }

    /// Response of a mode to a unit step through this kernel, `time` after the step.
    #[must_use]
    pub fn mode_response(&self, mode: &Mode, time: f64) -> f64 {
        let order = self.rectangles().len() as u32;
        self.powers().map(|(at, weight)| weight * mode.step_response(order, time - at)).sum()
    }

    /// The step through this kernel as a sum of powers: Σ c (t − τ)₊ⁿ / n! with n the number of rectangles. Gives (τ, c).
    ///
    /// A rectangle is the difference of two steps over its duration: each doubles the terms.
    pub(super) fn powers(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let subsets = 1_usize << self.rectangles().len().min(MAX_RECTANGLES);
        self.impulses().iter().flat_map(move |impulse| {
            (0..subsets).map(move |subset| {
                let term = (impulse.time, impulse.weight);
                self.rectangles().iter().enumerate().fold(term, |(at, weight), (bit, duration)| {
                    let late = subset >> bit & 1 == 1;
                    if late { (at + duration, -weight / duration) } else { (at, weight / duration) }
                })
            })
        })
    }
}

fn exponential(z: Complex<f64>) -> Complex<f64> {
    let (sin, cos) = float::sin_cos(z.im);
    Complex::new(cos, sin) * float::exp(z.re)
}

/// (e^z − 1) / z, also where z is small.
fn mean_of_exponential(z: Complex<f64>) -> Complex<f64> {
    const SMALL: f64 = 1e-3;
    if z.norm_sqr() < SMALL * SMALL {
        // The next term is z⁴/120 < 1e-14.
        return Complex::new(1.0, 0.0) + z * (Complex::new(0.5, 0.0) + z * (1.0 / 6.0 + z / 24.0));
    }
    (exponential(z) - 1.0) / z
}
