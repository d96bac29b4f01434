use jointscope_linalg::{EigenError, singular_values};
use num_complex::Complex64;

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
    for (columns, matrix) in [(2, &row[..]), (0, &row[..]), (1, &[]), (1, &[Complex64::new(f64::NAN, 0.0)])] {
        assert_eq!(singular_values(columns, matrix), Err(EigenError::Shape { order: columns }));
    }
}
