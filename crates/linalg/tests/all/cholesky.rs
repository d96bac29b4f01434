use jointscope_linalg::{Cholesky, semidefinite_factor, solve_positive_definite};
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

    #[test]
    fn a_matrix_times_its_inverse_is_one_whatever_the_units(v in prop::collection::vec(-1.0f64..1.0, 16), decades in prop::array::uniform4(-6i32..6)) {
        let unit = decades.map(|d| 10f64.powi(d));
        let entry = |i: usize, j: usize| {
            let gram: f64 = (0..4).map(|k| v[4 * k + i] * v[4 * k + j]).sum();
            (gram + if i == j { 0.1 } else { 0.0 }) * unit[i] * unit[j]
        };
        let a: Vec<f64> = (0..16).map(|e| entry(e / 4, e % 4)).collect();
        let factor = Cholesky::of(4, &a).unwrap();
        let inverse = factor.inverse();
        let double: Vec<f64> = a.iter().map(|e| 2.0 * e).collect();
        let doubled = Cholesky::of(4, &double).unwrap().ln_determinant() - factor.ln_determinant();
        prop_assert!((doubled - 4.0 * 2f64.ln()).abs() < 1e-9);
        for i in 0..4 {
            for j in 0..4 {
                let product: f64 = (0..4).map(|k| a[4 * i + k] * inverse[4 * k + j]).sum();
                prop_assert!((product / unit[i] * unit[j] - f64::from(u8::from(i == j))).abs() < 1e-10, "({i}, {j}): {product}");
            }
        }
    }
}

/// L⁻¹ of the factor, column by column.
fn inverse_of_lower(n: usize, factor: &Cholesky) -> Vec<Vec<f64>> {
    let column = |k: usize| {
        let mut unit = vec![0.0; n];
        unit[k] = 1.0;
        factor.solve_lower_in_place(&mut unit);
        unit
    };
    (0..n).map(column).collect()
}

#[test]
fn the_library_factorises_as_the_few_lines_here_do() {
    // From 64 rows on the library factorises; `semidefinite_factor` and what is factorised without it are a
    // few lines.
    let n = 64 + 13;
    let entry = |i: usize, j: usize| {
        f64::from(u8::from(i == j)) + 0.3 * (0.7 * i as f64).sin() * (0.7 * j as f64).sin()
    };
    let leading = |n: usize| -> Vec<f64> { (0..n * n).map(|e| entry(e / n, e % n)).collect() };
    let matrix = leading(n);
    let many = inverse_of_lower(n, &Cholesky::of(n, &matrix).unwrap());
    let lower = semidefinite_factor(n, &matrix, 1e-15);
    for (k, column) in many.iter().enumerate() {
        for i in 0..n {
            let product: f64 = (0..n).map(|j| lower[i * n + j] * column[j]).sum();
            assert!((product - f64::from(u8::from(i == k))).abs() < 1e-14, "({i}, {k}): {product}");
        }
    }
    // The factor of leading rows is the leading part of the factor.
    let few = inverse_of_lower(63, &Cholesky::of(63, &leading(63)).unwrap());
    assert!((0..63 * 63).all(|e| (few[e / 63][e % 63] - many[e / 63][e % 63]).abs() < 1e-14));
    let mut singular = matrix;
    (0..n).for_each(|k| singular[(n - 1) * n + k] = singular[(n - 2) * n + k]);
    singular[n * n - 1] = singular[(n - 2) * n + n - 2];
    singular[(n - 1) * n + n - 2] = singular[n * n - 1];
    assert!(Cholesky::of(n, &singular).is_none());
}

#[test]
fn a_factor_made_anew_is_that_of_the_new_matrix_alone() {
    for n in [3, 80] {
        let entry = |e: usize, own: f64| {
            if e.is_multiple_of(n + 1) { own } else { (0.3 * e as f64).sin() / n as f64 }
        };
        let [first, second] = [2.0, 5.0].map(|own| (0..n * n).map(|e| entry(e, own)).collect::<Vec<f64>>());
        let identity: Vec<f64> = (0..n * n).map(|e| f64::from(u8::from(e.is_multiple_of(n + 1)))).collect();
        let mut factor = Cholesky::of(n, &first).unwrap();
        assert!(factor.anew(&vec![-1.0; n * n]).is_none());
        assert_eq!(factor.anew(&second).unwrap().inverse(), Cholesky::of(n, &second).unwrap().inverse());
        assert_eq!(Cholesky::identity(n).inverse(), Cholesky::of(n, &identity).unwrap().inverse());
        assert!(factor.anew(&[1.0]).is_none());
    }
}

#[test]
fn an_indefinite_or_singular_matrix_is_refused() {
    assert!(!solve_positive_definite(&mut [1.0, 2.0, 2.0, 1.0], &mut [1.0, 1.0]));
    assert!(!solve_positive_definite(&mut [1.0, 1.0, 1.0, 1.0], &mut [1.0, 1.0]));
    assert!(!solve_positive_definite(&mut [0.0], &mut [1.0]));
    assert!(!solve_positive_definite(&mut [f64::NAN], &mut [1.0]));
    assert!(Cholesky::of(2, &[1.0, 2.0, 2.0, 1.0]).is_none());
    assert!(Cholesky::of(2, &[1.0, 1.0, 1.0, 1.0]).is_none());
    assert!(Cholesky::of(1, &[0.0]).is_none());
    assert!(Cholesky::of(1, &[f64::NAN]).is_none());
    assert!(Cholesky::of(1, &[f64::INFINITY]).is_none());
    assert!(Cholesky::of(2, &[1.0]).is_none());
}

#[test]
fn what_others_fix_has_no_column_of_its_own_in_a_semidefinite_factor() {
    // The third is the sum of the first two.
    let covariance = [4.0, 1.0, 5.0, 1.0, 9.0, 10.0, 5.0, 10.0, 15.0];
    let lower = semidefinite_factor(3, &covariance, 1e-12);
    for e in 0..9 {
        let (i, j) = (e / 3, e % 3);
        let product: f64 = (0..3).map(|k| lower[i * 3 + k] * lower[j * 3 + k]).sum();
        assert!((product - covariance[e]).abs() < 1e-12, "entry {i}, {j}: {product}");
    }
    assert_eq!([lower[8], lower[1], lower[2], lower[5]], [0.0; 4]);
}
