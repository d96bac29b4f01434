use jointscope_linalg::{EigenError, complex_eigenvalues};
use num_complex::Complex64;

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
