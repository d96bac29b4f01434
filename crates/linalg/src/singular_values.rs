//! Singular values, checked: the sum of their squares must be that of the elements.

use faer::Mat;
use num_complex::Complex64;

use crate::EigenError;

/// Singular values of a complex matrix, row-major with so many columns, the largest first.
///
/// The matrix is divided by its norm before it is solved, and the squares of what comes back are held against
/// it.
///
/// # Errors
/// See [`EigenError`].
pub fn singular_values(columns: usize, matrix: &[Complex64]) -> Result<Vec<f64>, EigenError> {
    let rows = matrix.len().checked_div(columns).unwrap_or(0);
    if rows == 0 || rows * columns != matrix.len() || !matrix.iter().all(|e| e.is_finite()) {
        return Err(EigenError::Shape { order: columns });
    }
    // By the largest first: squares of very small or large values leave the range of numbers.
    let largest = matrix.iter().map(|e| e.re.abs().max(e.im.abs())).fold(0.0, f64::max);
    if largest == 0.0 {
        return Ok(vec![0.0; rows.min(columns)]);
    }
    let norm = matrix.iter().map(|e| (e / largest).norm_sqr()).sum::<f64>().sqrt();
    let scaled = Mat::from_fn(rows, columns, |i, j| matrix[i * columns + j] / largest / norm);
    let mut values = scaled.singular_values().map_err(|_| EigenError::NoConvergence)?;
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    let residual = (values.iter().map(|value| value * value).sum::<f64>() - 1.0).abs();
    let allowed = ALLOWED * columns.max(rows) as f64;
    // A comparison that a residual of NaN fails as well.
    if residual <= allowed {
        Ok(values.into_iter().map(|value| value * norm * largest).collect())
    } else {
        Err(EigenError::Inaccurate { residual, allowed })
    }
}

/// Departure of the sum of squares from that of the elements that is tolerated, per row, of a matrix of norm
/// one.
const ALLOWED: f64 = 1e-13;
