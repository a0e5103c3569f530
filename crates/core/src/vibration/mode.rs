//! A flexible mode: a damped oscillator that follows the command.

use core::f64::consts::{PI, TAU};
use core::fmt;

use nalgebra::Complex;

use crate::math::float;

/// Damping ratios from here on are not a vibration any more: the prefilters' formulas lose their meaning.
const DAMPING_END: f64 = 0.95;

/// A mode y of the arm: ÿ + 2ζω ẏ + ω² y = ω² x, where x is the command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    omega: f64,
    damping: f64,
}

/// Why there is no such mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeError {
    /// The natural frequency is not a positive, finite number.
    Frequency {
        /// As given, in rad/s.
        omega: f64,
    },
    /// The damping ratio is not in [0, 0.95).
    Damping {
        /// As given.
        damping: f64,
    },
}

impl fmt::Display for ModeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frequency { omega } => {
                write!(f, "natural frequency {omega} rad/s: expected a number above 0")
            }
            Self::Damping { damping } => {
                write!(f, "damping ratio {damping}: expected a number from 0 to below {DAMPING_END}")
            }
        }
    }
}

impl core::error::Error for ModeError {}

impl Mode {
    /// A mode by its undamped natural frequency in rad/s and its damping ratio.
    ///
    /// # Errors
    /// A frequency that is not positive, a damping ratio outside [0, 0.95).
    pub fn try_new(omega: f64, damping: f64) -> Result<Self, ModeError> {
        if !(omega > 0.0 && omega.is_finite()) {
            return Err(ModeError::Frequency { omega });
        }
        if !(0.0..DAMPING_END).contains(&damping) {
            return Err(ModeError::Damping { damping });
        }
        Ok(Self { omega, damping })
    }

    /// Undamped natural frequency ω_n, in rad/s.
    #[must_use]
    pub fn omega(&self) -> f64 {
        self.omega
    }

    /// Damping ratio ζ.
    #[must_use]
    pub fn damping(&self) -> f64 {
        self.damping
    }

    /// √(1 − ζ²): the damped frequency over the undamped one.
    #[must_use]
    pub fn damped_ratio(&self) -> f64 {
        float::sqrt(1.0 - self.damping * self.damping)
    }

    /// Period of the damped vibration T_d, in seconds.
    #[must_use]
    pub fn period(&self) -> f64 {
        TAU / (self.omega * self.damped_ratio())
    }

    /// K = exp(−ζπ/√(1−ζ²)): what half a period leaves of the vibration.
    #[must_use]
    pub fn half_period_decay(&self) -> f64 {
        float::exp(-self.damping * PI / self.damped_ratio())
    }

    /// The pole in the upper half plane, −ζω + jω_d, in rad/s.
    #[must_use]
    pub fn pole(&self) -> Complex<f64> {
        Complex::new(-self.damping * self.omega, self.omega * self.damped_ratio())
    }

    /// The response to a unit step, integrated `order` times over time: zero before the step.
    ///
    /// It is the inverse transform of ω² / (s^(order+1) (s² + 2ζωs + ω²)): a polynomial, which the response approaches,
    /// and the vibration around it.
    #[must_use]
    pub fn step_response(&self, order: u32, time: f64) -> f64 {
        if time <= 0.0 {
            return 0.0;
        }
        let pole = self.pole();
        let residue = self.omega * self.omega / (pole.powu(order + 1) * Complex::new(0.0, 2.0 * pole.im));
        let (sin, cos) = float::sin_cos(pole.im * time);
        let vibration = 2.0 * float::exp(pole.re * time) * (residue.re * cos - residue.im * sin);
        self.trend(order, time) + vibration
    }

    /// Σ gₘ t^(order−m)/(order−m)!, where gₘ are the Taylor coefficients of ω² / (s² + 2ζωs + ω²) at s = 0.
    fn trend(&self, order: u32, time: f64) -> f64 {
        let (mut gain, mut before, mut sum) = (1.0, 0.0, 0.0);
        for m in 0..=order {
            sum += gain * power_over_factorial(time, order - m);
            let next = -(2.0 * self.damping * gain + before / self.omega) / self.omega;
            before = gain;
            gain = next;
        }
        sum
    }
}

/// tⁿ / n!
fn power_over_factorial(time: f64, exponent: u32) -> f64 {
    (1..=exponent).fold(1.0, |product, n| product * time / f64::from(n))
}
