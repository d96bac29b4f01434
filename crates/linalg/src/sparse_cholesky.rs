use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Side};

use crate::{SparseError, SparseSymmetric};

/// The Cholesky factor of a sparse positive definite matrix, equations reordered for little fill.
///
/// One thread only, so that the same matrix gives the same bits on every machine of a kind.
pub struct SparseCholesky {
    factor: Llt<usize, f64>,
    order: usize,
}

impl SparseCholesky {
    /// Factorises `matrix`.
    ///
    /// # Errors
    /// A matrix that is not positive definite, or too large for the memory.
    pub fn of(matrix: &SparseSymmetric) -> Result<Self, SparseError> {
        let order = matrix.order();
        if matrix.values.iter().any(|value| !value.is_finite()) {
            return Err(SparseError::NotPositiveDefinite);
        }
        let pattern = SymbolicSparseColMatRef::new_checked(
            order,
            order,
            &matrix.pattern.starts,
            None,
            &matrix.pattern.rows,
        );
        let symbolic =
            SymbolicLlt::try_new(pattern, Side::Lower).map_err(|_| SparseError::Memory { order })?;
        let values = SparseColMatRef::new(pattern, &matrix.values);
        let factor =
            Llt::try_new_with_symbolic(symbolic, values, Side::Lower).map_err(|error| match error {
                faer::sparse::linalg::LltError::Generic(_) => SparseError::Memory { order },
                faer::sparse::linalg::LltError::Numeric(_) => SparseError::NotPositiveDefinite,
            })?;
        Ok(SparseCholesky { factor, order })
    }

    /// Overwrites right-hand sides, one after the other, with their solutions.
    pub fn solve_in_place(&self, columns: &mut [f64]) {
        let count = columns.len() / self.order;
        let columns = MatMut::from_column_major_slice_mut(columns, self.order, count);
        self.factor.solve_in_place_with_conj(Conj::No, columns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SparsePattern;

    /// A grid of springs, width × height nodes, each also held to ground by `ground`.
    fn grid(width: usize, height: usize, ground: f64) -> SparseSymmetric {
        let mut couples = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let node = y * width + x;
                couples.push(vec![node]);
                if x + 1 < width {
                    couples.push(vec![node, node + 1]);
                }
                if y + 1 < height {
                    couples.push(vec![node, node + width]);
                }
            }
        }
        let pattern = SparsePattern::of_elements(width * height, couples.iter().map(Vec::as_slice)).unwrap();
        let mut matrix = SparseSymmetric::zero(&pattern);
        for couple in &couples {
            match couple.as_slice() {
                [a, b] => matrix.add_element(&[Some(*a), Some(*b)], &[1.0, -1.0, -1.0, 1.0]).unwrap(),
                [a] => matrix.add_element(&[Some(*a)], &[ground]).unwrap(),
                _ => unreachable!(),
            }
        }
        matrix
    }

    #[test]
    fn what_is_solved_multiplies_back_to_the_right_hand_side() {
        let matrix = grid(40, 30, 1e-3);
        let factor = SparseCholesky::of(&matrix).unwrap();
        let right: Vec<f64> = (0..2 * 1200).map(|i| ((i * 37) % 101) as f64 - 50.0).collect();
        let mut solution = right.clone();
        factor.solve_in_place(&mut solution);
        for (x, b) in solution.chunks(1200).zip(right.chunks(1200)) {
            for (found, wanted) in matrix.multiply(x).iter().zip(b) {
                assert!((found - wanted).abs() < 1e-8, "{found} instead of {wanted}");
            }
        }
    }

    #[test]
    fn a_structure_that_can_move_freely_has_no_factor() {
        assert!(matches!(SparseCholesky::of(&grid(5, 5, -1.0)), Err(SparseError::NotPositiveDefinite)));
        assert!(matches!(SparseCholesky::of(&grid(5, 5, f64::NAN)), Err(SparseError::NotPositiveDefinite)));
    }
}
