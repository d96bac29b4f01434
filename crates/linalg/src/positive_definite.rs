/// Solves A x = b for a symmetric positive definite A, row-major of order `b.len()`, by Cholesky; only the lower
/// triangle of `a` is read and it is overwritten by its factor, `b` by the solution.
///
/// Rows are scaled to a unit diagonal first, so that parameters of different units can share the matrix.
/// Returns false, with `a` and `b` spoilt, where A is not positive definite to working precision.
pub fn solve_positive_definite(a: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    let mut unit = [0.0; MOST];
    if n > MOST || a.len() != n * n {
        return false;
    }
    for i in 0..n {
        let diagonal = a[i * n + i];
        if !(diagonal > 0.0 && diagonal.is_finite()) {
            return false;
        }
        unit[i] = diagonal.sqrt().recip();
    }
    for i in 0..n {
        b[i] *= unit[i];
        for j in 0..=i {
            a[i * n + j] *= unit[i] * unit[j];
        }
    }
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| a[i * n + k] * a[j * n + k]).sum();
            let rest = a[i * n + j] - dot;
            if i == j {
                // Of a unit diagonal, less than this left is rounding.
                if rest.is_nan() || rest <= 1e-15 {
                    return false;
                }
                a[i * n + i] = rest.sqrt();
            } else {
                a[i * n + j] = rest / a[j * n + j];
            }
        }
    }
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| a[i * n + k] * b[k]).sum();
        b[i] = (b[i] - dot) / a[i * n + i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| a[k * n + i] * b[k]).sum();
        b[i] = (b[i] - dot) / a[i * n + i];
    }
    for i in 0..n {
        b[i] *= unit[i];
    }
    true
}

/// Largest order: normal equations of a fit, not models.
const MOST: usize = 128;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_solution_satisfies_the_equations_whatever_the_units(v in prop::collection::vec(-1.0f64..1.0, 20), decades in prop::array::uniform4(-6i32..6)) {
            let unit = decades.map(|d| 10f64.powi(d));
            let entry = |i: usize, j: usize| {
                let gram: f64 = (0..4).map(|k| v[4 * k + i] * v[4 * k + j]).sum();
                (gram + if i == j { 0.1 } else { 0.0 }) * unit[i] * unit[j]
            };
            let mut a: Vec<f64> = (0..16).map(|e| entry(e / 4, e % 4)).collect();
            let mut x: Vec<f64> = (0..4).map(|i| v[16 + i] * unit[i]).collect();
            prop_assert!(solve_positive_definite(&mut a, &mut x));
            for i in 0..4 {
                let left: f64 = (0..4).map(|j| entry(i, j) * x[j]).sum();
                prop_assert!((left / unit[i] - v[16 + i]).abs() < 1e-10, "row {i}");
            }
        }
    }

    #[test]
    fn an_indefinite_or_singular_matrix_is_refused() {
        assert!(!solve_positive_definite(&mut [1.0, 2.0, 2.0, 1.0], &mut [1.0, 1.0]));
        assert!(!solve_positive_definite(&mut [1.0, 1.0, 1.0, 1.0], &mut [1.0, 1.0]));
        assert!(!solve_positive_definite(&mut [0.0], &mut [1.0]));
        assert!(!solve_positive_definite(&mut [f64::NAN], &mut [1.0]));
    }
}
