//! One period of a weave without units: amplitude 1, period 1.

use core::f64::consts::TAU;

use super::{WeaveError, WeaveShape};
use crate::math::float::{floor, hypot};
use crate::math::taylor::Taylor;
use crate::timed::Shape;

/// The shape of a weave, seen along the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// A sine across the seam; with dwells, swings of constant jerk between them.
    Sine,
    /// Straight swings across the seam, with their turns rounded over a quarter of each swing.
    Triangle,
    /// A figure of eight: a sine across, and half of it with twice the frequency along the seam.
    FigureEight,
    /// A circle.
    Circular,
}

/// Ramps of a swing as a share of its duration: the least jerk, and a straight middle.
const GENTLE: f64 = 0.5;
const STRAIGHT: f64 = 0.25;
/// Dwells leave at least this share of the period to swing.
const LEAST_SWING: f64 = 0.1;
/// Hold and swing, twice, with a hold in the middle of each swing.
const PARTS: usize = 8;

/// One period.
#[allow(clippy::large_enum_variant, reason = "without a heap there is no place for it but here")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Period {
    /// Sines across and along the travel: amplitude and how many in a period.
    Harmonic { along: (f64, f64), cosine: bool },
    /// From edge to edge with rests between.
    Swings(Swings),
}

/// Rests and swings in their order, from the left edge on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Swings {
    shape: Shape,
    parts: [Part; PARTS],
    /// Where the period begins: in the middle, on the way to the left edge.
    start: f64,
}

/// From one place across the seam to another in a share of the period; a rest where they agree.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Part {
    begins: f64,
    lasts: f64,
    from: f64,
    to: f64,
}

impl Period {
    pub(super) fn try_new(shape: &WeaveShape) -> Result<Self, WeaveError> {
        let WeaveShape { amplitude, wavelength, dwells: [left, middle, right], tilt, elevation, .. } = *shape;
        if !(amplitude >= 0.0 && amplitude.is_finite()) {
            return Err(WeaveError::Amplitude { value: amplitude });
        }
        if !(wavelength > 0.0 && wavelength.is_finite()) {
            return Err(WeaveError::Wavelength { value: wavelength });
        }
        if !(tilt.is_finite() && elevation.is_finite()) {
            return Err(WeaveError::NotFinite);
        }
        let share = left + 2.0 * middle + right;
        // Written so that NaN fails.
        if !(left >= 0.0 && middle >= 0.0 && right >= 0.0 && share <= 1.0 - LEAST_SWING) {
            return Err(WeaveError::Dwells { share });
        }
        let swings = |ratio| Self::Swings(Swings::new(ratio, [left, middle, right]));
        match shape.pattern {
            Pattern::Sine if share > 0.0 => Ok(swings(GENTLE)),
            Pattern::Sine => Ok(Self::Harmonic { along: (0.0, 0.0), cosine: false }),
            Pattern::Triangle => Ok(swings(STRAIGHT)),
            Pattern::FigureEight | Pattern::Circular if share > 0.0 => Err(WeaveError::NoDwells),
            Pattern::FigureEight => Ok(Self::Harmonic { along: (0.5, 2.0), cosine: false }),
            Pattern::Circular => Ok(Self::Harmonic { along: (1.0, 1.0), cosine: true }),
        }
    }

    /// Along and across the travel after so many periods, with derivatives by the period.
    pub(super) fn at(&self, periods: f64) -> [Taylor; 2] {
        let phase = periods - floor(periods);
        match self {
            Self::Harmonic { along: (amplitude, times), cosine } => {
                let (across, _) = turning(phase, 1.0);
                let (sine, cosine_part) = turning(phase, *times);
                [(if *cosine { cosine_part } else { sine }) * *amplitude, across]
            }
            Self::Swings(swings) => [Taylor::constant(0.0), swings.at(phase)],
        }
    }

    /// It has no part along the travel.
    pub(super) fn is_across(&self) -> bool {
        match self {
            Self::Harmonic { along: (amplitude, _), .. } => *amplitude == 0.0,
            Self::Swings(_) => true,
        }
    }

    /// Bounds on the first three derivatives by the period.
    pub(super) fn peaks(&self) -> [f64; 3] {
        match self {
            Self::Harmonic { along: (amplitude, times), .. } => {
                let power = |n: i32| {
                    let along = amplitude * powi(TAU * times, n);
                    let across = powi(TAU, n);
                    // A circle's two parts are a quarter apart; an eight's peaks may meet.
                    if *times == 1.0 { across.max(along) } else { hypot(across, along) }
                };
                [power(1), power(2), power(3)]
            }
            Self::Swings(swings) => swings.peaks(),
        }
    }
}

/// xⁿ for small n.
fn powi(x: f64, n: i32) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}

/// Sine and cosine of so many turns in a period.
fn turning(phase: f64, times: f64) -> (Taylor, Taylor) {
    Taylor::from_derivatives(TAU * times * phase, TAU * times, 0.0, 0.0).sin_cos()
}

impl Swings {
    fn new(ratio: f64, [left, middle, right]: [f64; 3]) -> Self {
        let half = 0.25 * (1.0 - left - right - 2.0 * middle);
        // Without a rest in the middle a swing goes through in one.
        let (to_middle, through) = if middle > 0.0 { (half, half) } else { (2.0 * half, 0.0) };
        let stop = |edge: f64| if middle > 0.0 { 0.0 } else { -edge };
        let order = [
            (left, 1.0, 1.0),
            (to_middle, 1.0, stop(1.0)),
            (middle, 0.0, 0.0),
            (through, 0.0, -1.0),
            (right, -1.0, -1.0),
            (to_middle, -1.0, stop(-1.0)),
            (middle, 0.0, 0.0),
            (through, 0.0, 1.0),
        ];
        let (mut parts, mut begins) = ([Part::default(); PARTS], 0.0);
        for (part, (lasts, from, to)) in parts.iter_mut().zip(order) {
            *part = Part { begins, lasts, from, to };
            begins += lasts;
        }
        // The last part's way from the middle to the left edge takes this long, begun there or passed.
        Self { shape: Shape::new(ratio), parts, start: 1.0 - half }
    }

    fn at(&self, phase: f64) -> Taylor {
        let shifted = phase + self.start;
        let place = shifted - floor(shifted);
        let part = self.parts.iter().rev().find(|part| part.lasts > 0.0 && part.begins <= place);
        let Some(part) = part else { return Taylor::constant(0.0) };
        let (way, rate) = (part.to - part.from, 1.0 / part.lasts);
        let share = ((place - part.begins) * rate).min(1.0);
        let point = self.shape.at(share);
        Taylor::from_derivatives(
            part.from + way * point.displacement,
            way * rate * point.velocity,
            way * rate * rate * point.acceleration,
            way * rate * rate * rate * point.jerk,
        )
    }

    fn peaks(&self) -> [f64; 3] {
        let Shape { velocity, acceleration, jerk, .. } = self.shape;
        let moving = self.parts.iter().filter(|part| part.lasts > 0.0);
        moving.fold([0.0; 3], |[v, a, j], part| {
            let (way, rate) = ((part.to - part.from).abs(), 1.0 / part.lasts);
            let speed = way * rate;
            [
                f64::max(v, speed * velocity),
                f64::max(a, speed * rate * acceleration),
                f64::max(j, speed * rate * rate * jerk),
            ]
        })
    }
}
