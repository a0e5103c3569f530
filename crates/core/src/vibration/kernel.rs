//! What a prefilter is: a train of impulses, convolved with rectangles, in continuous time.

use core::fmt;

/// Most impulses of a kernel: three modes of ZVD, or two of 3HUMP-EI.
pub const MAX_IMPULSES: usize = 32;
/// Most rectangles of a kernel.
pub const MAX_RECTANGLES: usize = 3;

/// One impulse of a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Impulse {
    /// Delay, in seconds, ≥ 0.
    pub time: f64,
    /// Share of the command that comes at that delay, > 0.
    pub weight: f64,
}

/// Σ wᵢ δ(t − tᵢ) ∗ rect(T₁) ∗ rect(T₂) ∗ …, with Σ wᵢ = 1 and each rectangle of area 1 on [0, T].
///
/// Every prefilter has this form, and so have the trapezoid (one rectangle) and the S-curve (two) as ramps. Times are exact: nothing is
/// rounded to cycles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kernel {
    impulses: [Impulse; MAX_IMPULSES],
    impulse_count: usize,
    rectangles: [f64; MAX_RECTANGLES],
    rectangle_count: usize,
}

/// Why there is no such kernel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KernelError {
    /// More impulses than [`MAX_IMPULSES`], or none.
    ImpulseCount {
        /// How many there would be.
        count: usize,
    },
    /// More rectangles than [`MAX_RECTANGLES`].
    RectangleCount {
        /// How many there would be.
        count: usize,
    },
    /// An impulse before zero or without a positive weight, or either is not finite.
    Impulse {
        /// The impulse.
        impulse: Impulse,
    },
    /// A rectangle whose duration is not positive and finite.
    Rectangle {
        /// As given, in seconds.
        duration: f64,
    },
}

impl fmt::Display for KernelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ImpulseCount { count } => {
                write!(f, "{count} impulses: a kernel has from 1 to {MAX_IMPULSES}")
            }
            Self::RectangleCount { count } => {
                write!(f, "{count} rectangles: a kernel has at most {MAX_RECTANGLES}")
            }
            Self::Impulse { impulse: Impulse { time, weight } } => {
                write!(f, "impulse of weight {weight} at {time} s: expected a weight above 0 at or after 0 s")
            }
            Self::Rectangle { duration } => {
                write!(f, "rectangle of {duration} s: expected a duration above 0")
            }
        }
    }
}

impl core::error::Error for KernelError {}

impl Kernel {
    /// The kernel that changes nothing.
    pub const IDENTITY: Self = {
        let mut impulses = [Impulse { time: 0.0, weight: 0.0 }; MAX_IMPULSES];
        impulses[0].weight = 1.0;
        Self { impulses, impulse_count: 1, rectangles: [0.0; MAX_RECTANGLES], rectangle_count: 0 }
    };

    /// A train of impulses. Weights are scaled to the sum 1; impulses at one and the same time become one.
    ///
    /// # Errors
    /// None or too many impulses, a negative time, a weight that is not positive.
    pub fn from_impulses(impulses: &[Impulse]) -> Result<Self, KernelError> {
        let mut kernel = Self { impulse_count: 0, ..Self::IDENTITY };
        for impulse in impulses {
            let finite = (impulse.time + impulse.weight).is_finite();
            if !(impulse.time >= 0.0 && impulse.weight > 0.0 && finite) {
                return Err(KernelError::Impulse { impulse: *impulse });
            }
            kernel.add(*impulse)?;
        }
        if kernel.impulse_count == 0 {
            return Err(KernelError::ImpulseCount { count: 0 });
        }
        kernel.normalize();
        Ok(kernel)
    }

    /// One rectangle of unit area: a moving average.
    ///
    /// # Errors
    /// A duration that is not positive and finite.
    pub fn rectangle(duration: f64) -> Result<Self, KernelError> {
        if !(duration > 0.0 && duration.is_finite()) {
            return Err(KernelError::Rectangle { duration });
        }
        let mut kernel = Self { rectangle_count: 1, ..Self::IDENTITY };
        kernel.rectangles[0] = duration;
        Ok(kernel)
    }

    /// Both kernels one after the other: their order does not matter.
    ///
    /// # Errors
    /// The product has too many impulses or rectangles.
    pub fn convolve(&self, other: &Self) -> Result<Self, KernelError> {
        let mut product = Self { impulse_count: 0, ..Self::IDENTITY };
        for a in self.impulses() {
            for b in other.impulses() {
                product.add(Impulse { time: a.time + b.time, weight: a.weight * b.weight })?;
            }
        }
        let count = self.rectangle_count + other.rectangle_count;
        let slots = product.rectangles.get_mut(..count).ok_or(KernelError::RectangleCount { count })?;
        for (slot, duration) in slots.iter_mut().zip(self.rectangles().iter().chain(other.rectangles())) {
            *slot = *duration;
        }
        product.rectangle_count = count;
        product.normalize();
        Ok(product)
    }

    /// The impulses, earliest first.
    #[must_use]
    pub fn impulses(&self) -> &[Impulse] {
        self.impulses.get(..self.impulse_count).unwrap_or_default()
    }

    /// The durations of the rectangles, in seconds.
    #[must_use]
    pub fn rectangles(&self) -> &[f64] {
        self.rectangles.get(..self.rectangle_count).unwrap_or_default()
    }

    /// When the last of the command has come out, in seconds after it went in.
    #[must_use]
    pub fn length(&self) -> f64 {
        let last = self.impulses().last().map_or(0.0, |impulse| impulse.time);
        last + self.rectangles().iter().sum::<f64>()
    }

    /// How far the output lags behind a command of constant rate, in seconds: the kernel's centre.
    #[must_use]
    pub fn delay(&self) -> f64 {
        let impulses: f64 = self.impulses().iter().map(|impulse| impulse.weight * impulse.time).sum();
        impulses + 0.5 * self.rectangles().iter().sum::<f64>()
    }

    /// Mean square of the delays about [`Kernel::delay`], in seconds².
    #[must_use]
    pub fn variance(&self) -> f64 {
        let impulses = self.impulses();
        let centre: f64 = impulses.iter().map(|impulse| impulse.weight * impulse.time).sum();
        let square = |impulse: &Impulse| impulse.weight * (impulse.time - centre) * (impulse.time - centre);
        let rectangles = self.rectangles().iter().map(|duration| duration * duration / 12.0);
        impulses.iter().map(square).sum::<f64>() + rectangles.sum::<f64>()
    }

    /// Puts an impulse in its place, or adds it to the one that is there.
    fn add(&mut self, impulse: Impulse) -> Result<(), KernelError> {
        let used = self.impulses.get_mut(..self.impulse_count).unwrap_or_default();
        if let Some(there) = used.iter_mut().find(|there| same_time(there.time, impulse.time)) {
            there.weight += impulse.weight;
            return Ok(());
        }
        let place = used.iter().filter(|there| there.time < impulse.time).count();
        let count = self.impulse_count + 1;
        let grown = self.impulses.get_mut(place..count).ok_or(KernelError::ImpulseCount { count })?;
        grown.rotate_right(1);
        if let Some(free) = grown.first_mut() {
            *free = impulse;
        }
        self.impulse_count = count;
        Ok(())
    }

    fn normalize(&mut self) {
        let sum: f64 = self.impulses().iter().map(|impulse| impulse.weight).sum();
        for impulse in &mut self.impulses {
            impulse.weight /= sum;
        }
    }
}

/// Equal but for the rounding of a sum of delays.
pub(super) fn same_time(a: f64, b: f64) -> bool {
    const ROUNDING: f64 = 1e-13;
    (a - b).abs() <= ROUNDING * a.abs().max(b.abs())
}
