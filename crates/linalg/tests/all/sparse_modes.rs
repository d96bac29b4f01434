use crate::chains::free_chain;
use jointscope_linalg::{ModesWanted, SparseError, SparsePattern, SparseSymmetric, lowest_modes};
use std::f64::consts::{PI, TAU};

#[test]
fn a_free_chain_of_stiff_springs_has_its_closed_form_frequencies() {
    let (n, stiffness) = (2000, 1e12);
    let (k, m) = free_chain(n, stiffness);
    let exact = |r: usize| 4.0 * stiffness * (PI * r as f64 / (2 * n) as f64).sin().powi(2);
    let wanted = ModesWanted { at_least: 12, up_to: 0.0 };
    let modes = lowest_modes(&k, &m, &[vec![3.0; n]], 0.3 * exact(1), wanted, |_, _| {}).unwrap();
    assert_eq!(modes.eigenvalues.len(), 12);
    for (r, value) in modes.eigenvalues.iter().enumerate() {
        let error = (value / exact(r + 1) - 1.0).abs();
        assert!(error < 1e-8, "mode {}: {value:e} instead of {:e}", r + 1, exact(r + 1));
    }
}

#[test]
fn every_mode_below_the_limit_is_found_and_the_masses_are_one() {
    let (k, m) = free_chain(300, 1.0);
    let exact = |r: usize| 4.0 * (PI * r as f64 / 600.0).sin().powi(2);
    let limit = 0.5 * (exact(20) + exact(21));
    let wanted = ModesWanted { at_least: 1, up_to: limit };
    let modes = lowest_modes(&k, &m, &[vec![1.0; 300]], 1e-4, wanted, |_, _| {}).unwrap();
    assert_eq!(modes.eigenvalues.len(), 20);
    for (r, shape) in modes.shapes.iter().enumerate() {
        for (q, other) in modes.shapes.iter().enumerate() {
            let product = m.multiply(shape).iter().zip(other).map(|(a, b)| a * b).sum::<f64>();
            assert!((product - f64::from(r == q)).abs() < 1e-9, "({r}, {q}): {product}");
        }
    }
}

#[test]
fn a_system_as_small_as_the_block_is_solved_too() {
    let (k, m) = free_chain(3, 1.0);
    let wanted = ModesWanted { at_least: 10, up_to: 0.0 };
    let modes = lowest_modes(&k, &m, &[vec![1.0; 3]], 1.0, wanted, |_, _| {}).unwrap();
    assert_eq!(modes.eigenvalues.len(), 2);
    assert!((modes.eigenvalues[0] - 1.0).abs() < 1e-12 && (modes.eigenvalues[1] - 3.0).abs() < 1e-12);
}

/// `copies` chains of n unit masses beside each other, each held at one end: every eigenvalue as often as
/// there are chains.
fn equal_chains(copies: usize, n: usize) -> (SparseSymmetric, SparseSymmetric) {
    let couples: Vec<Vec<usize>> =
        (0..copies * n).map(|i| if i % n == 0 { vec![i] } else { vec![i - 1, i] }).collect();
    let pattern = SparsePattern::of_elements(copies * n, couples.iter().map(Vec::as_slice)).unwrap();
    let (mut k, mut m) = (SparseSymmetric::zero(&pattern), SparseSymmetric::zero(&pattern));
    for i in 0..copies * n {
        m.add_element(&[Some(i)], &[1.0]).unwrap();
        let before = (i % n > 0).then(|| i - 1);
        k.add_element(&[before, Some(i)], &[1.0, -1.0, -1.0, 1.0]).unwrap();
    }
    (k, m)
}

#[test]
fn equal_modes_of_any_multiplicity_are_all_found() {
    let n = 60;
    let exact = |r: usize| 4.0 * (PI * (r as f64 + 0.5) / (2 * n + 1) as f64).sin().powi(2);
    for copies in [2, 5, 8, 13] {
        let (k, m) = equal_chains(copies, n);
        let wanted = ModesWanted { at_least: 1, up_to: 0.5 * (exact(2) + exact(3)) };
        let modes = lowest_modes(&k, &m, &[], 1e-4, wanted, |_, _| {})
            .unwrap_or_else(|error| panic!("{copies} chains: {error}"));
        assert_eq!(modes.eigenvalues.len(), 3 * copies, "{copies} chains: {:?}", modes.eigenvalues);
        for (index, value) in modes.eigenvalues.iter().enumerate() {
            assert!(
                (value / exact(index / copies) - 1.0).abs() < 1e-8,
                "{copies} chains, mode {index}: {value}"
            );
        }
    }
}

#[test]
fn a_set_that_would_end_within_equal_modes_takes_them_all() {
    let (k, m) = equal_chains(3, 60);
    let wanted = ModesWanted { at_least: 4, up_to: 0.0 };
    let modes = lowest_modes(&k, &m, &[], 1e-4, wanted, |_, _| {}).unwrap();
    assert_eq!(modes.eigenvalues.len(), 6);
}

#[test]
fn a_mode_that_is_taken_away_is_missed() {
    let (k, m) = free_chain(300, 1.0);
    let wanted = ModesWanted { at_least: 6, up_to: 0.0 };
    let mut modes = lowest_modes(&k, &m, &[vec![1.0; 300]], 1e-4, wanted, |_, _| {}).unwrap();
    assert_eq!(modes.check_complete(&k, &m), Ok(()));
    modes.eigenvalues.remove(2);
    let hz = modes.complete_below.sqrt() / TAU;
    assert_eq!(modes.check_complete(&k, &m), Err(SparseError::Missing { found: 6, counted: 7, hz }));
}
