/// Cholesky factor of a symmetric positive definite matrix of any order, scaled to a unit diagonal first so that parameters of different
/// units can share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Cholesky {
    order: usize,
    lower: Vec<f64>,
    unit: Vec<f64>,
}

/// Of a unit diagonal, less than this left of a pivot is rounding.
const ROUNDING: f64 = 1e-14;

impl Cholesky {
    /// Factorises `matrix`, row-major of order `order`, of which only the lower triangle is read; `None` where it is not positive definite to
    /// working precision.
    pub fn of(order: usize, matrix: &[f64]) -> Option<Self> {
        let n = order;
        if matrix.len() != n * n {
            return None;
        }
        let mut unit = Vec::with_capacity(n);
        for i in 0..n {
            let diagonal = matrix[i * n + i];
            if !(diagonal > 0.0 && diagonal.is_finite()) {
                return None;
            }
            unit.push(diagonal.sqrt().recip());
        }
        let mut lower = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                let dot: f64 =
                    lower[i * n..i * n + j].iter().zip(&lower[j * n..j * n + j]).map(|(a, b)| a * b).sum();
                let rest = matrix[i * n + j] * unit[i] * unit[j] - dot;
                if i > j {
                    lower[i * n + j] = rest / lower[j * n + j];
                } else if rest > ROUNDING {
                    lower[i * n + i] = rest.sqrt();
                } else {
                    return None;
                }
            }
        }
        Some(Cholesky { order, lower, unit })
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_matrix_times_its_inverse_is_one_whatever_the_units(v in prop::collection::vec(-1.0f64..1.0, 16), decades in prop::array::uniform4(-6i32..6)) {
            let unit = decades.map(|d| 10f64.powi(d));
            let entry = |i: usize, j: usize| {
                let gram: f64 = (0..4).map(|k| v[4 * k + i] * v[4 * k + j]).sum();
                (gram + if i == j { 0.1 } else { 0.0 }) * unit[i] * unit[j]
            };
            let a: Vec<f64> = (0..16).map(|e| entry(e / 4, e % 4)).collect();
            let inverse = Cholesky::of(4, &a).unwrap().inverse();
            for i in 0..4 {
                for j in 0..4 {
                    let product: f64 = (0..4).map(|k| a[4 * i + k] * inverse[4 * k + j]).sum();
                    prop_assert!((product / unit[i] * unit[j] - f64::from(u8::from(i == j))).abs() < 1e-10, "({i}, {j}): {product}");
                }
            }
        }
    }

    #[test]
    fn an_indefinite_or_singular_matrix_is_refused() {
        assert_eq!(Cholesky::of(2, &[1.0, 2.0, 2.0, 1.0]), None);
        assert_eq!(Cholesky::of(2, &[1.0, 1.0, 1.0, 1.0]), None);
        assert_eq!(Cholesky::of(1, &[f64::NAN]), None);
        assert_eq!(Cholesky::of(2, &[1.0]), None);
    }
}
