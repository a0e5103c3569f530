//! Least squares: all components at once, by Levenberg's and Marquardt's method.

use nalgebra::{DMatrix, DVector, Matrix2};

/// e^(−decay·t) (cosine · cos ωt + sine · sin ωt), with ω the damped frequency.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Component {
    pub(super) cosine: f64,
    pub(super) sine: f64,
    /// In 1/s.
    pub(super) decay: f64,
    /// In rad/s.
    pub(super) omega: f64,
}

const PER_COMPONENT: usize = 4;
/// Bound of the steps; ten are usual.
const MAX_STEPS: usize = 200;
/// A step that betters the sum of squares by less than this share is the last.
const CONVERGED: f64 = 1e-12;

impl Component {
    pub(super) fn amplitude(&self) -> f64 {
        self.cosine.hypot(self.sine)
    }

    /// Value, and derivatives with respect to cosine, sine, decay and omega.
    fn at(&self, time: f64) -> (f64, [f64; PER_COMPONENT]) {
        let envelope = (-self.decay * time).exp();
        let (sin, cos) = (self.omega * time).sin_cos();
        let (cos, sin) = (envelope * cos, envelope * sin);
        let value = self.cosine * cos + self.sine * sin;
        (value, [cos, sin, -time * value, time * (self.sine * cos - self.cosine * sin)])
    }
}

/// A fit: an offset and components.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub(super) components: Vec<Component>,
    offset: f64,
    pub(super) residual_rms: f64,
    covariance: DMatrix<f64>,
}

impl Fit {
    pub(super) fn values(&self, times: &[f64]) -> Vec<f64> {
        times.iter().map(|t| self.offset + self.components.iter().map(|c| c.at(*t).0).sum::<f64>()).collect()
    }

    pub(super) fn residual(&self, times: &[f64], values: &[f64]) -> Vec<f64> {
        self.values(times).iter().zip(values).map(|(fitted, value)| value - fitted).collect()
    }

    /// Covariance of decay and omega of a component.
    pub(super) fn covariance(&self, index: usize) -> Matrix2<f64> {
        let first = 1 + PER_COMPONENT * index + 2;
        self.covariance.fixed_view::<2, 2>(first, first).into_owned()
    }
}

/// The normal equations at one place: JᵀJ, Jᵀr, rᵀr.
struct Normal {
    matrix: DMatrix<f64>,
    gradient: DVector<f64>,
    squares: f64,
}

impl Normal {
    fn at(times: &[f64], values: &[f64], offset: f64, components: &[Component]) -> Self {
        let count = 1 + PER_COMPONENT * components.len();
        let mut matrix = DMatrix::zeros(count, count);
        let mut gradient = DVector::zeros(count);
        let mut squares = 0.0;
        let mut row = vec![1.0; count];
        for (time, value) in times.iter().zip(values) {
            let mut residual = value - offset;
            for (component, slots) in components.iter().zip(row[1..].chunks_exact_mut(PER_COMPONENT)) {
                let (fitted, slopes) = component.at(*time);
                residual -= fitted;
                slots.copy_from_slice(&slopes);
            }
            squares += residual * residual;
            for i in 0..count {
                gradient[i] += row[i] * residual;
                for j in 0..=i {
                    matrix[(i, j)] += row[i] * row[j];
                }
            }
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        Self { matrix, gradient, squares }
    }

    /// Marquardt's step: each diagonal entry grows by the same share.
    fn step(&self, damping: f64) -> Option<DVector<f64>> {
        let mut matrix = self.matrix.clone();
        for i in 0..matrix.nrows() {
            matrix[(i, i)] *= 1.0 + damping;
        }
        Some(matrix.cholesky()?.solve(&self.gradient))
    }
}

/// Fits all components together, from where they stand; none where the fit does not determine them.
pub(super) fn refine(times: &[f64], values: &[f64], start: &[Component]) -> Option<Fit> {
    let (mut offset, mut components) = (0.0, start.to_vec());
    let mut normal = Normal::at(times, values, offset, &components);
    let mut damping = 1e-3;
    for _ in 0..MAX_STEPS {
        let Some(step) = normal.step(damping) else {
            damping = 10.0 * damping.max(1e-12);
            continue;
        };
        let (next_offset, next) = moved(offset, &components, &step);
        let tried = Normal::at(times, values, next_offset, &next);
        if tried.squares < normal.squares {
            let gain = normal.squares - tried.squares;
            let last = gain <= CONVERGED * normal.squares;
            (offset, components, normal) = (next_offset, next, tried);
            damping *= 0.1;
            if last {
                break;
            }
        } else {
            damping = 10.0 * damping.max(1e-12);
            if damping > 1e12 {
                break;
            }
        }
    }
    let count = normal.gradient.len();
    let variance = normal.squares / times.len().saturating_sub(count).max(1) as f64;
    let covariance = normal.matrix.cholesky()?.inverse() * variance;
    Some(Fit { components, offset, residual_rms: (normal.squares / times.len() as f64).sqrt(), covariance })
}

fn moved(offset: f64, components: &[Component], step: &DVector<f64>) -> (f64, Vec<Component>) {
    let steps = step.as_slice();
    let next = components.iter().zip(steps[1..].chunks_exact(PER_COMPONENT)).map(|(c, by)| Component {
        cosine: c.cosine + by[0],
        sine: c.sine + by[1],
        decay: c.decay + by[2],
        omega: c.omega + by[3],
    });
    (offset + steps[0], next.collect())
}
