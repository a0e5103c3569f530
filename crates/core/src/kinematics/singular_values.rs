//! How well an arm can move from where it is: singular values of the Jacobian.

use nalgebra::SMatrix;

use super::Jacobian;
use crate::math::float::sqrt;

/// Sweeps of the Jacobi iteration. It converges quadratically; six columns need at most ten.
const SWEEPS: usize = 30;
/// Columns are orthogonal if their cosine is below this: the next sweep would bring its square.
const ORTHOGONAL: f64 = 1e-9;
/// A column shorter than this part of the matrix is zero but for rounding.
const NEGLIGIBLE: f64 = 1e-16;

/// The Jacobian's singular values, linear rows divided by a characteristic length so that all rows are of one kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingularValues {
    values: [f64; 6],
    count: usize,
}

impl SingularValues {
    /// Of a 6 × N Jacobian: min(6, N) of them. `length` in metres: what a metre of motion counts against a radian.
    ///
    /// One-sided Jacobi rotations (Hestenes 1958; Golub & Van Loan, *Matrix Computations*, 4th ed., § 8.6): exact to
    /// rounding for small values too, at most 30 sweeps.
    #[must_use]
    pub fn of<const N: usize>(jacobian: &Jacobian<N>, length: f64) -> Self {
        let mut scaled = *jacobian;
        scaled.fixed_rows_mut::<3>(0).scale_mut(1.0 / length);
        if N <= 6 { Self::of_columns(scaled) } else { Self::of_columns(scaled.transpose()) }
    }

    fn of_columns<const R: usize, const C: usize>(mut matrix: SMatrix<f64, R, C>) -> Self {
        let negligible = NEGLIGIBLE * NEGLIGIBLE * matrix.norm_squared();
        for _ in 0..SWEEPS {
            let mut worst: f64 = 0.0;
            for j in 1..C {
                for i in 0..j {
                    worst = worst.max(rotate(&mut matrix, (i, j), negligible));
                }
            }
            if worst <= ORTHOGONAL {
                break;
            }
        }
        let mut values = [0.0; 6];
        for (value, column) in values.iter_mut().zip(matrix.column_iter()) {
            *value = column.norm();
        }
        let count = C.min(6);
        values[..count].sort_unstable_by(|a, b| b.total_cmp(a));
        Self { values, count }
    }

    /// The values, greatest first.
    #[must_use]
    pub fn as_slice(&self) -> &[f64] {
        self.values.get(..self.count).unwrap_or(&[])
    }

    /// Yoshikawa's manipulability: the product of the singular values, |det J| of a six-axis arm.
    #[must_use]
    pub fn manipulability(&self) -> f64 {
        self.as_slice().iter().product()
    }

    /// Greatest by least; infinite at a singularity.
    #[must_use]
    pub fn condition_number(&self) -> f64 {
        match self.as_slice() {
            [greatest, .., least] => greatest / least,
            _ => 1.0,
        }
    }
}

/// Makes two columns orthogonal by a rotation, and says how far they were from it (their cosine). A column of no more
/// than `negligible` squared length is left alone.
fn rotate<const R: usize, const C: usize>(
    matrix: &mut SMatrix<f64, R, C>,
    (i, j): (usize, usize),
    negligible: f64,
) -> f64 {
    let (a, b): (SMatrix<f64, R, 1>, SMatrix<f64, R, 1>) =
        (matrix.column(i).into_owned(), matrix.column(j).into_owned());
    let (aa, bb, ab) = (a.norm_squared(), b.norm_squared(), a.dot(&b));
    if ab == 0.0 || aa <= negligible || bb <= negligible {
        return 0.0;
    }
    let zeta = (bb - aa) / (2.0 * ab);
    let tan = 1.0_f64.copysign(zeta) / (zeta.abs() + sqrt(1.0 + zeta * zeta));
    let cos = 1.0 / sqrt(1.0 + tan * tan);
    let sin = cos * tan;
    matrix.set_column(i, &(a * cos - b * sin));
    matrix.set_column(j, &(a * sin + b * cos));
    ab.abs() / sqrt(aa * bb)
}
