//! The simulated hammer test: what its noise and coherence must be.

use crate::common::chi_squared;
use jointscope_fixture::Fixture;
use jointscope_rig::{Family, HammerSetup, Instrument, frfs, generator};
use jointscope_spectra::{FrfSet, SpectralLines};

const HAMMER: HammerSetup = HammerSetup {
    averages: 8,
    noise_response: 0.01,
    noise_force: 0.002,
    corner: 900.0,
    spread: 0.25,
    common_hits: false,
    seed: 3,
};

fn truth(seed: u64) -> (Fixture, FrfSet) {
    let fixture = Family::TwoBlocks.draw("two blocks", &mut generator(seed)).unwrap();
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let set = frfs(&fixture, &Family::TwoBlocks.usual_pairs(), &lines, Instrument::Perfect).unwrap();
    (fixture, set)
}

#[test]
fn the_truth_explains_its_recording_with_chi_squared_of_one_whatever_the_averages() {
    for averages in [5, 8, 20] {
        let (mut chi2, mut dof) = (0.0, 0.0);
        for seed in 0..10 {
            let truth = truth(seed).1;
            let recorded = HammerSetup { averages, seed, ..HAMMER }.measure(&truth).unwrap();
            let (c, d) = chi_squared(&recorded, &truth, 10);
            chi2 += c;
            dof += d;
        }
        println!("averages {averages}: chi2/dof {:.3}", chi2 / dof);
        assert!((chi2 / dof - 1.0_f64).abs() < 0.05, "averages {averages}: {}", chi2 / dof);
    }
}

#[test]
fn the_same_seed_gives_the_same_recording_and_another_seed_another() {
    let truth = truth(1).1;
    let recorded = HAMMER.measure(&truth).unwrap();
    assert_eq!(recorded, HAMMER.measure(&truth).unwrap());
    assert_ne!(recorded, HammerSetup { seed: 4, ..HAMMER }.measure(&truth).unwrap());
}

#[test]
fn without_noise_the_truth_comes_back_with_a_coherence_of_one() {
    let truth = truth(2).1;
    let quiet = HammerSetup { noise_response: 0.0, noise_force: 0.0, ..HAMMER };
    let recorded = quiet.measure(&truth).unwrap();
    for index in 0..4 {
        assert!(recorded.coherence(index).unwrap().iter().all(|g| (1.0 - g).abs() < 1e-12));
        for (a, b) in recorded.values(index).iter().zip(truth.values(index)) {
            assert!((a - b).norm() < 1e-12 * b.norm());
        }
        assert_eq!(recorded.averages(index), Some(8));
    }
}

/// Correlation of the errors of FRFs 4/1 and 3/1, each relative to its truth.
fn correlation(common_hits: bool) -> f64 {
    let truth = truth(5).1;
    let hammer = HammerSetup { noise_response: 1e-5, noise_force: 0.02, common_hits, ..HAMMER };
    let recorded = hammer.measure(&truth).unwrap();
    let error = |index: usize| {
        let truth = truth.values(index).to_vec();
        recorded.values(index).iter().zip(truth).map(|(a, b)| a / b - 1.0).collect::<Vec<_>>()
    };
    let (a, b) = (error(0), error(1));
    let product: f64 = a.iter().zip(&b).map(|(x, y)| (x * y.conj()).re).sum();
    let size = |e: &[num_complex::Complex64]| e.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt();
    product / (size(&a) * size(&b))
}

#[test]
fn responses_recorded_in_common_hits_share_the_noise_of_the_force() {
    let (common, roving) = (correlation(true), correlation(false));
    assert!(common > 0.95, "common hits: {common}");
    assert!(roving.abs() < 0.2, "hits of their own: {roving}");
}

#[test]
fn impossible_settings_are_refused_in_words() {
    let truth = truth(1).1;
    let error = HammerSetup { averages: 1, ..HAMMER }.measure(&truth).unwrap_err();
    assert_eq!(error.to_string(), "1 averages leave no coherence: at least 2 are needed");
    assert!(HammerSetup { noise_force: -0.1, ..HAMMER }.measure(&truth).is_err());
    assert!(HammerSetup { corner: 0.0, ..HAMMER }.measure(&truth).is_err());
}
