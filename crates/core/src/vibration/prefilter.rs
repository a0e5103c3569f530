//! The table of prefilters.
//!
//! Sources. ZV, ZVD: Singer & Seering, *Preshaping Command Inputs to Reduce System Vibration*, J. Dyn. Syst. Meas. Control 112
//! (1990). EI, 2HUMP-EI, 3HUMP-EI: Singhose, Seering & Singer, *Residual Vibration Reduction Using Vector Diagrams to Generate Shaped
//! Inputs*, J. Mech. Design 116 (1994), and Singhose, Porter, Tuttle & Singer, *Vibration Reduction Using Multi-Hump Input Shapers*,
//! J. Dyn. Syst. Meas. Control 119 (1997). MZV, and all of these with damping as they stand here: the shapers that the Klipper
//! project documents. FIR, FIR-ZV, FIR-ZVD: Yeh & You (2026), section 3.

use core::fmt;

use super::kernel::{Impulse, Kernel, KernelError};
use super::mode::Mode;
use crate::math::float;

/// Residual vibration that the EI prefilters permit at the modelled frequency.
const TOLERANCE: f64 = 0.05;

/// A way to shape the command so that a mode does not ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prefilter {
    /// The command as it is.
    None,
    /// Zero vibration: two impulses.
    Zv,
    /// Zero vibration, and insensitive to small errors of the frequency: three impulses.
    Zvd,
    /// A moving average over one period.
    Fir,
    /// FIR ∗ ZV.
    FirZv,
    /// FIR ∗ ZVD.
    FirZvd,
    /// Three impulses within three quarters of a period: between ZV and ZVD.
    Mzv,
    /// Extra insensitive: 5 % of the vibration is left at the modelled frequency, and little on either side.
    Ei,
    /// Extra insensitive with two humps.
    TwoHumpEi,
    /// Extra insensitive with three humps.
    ThreeHumpEi,
}

impl Prefilter {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::None,
        Self::Zv,
        Self::Zvd,
        Self::Fir,
        Self::FirZv,
        Self::FirZvd,
        Self::Mzv,
        Self::Ei,
        Self::TwoHumpEi,
        Self::ThreeHumpEi,
    ];

    /// Its name, as the literature writes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Zv => "ZV",
            Self::Zvd => "ZVD",
            Self::Fir => "FIR",
            Self::FirZv => "FIR-ZV",
            Self::FirZvd => "FIR-ZVD",
            Self::Mzv => "MZV",
            Self::Ei => "EI",
            Self::TwoHumpEi => "2HUMP-EI",
            Self::ThreeHumpEi => "3HUMP-EI",
        }
    }

    /// The prefilter of that name; upper and lower case are one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|prefilter| prefilter.name().eq_ignore_ascii_case(name))
    }

    /// The prefilter for a mode.
    ///
    /// # Errors
    /// None for any [`Mode`]; the type is that of the calls it is made of.
    pub fn kernel(self, mode: &Mode) -> Result<Kernel, KernelError> {
        let rectangle = || Kernel::rectangle(mode.period());
        match self {
            Self::None => Ok(Kernel::IDENTITY),
            Self::Fir => rectangle(),
            Self::FirZv => rectangle()?.convolve(&impulses(mode, &ZV, 0.5)?),
            Self::FirZvd => rectangle()?.convolve(&impulses(mode, &ZVD, 0.5)?),
            Self::Zv => impulses(mode, &ZV, 0.5),
            Self::Zvd => impulses(mode, &ZVD, 0.5),
            Self::Mzv => impulses(mode, &mzv(), 0.375),
            Self::Ei => impulses(mode, &ei(), 0.5),
            Self::TwoHumpEi => impulses(mode, &two_hump_ei(), 0.5),
            Self::ThreeHumpEi => impulses(mode, &three_hump_ei(), 0.5),
        }
    }

    /// The prefilter for several modes: one kernel after the other.
    ///
    /// # Errors
    /// More impulses or rectangles than a [`Kernel`] holds.
    pub fn for_modes(self, modes: &[Mode]) -> Result<Kernel, KernelError> {
        modes.iter().try_fold(Kernel::IDENTITY, |kernel, mode| kernel.convolve(&self.kernel(mode)?))
    }
}

impl fmt::Display for Prefilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Amplitudes of an undamped mode, made into impulses every `spacing` of a period, each smaller by what the vibration has decayed since.
fn impulses(mode: &Mode, amplitudes: &[f64], spacing: f64) -> Result<Kernel, KernelError> {
    const MOST: usize = 5;
    // K over half a period, to the power of the spacing in half periods.
    let decay = float::powf(mode.half_period_decay(), 2.0 * spacing);
    let mut train = [Impulse::default(); MOST];
    let mut impulse = Impulse { time: 0.0, weight: 1.0 };
    for (slot, amplitude) in train.iter_mut().zip(amplitudes) {
        *slot = Impulse { weight: amplitude * impulse.weight, ..impulse };
        impulse.time += spacing * mode.period();
        impulse.weight *= decay;
    }
    Kernel::from_impulses(train.get(..amplitudes.len()).unwrap_or_default())
}

const ZV: [f64; 2] = [0.5, 0.5];
const ZVD: [f64; 3] = [0.25, 0.5, 0.25];

fn mzv() -> [f64; 3] {
    let outer = 1.0 - core::f64::consts::FRAC_1_SQRT_2;
    [outer, core::f64::consts::SQRT_2 - 1.0, outer]
}

fn ei() -> [f64; 3] {
    let outer = 0.25 * (1.0 + TOLERANCE);
    [outer, 0.5 * (1.0 - TOLERANCE), outer]
}

fn two_hump_ei() -> [f64; 4] {
    let squared = TOLERANCE * TOLERANCE;
    let x = float::cbrt(squared * (float::sqrt(1.0 - squared) + 1.0));
    let outer = (3.0 * x * x + 2.0 * x + 3.0 * squared) / (16.0 * x);
    [outer, 0.5 - outer, 0.5 - outer, outer]
}

fn three_hump_ei() -> [f64; 5] {
    let outer = 0.0625 * (1.0 + 3.0 * TOLERANCE + 2.0 * float::sqrt(2.0 * TOLERANCE * (TOLERANCE + 1.0)));
    let second = 0.25 * (1.0 - TOLERANCE);
    [outer, second, 0.5 * (1.0 + TOLERANCE) - 2.0 * outer, second, outer]
}
