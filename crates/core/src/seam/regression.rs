//! Local regression over path length (Cleveland 1979), made robust by one bisquare re-weighting.

use nalgebra::SMatrix;

use super::Offset;
use super::bins::Bins;
use super::gate::median;
use crate::math::linear::Cholesky;

/// Bins in a window at most.
const WINDOW: usize = 128;
/// Highest degree.
const DEGREE: usize = 3;
/// Residuals are not told apart below this, in metres.
const LEAST_SCALE: f64 = 5e-6;

/// The offset as a polynomial of path length about a centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Polynomial {
    pub(super) centre: f64,
    /// Of powers of (s − centre), in metres.
    pub(super) coefficients: [Offset; DEGREE + 1],
}

impl Polynomial {
    pub(super) fn at(&self, s: f64) -> Offset {
        let x = s - self.centre;
        self.coefficients.iter().rev().fold(Offset::zeros(), |sum, c| sum * x + c)
    }

    pub(super) fn slope(&self, s: f64) -> Offset {
        let x = s - self.centre;
        let [_, c1, c2, c3] = self.coefficients;
        c1 + (c2 * 2.0 + c3 * (3.0 * x)) * x
    }

    pub(super) fn curvature(&self, s: f64) -> Offset {
        let [_, _, c2, c3] = self.coefficients;
        c2 * 2.0 + c3 * (6.0 * (s - self.centre))
    }
}

/// What counts in a fit, and how much.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Window {
    /// Around a place, less and less up to `half` metres from it: (1 − |x/half|³)³.
    Tricube { centre: f64, half: f64 },
    /// All of a stretch alike.
    Even { from: f64, to: f64 },
}

impl Window {
    fn span(&self) -> (f64, f64) {
        match *self {
            Self::Tricube { centre, half } => (centre - half, centre + half),
            Self::Even { from, to } => (from, to),
        }
    }

    /// The weight at x, which runs from −1 to 1 over the span.
    fn weight(&self, x: f64) -> f64 {
        match self {
            Self::Tricube { .. } => {
                let rest = 1.0 - x.abs() * x * x;
                rest * rest * rest
            }
            Self::Even { .. } => 1.0,
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    x: f64,
    offset: Offset,
    weight: f64,
}

/// The polynomial of `degree` (3 at most, less where there are too few bins) through the readings in a window. `None` without any.
///
/// Cost: two passes over the window's bins, 128 at most.
pub(super) fn fit(bins: &Bins, window: Window, degree: usize) -> Option<Polynomial> {
    let (from, to) = window.span();
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut held = [Sample { x: 0.0, offset: Offset::zeros(), weight: 0.0 }; WINDOW];
    let mut count = 0;
    for (sample, bin) in held.iter_mut().zip(bins.between(from, to)) {
        let x = (bin.s - centre) / half;
        *sample = Sample { x, offset: bin.offset, weight: bin.count * window.weight(x) };
        count += 1;
    }
    let samples = &mut held[..count];
    // A parabola through three bins would be all noise.
    let degree = degree.min(count / 2);
    let first = solve(samples, degree)?;
    reweigh(samples, &first);
    let coefficients = solve(samples, degree).unwrap_or(first);
    let mut power = 1.0;
    let coefficients = coefficients.map(|c| {
        let scaled = c / power;
        power *= half;
        scaled
    });
    Some(Polynomial { centre, coefficients })
}

/// Bisquare weights (1 − (r/6m)²)² with the median residual m.
fn reweigh(samples: &mut [Sample], fitted: &[Offset; DEGREE + 1]) {
    let mut residuals = [0.0; WINDOW];
    for (residual, sample) in residuals.iter_mut().zip(samples.iter()) {
        let value = fitted.iter().rev().fold(Offset::zeros(), |sum, c| sum * sample.x + c);
        *residual = (sample.offset - value).norm();
    }
    let mut sorted = residuals;
    let scale = 6.0 * median(&mut sorted[..samples.len()]).max(LEAST_SCALE);
    for (sample, residual) in samples.iter_mut().zip(residuals) {
        let ratio = residual / scale;
        let rest = (1.0 - ratio * ratio).max(0.0);
        sample.weight *= rest * rest;
    }
}

/// Least squares of one degree, or the highest below it that the samples determine.
fn solve(samples: &[Sample], degree: usize) -> Option<[Offset; DEGREE + 1]> {
    let mut moments = [0.0; 2 * DEGREE + 1];
    let mut values = [Offset::zeros(); DEGREE + 1];
    for sample in samples {
        let mut power = sample.weight;
        for (k, moment) in moments.iter_mut().enumerate() {
            *moment += power;
            if let Some(value) = values.get_mut(k) {
                *value += sample.offset * power;
            }
            power *= sample.x;
        }
    }
    let cubic = || normal_equations::<4>(&moments, &values);
    let quadratic = || normal_equations::<3>(&moments, &values);
    let linear = || normal_equations::<2>(&moments, &values);
    let constant = || normal_equations::<1>(&moments, &values);
    match degree {
        0 => constant(),
        1 => linear().or_else(constant),
        2 => quadratic().or_else(linear).or_else(constant),
        _ => cubic().or_else(quadratic).or_else(linear).or_else(constant),
    }
}

fn normal_equations<const N: usize>(moments: &[f64], values: &[Offset]) -> Option<[Offset; DEGREE + 1]> {
    let matrix =
        SMatrix::<f64, N, N>::from_fn(|i, j| moments[i + j] + if i == j { moments[0] * 1e-12 } else { 0.0 });
    let factor = Cholesky::new(&matrix)?;
    let mut coefficients = [Offset::zeros(); DEGREE + 1];
    for axis in 0..2 {
        let solved = factor.solve(&core::array::from_fn(|i| values[i][axis]));
        for (coefficient, value) in coefficients.iter_mut().zip(solved) {
            coefficient[axis] = value;
        }
    }
    Some(coefficients)
}
