//! No mode is left out: the count of eigenvalues below a frequency, against beams whose modes are known.

use crate::timoshenko::{Beam, Ends};
use jointscope_fem::{Elasticity, FemError, Matrices, Mesh, MeshOptions, ModeRange, Twin};
use jointscope_fixture::Fixture;
use jointscope_linalg::{ModesWanted, SparseError, eigenvalues_below, lowest_modes};
use std::f64::consts::TAU;

const STEEL: Elasticity =
    Elasticity { youngs_modulus: 2.07e11, poisson_ratio: 0.0, density: 7850.0, shear_factor: 1.0 };

#[test]
fn between_two_frequencies_of_a_beam_the_count_is_that_of_its_theory() {
    let size = [0.3, 0.02, 0.01];
    let mesh = Mesh::of_box(size, [32, 2, 1], STEEL);
    let speed = (STEEL.youngs_modulus / STEEL.density).sqrt();
    for (ends, rigid) in [(Ends::Free, 3), (Ends::Clamped, 0)] {
        let clamped = ends == Ends::Clamped;
        let held = |place: [f64; 3], axis: usize| axis == 2 || (clamped && place[0] == 0.0);
        let matrices = Matrices::of(&mesh, held).unwrap();
        // In its plane it bends, and it stretches: half waves of √(E/ρ), or odd quarter waves.
        let axial = |n: i32| f64::from(if clamped { 2 * n - 1 } else { 2 * n }) * speed / (4.0 * size[0]);
        let mut known = Beam::of_box(size, &STEEL).frequencies(ends, 8);
        known.extend((1..=3).map(axial));
        known.sort_by(f64::total_cmp);
        for (index, pair) in known[..8].windows(2).enumerate() {
            let between = 0.5 * (pair[0] + pair[1]);
            let counted = eigenvalues_below(&matrices.stiffness, &matrices.mass, (TAU * between).powi(2));
            assert_eq!(counted, Ok(rigid + index + 1), "{ends:?}, below {between} Hz of {known:?}");
        }
    }
}

#[test]
fn the_equal_modes_of_a_square_bar_are_found_and_counted_in_pairs() {
    let matrices = Matrices::of(&Mesh::of_box([0.2, 0.02, 0.02], [14, 2, 2], STEEL), |_, _| false).unwrap();
    let (stiffness, mass) = (&matrices.stiffness, &matrices.mass);
    let wanted = ModesWanted { at_least: 1, up_to: 0.0 };
    let shift = (TAU * 500.0_f64).powi(2);
    let modes = lowest_modes(stiffness, mass, &matrices.rigid, shift, wanted, |_, _| {}).unwrap();
    assert_eq!(modes.eigenvalues.len(), 2, "one was asked for, and it is double: {:?}", modes.eigenvalues);
    assert!((modes.eigenvalues[1] / modes.eigenvalues[0] - 1.0).abs() < 1e-8);
    assert_eq!(modes.check_complete(stiffness, mass), Ok(()));
}

#[test]
fn a_twin_that_has_lost_a_mode_is_told_so() {
    let fixture = Fixture::from_json(include_str!("../../../../fixtures/paper/D0.json")).unwrap();
    for whole in [false, true] {
        let coarse =
            MeshOptions { corner: 2, along: 6, across: 1, growth: 3.0, whole, ..MeshOptions::default() };
        let range = ModeRange { at_least: 4, up_to: 2000.0 };
        let mut twin = Twin::of(&fixture, &coarse, range, |_| {}).unwrap();
        assert_eq!(twin.check_complete(), Ok(()));
        assert!(twin.modes.complete_below > *twin.modes.eigenvalues.last().unwrap());
        // Two modes lie below the limit, and four were asked for.
        assert!(twin.modes.eigenvalues.len() >= 4);
        let all = twin.modes.rigid.len() + twin.modes.eigenvalues.len();
        twin.modes.eigenvalues.remove(1);
        let answer = twin.check_complete();
        let expected = |error: &FemError| {
            matches!(error, FemError::Sparse(SparseError::Missing { found, counted, .. })
                if *counted == all && *found == all - 1)
        };
        assert!(answer.as_ref().is_err_and(expected), "{answer:?}");
    }
}
