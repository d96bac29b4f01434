//! The brick against fields and beams whose answers are known.

use crate::timoshenko::{Beam, Ends};
use jointscope_fem::{Elasticity, Matrices, Mesh};
use jointscope_linalg::{ModesWanted, SparseCholesky, lowest_modes};
use std::f64::consts::TAU;

const STEEL: Elasticity =
    Elasticity { youngs_modulus: 2.07e11, poisson_ratio: 0.3, density: 7850.0, shear_factor: 1.0 };

/// Forces at the free equations inside a block whose nodes all follow `field`, relative to the largest at its
/// faces.
fn unbalanced(mesh: &Mesh, size: [f64; 3], field: impl Fn([f64; 3]) -> [f64; 3]) -> f64 {
    let matrices = Matrices::of(mesh, |_, _| false).unwrap();
    let mut vector = vec![0.0; matrices.order()];
    for (node, place) in mesh.nodes.iter().enumerate() {
        for (a, value) in field(*place).into_iter().enumerate() {
            vector[matrices.equations[3 * node + a].unwrap()] = value;
        }
    }
    let forces = matrices.displacements(&matrices.stiffness.multiply(&vector));
    let low = [0.0, 0.0, -0.5 * size[2]];
    let inside =
        |place: &[f64; 3]| (0..3).all(|a| place[a] > low[a] + 1e-9 && place[a] < low[a] + size[a] - 1e-9);
    let largest = forces.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let inner = mesh.nodes.iter().enumerate().filter(|(_, place)| inside(place));
    inner.flat_map(|(node, _)| &forces[3 * node..3 * node + 3]).fold(0.0_f64, |m, f| m.max(f.abs())) / largest
}

#[test]
fn distorted_elements_carry_every_constant_strain_exactly() {
    let size = [0.03, 0.02, 0.01];
    let mut mesh = Mesh::of_box(size, [2, 2, 2], STEEL);
    // Push the middle corner about, and with it the edges that end there.
    let middle = mesh
        .nodes
        .iter()
        .position(|n| n.iter().zip([0.015, 0.01, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12))
        .unwrap();
    mesh.nodes[middle] = [0.018, 0.0085, 0.0012];
    for element in mesh.elements.clone() {
        for (edge, ends) in [
            (8, [0, 1]),
            (9, [1, 2]),
            (10, [2, 3]),
            (11, [3, 0]),
            (12, [4, 5]),
            (13, [5, 6]),
            (14, [6, 7]),
            (15, [7, 4]),
            (16, [0, 4]),
            (17, [1, 5]),
            (18, [2, 6]),
            (19, [3, 7]),
        ] {
            let [a, b] = ends.map(|end| mesh.nodes[element.nodes[end]]);
            mesh.nodes[element.nodes[edge]] = [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]));
        }
    }
    for strain in 0..9 {
        let field = |x: [f64; 3]| {
            let mut u = [0.0; 3];
            u[strain / 3] = x[strain % 3];
            u
        };
        let error = unbalanced(&mesh, size, field);
        assert!(error < 1e-12, "displacement {} growing along {}: {error:e}", strain / 3, strain % 3);
    }
}

#[test]
fn a_box_in_pure_bending_is_exact_however_long_its_elements() {
    let (size, nu) = ([0.4, 0.01, 0.02], STEEL.poisson_ratio);
    let mesh = Mesh::of_box(size, [4, 2, 2], STEEL);
    let bending = |[x, y, z]: [f64; 3]| {
        let y = y - 0.005;
        [-x * y, 0.5 * (x * x + nu * (y * y - z * z)), nu * y * z]
    };
    let error = unbalanced(&mesh, size, bending);
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn a_cantilever_sags_as_timoshenko_says() {
    let size = [0.2, 0.02, 0.01];
    let material = Elasticity { poisson_ratio: 0.0, ..STEEL };
    let mesh = Mesh::of_box(size, [10, 2, 1], material);
    let matrices = Matrices::of(&mesh, |place, _| place[0] == 0.0).unwrap();
    // A parabolic shear at the tip, as the beam has it: on one line of nodes the difference is St. Venant's.
    let tip: Vec<usize> =
        (0..mesh.nodes.len()).filter(|n| (mesh.nodes[*n][0] - size[0]).abs() < 1e-12).collect();
    let weight = |n: usize| {
        let y = mesh.nodes[n][1] / size[1];
        y * (1.0 - y)
    };
    let total: f64 = tip.iter().map(|n| weight(*n)).sum();
    let mut load = vec![0.0; matrices.order()];
    tip.iter().for_each(|n| load[matrices.equations[3 * n + 1].unwrap()] = 1000.0 * weight(*n) / total);
    SparseCholesky::of(&matrices.stiffness).unwrap().solve_in_place(&mut load);
    let displacement = matrices.displacements(&load);
    let found = displacement[3 * tip[tip.len() / 2] + 1];
    let (area, second) = (size[1] * size[2], size[2] * size[1].powi(3) / 12.0);
    let (bending, shear) =
        (material.youngs_modulus * second, 0.5 * material.youngs_modulus * area * 5.0 / 6.0);
    let expected = 1000.0 * (size[0].powi(3) / (3.0 * bending) + size[0] / shear);
    assert!((found / expected - 1.0).abs() < 3e-3, "{found:e} m for {expected:e} m");
}

/// Elastic frequencies of a box (Hz), cantilevered at x = 0 or free, that bend it in the plane.
fn bending_frequencies(size: [f64; 3], divisions: [usize; 3], clamped: bool, count: usize) -> Vec<f64> {
    let material = Elasticity { poisson_ratio: 0.0, ..STEEL };
    let mesh = Mesh::of_box(size, divisions, material);
    // Held to the plane everywhere: bending about the other axis and torsion stay out.
    let matrices = Matrices::of(&mesh, |place, a| a == 2 || (clamped && place[0] == 0.0)).unwrap();
    let rigid = if clamped { Vec::new() } else { plane_motions(&mesh, &matrices) };
    let first =
        Beam::of_box(size, &material).frequencies(if clamped { Ends::Clamped } else { Ends::Free }, 1)[0];
    let wanted = ModesWanted { at_least: 3 * count, up_to: 0.0 };
    let modes = lowest_modes(
        &matrices.stiffness,
        &matrices.mass,
        &rigid,
        (TAU * 0.2 * first).powi(2),
        wanted,
        |_, _| {},
    )
    .unwrap();
    let bends = |shape: &&Vec<f64>| {
        // Along the axis a bending mode moves across, an axial one along.
        let u = matrices.displacements(shape);
        let axis = |a: usize| mesh.nodes.iter().enumerate().map(|(n, _)| u[3 * n + a].powi(2)).sum::<f64>();
        axis(1) > axis(0)
    };
    let pairs = modes.eigenvalues.iter().zip(&modes.shapes).filter(|(_, shape)| bends(shape));
    pairs.map(|(value, _)| value.sqrt() / TAU).take(count).collect()
}

fn plane_motions(mesh: &Mesh, matrices: &Matrices) -> Vec<Vec<f64>> {
    let motions: [fn([f64; 3]) -> [f64; 2]; 3] = [|_| [1.0, 0.0], |_| [0.0, 1.0], |x| [-x[1], x[0]]];
    let vector = |motion: &fn([f64; 3]) -> [f64; 2]| {
        let mut vector = vec![0.0; matrices.order()];
        for (node, place) in mesh.nodes.iter().enumerate() {
            for (a, value) in motion(*place).into_iter().enumerate() {
                vector[matrices.equations[3 * node + a].unwrap()] = value;
            }
        }
        vector
    };
    motions.iter().map(vector).collect()
}

#[test]
fn a_cantilever_and_a_free_beam_vibrate_as_timoshenko_says() {
    let size = [0.3, 0.02, 0.01];
    let beam = Beam::of_box(size, &Elasticity { poisson_ratio: 0.0, ..STEEL });
    for (clamped, ends) in [(true, Ends::Clamped), (false, Ends::Free)] {
        let expected = beam.frequencies(ends, 4);
        let found = bending_frequencies(size, [32, 2, 1], clamped, 4);
        for (mode, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let error = found / expected - 1.0;
            assert!(error.abs() < 2e-3, "mode {}, {ends:?}: {found} Hz, Timoshenko {expected} Hz", mode + 1);
        }
    }
}

#[test]
fn frequencies_converge_with_the_fourth_power_of_the_element_size() {
    let frequency = |n: usize| bending_frequencies([0.1, 0.02, 0.02], [3 * n, n, n], false, 1)[0];
    let [coarse, medium, fine] = [1, 2, 4].map(frequency);
    let order = ((coarse - medium) / (medium - fine)).log2();
    assert!(
        coarse > medium && medium > fine,
        "{coarse} {medium} {fine}: from above, as a displacement method must"
    );
    assert!(order > 3.4 && order < 4.6, "order {order}: {coarse} {medium} {fine} Hz");
}

#[test]
fn six_motions_of_a_free_block_cost_nothing_and_their_modes_are_at_zero() {
    let mesh = Mesh::of_box([0.1, 0.03, 0.02], [5, 2, 2], STEEL);
    let matrices = Matrices::of(&mesh, |_, _| false).unwrap();
    assert_eq!(matrices.rigid.len(), 6);
    let wanted = ModesWanted { at_least: 7, up_to: 0.0 };
    let shift = (TAU * 2000.0_f64).powi(2);
    // Not told of them, the search finds the six by itself.
    let modes = lowest_modes(&matrices.stiffness, &matrices.mass, &[], shift, wanted, |_, _| {});
    let told =
        lowest_modes(&matrices.stiffness, &matrices.mass, &matrices.rigid, shift, wanted, |_, _| {}).unwrap();
    let first = told.eigenvalues[0];
    for motion in &told.rigid {
        let ratio = (matrices.rayleigh_quotient(&mesh, motion) / first).sqrt();
        assert!(ratio < 1e-6, "a rigid motion at {ratio:e} of the first elastic frequency");
    }
    // Their residual relative to λM φ means nothing at λ = 0, so they are refused rather than handed out as
    // they are.
    assert!(modes.is_err() || modes.unwrap().eigenvalues[..6].iter().all(|value| value.abs() < 1e-6 * first));
}
