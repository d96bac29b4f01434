//! The mode indicator against the closed form of two equal masses.

use jointscope_modes::ModeIndicator;
use jointscope_samples::transverse;
use jointscope_spectra::{Channel, Dof, FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// m, natural frequencies (Hz) and damping ratios of two equal masses, held alike and tied to each other:
/// they move together in the first mode and against each other in the second.
const MASS: f64 = 2.5;
const MODES: [(f64, f64); 2] = [(40.0, 0.01), (43.0, 0.02)];

fn lines() -> SpectralLines {
    SpectralLines::even(10.0, 0.5, 140).unwrap()
}

/// −ω²/(m(ω_r² − ω² + 2iζ_rω_rω)): what a mode contributes to the accelerances, whose matrix is ½[[h₁ + h₂,
/// h₁ − h₂], [h₁ − h₂, h₁ + h₂]].
fn mode((hz, ratio): (f64, f64), omega: f64) -> Complex64 {
    let natural = TAU * hz;
    let stiffness = Complex64::new(natural * natural - omega * omega, 2.0 * ratio * natural * omega);
    -omega * omega / (MASS * stiffness)
}

fn accelerance(pair: &FrfPair, omega: f64) -> Complex64 {
    let [first, second] = MODES.map(|own| mode(own, omega));
    let sign = if pair.response.point == pair.reference.point { 1.0 } else { -1.0 };
    0.5 * (first + sign * second)
}

fn set(pairs: Vec<FrfPair>) -> FrfSet {
    let lines = lines();
    let values = pairs
        .iter()
        .flat_map(|pair| lines.omegas().map(|omega| accelerance(pair, omega)).collect::<Vec<_>>());
    let values = values.collect();
    FrfSet::new(lines, FrfForm::Accelerance, pairs, values).unwrap()
}

const ALL: [(&str, &str); 4] = [("1", "1"), ("2", "1"), ("1", "2"), ("2", "2")];

#[test]
fn each_curve_of_two_equal_masses_is_one_mode() {
    let indicator = ModeIndicator::of(&set(transverse(&ALL))).unwrap();
    assert_eq!(indicator.curves.len(), 2);
    for (line, omega) in lines().omegas().enumerate() {
        let mut modes = MODES.map(|own| mode(own, omega).norm());
        modes.sort_by(|a, b| b.total_cmp(a));
        for (curve, expected) in indicator.curves.iter().zip(modes) {
            let found = curve[line];
            let hz = lines().hz()[line];
            assert!((found / expected - 1.0).abs() < 1e-11, "{hz} Hz: {found}, not {expected}");
        }
    }
    // Two modes within the width of one peak are two peaks of two curves.
    let peak = |curve: &[f64]| curve.windows(3).filter(|near| near[1] > near[0] && near[1] > near[2]).count();
    assert!(indicator.curves.iter().map(|curve| peak(curve)).sum::<usize>() >= 2);
}

#[test]
fn of_one_reference_it_is_the_root_of_the_summed_squares() {
    let frfs = set(transverse(&ALL[..2]));
    let indicator = ModeIndicator::of(&frfs).unwrap();
    assert_eq!(indicator.curves.len(), 1);
    for line in 0..lines().len() {
        let sum = frfs.values(0)[line].norm_sqr() + frfs.values(1)[line].norm_sqr();
        assert!((indicator.curves[0][line] / sum.sqrt() - 1.0).abs() < 1e-13);
    }
}

#[test]
fn channels_of_which_frfs_are_missing_and_rotations_beside_translations_are_left_out() {
    let whole = ModeIndicator::of(&set(transverse(&ALL))).unwrap();
    let mut pairs = transverse(&[("3", "1"), ("1", "4")]);
    pairs.extend(transverse(&ALL));
    pairs.push(FrfPair::new(Channel::rotational("2"), Channel::transverse("1")));
    let found = ModeIndicator::of(&set(pairs)).unwrap();
    assert_eq!(found.curves, whole.curves);
    let names = |channels: &[Channel]| channels.iter().map(Channel::to_string).collect::<Vec<_>>();
    assert_eq!(
        (names(&found.responses), names(&found.references)),
        (names(&whole.responses), names(&whole.references))
    );
    // FRFs that have no channel in common are no matrix of more than one.
    let apart = ModeIndicator::of(&set(transverse(&[("1", "1"), ("2", "2")]))).unwrap();
    assert_eq!((apart.curves.len(), apart.frfs()), (1, 1));
    let turned = FrfPair::new(Channel::rotational("1"), Channel::rotational("1"));
    assert_eq!(ModeIndicator::of(&set(vec![turned])).unwrap().responses[0].dof, Dof::Rotation);
    let mixed = FrfPair::new(Channel::rotational("1"), Channel::transverse("1"));
    assert_eq!(ModeIndicator::of(&set(vec![mixed])), None);
}
