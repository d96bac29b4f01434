//! Eigenvalues of a complex matrix without symmetry, checked: their sum must be its trace.

use faer::Mat;
use num_complex::Complex64;

use crate::EigenError;

/// Eigenvalues of a general complex matrix, row-major of order `order`, in no particular order.
///
/// The matrix is divided by its norm before it is solved, and the sum of what comes back is held against the
/// trace.
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
