//! The complex LU of one spectral line, its memory kept for the next.

use num_complex::Complex64;

/// The matrix has no inverse to working precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is singular to working precision")]
pub struct Singular;

/// Dense complex LU with row equilibration and partial pivoting; keeps its memory from one
/// spectral line to the next.
///
/// Rows are scaled before pivots are compared, because forces and moments share a matrix here.
#[derive(Debug, Clone, Default)]
pub struct LuWorkspace {
    order: usize,
    factors: Vec<Complex64>,
    pivots: Vec<usize>,
    row_scale: Vec<f64>,
    scratch: Vec<Complex64>,
}

impl LuWorkspace {
    /// A workspace for matrices of any order.
    pub fn new() -> Self {
        Self::default()
    }

    /// Factorises the `order` × `order` matrix that `fill` writes row by row.
    ///
    /// # Errors
    /// [`Singular`] where a row is zero, a pivot vanishes or an element is not finite.
    pub fn factorize(&mut self, order: usize, fill: impl FnOnce(&mut [Complex64])) -> Result<(), Singular> {
        self.order = order;
        self.factors.clear();
        self.factors.resize(order * order, Complex64::ZERO);
        fill(&mut self.factors);
        self.equilibrate_rows()?;
        self.pivots.clear();
        for column in 0..order {
            let pivot = self.largest_below(column);
            self.pivots.push(pivot);
            if pivot != column {
                for j in 0..order {
                    self.factors.swap(column * order + j, pivot * order + j);
                }
            }
            let diagonal = self.factors[column * order + column];
            // Rows were scaled to size one, so a pivot of rounding size is a zero.
            if diagonal.l1_norm() < 1e-15 {
                return Err(Singular);
            }
            let inverse = diagonal.inv();
            for i in column + 1..order {
                let factor = self.factors[i * order + column] * inverse;
                self.factors[i * order + column] = factor;
                let (upper, lower) = self.factors.split_at_mut(i * order);
                let pivot_row = &upper[column * order + column + 1..(column + 1) * order];
                for (target, source) in lower[column + 1..order].iter_mut().zip(pivot_row) {
                    *target -= factor * source;
                }
            }
        }
        Ok(())
    }

    fn equilibrate_rows(&mut self) -> Result<(), Singular> {
        self.row_scale.clear();
        for row in self.factors.chunks_exact_mut(self.order.max(1)) {
            let largest = row.iter().map(|e| e.l1_norm()).fold(0.0, f64::max);
            let sum: f64 = row.iter().map(|e| e.l1_norm()).sum();
            if largest == 0.0 || !sum.is_finite() {
                return Err(Singular);
            }
            let scale = 1.0 / largest;
            row.iter_mut().for_each(|e| *e *= scale);
            self.row_scale.push(scale);
        }
        Ok(())
    }

    fn largest_below(&self, column: usize) -> usize {
        let size = |row: usize| self.factors[row * self.order + column].l1_norm();
        (column..self.order).fold(column, |best, row| if size(row) > size(best) { row } else { best })
    }

    /// Overwrites `rhs` (one column, length `order`) with the solution.
    pub fn solve_in_place(&mut self, rhs: &mut [Complex64]) {
        let order = self.order;
        for (value, scale) in rhs.iter_mut().zip(&self.row_scale) {
            *value *= scale;
        }
        for (row, &pivot) in self.pivots.iter().enumerate() {
            rhs.swap(row, pivot);
        }
        for i in 0..order {
            let row = &self.factors[i * order..i * order + i];
            let sum: Complex64 = row.iter().zip(&rhs[..i]).map(|(a, x)| a * x).sum();
            rhs[i] -= sum;
        }
        for i in (0..order).rev() {
            let row = &self.factors[i * order + i + 1..(i + 1) * order];
            let sum: Complex64 = row.iter().zip(&rhs[i + 1..order]).map(|(a, x)| a * x).sum();
            rhs[i] = (rhs[i] - sum) * self.factors[i * order + i].inv();
        }
    }

    /// Overwrites the row-major `order` × `columns` matrix `rhs` with the solution.
    pub fn solve_columns_in_place(&mut self, rhs: &mut [Complex64], columns: usize) {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.resize(self.order, Complex64::ZERO);
        for column in 0..columns {
            for i in 0..self.order {
                scratch[i] = rhs[i * columns + column];
            }
            self.solve_in_place(&mut scratch);
            for i in 0..self.order {
                rhs[i * columns + column] = scratch[i];
            }
        }
        self.scratch = scratch;
    }
}
