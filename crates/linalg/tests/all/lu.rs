use jointscope_linalg::{LuWorkspace, Singular};
use num_complex::Complex64;
use proptest::prelude::*;

proptest! {
    #[test]
    fn the_solution_satisfies_the_equations_whatever_the_units_of_the_rows(
        values in prop::collection::vec(-1.0f64..1.0, 5 * 5 * 2 + 5 * 2), decades in prop::collection::vec(-8i32..8, 5)
    ) {
        let n = 5;
        let entry = |i: usize, j: usize| {
            let diagonal = if i == j { 3.0 } else { 0.0 };
            Complex64::new(values[2 * (i * n + j)] + diagonal, values[2 * (i * n + j) + 1]) * 10f64.powi(decades[i])
        };
        let mut lu = LuWorkspace::new();
        lu.factorize(n, |a| for i in 0..n { for j in 0..n { a[i * n + j] = entry(i, j); } }).unwrap();
        let rhs: Vec<_> = (0..n).map(|i| Complex64::new(values[50 + 2 * i], values[51 + 2 * i]) * 10f64.powi(decades[i])).collect();
        let mut x = rhs.clone();
        lu.solve_in_place(&mut x);
        for i in 0..n {
            let left: Complex64 = (0..n).map(|j| entry(i, j) * x[j]).sum();
            prop_assert!((left - rhs[i]).norm() <= 1e-12 * 10f64.powi(decades[i]), "row {i}: {left} against {}", rhs[i]);
        }
    }
}

#[test]
fn two_equal_rows_are_singular() {
    let fill = |a: &mut [Complex64]| {
        a.iter_mut().enumerate().for_each(|(i, e)| *e = Complex64::new((i % 3) as f64 + 1.0, 0.0));
    };
    assert_eq!(LuWorkspace::new().factorize(3, fill), Err(Singular));
}

#[test]
fn a_matrix_with_a_missing_value_is_refused() {
    let fill = |a: &mut [Complex64]| a.fill(Complex64::new(f64::NAN, 0.0));
    assert_eq!(LuWorkspace::new().factorize(2, fill), Err(Singular));
}
