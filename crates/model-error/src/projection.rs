//! Complex linear least squares with weights: the columns made orthonormal once (Gram–Schmidt, twice for
//! accuracy), then projections.

use num_complex::Complex64;

/// √w·B = Q·R, for columns B that values are to be written as combinations of.
#[derive(Debug, Clone)]
pub(crate) struct Projection {
    lines: usize,
    columns: usize,
    /// Orthonormal columns, one after another.
    q: Vec<Complex64>,
    /// R⁻¹, row-major, upper triangular.
    inverse: Vec<Complex64>,
    roots: Vec<f64>,
}

impl Projection {
    /// From rows of B and a weight each; `None` where the columns are dependent to working precision.
    pub(crate) fn new(rows: &[Vec<Complex64>], weights: &[f64]) -> Option<Self> {
        let (lines, columns) = (rows.len(), rows.first()?.len());
        let roots: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let mut q = vec![Complex64::ZERO; lines * columns];
        for column in 0..columns {
            for line in 0..lines {
                q[column * lines + line] = rows[line][column] * roots[line];
            }
        }
        let mut r = vec![Complex64::ZERO; columns * columns];
        for column in 0..columns {
            let (before, rest) = q.split_at_mut(column * lines);
            let own = &mut rest[..lines];
            let size = norm(own);
            // Twice is enough.
            for _ in 0..2 {
                for (k, other) in before.chunks_exact(lines).enumerate() {
                    let along = inner(other, own);
                    r[k * columns + column] += along;
                    own.iter_mut().zip(other).for_each(|(value, q)| *value -= along * q);
                }
            }
            let left = norm(own);
            if !left.is_finite() || left <= 1e-12 * size {
                return None;
            }
            r[column * columns + column] = Complex64::from(left);
            own.iter_mut().for_each(|value| *value /= left);
        }
        Some(Projection { lines, columns, q, inverse: upper_inverse(columns, &r), roots })
    }

    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    /// √w·values, and its components along the orthonormal columns.
    fn components(&self, values: &[Complex64]) -> (Vec<Complex64>, Vec<Complex64>) {
        let whitened: Vec<Complex64> = values.iter().zip(&self.roots).map(|(v, root)| v * root).collect();
        let components = self.q.chunks_exact(self.lines).map(|q| inner(q, &whitened)).collect();
        (whitened, components)
    }

    fn coefficients_of(&self, components: &[Complex64]) -> Vec<Complex64> {
        let row = |i: usize| (i..self.columns).map(move |j| (i, j));
        (0..self.columns)
            .map(|i| row(i).map(|(i, j)| self.inverse[i * self.columns + j] * components[j]).sum())
            .collect()
    }

    /// The coefficients of the combination nearest to `values`, and by how much the last column lowers what
    /// the others leave of Σ w|values|².
    pub(crate) fn with_last(&self, values: &[Complex64]) -> (Vec<Complex64>, f64) {
        let components = self.components(values).1;
        let lowered = components.last().map_or(0.0, |along| along.norm_sqr());
        (self.coefficients_of(&components), lowered)
    }

    /// The coefficients, and what the combination leaves of √w·`values`.
    pub(crate) fn split(&self, values: &[Complex64]) -> (Vec<Complex64>, Vec<Complex64>) {
        let (mut left, components) = self.components(values);
        for (q, along) in self.q.chunks_exact(self.lines).zip(&components) {
            left.iter_mut().zip(q).for_each(|(value, q)| *value -= along * q);
        }
        (self.coefficients_of(&components), left)
    }

    /// (BᴴWB)⁻¹, row-major: its real part is the covariance of the coefficients' real parts where the weights
    /// are 1/variance of one part.
    pub(crate) fn covariance(&self) -> Vec<Complex64> {
        let n = self.columns;
        let mut all = vec![Complex64::ZERO; n * n];
        for i in 0..n {
            for j in 0..n {
                all[i * n + j] =
                    (i.max(j)..n).map(|k| self.inverse[i * n + k] * self.inverse[j * n + k].conj()).sum();
            }
        }
        all
    }
}

fn inner(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
}

fn norm(values: &[Complex64]) -> f64 {
    values.iter().map(|v| v.norm_sqr()).sum::<f64>().sqrt()
}

fn upper_inverse(n: usize, r: &[Complex64]) -> Vec<Complex64> {
    let mut inverse = vec![Complex64::ZERO; n * n];
    for column in 0..n {
        inverse[column * n + column] = r[column * n + column].inv();
        for row in (0..column).rev() {
            let sum: Complex64 = (row + 1..=column).map(|k| r[row * n + k] * inverse[k * n + column]).sum();
            inverse[row * n + column] = -sum / r[row * n + row];
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LINES: usize = 12;
    const COLUMNS: usize = 4;

    fn complex() -> impl Strategy<Value = Complex64> {
        (-1.0..1.0f64, -1.0..1.0f64).prop_map(|(re, im)| Complex64::new(re, im))
    }

    /// Columns that are well apart: a diagonal of three and anything below one besides.
    fn rows() -> impl Strategy<Value = Vec<Vec<Complex64>>> {
        let row = prop::collection::vec(complex(), COLUMNS);
        prop::collection::vec(row, LINES).prop_map(|mut rows| {
            (0..COLUMNS).for_each(|k| rows[k][k] += 3.0);
            rows
        })
    }

    fn weights() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(0.1..10.0f64, LINES)
    }

    proptest! {
        #[test]
        fn an_exact_combination_gives_its_coefficients_and_leaves_nothing(
            rows in rows(), weights in weights(), truth in prop::collection::vec(complex(), COLUMNS),
        ) {
            let values: Vec<Complex64> =
                rows.iter().map(|row| row.iter().zip(&truth).map(|(b, c)| b * c).sum()).collect();
            let (found, left) = Projection::new(&rows, &weights).unwrap().split(&values);
            for (found, truth) in found.iter().zip(&truth) {
                prop_assert!((found - truth).norm() < 1e-10, "coefficient {found}, expected {truth}");
            }
            prop_assert!(norm(&left) < 1e-10, "left {}", norm(&left));
        }

        #[test]
        fn what_is_left_is_orthogonal_to_all_columns(
            rows in rows(), weights in weights(), values in prop::collection::vec(complex(), LINES),
        ) {
            let projection = Projection::new(&rows, &weights).unwrap();
            let (coefficients, left) = projection.split(&values);
            prop_assert_eq!(&coefficients, &projection.with_last(&values).0);
            for column in 0..COLUMNS {
                let along: Complex64 =
                    (0..LINES).map(|k| (rows[k][column] * weights[k].sqrt()).conj() * left[k]).sum();
                prop_assert!(along.norm() < 1e-10, "column {column}: {along}");
            }
        }

        #[test]
        fn the_covariance_is_the_inverse_of_the_normal_matrix(rows in rows(), weights in weights()) {
            let covariance = Projection::new(&rows, &weights).unwrap().covariance();
            // BᴴWB, by its definition.
            let normal = |i: usize, j: usize| -> Complex64 {
                rows.iter().zip(&weights).map(|(row, w)| row[i].conj() * row[j] * w).sum()
            };
            for i in 0..COLUMNS {
                for j in 0..COLUMNS {
                    let product: Complex64 =
                        (0..COLUMNS).map(|k| normal(i, k) * covariance[k * COLUMNS + j]).sum();
                    let expected = f64::from(u8::from(i == j));
                    prop_assert!((product - expected).norm() < 1e-9, "entry {i}, {j}: {product}, expected {expected}");
                }
            }
        }
    }

    #[test]
    fn a_line_without_weight_does_not_count() {
        let rows: Vec<Vec<Complex64>> =
            (0..6).map(|k| vec![Complex64::ONE, Complex64::new(0.0, f64::from(k))]).collect();
        let mut values: Vec<Complex64> = rows.iter().map(|row| row[0] * 2.0 - row[1]).collect();
        values[3] = Complex64::from(1e6);
        let found = Projection::new(&rows, &[1.0, 1.0, 1.0, 0.0, 1.0, 1.0]).unwrap().with_last(&values).0;
        assert!((found[0] - 2.0).norm() < 1e-12 && (found[1] + 1.0).norm() < 1e-12, "{found:?}");
    }

    #[test]
    fn dependent_columns_have_no_projection() {
        let rows: Vec<Vec<Complex64>> =
            (0..6).map(|k| vec![Complex64::from(f64::from(k)), Complex64::new(0.0, f64::from(k))]).collect();
        assert!(Projection::new(&rows, &[1.0; 6]).is_none());
    }
}
