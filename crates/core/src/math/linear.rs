//! Small dense systems of equations, on the stack.

use nalgebra::SMatrix;

use super::float::sqrt;

/// Cholesky factor L of a symmetric positive definite matrix, A = L·Lᵀ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cholesky<const N: usize> {
    /// Column i holds L's column i below the diagonal; the diagonal holds reciprocals.
    factor: [[f64; N]; N],
}

impl<const N: usize> Cholesky<N> {
    /// Factorizes a matrix, of which only the lower triangle is read. Nothing if it is not positive definite.
    #[inline]
    #[must_use]
    pub fn new(matrix: &SMatrix<f64, N, N>) -> Option<Self> {
        let mut factor = [[0.0; N]; N];
        for j in 0..N {
            for i in j..N {
                factor[j][i] = matrix[(i, j)];
            }
        }
        for j in 0..N {
            let pivot = factor[j][j];
            let positive = pivot > 0.0;
            if !positive {
                return None;
            }
            let reciprocal = 1.0 / sqrt(pivot);
            factor[j][j] = reciprocal;
            for below in &mut factor[j][j + 1..] {
                *below *= reciprocal;
            }
            let column = factor[j];
            for k in j + 1..N {
                for (place, below) in factor[k][k..].iter_mut().zip(&column[k..]) {
                    *place -= column[k] * below;
                }
            }
        }
        Some(Self { factor })
    }

    /// x with A·x = b.
    #[inline]
    #[must_use]
    pub fn solve(&self, b: &[f64; N]) -> [f64; N] {
        let mut x = *b;
        for j in 0..N {
            x[j] *= self.factor[j][j];
            for i in j + 1..N {
                x[i] -= self.factor[j][i] * x[j];
            }
        }
        for j in (0..N).rev() {
            for i in j + 1..N {
                x[j] -= self.factor[j][i] * x[i];
            }
            x[j] *= self.factor[j][j];
        }
        x
    }
}

/// Orthogonal factorization A = Q·R of a matrix with at least as many rows as columns: Gram–Schmidt, each column
/// orthogonalized twice, which makes Q orthogonal to rounding (Giraud, Langou, Rozložník 2005).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrthogonalFactors<const R: usize, const C: usize> {
    q: SMatrix<f64, R, C>,
    r: SMatrix<f64, C, C>,
}

impl<const R: usize, const C: usize> OrthogonalFactors<R, C> {
    /// Factorizes a matrix. Where a column lies in the span of those before it to within `dependent` of its length,
    /// the answer is that part of its length that is left.
    ///
    /// # Errors
    /// The part of the length that is left, for a matrix without full rank.
    pub fn new(matrix: &SMatrix<f64, R, C>, dependent: f64) -> Result<Self, f64> {
        let (mut q, mut r) = (*matrix, SMatrix::<f64, C, C>::zeros());
        for j in 0..C {
            let mut column = q.column(j).into_owned();
            let length = column.norm();
            for _ in 0..2 {
                for i in 0..j {
                    let share = q.column(i).dot(&column);
                    r[(i, j)] += share;
                    column -= q.column(i) * share;
                }
            }
            let left = column.norm();
            let independent = left > dependent * length;
            if !independent {
                return Err(if length > 0.0 { left / length } else { 0.0 });
            }
            r[(j, j)] = left;
            q.set_column(j, &(column / left));
        }
        Ok(Self { q, r })
    }

    /// x with least |A·x − b|.
    #[must_use]
    pub fn least_squares(&self, b: &SMatrix<f64, R, 1>) -> [f64; C] {
        let mut x = [0.0; C];
        for i in (0..C).rev() {
            let known: f64 = (i + 1..C).map(|k| self.r[(i, k)] * x[k]).sum();
            x[i] = (self.q.column(i).dot(b) - known) / self.r[(i, i)];
        }
        x
    }

    /// x of least length with Aᵀ·x = b.
    #[must_use]
    pub fn least_norm_of_transposed(&self, b: &[f64; C]) -> SMatrix<f64, R, 1> {
        let mut x = SMatrix::<f64, R, 1>::zeros();
        let mut share = *b;
        for i in 0..C {
            for k in 0..i {
                share[i] -= self.r[(k, i)] * share[k];
            }
            share[i] /= self.r[(i, i)];
            x += self.q.column(i) * share[i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hilbert's matrix shifted: symmetric, positive definite, badly conditioned without being hopeless.
    fn symmetric() -> SMatrix<f64, 4, 4> {
        SMatrix::from_fn(|i, j| 1.0 / (1.0 + (i + j) as f64) + if i == j { 0.01 } else { 0.0 })
    }

    #[test]
    fn cholesky_solves_and_refuses() {
        let x = [1.0, -2.0, 3.0, 0.5];
        let b = symmetric() * SMatrix::<f64, 4, 1>::from(x);
        let factor = Cholesky::new(&symmetric()).unwrap();
        for (got, expected) in factor.solve(&[b[0], b[1], b[2], b[3]]).iter().zip(x) {
            assert!((got - expected).abs() < 1e-12);
        }
        let indefinite = SMatrix::<f64, 2, 2>::new(1.0, 2.0, 2.0, 1.0);
        assert!(Cholesky::new(&indefinite).is_none());
        assert!(Cholesky::new(&SMatrix::<f64, 1, 1>::new(f64::NAN)).is_none());
    }

    #[test]
    fn least_squares_leaves_an_orthogonal_rest() {
        let a =
            SMatrix::<f64, 6, 4>::from_fn(|i, j| ((i * 7 + j * 3) % 5) as f64 - 1.5 + i as f64 * j as f64);
        let b = SMatrix::<f64, 6, 1>::from_fn(|i, _| (i as f64 - 2.0).powi(2));
        let x = OrthogonalFactors::new(&a, 1e-12).unwrap().least_squares(&b);
        let rest = a * SMatrix::<f64, 4, 1>::from(x) - b;
        assert!((a.transpose() * rest).norm() < 1e-11);
        assert!(rest.norm() > 0.1);
    }

    #[test]
    fn least_norm_lies_in_the_row_space() {
        let a = SMatrix::<f64, 5, 3>::from_fn(|i, j| ((i * i + 2 * j) % 7) as f64 - 2.0);
        let b = [1.0, 2.0, -1.0];
        let factors = OrthogonalFactors::new(&a, 1e-12).unwrap();
        let x = factors.least_norm_of_transposed(&b);
        assert!((a.transpose() * x - SMatrix::<f64, 3, 1>::from(b)).norm() < 1e-13);
        let inside = a * SMatrix::<f64, 3, 1>::from(factors.least_squares(&x));
        assert!((inside - x).norm() < 1e-13);
    }

    #[test]
    fn dependent_columns_are_refused() {
        let a = SMatrix::<f64, 3, 2>::new(1.0, 2.0, 2.0, 4.0, 3.0, 6.0);
        assert!(OrthogonalFactors::new(&a, 1e-12).is_err_and(|left| left < 1e-15));
    }
}
