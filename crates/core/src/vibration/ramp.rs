//! A feedrate that rises from 0 to 1: a piecewise polynomial, with its integral.

use core::fmt;

use super::kernel::{Kernel, KernelError, MAX_RECTANGLES, same_time};

/// Most pieces of a ramp.
pub const MAX_PIECES: usize = 72;
/// Coefficients of a piece: cubic, as three rectangles make it.
const TERMS: usize = MAX_RECTANGLES + 1;

/// One piece of a ramp: Σ cₙ (t − start)ⁿ for `duration`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RampPiece {
    /// In seconds, > 0.
    pub duration: f64,
    /// From the constant term upwards.
    pub coefficients: [f64; TERMS],
}

impl RampPiece {
    fn value(&self, time: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * time + c)
    }

    fn integral(&self, time: f64) -> f64 {
        const RECIPROCALS: [f64; TERMS] = [1.0, 0.5, 1.0 / 3.0, 0.25];
        let terms = self.coefficients.iter().zip(RECIPROCALS).rev();
        terms.fold(0.0, |sum, (c, r)| sum * time + c * r) * time
    }

    /// The same polynomial seen from a later start.
    fn shifted(&self, by: f64) -> [f64; TERMS] {
        let mut c = self.coefficients;
        // Horner's scheme, once a coefficient: bounded by TERMS².
        for low in 0..TERMS {
            for n in (low..TERMS - 1).rev() {
                c[n] += by * c[n + 1];
            }
        }
        c
    }

    /// Whether it never falls, but for rounding: asked at its ends, in its middle and between.
    fn rises(&self) -> bool {
        const PROBES: u32 = 8;
        let step = self.duration / f64::from(PROBES);
        let mut last = self.value(0.0);
        (1..=PROBES).all(|probe| {
            let value = self.value(f64::from(probe) * step);
            let rises = value >= last - MONOTONE;
            last = value;
            rises
        })
    }
}

/// A fall of the ramp below this is rounding.
const MONOTONE: f64 = 1e-9;
/// Where the pieces end, the ramp is 1 to this.
const ARRIVES: f64 = 1e-9;

/// A feedrate that rises from 0 to 1 in a finite time and never falls on the way; it may jump.
///
/// A segment's acceleration is `feedrate × ramp(t)`, its deceleration `feedrate × (1 − ramp(t))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ramp {
    /// Start, piece, integral up to the start.
    pieces: [Placed; MAX_PIECES],
    count: usize,
    duration: f64,
    /// ∫ of the ramp over its duration.
    area: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Placed {
    start: f64,
    area: f64,
    piece: RampPiece,
}

/// Why there is no such ramp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RampError {
    /// More than [`MAX_PIECES`] pieces.
    TooManyPieces,
    /// A piece without positive duration, or that falls, or starts below the end of the one before.
    Piece {
        /// Its number, from 0.
        index: usize,
    },
    /// The last piece does not end at 1.
    End {
        /// Where it ends.
        value: f64,
    },
    /// The kernel of the ramp.
    Kernel(KernelError),
}

impl fmt::Display for RampError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyPieces => write!(f, "a ramp has at most {MAX_PIECES} pieces"),
            Self::Piece { index } => {
                write!(
                    f,
                    "piece {index} of the ramp: expected a duration above 0 and values that do not fall"
                )
            }
            Self::End { value } => write!(f, "the ramp ends at {value}: expected 1"),
            Self::Kernel(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for RampError {}

impl From<KernelError> for RampError {
    fn from(error: KernelError) -> Self {
        Self::Kernel(error)
    }
}

impl Ramp {
    /// The jump from 0 to 1 at once.
    pub const STEP: Self = Self {
        pieces: [Placed {
            start: 0.0,
            area: 0.0,
            piece: RampPiece { duration: 0.0, coefficients: [0.0; TERMS] },
        }; MAX_PIECES],
        count: 0,
        duration: 0.0,
        area: 0.0,
    };

    /// A step through a kernel.
    ///
    /// # Errors
    /// [`RampError::TooManyPieces`].
    pub fn from_kernel(kernel: &Kernel) -> Result<Self, RampError> {
        let mut ramp = Self::STEP;
        let order = kernel.rectangles().len();
        let mut at = 0.0;
        let mut polynomial = RampPiece::default();
        for _ in 0..=MAX_PIECES {
            // The powers that start here.
            let mut next = f64::INFINITY;
            for (start, weight) in kernel.powers() {
                if same_time(start, at) {
                    if let Some(c) = polynomial.coefficients.get_mut(order) {
                        *c += weight / FACTORIALS[order.min(MAX_RECTANGLES)];
                    }
                } else if start > at {
                    next = next.min(start);
                }
            }
            if next == f64::INFINITY {
                return Ok(ramp);
            }
            polynomial.duration = next - at;
            ramp.push(polynomial)?;
            polynomial.coefficients = polynomial.shifted(next - at);
            at = next;
        }
        Err(RampError::TooManyPieces)
    }

    /// Constant acceleration over a duration, in seconds.
    ///
    /// # Errors
    /// A duration that is not positive.
    pub fn trapezoid(duration: f64) -> Result<Self, RampError> {
        Self::from_kernel(&Kernel::rectangle(duration)?)
    }

    /// The generator's ramp to a feedrate under limits of acceleration and jerk: constant jerk, acceleration, and jerk again. An infinite jerk
    /// makes it a trapezoid.
    ///
    /// # Errors
    /// An argument that is not positive.
    pub fn s_curve(feedrate: f64, acceleration: f64, jerk: f64) -> Result<Self, RampError> {
        if jerk == f64::INFINITY {
            return Self::trapezoid(feedrate / acceleration);
        }
        let (mut whole, mut rise) = (feedrate / acceleration, acceleration / jerk);
        if rise > whole {
            // The acceleration limit is not reached.
            rise = crate::math::float::sqrt(feedrate / jerk);
            whole = rise;
        }
        Self::from_kernel(&Kernel::rectangle(whole)?.convolve(&Kernel::rectangle(rise)?)?)
    }

    /// A ramp by its pieces, one after the other.
    ///
    /// # Errors
    /// Too many pieces, one that falls, or an end that is not 1.
    pub fn from_pieces(pieces: &[RampPiece]) -> Result<Self, RampError> {
        let mut ramp = Self::STEP;
        let mut reached = 0.0;
        for (index, piece) in pieces.iter().enumerate() {
            let starts = piece.value(0.0) >= reached - MONOTONE;
            if !(piece.duration > 0.0 && piece.duration.is_finite() && starts && piece.rises()) {
                return Err(RampError::Piece { index });
            }
            reached = piece.value(piece.duration);
            ramp.push(*piece)?;
        }
        if pieces.is_empty() || (reached - 1.0).abs() <= ARRIVES {
            Ok(ramp)
        } else {
            Err(RampError::End { value: reached })
        }
    }

    /// How long it takes, in seconds.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The ramp at a time: 0 before its start, 1 from its end on.
    #[must_use]
    #[inline]
    pub fn value(&self, time: f64) -> f64 {
        self.value_and_integral(time).0
    }

    /// ∫ of the ramp from its start to a time, in seconds.
    #[must_use]
    #[inline]
    pub fn integral(&self, time: f64) -> f64 {
        self.value_and_integral(time).1
    }

    /// Both at once.
    #[must_use]
    #[inline]
    pub fn value_and_integral(&self, time: f64) -> (f64, f64) {
        if time >= self.duration {
            return (1.0, self.area + (time - self.duration));
        }
        if time < 0.0 {
            return (0.0, 0.0);
        }
        let placed = self.at(time);
        let inside = time - placed.start;
        (placed.piece.value(inside), placed.area + placed.piece.integral(inside))
    }

    /// ∫ of 1 − ramp from a time to the ramp's end: what a deceleration has still to go, over the feedrate.
    ///
    /// Formed from the end, so that its digits survive where little is left.
    #[must_use]
    #[inline]
    pub fn remaining(&self, time: f64) -> f64 {
        if time >= self.duration {
            return 0.0;
        }
        if time < 0.0 {
            return self.duration - self.area - time;
        }
        let (_, integral) = self.value_and_integral(time);
        (self.duration - time) - (self.area - integral)
    }

    /// Where the pieces meet, from the start to the end.
    pub fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.placed().iter().map(|placed| placed.start).chain(core::iter::once(self.duration))
    }

    fn placed(&self) -> &[Placed] {
        self.pieces.get(..self.count).unwrap_or_default()
    }

    fn at(&self, time: f64) -> &Placed {
        let later = self.placed().iter().skip(1).take_while(|placed| placed.start <= time).count();
        self.pieces.get(later).unwrap_or(&self.pieces[0])
    }

    fn push(&mut self, piece: RampPiece) -> Result<(), RampError> {
        let slot = self.pieces.get_mut(self.count).ok_or(RampError::TooManyPieces)?;
        *slot = Placed { start: self.duration, area: self.area, piece };
        self.count += 1;
        self.duration += piece.duration;
        self.area += piece.integral(piece.duration);
        Ok(())
    }
}

const FACTORIALS: [f64; TERMS] = [1.0, 1.0, 2.0, 6.0];
