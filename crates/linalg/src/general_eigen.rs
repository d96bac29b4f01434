use faer::Mat;
use num_complex::Complex64;

use crate::EigenError;

/// Eigenvalues of a general complex matrix, row-major of order `order`, in no particular order.
///
/// The matrix is divided by its norm before it is solved, and the sum of what comes back is held against the trace.
///
/// # Errors
/// See [`EigenError`].
pub fn complex_eigenvalues(order: usize, matrix: &[Complex64]) -> Result<Vec<Complex64>, EigenError> {
    if order == 0 || matrix.len() != order * order || !matrix.iter().all(|e| e.is_finite()) {
        return Err(EigenError::Shape { order });
    }
    let norm = matrix.iter().map(|e| e.norm_sqr()).sum::<f64>().sqrt();
    if norm == 0.0 {
        return Ok(vec![Complex64::ZERO; order]);
    }
    let scaled = Mat::from_fn(order, order, |i, j| matrix[i * order + j] / norm);
    let values = scaled.eigenvalues().map_err(|_| EigenError::NoConvergence)?;
    let trace: Complex64 = (0..order).map(|i| scaled[(i, i)]).sum();
    let residual = (values.iter().sum::<Complex64>() - trace).norm();
    let allowed = ALLOWED * order as f64;
    // A comparison that a residual of NaN fails as well.
    if residual <= allowed {
        Ok(values.into_iter().map(|value| value * norm).collect())
    } else {
        Err(EigenError::Inaccurate { residual, allowed })
    }
}

/// Departure of the eigenvalues' sum from the trace that is tolerated, per order, of a matrix of norm one.
const ALLOWED: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_companion_matrix_of_a_polynomial_has_its_roots() {
        let roots = [Complex64::new(0.3, 0.9), Complex64::new(-1.1, 0.2), Complex64::new(2.0, -1e-3)];
        let [a, b, c] = roots;
        let matrix = [a + b + c, -(a * b + b * c + c * a), a * b * c];
        let mut companion = [Complex64::ZERO; 9];
        companion[..3].copy_from_slice(&matrix);
        companion[3] = Complex64::ONE;
        companion[7] = Complex64::ONE;
        for scale in [1e-9, 1.0, 1e12] {
            let scaled: Vec<Complex64> = companion.iter().map(|e| e * scale).collect();
            let found = complex_eigenvalues(3, &scaled).unwrap();
            for root in roots {
                let nearest = found.iter().map(|f| (f / scale - root).norm()).fold(f64::INFINITY, f64::min);
                assert!(nearest < 1e-13, "{root} at scale {scale}: {nearest}");
            }
        }
    }

    #[test]
    fn a_matrix_with_a_missing_value_is_refused() {
        let matrix = [Complex64::new(f64::NAN, 0.0)];
        assert_eq!(complex_eigenvalues(1, &matrix), Err(EigenError::Shape { order: 1 }));
        assert_eq!(complex_eigenvalues(1, &[Complex64::ZERO]), Ok(vec![Complex64::ZERO]));
    }
}
