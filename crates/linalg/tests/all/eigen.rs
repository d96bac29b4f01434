use jointscope_linalg::{EigenError, generalized_symmetric_eigen};
use proptest::prelude::*;

/// Coordinates up to which modes are found without the library.
const FEW: usize = 8;

/// The modes of `n` coordinates as the library finds them: beside them stand so many of unit mass, uncoupled
/// and stiffer than `largest`, that they are not few.
fn by_library(n: usize, mass: &[f64], stiffness: &[f64], largest: f64) -> (Vec<f64>, Vec<Vec<f64>>) {
    let all = FEW + 1;
    let beside = |own: &[f64], other: f64| -> Vec<f64> {
        let entry = |i: usize, j: usize| match (i < n && j < n, i == j) {
            (true, _) => own[i * n + j],
            (false, true) => other,
            (false, false) => 0.0,
        };
        (0..all * all).map(|e| entry(e / all, e % all)).collect()
    };
    let basis =
        generalized_symmetric_eigen(all, &beside(mass, 1.0), &beside(stiffness, 2.0 * largest)).unwrap();
    let shapes = (0..n).map(|r| basis.shape(r)[..n].to_vec()).collect();
    (basis.eigenvalues()[..n].to_vec(), shapes)
}

proptest! {
    #[test]
    fn a_few_coordinates_have_the_modes_that_the_library_finds(
        n in 1usize..=FEW,
        v in prop::collection::vec(-1.0f64..1.0, 2 * FEW * FEW),
        decades in prop::collection::vec(-3i32..3, FEW),
        rigid in any::<bool>(),
    ) {
        let gram = |from: usize, rank: usize, i: usize, j: usize| -> f64 {
            (0..rank).map(|k| v[from + k * FEW + i] * v[from + k * FEW + j]).sum()
        };
        let unit = |i: usize| 10f64.powi(decades[i]);
        let of = |entry: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..n * n).map(|e| entry(e / n, e % n) * unit(e / n) * unit(e % n)).collect()
        };
        let mass = of(&|i, j| gram(0, FEW, i, j) + if i == j { 0.3 } else { 0.0 });
        // Of low rank, the stiffness leaves rigid motions.
        let rank = if rigid { n.div_ceil(2) } else { FEW };
        let stiffness = of(&|i, j| 1e8 * gram(FEW * FEW, rank, i, j));
        let few = generalized_symmetric_eigen(n, &mass, &stiffness).unwrap();
        let largest = few.eigenvalues()[n - 1];
        let (library, library_shapes) = by_library(n, &mass, &stiffness, largest);
        for r in 0..n {
            prop_assert!((few.eigenvalues()[r] - library[r]).abs() < 1e-12 * largest, "mode {}", r);
        }
        // Shapes of repeated values are free within their space; what all of them make of the stiffness is
        // not.
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let whole = |values: &[f64], shape: &dyn Fn(usize) -> Vec<f64>| -> f64 {
                (0..n).map(|r| shape(r)[i] * shape(r)[j] / (1.0 + values[r] / largest)).sum()
            };
            let few = whole(few.eigenvalues(), &|r| few.shape(r).to_vec());
            let library = whole(&library, &|r| library_shapes[r].clone());
            let size = unit(i).recip() * unit(j).recip();
            prop_assert!((few - library).abs() < 1e-10 * size, "({}, {})", i, j);
        }
    }
}

#[test]
fn two_masses_on_a_spring_have_a_rigid_mode_and_the_textbook_frequency() {
    let (m1, m2, k) = (2.0, 3.0, 5e6);
    let basis = generalized_symmetric_eigen(2, &[m1, 0.0, 0.0, m2], &[k, -k, -k, k]).unwrap();
    assert_eq!(basis.eigenvalues()[0], 0.0);
    let expected = k * (1.0 / m1 + 1.0 / m2);
    assert!((basis.eigenvalues()[1] / expected - 1.0).abs() < 1e-14);
    let rigid = basis.shape(0);
    assert!((rigid[0].abs() - (m1 + m2).sqrt().recip()).abs() < 1e-12 && (rigid[0] - rigid[1]).abs() < 1e-12);
}

#[test]
fn a_chain_of_two_hundred_stiff_springs_has_its_closed_form_frequencies() {
    // Stiffness of 1e12 N/m: the case in which an unscaled solver goes wrong without a word.
    let (n, k) = (200, 1e12);
    let mut mass = vec![0.0; n * n];
    let mut stiffness = vec![0.0; n * n];
    for i in 0..n {
        mass[i * n + i] = 1e-3;
        stiffness[i * n + i] = 2.0 * k;
        if i + 1 < n {
            stiffness[i * n + i + 1] = -k;
            stiffness[(i + 1) * n + i] = -k;
        }
    }
    let basis = generalized_symmetric_eigen(n, &mass, &stiffness).unwrap();
    for r in 0..n {
        let angle = std::f64::consts::PI * (r + 1) as f64 / (2.0 * (n + 1) as f64);
        let expected = 4.0 * k / 1e-3 * angle.sin().powi(2);
        let error = (basis.eigenvalues()[r] / expected - 1.0).abs();
        assert!(error < 1e-10, "mode {}: {} instead of {expected}", r + 1, basis.eigenvalues()[r]);
    }
}

/// Hermite elements of a beam with EI = m = L = 1 (eq of any textbook), its left end on springs of `clamp`
/// and `clamp`/4, as `clamp` may be zero.
fn beam(elements: usize, clamp: f64) -> (usize, Vec<f64>, Vec<f64>) {
    let (n, h) = (2 * (elements + 1), 1.0 / elements as f64);
    let k =
        [[12.0, 6.0, -12.0, 6.0], [6.0, 4.0, -6.0, 2.0], [-12.0, -6.0, 12.0, -6.0], [6.0, 2.0, -6.0, 4.0]];
    let m = [
        [156.0, 22.0, 54.0, -13.0],
        [22.0, 4.0, 13.0, -3.0],
        [54.0, 13.0, 156.0, -22.0],
        [-13.0, -3.0, -22.0, 4.0],
    ];
    let (mut mass, mut stiffness) = (vec![0.0; n * n], vec![0.0; n * n]);
    for e in 0..elements {
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
            let (at, turns) = ((2 * e + i) * n + 2 * e + j, (i % 2 + j % 2) as i32);
            stiffness[at] += k[i][j] * h.powi(turns - 3);
            mass[at] += m[i][j] * h.powi(turns + 1) / 420.0;
        }
    }
    stiffness[0] += clamp;
    stiffness[n + 1] += clamp / 4.0;
    (n, mass, stiffness)
}

#[test]
fn a_clamp_a_hundred_thousand_times_as_stiff_as_its_beam_leaves_every_mode_at_the_closed_form() {
    // Roots of cos x · cosh x = −1.
    let roots =
        [1.875_104_068_711_961_f64, 4.694_091_132_974_175, 7.854_757_438_237_613, 10.995_540_734_875_467];
    for (elements, clamp) in [(20, 1e8), (60, 1e8), (60, 1e12), (120, 1e8)] {
        let (n, mass, stiffness) = beam(elements, clamp);
        let basis = generalized_symmetric_eigen(n, &mass, &stiffness).unwrap();
        for (r, root) in roots.iter().enumerate() {
            let frequency = basis.eigenvalues()[r].max(0.0).sqrt();
            let error = frequency / (root * root) - 1.0;
            // What an element of so much of a wave is off by, and the clamp that gives way.
            let allowed = 2e-5 + (root / elements as f64).powi(4) / 1e3;
            assert!(error.abs() < allowed, "{elements} elements, mode {}: off by {error:.1e}", r + 1);
        }
    }
}

#[test]
fn a_beam_that_nothing_holds_keeps_its_two_motions_at_exactly_zero() {
    for elements in [5, 20, 60, 120] {
        let (n, mass, stiffness) = beam(elements, 0.0);
        let basis = generalized_symmetric_eigen(n, &mass, &stiffness).unwrap();
        assert_eq!(basis.eigenvalues()[..2], [0.0, 0.0], "{elements} elements");
        assert!((basis.eigenvalues()[2].sqrt() / 4.730_040_744_862_704_f64.powi(2) - 1.0).abs() < 1e-3);
    }
}

#[test]
fn a_motion_without_mass_is_refused() {
    let answer = generalized_symmetric_eigen(2, &[1.0, 0.0, 0.0, 0.0], &[1.0, 0.0, 0.0, 1.0]);
    assert_eq!(answer, Err(EigenError::MassNotPositive));
}
