//! Cholesky factors of symmetric positive matrices, scaled to a unit diagonal first.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::{MatMut, Par, Spec};

/// Cholesky factor of a symmetric positive definite matrix of any order, scaled to a unit diagonal first so
/// that parameters of different units can share it.
#[derive(Debug, Clone)]
pub struct Cholesky {
    order: usize,
    /// L, column after column; what is above its diagonal means nothing.
    lower: Vec<f64>,
    unit: Vec<f64>,
}

/// Of a unit diagonal, less than this left of a pivot is rounding.
const ROUNDING: f64 = 1e-15;

/// Order from which the library's blocks pay.
const MANY: usize = 64;

impl Cholesky {
    /// Factorises `matrix`, row-major of order `order`, of which only the lower triangle is read; `None`
    /// where it is not positive definite to working precision.
    pub fn of(order: usize, matrix: &[f64]) -> Option<Self> {
        let mut factor = Cholesky::identity(order);
        factor.anew(matrix).is_some().then_some(factor)
    }

    /// The factor of the unit matrix.
    pub fn identity(order: usize) -> Self {
        let mut lower = vec![0.0; order * order];
        (0..order).for_each(|j| lower[j * order + j] = 1.0);
        Cholesky { order, lower, unit: vec![1.0; order] }
    }

    /// [`Cholesky::of`] another matrix of the same order, in this one's memory. Where there is `None`, this
    /// is no matrix' factor any more.
    pub fn anew(&mut self, matrix: &[f64]) -> Option<&Self> {
        let n = self.order;
        if matrix.len() != n * n {
            return None;
        }
        for (i, unit) in self.unit.iter_mut().enumerate() {
            let own = matrix[i * n + i];
            *unit = (own > 0.0).then(|| own.sqrt().recip())?;
        }
        for i in 0..n {
            for (j, entry) in matrix[i * n..=i * n + i].iter().enumerate() {
                self.lower[j * n + i] = entry * self.unit[i] * self.unit[j];
            }
        }
        let positive = match n < MANY {
            true => factorise(n, &mut self.lower),
            false => factorise_many(n, &mut self.lower),
        };
        positive.then_some(self)
    }

    /// The matrix' order.
    pub fn order(&self) -> usize {
        self.order
    }

    /// L's column `j` from its diagonal down.
    fn column(&self, j: usize) -> &[f64] {
        &self.lower[j * self.order + j..(j + 1) * self.order]
    }

    /// Overwrites `b` by the solution of L x = b, with L the scaled factor of the unscaled matrix A = L Lᵀ.
    pub fn solve_lower_in_place(&self, b: &mut [f64]) {
        b.iter_mut().zip(&self.unit).for_each(|(value, unit)| *value *= unit);
        for j in 0..self.order {
            let column = self.column(j);
            let value = b[j] / column[0];
            b[j] = value;
            b[j + 1..].iter_mut().zip(&column[1..]).for_each(|(rest, factor)| *rest -= factor * value);
        }
    }

    /// Overwrites `b` by the solution of Lᵀ x = b.
    pub fn solve_upper_in_place(&self, b: &mut [f64]) {
        for j in (0..self.order).rev() {
            let column = self.column(j);
            let known: f64 = column[1..].iter().zip(&b[j + 1..]).map(|(a, b)| a * b).sum();
            b[j] = (b[j] - known) / column[0];
        }
        b.iter_mut().zip(&self.unit).for_each(|(value, unit)| *value *= unit);
    }

    /// Overwrites `b` by the solution of A x = b.
    pub fn solve_in_place(&self, b: &mut [f64]) {
        self.solve_lower_in_place(b);
        self.solve_upper_in_place(b);
    }

    /// ln det A.
    pub fn ln_determinant(&self) -> f64 {
        2.0 * (0..self.order).map(|j| (self.column(j)[0] / self.unit[j]).ln()).sum::<f64>()
    }

    /// A⁻¹, row-major: the covariance of parameters of which A is the information.
    pub fn inverse(&self) -> Vec<f64> {
        let n = self.order;
        let mut inverse = vec![0.0; n * n];
        for i in 0..n {
            let row = &mut inverse[i * n..(i + 1) * n];
            row[i] = 1.0;
            self.solve_in_place(row);
        }
        inverse
    }
}

/// Overwrites the lower triangle of a matrix with a unit diagonal, column after column, with its Cholesky
/// factor; false where it is not positive definite.
fn factorise(order: usize, columns: &mut [f64]) -> bool {
    for j in 0..order {
        let (before, own) = columns.split_at_mut(j * order);
        let own = &mut own[j..order];
        for column in before.chunks_exact(order) {
            let factor = column[j];
            own.iter_mut().zip(&column[j..]).for_each(|(entry, a)| *entry -= factor * a);
        }
        if !is_left(own[0]) {
            return false;
        }
        let pivot = own[0].sqrt();
        own.iter_mut().for_each(|entry| *entry /= pivot);
    }
    true
}

/// [`factorise`] by the library.
fn factorise_many(order: usize, columns: &mut [f64]) -> bool {
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<f64>(order, Par::Seq, Spec::default()));
    let matrix = MatMut::from_column_major_slice_mut(&mut *columns, order, order);
    let stack = MemStack::new(&mut memory);
    cholesky_in_place(matrix, LltRegularization::default(), Par::Seq, stack, Spec::default()).is_ok()
        && (0..order).all(|j| is_left(columns[j * order + j].powi(2)))
}

/// Whether what is left of a pivot is more than rounding.
fn is_left(pivot: f64) -> bool {
    pivot > ROUNDING && pivot.is_finite()
}

/// Overwrites `b` by the solution of A x = b for a symmetric positive definite A, row-major of order
/// `b.len()`; false where A is not positive definite to working precision.
pub fn solve_positive_definite(a: &mut [f64], b: &mut [f64]) -> bool {
    Cholesky::of(b.len(), a).map(|factor| factor.solve_in_place(b)).is_some()
}

/// L of a symmetric positive semidefinite A = L Lᵀ, both row-major: zero in the columns of what others fix,
/// of whose own entry they leave no more than the share `rounding`.
pub fn semidefinite_factor(order: usize, matrix: &[f64], rounding: f64) -> Vec<f64> {
    let mut lower = vec![0.0; order * order];
    for i in 0..order {
        for j in 0..i {
            let known: f64 = (0..j).map(|k| lower[i * order + k] * lower[j * order + k]).sum();
            let pivot: f64 = lower[j * order + j];
            if pivot > 0.0 {
                lower[i * order + j] = (matrix[i * order + j] - known) / pivot;
            }
        }
        let own = matrix[i * order + i];
        let rest = own - lower[i * order..i * order + i].iter().map(|entry| entry * entry).sum::<f64>();
        if rest > rounding * own {
            lower[i * order + i] = rest.sqrt();
        }
    }
    lower
}
