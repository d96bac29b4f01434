//! Which mode of a model is which of a recording.

use crate::common::*;
use jointscope_model_error::{Expected, ModelledModes, Pairing, RecordedModes, WeightedFrfs};
use jointscope_modes::ModesOptions;
use jointscope_spectra::SpectralLines;
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::sync::LazyLock;

static SIX: LazyLock<(RecordedModes, ModelledModes)> = LazyLock::new(|| {
    let fixture = chain(7);
    let pairs = pairs(&[("1", "1"), ("2", "1"), ("4", "1")]);
    let recorded = Recorded::of(&fixture, &pairs, &lines(800.0), noise(None)).modes();
    let model = modelled(&fixture, &recorded);
    assert_eq!((recorded.modes.len(), model.modes.len()), (6, 6), "modes of seven masses in a row");
    (recorded, model)
});

fn each_with_its_own() -> Vec<(usize, usize)> {
    (0..6).map(|k| (k, k)).collect()
}

/// A mode more between the third and the fourth, of a shape of its own.
fn with_a_spurious_mode(recorded: &RecordedModes) -> RecordedModes {
    let mut with = recorded.clone();
    let mut spurious = with.modes[2].clone();
    spurious.pole.omega = 0.5 * (with.modes[2].pole.omega + with.modes[3].pole.omega);
    spurious.residues = vec![Complex64::new(0.0, 0.3), Complex64::new(0.4, 0.0), Complex64::new(0.0, -0.5)];
    with.modes.insert(3, spurious);
    with
}

#[test]
fn modes_of_the_model_that_was_recorded_pair_one_by_one() {
    let pairing = Pairing::of(&SIX.0, &SIX.1);
    assert_eq!(pairing.pairs, each_with_its_own());
    assert_eq!(pairing.alone(), 0.0, "nats for modes without a partner");
}

#[test]
fn a_mode_that_is_off_in_frequency_pairs_by_its_shape() {
    for moved in 0..6 {
        let mut model = SIX.1.clone();
        model.modes[moved].pole.omega *= 1.06;
        model.modes.sort_by(|a, b| a.pole.omega.total_cmp(&b.pole.omega));
        // Where the move keeps the order, the partner stays.
        if model.modes[moved].residues == SIX.1.modes[moved].residues {
            let hz = SIX.1.modes[moved].pole.omega / TAU;
            assert_eq!(Pairing::of(&SIX.0, &model).pairs, each_with_its_own(), "mode at {hz:.1} Hz, 6 % off");
        }
    }
}

#[test]
fn a_spurious_mode_of_the_recording_is_left_alone() {
    let (recorded, model) = &*SIX;
    let with = with_a_spurious_mode(recorded);
    let pairing = Pairing::of(&with, model);
    assert_eq!(pairing.pairs, [(0, 0), (1, 1), (2, 2), (4, 3), (5, 4), (6, 5)]);
    // ln of: any frequency in the band, any damping ratio of four decades, three complex residues of their
    // own size.
    let (low, high) = recorded.band;
    let expected = -((high / low).ln().ln() + (4.0 * 10f64.ln()).ln() + 3.0 * (TAU.ln() + 0.5));
    assert!((pairing.alone() - expected).abs() < 1e-9, "{} nats, expected {expected}", pairing.alone());
}

#[test]
fn a_mode_without_a_partner_may_take_that_of_either_neighbour() {
    let (recorded, model) = &*SIX;
    // Of a recorded mode that has none …
    let with = with_a_spurious_mode(recorded);
    let pairing = Pairing::of(&with, model);
    let others: Vec<_> = pairing.others(&with, model).into_iter().map(|other| other.pairs).collect();
    let own = [(0, 0), (1, 1), (2, 2), (4, 3), (5, 4), (6, 5)];
    let [mut below, mut above] = [own; 2];
    (below[2], above[3]) = ((3, 2), (3, 3));
    assert_eq!(others, [below, above]);
    // … and of a mode of the model that has none, which then costs what its neighbour would if the recording
    // did not show it.
    let mut fewer = recorded.clone();
    fewer.modes.remove(5);
    let pairing = Pairing::of(&fewer, model);
    let [other] = &pairing.others(&fewer, model)[..] else { panic!("one neighbour alone") };
    assert_eq!((pairing.pairs[4], other.pairs[4]), ((4, 4), (4, 5)));
    // Both are as plain as any: the most that one may cost.
    assert_eq!((pairing.alone(), other.alone()), (-60.0, -60.0));
    assert!(Pairing::of(recorded, model).others(recorded, model).is_empty());
}

#[test]
fn a_mode_of_the_model_that_a_recording_does_not_show_costs_half_its_chi_square() {
    let (recorded, model) = &*SIX;
    // A floor alone, so that every line weighs the same.
    let floor = Noise { floor: 0.01, share: 0.0, seed: None };
    let fixture = chain(7);
    let pairs = pairs(&[("1", "1"), ("2", "1"), ("4", "1")]);
    let set = Recorded::of(&fixture, &pairs, &lines(800.0), floor);
    let recorded_so = set.modes();
    assert_eq!(recorded_so.modes.len(), recorded.modes.len());
    let mut with = model.clone();
    let mut unseen = model.modes[5].clone();
    unseen.pole.omega *= 1.06;
    unseen.pole.damping_ratio = 0.01;
    unseen.residues = vec![Complex64::new(3e-4, 0.0), Complex64::new(0.0, 2e-4), Complex64::new(1e-4, 0.0)];
    with.modes.push(unseen.clone());
    let pairing = Pairing::of(&recorded_so, &with);
    assert_eq!(pairing.pairs, each_with_its_own());
    let (omega, ratio) = (unseen.pole.omega, unseen.pole.damping_ratio);
    let mut chi2 = 0.0;
    for line in set.set.lines().omegas() {
        let s = Complex64::new(0.0, line);
        let response = s * s / (s * s + 2.0 * ratio * omega * s + omega * omega);
        chi2 +=
            unseen.residues.iter().map(|a| (a * response).norm_sqr() * 2.0 / 0.01f64.powi(2)).sum::<f64>();
    }
    let found = -2.0 * pairing.alone();
    assert!((found / chi2 - 1.0).abs() < 0.1, "χ² of the unseen mode {found:.3}, line by line {chi2:.3}");
}

#[test]
fn a_mode_that_the_analysis_left_out_is_found_by_the_model_that_expects_it() {
    let fixture = blocks("");
    let set = Recorded::of(&fixture, &four(), &lines(1500.0), noise(Some(1)));
    let recording = WeightedFrfs { frfs: &set.set, weights: &set.weights };
    // The analyst picked the second mode only. The first is narrower than the lines are apart: by itself it
    // might be a tone.
    let options = ModesOptions { pick: vec![907.8], ..ModesOptions::default() };
    let without = RecordedModes::of(recording, &options, |_| Expected::default()).unwrap();
    let expected = without.expected_by(&fixture);
    let hz: Vec<f64> = expected.unpaired.iter().map(|pole| pole.omega / TAU).collect();
    assert!(hz.len() == 1 && (hz[0] - 247.0).abs() < 1.0, "expected besides: {hz:.1?} Hz");
    let with = RecordedModes::of(recording, &options, |_| expected).unwrap();
    assert_eq!(with.modes.len(), 2, "modes with the expected one");
    assert!((0.9..1.1).contains(&with.chi2_per_dof), "χ² per degree of freedom {:.3}", with.chi2_per_dof);
    assert!(with.expected_by(&fixture).unpaired.is_empty());
}

#[test]
fn a_wide_mode_that_the_analysis_left_out_is_found_without_a_model_that_expects_it() {
    let set = Recorded::of(&blocks(""), &four(), &lines(1500.0), noise(Some(1)));
    let recording = WeightedFrfs { frfs: &set.set, weights: &set.weights };
    let options = ModesOptions { pick: vec![247.0], ..ModesOptions::default() };
    let found = RecordedModes::of(recording, &options, |_| Expected::default()).unwrap();
    assert_eq!(found.modes.len(), 2);
    assert!((0.9..1.1).contains(&found.chi2_per_dof), "χ² per degree of freedom {:.3}", found.chi2_per_dof);
}

proptest! {
    #[test]
    fn pairs_keep_the_order_of_both(
        shifts in prop::collection::vec(-0.3..0.3f64, 6),
        kept in prop::collection::vec(any::<bool>(), 6),
        shown in prop::collection::vec(any::<bool>(), 6),
    ) {
        let (mut recorded, mut model) = SIX.clone();
        let mut keep = kept.iter();
        model.modes.retain(|_| *keep.next().unwrap());
        model.modes.iter_mut().zip(&shifts).for_each(|(mode, shift)| mode.pole.omega *= shift.exp());
        model.modes.sort_by(|a, b| a.pole.omega.total_cmp(&b.pole.omega));
        let mut show = shown.iter();
        recorded.modes.retain(|_| *show.next().unwrap());
        let pairs = Pairing::of(&recorded, &model).pairs;
        prop_assert!(pairs.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 < w[1].1), "{pairs:?}");
        prop_assert!(pairs.iter().all(|&(r, m)| r < recorded.modes.len() && m < model.modes.len()), "{pairs:?}");
    }
}

#[test]
fn a_mode_just_above_the_lowest_line_counts_where_the_model_has_none() {
    // Damped so that the lines tell by how much, and so little that they tell no more than that.
    for dashpot in [10.0, 0.05] {
        counts_just_above_the_lowest_line(dashpot);
    }
}

fn counts_just_above_the_lowest_line(dashpot: f64) {
    // On a spring that nobody stated, 52 Hz, on lines from 20 Hz: the third line above the lowest.
    let spring =
        &format!(r#"{{"kind": "support", "place": "A", "x": 0, "stiffness": 5.4e5, "damping": {dashpot}}}"#);
    let lines = SpectralLines::even(20.0, 9.5, 120).unwrap();
    let set =
        Recorded::of(&two_masses(0.004, spring), &pairs(&[("1", "1"), ("2", "1")]), &lines, noise(Some(1)));
    let recording = WeightedFrfs { frfs: &set.set, weights: &set.weights };
    let beside = |physics: &str| {
        let fixture = two_masses(0.004, physics);
        let expected = |alone: &RecordedModes| alone.expected_by(&fixture);
        RecordedModes::of(recording, &ModesOptions::default(), expected).unwrap()
    };
    let recorded = beside("");
    let lowest = &recorded.modes[0];
    assert!(lowest.resolved && (lowest.pole.omega / TAU - 52.0).abs() < 3.0, "{dashpot} N s/m: {lowest:?}");
    let alone = |physics: &str| Compared::of(&two_masses(0.004, physics), recorded.clone()).pairing.alone();
    assert!(alone("") < -5.0, "the model without the spring lacks it: {}", alone(""));
    assert_eq!(alone(spring), 0.0);
    // Of a model that states it, it stays a part of the mass line, as a suspension is.
    assert!(beside(spring).modes.iter().all(|mode| mode.pole.omega > TAU * 58.0));
}
