use faer::{MatRef, Side};

/// Cholesky factor of a symmetric positive definite matrix of any order, scaled to a unit diagonal first so that parameters of different
/// units can share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Cholesky {
    order: usize,
    lower: Vec<f64>,
    unit: Vec<f64>,
}

/// Of a unit diagonal, less than this left of a pivot is rounding.
const ROUNDING: f64 = 1e-15;

/// Order from which the library's blocks pay for copying to them and back.
const MANY: usize = 64;

impl Cholesky {
    /// Factorises `matrix`, row-major of order `order`, of which only the lower triangle is read; `None` where it is not positive definite to
    /// working precision.
    pub fn of(order: usize, matrix: &[f64]) -> Option<Self> {
        if matrix.len() != order * order {
            return None;
        }
        let diagonal = (0..order).map(|i| matrix[i * order + i]);
        let unit: Vec<f64> = diagonal.map(|d| (d > 0.0).then(|| d.sqrt().recip())).collect::<Option<_>>()?;
        let mut lower = vec![0.0; order * order];
        for i in 0..order {
            for j in 0..=i {
                lower[i * order + j] = matrix[i * order + j] * unit[i] * unit[j];
            }
        }
        let positive = match order < MANY {
            true => factorise(order, order, &mut lower, ROUNDING),
            false => factorise_many(order, &mut lower),
        };
        positive.then_some(Cholesky { order, lower, unit })
    }

    /// The matrix' order.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Overwrites `b` by the solution of L x = b, with L the scaled factor of the unscaled matrix A = L Lᵀ.
    pub fn solve_lower_in_place(&self, b: &mut [f64]) {
        let n = self.order;
        for i in 0..n {
            let dot: f64 = self.lower[i * n..i * n + i].iter().zip(b.iter()).map(|(a, b)| a * b).sum();
            b[i] = (b[i] * self.unit[i] - dot) / self.lower[i * n + i];
        }
    }

    /// Overwrites `b` by the solution of Lᵀ x = b.
    pub fn solve_upper_in_place(&self, b: &mut [f64]) {
        let n = self.order;
        for i in (0..n).rev() {
            b[i] /= self.lower[i * n + i];
            let value = b[i];
            for (target, factor) in b[..i].iter_mut().zip(&self.lower[i * n..i * n + i]) {
                *target -= factor * value;
            }
        }
        for (value, unit) in b.iter_mut().zip(&self.unit) {
            *value *= unit;
        }
    }

    /// Overwrites `b` by the solution of A x = b.
    pub fn solve_in_place(&self, b: &mut [f64]) {
        self.solve_lower_in_place(b);
        self.solve_upper_in_place(b);
    }

    /// ln det A.
    pub fn ln_determinant(&self) -> f64 {
        let n = self.order;
        2.0 * (0..n).map(|i| (self.lower[i * n + i] / self.unit[i]).ln()).sum::<f64>()
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

/// Overwrites the lower triangle of the leading `order` × `order` part of a matrix, row-major in rows of `width`, with its Cholesky factor; false
/// where a pivot is not larger than `least`.
pub(crate) fn factorise(order: usize, width: usize, matrix: &mut [f64], least: f64) -> bool {
    for i in 0..order {
        let (above, row) = matrix.split_at_mut(i * width);
        for j in 0..=i {
            let left = if j < i { &above[j * width..j * width + j] } else { &row[..i] };
            let rest = row[j] - row[..j].iter().zip(left).map(|(a, b)| a * b).sum::<f64>();
            if j < i {
                row[j] = rest / above[j * width + j];
            } else if rest > least && rest.is_finite() {
                row[i] = rest.sqrt();
            } else {
                return false;
            }
        }
    }
    true
}

/// [`factorise`] of a whole matrix with a unit diagonal, by the library.
fn factorise_many(order: usize, matrix: &mut [f64]) -> bool {
    let rows = MatRef::from_row_major_slice(&*matrix, order, order).to_owned();
    let Ok(factor) = rows.llt(Side::Lower) else { return false };
    let lower = factor.L();
    for (i, row) in matrix.chunks_exact_mut(order).enumerate() {
        row[..=i].iter_mut().enumerate().for_each(|(j, entry)| *entry = lower[(i, j)]);
    }
    (0..order).all(|i| lower[(i, i)].powi(2) > ROUNDING && lower[(i, i)].is_finite())
}

/// Overwrites `b` by the solution of A x = b for a symmetric positive definite A, row-major of order `b.len()`; false where A is not positive
/// definite to working precision.
pub fn solve_positive_definite(a: &mut [f64], b: &mut [f64]) -> bool {
    Cholesky::of(b.len(), a).map(|factor| factor.solve_in_place(b)).is_some()
}

/// L of a symmetric positive semidefinite A = L Lᵀ, both row-major: zero in the columns of what others fix, of whose own entry they leave no more than the share `rounding`.
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
