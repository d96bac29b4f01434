//! What the analysis does with the sets that people have: any form, any roving, gaps, one FRF, none worth it.

use crate::common::*;
use jointscope_modes::{ExpectedMode, ModalAnalysis, ModesError, ModesOptions, match_modes};
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use jointscope_wording::Remarks;
use num_complex::Complex64;

const FOUR: [(usize, usize); 4] = [(4, 1), (3, 1), (4, 2), (3, 2)];

fn three() -> Vec<TrueMode> {
    vec![
        mode(120.0, 0.003, &[1.0, 0.2, -0.3, -0.9]),
        mode(410.0, 0.006, &[0.8, -0.7, 0.6, 0.9]),
        mode(700.0, 0.01, &[0.3, 0.7, 0.9, -0.5]),
    ]
}

fn lines() -> SpectralLines {
    SpectralLines::even(0.0, 2.5, 401).unwrap()
}

fn of(modes: &[TrueMode], pairs: &[(usize, usize)], lines: &SpectralLines, seed: u64) -> FrfSet {
    noisy(&accelerances(modes, 2.0, pairs, lines), pairs, lines, 1e-4, 0.01, seed)
}

fn analyse(set: &FrfSet) -> ModalAnalysis {
    ModalAnalysis::of(set, &ModesOptions::default()).unwrap()
}

/// Every mode within five of its standard deviations, none missing and none besides.
#[track_caller]
fn meets(analysis: &ModalAnalysis, truth: &[TrueMode]) {
    let found: Vec<f64> = analysis.modes.iter().map(|m| m.frequency).collect();
    assert_eq!(found.len(), truth.len(), "found {found:?} Hz");
    for (mode, truth) in analysis.modes.iter().zip(truth) {
        let off = (mode.frequency - truth.frequency) / mode.frequency_std;
        assert!(off.abs() < 5.0, "{} ± {} Hz of {} Hz", mode.frequency, mode.frequency_std, truth.frequency);
        let off = (mode.damping_ratio - truth.ratio) / mode.damping_std;
        assert!(off.abs() < 5.0, "{} ± {} of {}", mode.damping_ratio, mode.damping_std, truth.ratio);
    }
}

#[test]
fn receptances_mobilities_and_accelerances_tell_the_same_modes() {
    let set = of(&three(), &FOUR, &SpectralLines::even(2.5, 2.5, 400).unwrap(), 1);
    let as_recorded = analyse(&set);
    meets(&as_recorded, &three());
    for form in [FrfForm::Mobility, FrfForm::Receptance] {
        let other = analyse(&set.to_form(form).unwrap());
        for (a, b) in as_recorded.modes.iter().zip(&other.modes) {
            assert!((a.frequency - b.frequency).abs() < 1e-6 * a.frequency_std.max(1e-3), "{form:?}");
            assert!((a.damping_ratio - b.damping_ratio).abs() < 1e-4 * a.damping_std, "{form:?}");
        }
    }
}

#[test]
fn shapes_and_modal_masses_come_out_as_they_are() {
    let pairs: Vec<(usize, usize)> = (1..5).flat_map(|o| [(o, 1), (o, 2)]).collect();
    let analysis = analyse(&of(&three(), &pairs, &lines(), 2));
    for (mode, truth) in analysis.modes.iter().zip(three()) {
        let largest = truth.shape.iter().fold(0.0, |l: f64, s| if s.abs() > l.abs() { *s } else { l });
        for ((channel, value), true_value) in mode.responses.iter().zip(&truth.shape) {
            assert!(
                (value - true_value / largest).norm() < 0.02,
                "{channel}: {value} of {}",
                true_value / largest
            );
        }
        // Shapes are mass-normalised, so the mass of one whose largest entry is one is that entry's square's
        // inverse.
        let mass = mode.modal_mass.unwrap() * largest * largest;
        assert!((mass - 1.0).abs() < 0.02, "{mass}");
        assert!(mode.phase_collinearity > 0.999);
    }
    let mac = analysis.auto_mac();
    assert!((0..3).all(|r| (mac[4 * r] - 1.0).abs() < 1e-12));
    assert!(analysis.relative_errors().iter().all(|error| *error < 0.02));
}

#[test]
fn a_roving_hammer_and_a_roving_sensor_tell_the_same() {
    let hammer = [(4, 1), (4, 2), (4, 3), (4, 4)];
    let sensor = hammer.map(|(o, i)| (i, o));
    let one = analyse(&of(&three(), &hammer, &lines(), 3));
    let other = analyse(&of(&three(), &sensor, &lines(), 3));
    meets(&one, &three());
    for (a, b) in one.modes.iter().zip(&other.modes) {
        assert!((a.frequency - b.frequency).abs() < 1e-4 * a.frequency_std);
        assert!((a.damping_ratio - b.damping_ratio).abs() < 1e-4 * a.damping_std);
        let same = a.references.iter().zip(&b.responses);
        same.for_each(|(x, y)| assert!(x.0 == y.0 && (x.1 - y.1).norm() < 1e-6, "{x:?} {y:?}"));
    }
}

#[test]
fn a_matrix_with_gaps_shares_poles_only_and_says_so() {
    let set = of(&three(), &[(4, 1), (3, 1), (4, 2)], &lines(), 4);
    let analysis = analyse(&set);
    meets(&analysis, &three());
    assert!(!analysis.complete && analysis.modes[0].responses.is_empty());
    assert!(analysis.remarks()[0].contains("share their poles only"), "{:?}", analysis.remarks());
}

#[test]
fn a_record_of_another_scale_doubles_every_mode_and_is_told() {
    let nine: Vec<(usize, usize)> = (2..5).flat_map(|o| [(o, 1), (o, 2), (o, 3)]).collect();
    let six: Vec<(usize, usize)> = nine.iter().copied().filter(|(_, i)| *i < 3).collect();
    let scaled = |pairs: &[(usize, usize)], factor: f64| {
        let set = of(&three(), pairs, &lines(), 5);
        let set = set.with_values(|at, value| if at / 401 == 3 { factor * value } else { value });
        analyse(&set)
    };
    for factor in [1.0 / 9.80665, -1.0] {
        let analysis = scaled(&nine, factor);
        let uneven = analysis.uneven_scale().unwrap();
        let [(3, told)] = uneven.frfs[..] else { panic!("{uneven:?}") };
        assert!((told / factor - 1.0).abs() < 0.02, "{uneven:?}");
        assert!(analysis.remarks().iter().any(|remark| remark.contains("one FRF is of another scale")));
    }
    // To one response with two references it may be either, of two by two it may be any.
    for (pairs, count) in [(&six[..], 2), (&FOUR[..], 4)] {
        let told = scaled(pairs, 0.5).uneven_scale().unwrap().frfs;
        assert_eq!(told.len(), count);
        assert!(told.iter().all(|(_, factor)| (factor.ln().abs() - 2f64.ln()).abs() < 0.02), "{told:?}");
    }
    assert_eq!(scaled(&six, 1.0).uneven_scale(), None);
    // Two that are really close are two.
    let close = [three(), vec![mode(120.01, 0.003, &[-0.9, 0.5, 0.3, 0.2])]].concat();
    assert_eq!(analyse(&of(&close, &six, &lines(), 6)).uneven_scale(), None);
}

#[test]
fn one_frf_does_and_says_what_it_costs() {
    let analysis = analyse(&of(&three(), &FOUR[..1], &lines(), 5));
    meets(&analysis, &three());
    assert!(analysis.remarks()[0].starts_with("there is one FRF"), "{:?}", analysis.remarks());
}

#[test]
fn gaps_and_uneven_lines_do() {
    let hz: Vec<f64> = (1..=400).map(|k| 2.5 * k as f64 + 0.8 * (k as f64).sin()).collect();
    let gappy = |f: &f64| !(180.0..260.0).contains(f) && !(408.0..409.0).contains(f);
    let lines = SpectralLines::new(hz.into_iter().filter(gappy).collect()).unwrap();
    meets(&analyse(&of(&three(), &FOUR, &lines, 6)), &three());
}

#[test]
fn modes_on_both_sides_of_a_band_do_not_bend_those_inside() {
    let many: Vec<TrueMode> = (1..=12)
        .map(|k| {
            let k = f64::from(k);
            let shape = [(0.7 * k).cos(), (1.3 * k).sin(), (2.1 * k + 0.4).cos(), (1.0 + 0.9 * k).sin()];
            mode(60.0 * k + 7.0 * (k * k % 5.0), 0.002 * (1.0 + k % 4.0), &shape)
        })
        .collect();
    let set = of(&many, &FOUR, &SpectralLines::even(1.0, 1.0, 800).unwrap(), 7);
    let options = ModesOptions { band: Some((200.0, 580.0)), ..ModesOptions::default() };
    let analysis = ModalAnalysis::of(&set, &options).unwrap();
    let inside: Vec<TrueMode> = many.into_iter().filter(|m| (200.0..580.0).contains(&m.frequency)).collect();
    meets(&analysis, &inside);
    assert!(analysis.chi2_per_dof < 1.1, "{}", analysis.chi2_per_dof);
}

#[test]
fn a_mode_that_hardly_decays_is_found_whichever_way_noise_turns_it() {
    let mut modes = three();
    modes[0] = mode(62.654, 1e-5, &[1.0, 0.2, -0.3, -0.9]);
    let lines = SpectralLines::even(20.0, 1.25, 800).unwrap();
    for seed in 0..20 {
        let found = analyse(&of(&modes, &FOUR, &lines, seed));
        let hz: Vec<f64> = found.modes.iter().map(|mode| mode.frequency).collect();
        assert!(hz.len() == 3 && (hz[0] - 62.654).abs() < 0.01, "seed {seed}: {hz:?} Hz");
        assert!(found.chi2_per_dof < 1.2, "seed {seed}: {}", found.chi2_per_dof);
    }
}

#[test]
fn noise_alone_and_a_rigid_mass_alone_have_no_modes() {
    let refused = |set: &FrfSet| {
        let error = ModalAnalysis::of(set, &ModesOptions::default()).unwrap_err();
        assert!(matches!(error, ModesError::NothingStable { .. }), "{error}");
        assert!(error.to_string().contains("nothing is stable"), "{error}");
    };
    for seed in 0..30 {
        let pairs = if seed % 2 == 0 { &FOUR[..] } else { &FOUR[..1] };
        let clean = vec![Complex64::ZERO; pairs.len() * 400];
        let even = SpectralLines::even(2.5, 2.5, 400).unwrap();
        refused(&noisy(&clean, pairs, &even, 1.0, 0.0, seed));
        refused(&without_variances(&noisy(&clean, pairs, &even, 1.0, 0.0, seed)));
        refused(&of(&[], pairs, &even, seed));
    }
}

#[test]
fn a_resonance_that_moves_from_frf_to_frf_is_known_no_better_than_it_stays() {
    let lines = SpectralLines::even(100.0, 0.05, 800).unwrap();
    let places = [0.0, 0.02, -0.015, 0.01, -0.02, 0.012];
    let pairs: Vec<(usize, usize)> = (1..=6).map(|i| (1, i)).collect();
    let mut clean = Vec::new();
    for (k, place) in places.iter().enumerate() {
        let moved = mode(120.0 + place, 3e-4, &[1.0, 0.9, 0.8, -0.7, -0.8, -1.0]);
        clean.extend(accelerances(&[moved], 2.0, &[(1, k + 1)], &lines));
    }
    let analysis = analyse(&noisy(&clean, &pairs, &lines, 0.0, 0.01, 8));
    let mode = &analysis.modes[0];
    let drift = mode.drift.as_ref().unwrap();
    assert!((drift.frequency / 0.0164 - 1.0).abs() < 0.1, "scatter {} of 0.0164 Hz", drift.frequency);
    assert!(mode.frequency_std > drift.frequency);
    // A pole for all would be as wide as the places are apart.
    assert!((mode.damping_ratio / 3e-4 - 1.0).abs() < 0.02, "{}", mode.damping_ratio);
    assert!(analysis.remarks().iter().any(|r| r.contains("differ from FRF to FRF")));
}

#[test]
fn poles_picked_by_hand_are_taken_and_picks_beside_them_refused() {
    let set = of(&three(), &FOUR, &lines(), 9);
    let pick = |pick: &[f64]| {
        ModalAnalysis::of(&set, &ModesOptions { pick: pick.to_vec(), ..ModesOptions::default() })
    };
    meets(&pick(&[700.9, 120.2, 409.0]).unwrap(), &three());
    let two = pick(&[120.2, 409.0]).unwrap();
    let hz: Vec<f64> = two.modes.iter().map(|m| m.frequency.round()).collect();
    assert_eq!(hz, [120.0, 410.0]);
    assert!(two.chi2_per_dof > 2.0, "the third is missed");
    let error = pick(&[250.0]).unwrap_err();
    assert!(matches!(error, ModesError::NothingThere { picked: 250.0, .. }), "{error}");
}

#[test]
fn what_cannot_be_done_is_refused_in_a_sentence() {
    let set = of(&three(), &FOUR, &lines(), 10);
    let refused = |set: &FrfSet, options: ModesOptions, part: &str| {
        let message = ModalAnalysis::of(set, &options).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    };
    let band = |from, to| ModesOptions { band: Some((from, to)), ..ModesOptions::default() };
    refused(&set, band(300.0, 305.0), "widen the band");
    refused(&set, band(1e4, 2e4), "widen the band");
    refused(&set, ModesOptions { orders: Some((2, 4000)), ..ModesOptions::default() }, "orders 2 to 4000");
    refused(&set, ModesOptions { orders: Some((5, 6)), ..ModesOptions::default() }, "tell which poles stay");
    let dead = FrfSet::new(
        lines(),
        FrfForm::Accelerance,
        vec![FrfPair::transverse("1", "1")],
        vec![Complex64::ZERO; 401],
    );
    refused(&dead.unwrap(), ModesOptions::default(), "is a channel dead?");
}

#[test]
fn a_dead_channel_among_others_spoils_nothing() {
    let mut clean = accelerances(&three(), 2.0, &FOUR, &lines());
    clean[..401].fill(Complex64::ZERO);
    let set = noisy(&clean, &FOUR, &lines(), 0.0, 0.01, 11);
    for set in [without_variances(&set), set] {
        let analysis = analyse(&set);
        meets(&analysis, &three());
        assert!(analysis.remarks().iter().any(|r| r.contains("FRF 4/1 is zero")), "{:?}", analysis.remarks());
    }
}

#[test]
fn the_same_set_gives_the_same_modes() {
    let set = without_variances(&of(&three(), &FOUR, &lines(), 12));
    let (one, other) = (analyse(&set), analyse(&set));
    assert_eq!(one.modes, other.modes);
    assert_eq!(one.chart, other.chart);
}

#[test]
fn measured_modes_are_matched_by_frequency_and_shape_and_what_is_left_over_is_named() {
    let analysis = analyse(&of(&three(), &FOUR, &lines(), 13));
    let expected = |frequency: f64, truth: &TrueMode| ExpectedMode {
        frequency,
        products: FOUR.iter().map(|(o, i)| truth.shape[o - 1] * truth.shape[i - 1]).collect(),
    };
    let truth = three();
    // The model has the second mode a little low, one that was not measured just beside it, and none like the
    // third.
    let model = [expected(121.0, &truth[0]), expected(400.0, &truth[1]), expected(415.0, &truth[0])];
    let matches = match_modes(&analysis.modes, &model);
    let mut pairs: Vec<(usize, usize)> = matches.pairs.iter().map(|p| (p.measured, p.expected)).collect();
    pairs.sort_unstable();
    assert_eq!(pairs, [(0, 0), (1, 1)]);
    assert_eq!((matches.other_measured, matches.other_expected), (vec![2], vec![2]));
}
