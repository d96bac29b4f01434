//! Features of two masses on a spring against the textbook.

use crate::common::*;
use jointscope_fixture::{Damping, Fixture, Quantity};
use jointscope_model_error::{
    ErrorSizes, ModelledModes, Pairing, Pole, Shapes, SharedFeatures, modes_within,
};
use jointscope_spectra::{FrfPair, SpectralLines};
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Masses of [`two_masses`], kg, and the spring, N/m.
const MASSES: (f64, f64) = (2.0, 3.0);
const SPRING: f64 = 5e6;

/// ω = √(k(1/m₁ + 1/m₂)), rad/s.
fn natural() -> f64 {
    (SPRING * (1.0 / MASSES.0 + 1.0 / MASSES.1)).sqrt()
}

/// Mass-normalised shape of the elastic mode: φ₁ = √(m₂/(m₁M)), φ₂ = −√(m₁/(m₂M)).
fn shape() -> (f64, f64) {
    let (m1, m2) = MASSES;
    ((m2 / (m1 * (m1 + m2))).sqrt(), -(m1 / (m2 * (m1 + m2))).sqrt())
}

#[test]
fn poles_and_residues_of_two_masses_are_those_of_the_textbook() {
    let pairs = pairs(&[("1", "1"), ("2", "1"), ("2", "2")]);
    let (a, b) = shape();
    for ratio in [0.001, 0.01, 0.1] {
        let fixture = two_masses(ratio, "");
        let recorded = Recorded::of(&fixture, &pairs, &lines(600.0), noise(None)).modes();
        let modes = modelled(&fixture, &recorded).modes;
        assert_eq!(modes.len(), 1, "elastic modes of two masses");
        let Pole { omega, damping_ratio } = modes[0].pole;
        assert!(
            (omega / natural() - 1.0).abs() < 1e-8,
            "{} Hz, expected {} Hz",
            omega / TAU,
            natural() / TAU
        );
        assert!(
            (damping_ratio / ratio - 1.0).abs() < 1e-6,
            "damping ratio {damping_ratio}, expected {ratio}"
        );
        for (residue, expected) in modes[0].residues.iter().zip([a * a, a * b, b * b]) {
            assert!((residue - expected).norm() < 1e-7, "residue {residue} 1/kg, expected {expected} 1/kg");
        }
    }
}

#[test]
fn a_mode_without_damping_is_followed_as_any_other() {
    let pairs = pairs(&[("1", "1"), ("2", "1")]);
    let recorded = Recorded::of(&two_masses(0.01, ""), &pairs, &lines(600.0), noise(None)).modes();
    let damped = modelled(&two_masses(1e-5, ""), &recorded);
    for step in 1..40 {
        let factor = 1.0 + 1e-5 * f64::from(step);
        let softer = format!(r#"{{"kind": "stiffness_change", "place": "J", "factor": {factor}}}"#);
        let modes = ModelledModes::near(&two_masses(0.0, &softer), &recorded, &damped);
        let modes = modes.unwrap_or_else(|| panic!("factor {factor}"));
        let Pole { omega, damping_ratio } = modes.modes[0].pole;
        assert!((omega / natural() / factor.sqrt() - 1.0).abs() < 1e-8 && damping_ratio < 1e-8);
        assert!(damping_ratio > 0.0, "its logarithm is a feature");
    }
}

#[test]
fn the_free_fit_finds_the_textbook_values_where_noise_is_nil() {
    let pairs = pairs(&[("1", "1"), ("2", "1")]);
    let (a, b) = shape();
    let recorded = Recorded::of(&two_masses(0.01, ""), &pairs, &lines(600.0), noise(None)).modes();
    assert_eq!(recorded.modes.len(), 1);
    let mode = &recorded.modes[0];
    assert!(
        (mode.pole.omega / natural() - 1.0).abs() < 1e-7,
        "{} of {} Hz",
        mode.pole.omega / TAU,
        natural() / TAU
    );
    assert!((mode.pole.damping_ratio - 0.01).abs() < 1e-7, "damping ratio {}", mode.pole.damping_ratio);
    for (residue, expected) in mode.residues.iter().zip([a * a, a * b]) {
        assert!((residue - expected).norm() < 1e-5, "residue {residue} 1/kg, expected {expected} 1/kg");
    }
    // The mass line of either FRF is 1/(m₁ + m₂); it stands after poles and residues, the upper residual
    // behind it.
    let features = recorded.features();
    let mass_lines = &features[2 + 4..];
    assert!(
        (mass_lines[0] - 1.0).abs() < 1e-4 && (mass_lines[2] - 1.0).abs() < 1e-4,
        "mass lines {mass_lines:?}"
    );
}

#[test]
fn a_mode_makes_one_of_the_band_only_where_it_lies_in_it() {
    let fixture = two_masses(0.01, "");
    let within = |to: f64| {
        modes_within(&fixture, &Recorded::of(&fixture, &pairs(&[("2", "1")]), &lines(to), noise(None)).set)
    };
    assert_eq!(
        (within(600.0), within(300.0)),
        (Some(1), Some(0)),
        "the mode lies at {:.1} Hz",
        natural() / TAU
    );
}

#[test]
fn all_modes_of_masses_in_a_row_are_found_where_they_should_be() {
    for count in 3..=10 {
        let fixture = chain(count);
        let set = Recorded::of(&fixture, &pairs(&[("1", "1"), ("2", "1")]), &lines(800.0), noise(None));
        let modes = modelled(&fixture, &set.modes()).modes;
        // ω = 2√(k/m) sin(jπ/2N), with k = 5 MN/m and m = 1 kg.
        let expected = |j: usize| 2.0 * 5e6f64.sqrt() * (j as f64 * PI / (2 * count) as f64).sin();
        assert_eq!(modes.len(), count - 1, "modes of {count} masses");
        for (j, mode) in modes.iter().enumerate() {
            let (found, expected) = (mode.pole.omega, expected(j + 1));
            assert!(
                (found / expected - 1.0).abs() < 1e-7,
                "{} Hz, expected {} Hz",
                found / TAU,
                expected / TAU
            );
        }
    }
}

#[test]
fn an_error_of_the_shape_moves_residues_by_both_channels() {
    let pairs = pairs(&[("1", "1"), ("2", "1")]);
    let fixture = two_masses(0.01, "");
    let compared = Compared::of(&fixture, Recorded::of(&fixture, &pairs, &lines(600.0), noise(None)).modes());
    let n = compared.comparison.count();
    let none = no_error();
    let of = |sizes| {
        let with = compared.covariance(&sizes);
        with.iter().zip(compared.covariance(&none)).map(|(a, b)| a - b).collect::<Vec<f64>>()
    };
    let (a, b) = shape();
    let rms = ((a * a + b * b) / 2.0).sqrt();
    let scale = compared.recorded.modes[0].scale;
    // With independent errors e₁, e₂ of the two channels, of deviation rms: δ(φ₁φ₁) = 2φ₁e₁,
    // δ(φ₂φ₁) = φ₁e₂ + φ₂e₁.
    let expected = [[4.0 * a * a, 2.0 * a * b], [2.0 * a * b, a * a + b * b]];
    // A modal mass errs by the same share, and both residues with it.
    let residues = [a * a, a * b];
    for (sizes, part) in [(ErrorSizes { shape: 1.0, ..none }, 0), (ErrorSizes { quadrature: 1.0, ..none }, 1)]
    {
        let covariance = of(sizes);
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                let entry = covariance[(2 + 2 * i + part) * n + 2 + 2 * j + part];
                // Of shapes in phase, both errors together besides: e₁² and e₁e₂, as if independent.
                let both = if i == j && part == 0 { rms.powi(4) } else { 0.0 };
                let of_mass = if part == 0 { residues[i] * residues[j] } else { 0.0 };
                let value = (value * rms * rms + both + of_mass) / (scale * scale);
                assert!(
                    (entry - value).abs() < 1e-6,
                    "covariance of residues {i} and {j}: {entry}, expected {value}"
                );
            }
        }
    }
    let poles = of(ErrorSizes { frequency: 0.003, damping: 0.1, ..none });
    assert!(
        (poles[0] - 9e-6).abs() < 1e-12 && (poles[n + 1] - 0.01).abs() < 1e-9,
        "{} {}",
        poles[0],
        poles[n + 1]
    );
    assert!(poles[1] == 0.0, "errors of frequency and damping are independent");
}

#[test]
fn what_a_model_lacks_above_the_band_it_lacks_in_all_frfs_and_in_each() {
    let pairs = pairs(&[("1", "1"), ("2", "1"), ("2", "2")]);
    let fixture = blocks("");
    let compared = Compared::of(&fixture, Recorded::of(&fixture, &pairs, &lines(600.0), noise(None)).modes());
    let n = compared.comparison.count();
    let sizes = ErrorSizes { upper_residual: 0.1, ..no_error() };
    let (with, without) = (compared.covariance(&sizes), compared.covariance(&no_error()));
    let features = compared.recorded.features();
    let above = &features[features.len() - 6..];
    let of = |i: usize, j: usize| {
        with[(n - 5 + 2 * i) * n + n - 5 + 2 * j] - without[(n - 5 + 2 * i) * n + n - 5 + 2 * j]
    };
    for (i, j) in [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)] {
        let common = above[2 * i + 1] * above[2 * j + 1];
        // By itself, one of less than a third of the root mean square errs as one of a third.
        let own = if i == j { common.max(0.1) } else { 0.0 };
        let expected = 0.01 * (common + own);
        assert!((of(i, j) / expected - 1.0).abs() < 1e-6, "{i} and {j}: {}, expected {expected}", of(i, j));
    }
}

#[test]
fn an_error_of_the_damping_is_one_of_ratios_and_of_what_is_in_quadrature() {
    // A dashpot at one of two masses is all the damping there is. It couples the modes, and to first order
    // ratios and quadrature are in proportion to it.
    let damped = |damping: f64| {
        let support =
            format!(r#"{{"kind": "support", "place": "A", "x": 0, "stiffness": 2e6, "damping": {damping}}}"#);
        two_masses(1e-9, &support)
    };
    let fixture = damped(100.0);
    let pairs = pairs(&[("1", "1"), ("2", "1")]);
    let compared = Compared::of(&fixture, Recorded::of(&fixture, &pairs, &lines(600.0), noise(None)).modes());
    assert_eq!(compared.pairing.pairs.len(), 2);
    let n = compared.comparison.count();
    let sizes = ErrorSizes { damping: 1.0, ..no_error() };
    let (with, without) = (compared.covariance(&sizes), compared.covariance(&no_error()));
    // What a common error of both modes' damping makes of each feature.
    let of_all = |feature: usize| -> f64 {
        [1, 3].iter().map(|ratio| with[ratio * n + feature] - without[ratio * n + feature]).sum()
    };
    const SHARE: f64 = 1e-3;
    let more = modelled(&damped(100.0 * (1.0 + SHARE)), &compared.recorded);
    let features = compared.recorded.features();
    let residual =
        |modes| compared.comparison.residual(&compared.recorded, &features, modes, &compared.pairing);
    let change: Vec<f64> =
        residual(&compared.modelled).iter().zip(residual(&more)).map(|(a, b)| a - b).collect();
    // Poles and residues; of what is held to ground residual terms are next to nothing.
    for (feature, change) in change.iter().enumerate().take(12) {
        let expected = SHARE * of_all(feature);
        // Frequencies and real parts change by its square.
        assert!((change - expected).abs() < 1e-6, "feature {feature}: {change:e}, expected {expected:e}");
    }
    let quadrature = change[4..12].iter().skip(1).step_by(2).fold(0.0_f64, |most, c| most.max(c.abs()));
    assert!(quadrature > 1e-5, "the dashpot turns phases by {quadrature:e} for that share");
}

#[test]
fn a_model_in_phase_leaves_all_that_is_recorded_in_quadrature() {
    let dashpot = r#"{"kind": "support", "place": "A", "x": 0, "stiffness": 2e6, "damping": 100}"#;
    let pairs = pairs(&[("1", "1"), ("2", "1")]);
    let of = |fixture: &Fixture| {
        let recorded = Recorded::of(fixture, &pairs, &lines(600.0), noise(None)).modes();
        let compared = Compared::of(fixture, recorded);
        let shapes = Shapes::of(fixture, &compared.recorded, &compared.modelled.poles()).unwrap();
        let Compared { recorded, pairing, comparison, .. } = &compared;
        let in_question = comparison.clone().with_damping_distributed_otherwise(recorded, pairing, &shapes);
        (in_question, compared)
    };
    let (in_question, compared) = of(&two_masses(1e-3, dashpot));
    assert!(in_question.turns_phases() && !of(&two_masses(1e-3, "")).0.turns_phases());
    let in_phase = in_question.clone().with_shapes_in_phase();
    assert!(in_phase.is_in_phase() && !in_phase.turns_phases());
    let features = compared.recorded.features();
    let left = |comparison: &SharedFeatures| {
        let all = comparison.residual(&compared.recorded, &features, &compared.modelled, &compared.pairing);
        // Behind two frequencies and two ratios, two modes in two FRFs: real part, imaginary part.
        all[4..12].iter().skip(1).step_by(2).copied().collect::<Vec<_>>()
    };
    let recorded = features[4..12].iter().skip(1).step_by(2);
    for ((as_modelled, in_phase), recorded) in left(&in_question).iter().zip(left(&in_phase)).zip(recorded) {
        assert!(as_modelled.abs() < 1e-5 && recorded.abs() > 1e-4, "{as_modelled:e}, recorded {recorded:e}");
        assert!((in_phase - recorded).abs() < 1e-5, "{in_phase:e} of {recorded:e} is left");
    }
}

#[test]
fn structural_damping_turns_the_residues_of_a_viscous_mode_by_its_own_damping_ratio() {
    // What a window adds, three times what the mode has by itself, turns nothing and is not in error.
    for window in [0.0, 0.03 * natural()] {
        let effect = format!(r#"{{"kind": "exponential_window", "place": "all", "decay": {window}}}"#);
        let viscous = two_masses(0.01, &effect);
        let structural = viscous.clone().with_damping(Damping::LossFactor(Quantity::bare(0.02))).unwrap();
        let pairs = pairs(&[("1", "1"), ("2", "1"), ("2", "2")]);
        let recorded = Recorded::of(&structural, &pairs, &lines(600.0), noise(None)).modes();
        let compared = Compared::of(&viscous, recorded);
        let (law, noise) = (compared.covariance(&no_error()), compared.noise());
        let (n, difference, model) = (compared.comparison.count(), compared.difference(), compared.model());
        for a in 0..3 {
            let (real, imaginary) = (2 + 2 * a, 3 + 2 * a);
            let turned = difference[imaginary] / model[real];
            assert!((turned / -0.01 - 1.0).abs() < 0.03, "FRF {a}, window {window}: {turned}");
            for b in 0..3 {
                let entry = law[imaginary * n + 3 + 2 * b] - noise[imaginary * n + 3 + 2 * b];
                let expected = 1e-4 * model[real] * model[2 + 2 * b];
                let off = entry / expected - 1.0;
                assert!(off.abs() < 0.03, "FRFs {a} and {b}, window {window}: {entry}, expected {expected}");
            }
        }
        let sizes = ErrorSizes { damping: 1.0, ..no_error() };
        let of_ratio = compared.covariance(&sizes)[n + 1] - law[n + 1];
        let own = 0.01 / (0.01 + window / natural());
        assert!((of_ratio / (own * own) - 1.0).abs() < 0.03, "window {window}: {of_ratio}, expected {own}²");
    }
}

#[test]
fn an_error_of_the_shape_of_a_suspension_mode_is_one_of_mass_lines() {
    // Both masses at 14 Hz on one spring, below the lowest line: φ² = 1/(5 kg), and so are mass lines.
    let stiffness = 5.0 * (TAU * 14.0).powi(2);
    let support =
        format!(r#"{{"kind": "support", "place": "A", "x": 0, "stiffness": {stiffness}, "damping": 20}}"#);
    let fixture = two_masses(0.01, &support);
    let pairs = pairs(&[("1", "1"), ("2", "1")]);
    let recorded = Recorded::of(&fixture, &pairs, &lines(600.0), noise(None)).modes();
    let compared = Compared::of(&fixture, recorded.beside(&fixture));
    assert_eq!((compared.modelled.modes.len(), compared.recorded.modes.len()), (2, 1));
    let sizes = ErrorSizes { shape: 1.0, ..no_error() };
    let (with, without, n) = (compared.covariance(&sizes), compared.noise(), compared.comparison.count());
    let first = n - 4;
    for (i, row) in [[4.0, 2.0], [2.0, 2.0]].iter().enumerate() {
        for (j, expected) in row.iter().enumerate() {
            let at = (first + 2 * i) * n + first + 2 * j;
            let entry = with[at] - without[at];
            assert!(
                (entry / expected - 1.0).abs() < 0.02,
                "mass lines {i} and {j}: {entry}, expected {expected}"
            );
        }
    }
}

#[test]
fn modes_left_alone_are_not_compared() {
    let fixture = two_masses(0.01, "");
    let recorded = Recorded::of(&fixture, &pairs(&[("2", "1")]), &lines(600.0), noise(None)).modes();
    let mut model = modelled(&fixture, &recorded);
    model.modes.clear();
    let pairing = Pairing::of(&recorded, &model);
    let shapes = Shapes::of(&fixture, &recorded, &[]).unwrap();
    let comparison = SharedFeatures::new(&recorded, &pairing, &model, &shapes);
    // The two residual terms are left.
    assert_eq!((pairing.pairs.len(), comparison.count()), (0, 2));
}

proptest! {
    #[test]
    fn a_pole_is_its_frequency_and_damping_ratio(omega in 1.0..1e5f64, damping_ratio in 1e-6..0.99f64) {
        let lambda = Pole { omega, damping_ratio }.lambda();
        let again = Pole::of(lambda);
        prop_assert!((again.omega / omega - 1.0).abs() < 1e-12 && (again.damping_ratio - damping_ratio).abs() < 1e-12, "{again:?}");
        // λ is a root of s² + 2ζωs + ω².
        let left = lambda * lambda + lambda * (2.0 * damping_ratio * omega) + Complex64::from(omega * omega);
        prop_assert!(left.norm() < 1e-12 * omega * omega, "{left}");
    }

    #[test]
    fn sizes_go_to_an_array_and_back(sizes in prop::array::uniform8(0.0..1.0f64)) {
        prop_assert_eq!(ErrorSizes::from_array(sizes).to_array(), sizes);
    }
}

#[test]
fn features_go_on_smoothly_where_a_suspension_crosses_the_lowest_line() {
    let pairs = pairs(&[("1", "1"), ("2", "1"), ("2", "2")]);
    let lowest = 5.0 * (TAU * 20.0).powi(2);
    let on = |stiffness: f64| {
        two_masses(
            0.01,
            &format!(
                r#"{{"kind": "support", "place": "A", "x": 0, "stiffness": {stiffness}, "damping": 20}}"#
            ),
        )
    };
    let recorded = || Recorded::of(&on(0.25 * lowest), &pairs, &lines(600.0), noise(None)).modes();
    let mut compared = Compared::of(&on(lowest), recorded());
    let found = compared.modelled.clone();
    let near = |stiffness: f64| ModelledModes::near(&on(stiffness), &compared.recorded, &found).unwrap();
    // The recording has no mode at the lowest line. What the model's passes it with, from a hair below to
    // either side:
    let (mut low, mut high) = (0.9 * lowest, 1.1 * lowest);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let is_below = near(middle).modes[0].pole.omega < TAU * 20.0;
        if is_below { low = middle } else { high = middle }
    }
    compared.modelled = ModelledModes::of(&on(low), &compared.recorded).unwrap();
    let (here, found) = (compared.model(), compared.modelled.clone());
    let mut features = |factor: f64| {
        compared.modelled = ModelledModes::near(&on(factor * low), &compared.recorded, &found).unwrap();
        compared.model()
    };
    let (above, below) = (features(1.0001), features(0.9999));
    let size = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let change = size(&mut above.iter().zip(&below).map(|(a, b)| a - b));
    let bend = size(&mut above.iter().zip(&below).zip(&here).map(|((a, b), h)| a + b - 2.0 * h));
    assert!(change > 1e-6 && bend < 0.02 * change, "change {change}, of which {bend} is no straight line");
}

#[test]
fn residual_terms_are_a_strain_only_where_the_model_has_nothing_out_of_the_band_that_asks_for_them() {
    // An aluminium bar on soft springs, the band ending halfway between its third mode and its fourth.
    let fixture = Fixture::from_json(
        r#"{ "bodies": { "A": { "beam": { "from": 0.0, "to": 0.428, "youngs_modulus": 7e10, "second_moment": 6.06e-9, "mass_per_length": 1.044 } } },
             "points": { "1": { "body": "A", "x": 0.0128 }, "2": { "body": "A", "x": 0.107 }, "3": { "body": "A", "x": 0.214 },
                         "4": { "body": "A", "x": 0.308 }, "5": { "body": "A", "x": 0.415 } },
             "supports": { "left": { "body": "A", "x": 0.077, "stiffness": 488, "damping": 0.19 },
                           "right": { "body": "A", "x": 0.342, "stiffness": 447, "damping": 0.19 } },
             "joints": {}, "damping": { "modal_ratios": [0.00115, 0.0038, 0.0023] } }"#,
    )
    .unwrap();
    let pairs: Vec<FrfPair> = ["1", "2"]
        .iter()
        .flat_map(|i| ["1", "2", "3", "4", "5"].map(|o| FrfPair::transverse(o, i)))
        .collect();
    let lines = SpectralLines::even(20.0, 5.5, 473).unwrap();
    let recorded = Recorded::of(&fixture, &pairs, &lines, noise(Some(1))).modes();
    assert!(recorded.has_excess_residual_terms(), "the free fit takes all the terms it may");
    assert!(!recorded.clone().beside(&fixture).has_excess_residual_terms(), "so does the model's");
    let other = two_masses(0.004, "");
    assert!(
        recorded.beside(&other).has_excess_residual_terms(),
        "a model without modes above the band asks for none"
    );
}
