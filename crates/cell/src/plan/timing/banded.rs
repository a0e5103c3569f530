//! Symmetric positive definite systems with three diagonals beside the main one.

/// Diagonals from the main one outwards.
const BAND: usize = 4;

/// The matrix, and in its place the factors L D Lᵀ after [`Banded::factor`].
#[derive(Debug, Clone, Default)]
pub(super) struct Banded {
    /// Row i holds the elements (i, i), (i + 1, i), (i + 2, i), (i + 3, i).
    rows: Vec<[f64; BAND]>,
}

impl Banded {
    pub(super) fn reset(&mut self, size: usize) {
        self.rows.clear();
        self.rows.resize(size, [0.0; BAND]);
    }

    /// Adds a symmetric block with its corner at (`index`, `index`); its lower triangle is read.
    pub(super) fn add(&mut self, index: usize, block: &[[f64; BAND]; BAND]) {
        for (column, row) in self.rows[index..index + BAND].iter_mut().enumerate() {
            for (below, element) in row[..BAND - column].iter_mut().enumerate() {
                *element += block[column + below][column];
            }
        }
    }

    /// Holds an unknown at zero: its row and column become those of the unit matrix.
    pub(super) fn freeze(&mut self, index: usize) {
        self.rows[index] = [1.0, 0.0, 0.0, 0.0];
        for above in 1..BAND.min(index + 1) {
            self.rows[index - above][above] = 0.0;
        }
    }

    /// Factors in place. False where the matrix is not positive definite.
    pub(super) fn factor(&mut self) -> bool {
        for i in 0..self.rows.len() {
            let column = self.rows[i];
            let pivot = column[0];
            if !(pivot > 0.0 && pivot.is_finite()) {
                return false;
            }
            let last = (BAND - 1).min(self.rows.len() - 1 - i);
            for below in 1..=last {
                let factor = column[below] / pivot;
                let row = &mut self.rows[i + below];
                for (element, further) in row.iter_mut().zip(&column[below..=last]) {
                    *element -= factor * further;
                }
                self.rows[i][below] = factor;
            }
        }
        true
    }

    /// Solves with the factors, in place of the right-hand side.
    pub(super) fn solve(&self, x: &mut [f64]) {
        let size = self.rows.len();
        for i in 0..size {
            let value = x[i];
            for below in 1..BAND.min(size - i) {
                x[i + below] -= self.rows[i][below] * value;
            }
        }
        for i in (0..size).rev() {
            let mut value = x[i] / self.rows[i][0];
            for below in 1..BAND.min(size - i) {
                value -= self.rows[i][below] * x[i + below];
            }
            x[i] = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A definite matrix of 37 blocks times a known vector gives that vector back, a frozen unknown zero.
    #[test]
    fn solves_what_it_multiplies() {
        let size = 40;
        let mut matrix = Banded::default();
        let mut full = vec![vec![0.0; size]; size];
        matrix.reset(size);
        for i in 0..=size - BAND {
            let x = i as f64;
            let g = [x.sin(), (1.7 * x).cos(), (0.3 * x).sin() - 0.5, (2.9 * x).cos()];
            let block: [[f64; BAND]; BAND] = core::array::from_fn(|row| {
                core::array::from_fn(|column| g[row] * g[column] + if row == column { 0.1 } else { 0.0 })
            });
            matrix.add(i, &block);
            for row in 0..BAND {
                for column in 0..BAND {
                    full[i + row][i + column] += block[row][column];
                }
            }
        }
        let held = 7;
        matrix.freeze(held);
        let wanted: Vec<f64> =
            (0..size).map(|i| if i == held { 0.0 } else { (2.3 * i as f64).cos() }).collect();
        let mut product: Vec<f64> =
            full.iter().map(|row| row.iter().zip(&wanted).map(|(a, b)| a * b).sum()).collect();
        product[held] = 0.0;
        assert!(matrix.factor());
        matrix.solve(&mut product);
        for (found, wanted) in product.iter().zip(&wanted) {
            assert!((found - wanted).abs() < 1e-10);
        }
    }
}
