use crate::chains::free_chain;
use jointscope_linalg::{SparseError, SparsePattern, SparseSymmetric, eigenvalues_below};
use std::f64::consts::PI;

#[test]
fn the_count_below_any_shift_is_that_of_the_closed_form() {
    for (n, k) in [(2, 1.0), (7, 1e-9), (50, 1e12), (400, 3.0)] {
        let (stiffness, mass) = free_chain(n, k);
        let exact = |r: usize| 4.0 * k * (PI * r as f64 / (2 * n) as f64).sin().powi(2);
        for r in 0..n {
            let above = if r + 1 < n { exact(r + 1) } else { 5.0 * k };
            let shift = 0.5 * (exact(r) + above);
            assert_eq!(eigenvalues_below(&stiffness, &mass, shift), Ok(r + 1), "n {n}, mode {r}");
        }
        assert_eq!(eigenvalues_below(&stiffness, &mass, -k), Ok(0));
    }
}

#[test]
fn a_zero_on_the_diagonal_is_no_obstacle() {
    // Two unit masses, K − σM = [[0, −1], [−1, 0]] at σ = 1: no pivot of one will do.
    let (stiffness, mass) = free_chain(2, 1.0);
    assert_eq!(eigenvalues_below(&stiffness, &mass, 1.0), Ok(1));
    // Inner masses of a chain at σ = 2k: the diagonal is zero all along.
    let (stiffness, mass) = free_chain(301, 1.0);
    let exact = (0..301).filter(|r| 4.0 * (PI * *r as f64 / 602.0).sin().powi(2) < 2.0).count();
    assert_eq!(eigenvalues_below(&stiffness, &mass, 2.0), Ok(exact));
}

#[test]
fn equal_modes_are_counted_each() {
    let pattern =
        SparsePattern::of_elements(9, (0..9).map(|i| vec![i]).collect::<Vec<_>>().iter().map(Vec::as_slice))
            .unwrap();
    let (mut stiffness, mut mass) = (SparseSymmetric::zero(&pattern), SparseSymmetric::zero(&pattern));
    for i in 0..9 {
        stiffness.add_element(&[Some(i)], &[if i < 6 { 4.0 } else { 9.0 }]).unwrap();
        mass.add_element(&[Some(i)], &[1.0]).unwrap();
    }
    let counts = [3.9, 4.1, 8.9, 9.1].map(|shift| eigenvalues_below(&stiffness, &mass, shift).unwrap());
    assert_eq!(counts, [0, 6, 6, 9]);
}

#[test]
fn a_shift_upon_an_eigenvalue_has_no_certain_count() {
    let (stiffness, mass) = free_chain(3, 1.0);
    // Eigenvalues 0, 1, 3: the factor of K − M is singular but for rounding.
    let answer = eigenvalues_below(&stiffness, &mass, 1.0);
    assert!(matches!(answer, Err(SparseError::Uncertain { .. })), "{answer:?}");
}

#[test]
fn values_that_are_not_finite_are_refused() {
    let (stiffness, mut mass) = free_chain(3, 1.0);
    mass.add_element(&[Some(1)], &[f64::NAN]).unwrap();
    assert!(eigenvalues_below(&stiffness, &mass, 0.5).is_err());
    let (_, unit) = free_chain(3, 1.0);
    let nothing = unit.plus(-1.0, &unit).unwrap();
    assert!(eigenvalues_below(&stiffness, &nothing, 0.5).is_err());
}
