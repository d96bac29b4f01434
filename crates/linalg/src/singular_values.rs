use faer::Mat;
use num_complex::Complex64;

use crate::EigenError;

/// Singular values of a complex matrix, row-major with so many columns, the largest first.
///
/// The matrix is divided by its norm before it is solved, and the squares of what comes back are held against it.
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

/// Departure of the sum of squares from that of the elements that is tolerated, per row, of a matrix of norm one.
const ALLOWED: f64 = 1e-13;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_by_two_matrices_have_the_values_of_the_closed_form() {
        let [a, b, c, d] =
            [(0.3, 0.9), (-1.1, 0.2), (2.0, -1e-3), (0.4, 0.7)].map(|(re, im)| Complex64::new(re, im));
        let squares = [a, b, c, d].iter().map(|e| e.norm_sqr()).sum::<f64>();
        let determinant = (a * d - b * c).norm();
        let root = (squares * squares - 4.0 * determinant * determinant).sqrt();
        let expected = [(0.5 * (squares + root)).sqrt(), (0.5 * (squares - root)).sqrt()];
        for scale in [1e-200, 1e-9, 1.0, 1e12, 1e200] {
            let found = singular_values(2, &[a, b, c, d].map(|e| e * scale)).unwrap();
            for (found, expected) in found.iter().zip(expected) {
                assert!((found / scale - expected).abs() < 1e-14, "scale {scale}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn a_small_value_beside_a_large_one_keeps_its_digits() {
        // Rotations on both sides of diag(1, 1e-6).
        let (u, v) = (0.7f64.sin_cos(), 0.4f64.sin_cos());
        let element = |a: f64, b: f64, c: f64, d: f64| Complex64::new(a * b + 1e-6 * c * d, 0.0);
        let matrix = [
            element(u.1, v.1, u.0, v.0),
            element(u.1, v.0, -u.0, v.1),
            element(u.0, v.1, -u.1, v.0),
            element(u.0, v.0, u.1, v.1),
            Complex64::ZERO,
            Complex64::ZERO,
        ];
        let found = singular_values(2, &matrix).unwrap();
        assert!((found[0] - 1.0).abs() < 1e-15 && (found[1] / 1e-6 - 1.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn there_are_as_many_as_the_shorter_side_and_none_of_what_is_no_matrix() {
        let row = [3.0, 4.0, 0.0].map(Complex64::from);
        assert_eq!(singular_values(3, &row).unwrap().len(), 1);
        assert!((singular_values(1, &row).unwrap()[0] - 5.0).abs() < 1e-15);
        assert_eq!(singular_values(3, &[Complex64::ZERO; 6]), Ok(vec![0.0, 0.0]));
        for (columns, matrix) in
            [(2, &row[..]), (0, &row[..]), (1, &[]), (1, &[Complex64::new(f64::NAN, 0.0)])]
        {
            assert_eq!(singular_values(columns, matrix), Err(EigenError::Shape { order: columns }));
        }
    }
}
