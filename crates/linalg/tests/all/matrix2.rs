use jointscope_linalg::{ComplexMatrix2, Field, Matrix2};
use num_complex::Complex64;
use proptest::prelude::*;

fn complex() -> impl Strategy<Value = Complex64> {
    (-1.0..1.0, -1.0..1.0).prop_map(|(re, im)| Complex64::new(re, im))
}

proptest! {
    #[test]
    fn a_matrix_times_its_inverse_is_the_identity(a in complex(), b in complex(), c in complex(), d in complex()) {
        let matrix = Matrix2::new(a, b, c, d);
        prop_assume!(matrix.balanced_condition() < 1e6);
        let product = matrix * matrix.inverse().unwrap();
        let error = (product - ComplexMatrix2::identity()).norm_squared().sqrt();
        prop_assert!(error < 1e-8, "{product:?}");
    }

    #[test]
    fn the_balanced_condition_does_not_depend_on_units(
        a in complex(), b in complex(), c in complex(), d in complex(), row in 1e-4..1e4, column in 1e-4..1e4
    ) {
        let matrix = Matrix2::new(a, b, c, d);
        prop_assume!(matrix.balanced_condition() < 1e6);
        let rescaled = Matrix2::new(a, b * column, c * row, d * row * column);
        let ratio = rescaled.balanced_condition() / matrix.balanced_condition();
        prop_assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
    }
}

#[test]
fn the_balanced_condition_of_a_balanced_matrix_is_its_ratio_of_singular_values() {
    // Singular values of [[1, r], [r, 1]] are 1 + r and 1 - r.
    let matrix = Matrix2::new(1.0, 0.5, 0.5, 1.0);
    assert!((matrix.balanced_condition() - 3.0).abs() < 1e-12);
}

#[test]
fn a_singular_matrix_has_no_inverse_and_an_infinite_condition() {
    let matrix = Matrix2::new(1.0, 2.0, 2.0, 4.0);
    assert!(matrix.inverse().is_none());
    assert_eq!(matrix.balanced_condition(), f64::INFINITY);
}

#[test]
fn the_reciprocal_of_a_tiny_receptance_product_does_not_underflow() {
    let tiny = Complex64::new(3e-200, -4e-200);
    let product = tiny * tiny.reciprocal();
    assert!((product - 1.0).norm() < 1e-12, "{product}");
}
