//! Quantities that are wrong beyond their stated deviations, and effects that are not to be taken for them.

use crate::common::{self, believed, four_pairs, hammer, lines, measured};
use crate::model_error::told;
use jointscope::diagnosis::{Diagnosis, DiagnosisOptions, Finding, Verdict};
use jointscope::fixture::{Effect, EffectKind, Place};
use jointscope::{Fixture, FrfSet, SpectralLines};
use jointscope_samples::transverse;
use serde_json::json;

/// What is believed of two blocks, with other values at these places of the file.
fn with(values: &[(&str, f64)]) -> Fixture {
    let mut file = believed(common::RATIOS).to_value();
    for (path, value) in values {
        file.pointer_mut(path).unwrap()["value"] = json!(value);
    }
    Fixture::from_value(&file).unwrap()
}

fn recording_of(truth: &Fixture, seed: u64) -> FrfSet {
    measured(truth, Vec::new(), (&four_pairs(), &lines()), &hammer(seed))
}

/// What is believed of two blocks, and a recording of blocks with other values at these places of the file.
fn wrong(values: &[(&str, f64)], seed: u64) -> (Fixture, FrfSet) {
    (believed(common::RATIOS), recording_of(&with(values), seed))
}

/// Diagnoses, and expects these quantities to be called wrong, their true values found, and nothing else.
#[track_caller]
fn called_wrong((fixture, frfs): (Fixture, FrfSet), values: &[(&str, f64)]) {
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    let said = told(&diagnosis);
    assert_eq!((diagnosis.verdict, diagnosis.findings.len()), (Verdict::Explained, values.len()), "{said}");
    for (path, value) in values {
        let path = path.trim_start_matches('/');
        let of_it = |finding: &&Finding| finding.effect.place.to_string() == path;
        let found = diagnosis.findings.iter().find(of_it).unwrap_or_else(|| panic!("{path}: {said}"));
        let estimate = found.estimates[0];
        assert_eq!((found.effect.kind, found.estimates.len()), (EffectKind::QuantityError, 1));
        assert!((estimate.value / value - 1.0).abs() < 0.05 && estimate.interval.is_some(), "{estimate:?}");
        assert!(found.probability > 0.5, "{said}");
        let departure = diagnosis.departures.iter().find(|departure| departure.path == path);
        let departure = departure.unwrap_or_else(|| panic!("{path} of {:?}", diagnosis.departures));
        assert!(departure.remains() && departure.repaired == estimate.value, "{departure:?}");
        let repaired = diagnosis.search.repaired.hypothesis.to_fixture().unwrap().to_value();
        assert_eq!(repaired.pointer(&format!("/{path}")).unwrap()["value"], json!(estimate.value));
    }
}

#[test]
fn a_centre_of_gravity_that_is_elsewhere_is_called_wrong_and_is_no_pair_of_masses() {
    let values = [("/bodies/A/x_cg", -0.0325)];
    called_wrong(wrong(&values, 3), &values);
}

#[test]
fn a_wrong_sign_or_decimal_point_is_called_wrong_and_bends_nothing_else() {
    for (path, stated, truth) in [("/bodies/A/x_cg", 0.030, -0.030), ("/bodies/A/inertia", 9.5e-3, 9.5e-4)] {
        let frfs = recording_of(&with(&[(path, truth)]), 7);
        called_wrong((with(&[(path, stated)]), frfs), &[(path, truth)]);
    }
}

#[test]
fn damping_that_is_far_from_what_is_stated_is_called_wrong() {
    let values = [("/damping/modal_ratios/0", 0.02), ("/damping/modal_ratios/1", 0.028)];
    called_wrong(wrong(&values, 4), &values);
}

/// Three storeys on their columns, which a mass of the first one is wrong of, or on which something stands.
#[test]
fn a_storey_too_heavy_is_a_wrong_mass_or_an_added_one() {
    let frame = |mass: f64| {
        let storey = |mass: f64| json!({ "mass": {"value": mass, "std": 0.02 * 3.5}, "rotates": false });
        let columns =
            |stiffness: f64| json!([[{"value": stiffness, "std": 0.02 * stiffness}, 0.0], [0.0, 0.0]]);
        Fixture::from_value(&json!({
            "bodies": { "F1": storey(mass), "F2": storey(3.5), "F3": storey(3.5) },
            "points": { "1": { "body": "F1", "x": 0.0 }, "2": { "body": "F2", "x": 0.0 }, "3": { "body": "F3", "x": 0.0 } },
            "joints": { "J12": { "from": "1", "to": "2", "stiffness": columns(6.1e5) }, "J23": { "from": "2", "to": "3", "stiffness": columns(5.7e5) } },
            "supports": { "S": { "point": "1", "stiffness": {"value": 6.4e5, "std": 1.3e4} } },
            "damping": { "loss_factor": 0.018 },
        }))
        .unwrap()
    };
    let pairs = transverse(&[("1", "1"), ("2", "1"), ("3", "1")]);
    let lines = SpectralLines::even(5.0, 0.25, 600).unwrap();
    let frfs = measured(&frame(4.6), Vec::new(), (&pairs, &lines), &hammer(8));
    let diagnosis = Diagnosis::of(&frame(3.5), &frfs, &DiagnosisOptions::default()).unwrap();
    let said = told(&diagnosis);
    assert_eq!((diagnosis.verdict, diagnosis.findings.len()), (Verdict::Explained, 1), "{said}");
    let found = &diagnosis.findings[0];
    let mut names = vec![(found.effect.clone(), found.probability)];
    names.extend(found.alternatives.iter().cloned());
    for (kind, place) in [(EffectKind::AddedMass, "F1"), (EffectKind::QuantityError, "bodies/F1/mass")] {
        let own = names.iter().find(|(effect, _)| effect.kind == kind && effect.place.to_string() == place);
        assert!(own.is_some_and(|(_, probability)| *probability > 0.05), "{kind:?}: {said}");
    }
    assert_eq!(diagnosis.departures[0].path, "bodies/F1/mass");
}

/// A modal test reads the ratios of the frame with its column as it is, which no change of stiffness beside
/// the damping of the stated frame has.
#[test]
fn a_column_that_is_softer_than_stated_is_named_where_ratios_are_those_read_with_it() {
    let frame = |factor: f64, std: f64| {
        let storey = |mass: f64| json!({ "mass": {"value": mass, "std": 0.002 * mass}, "rotates": false });
        let columns =
            |factor: f64, std: f64| json!([[{"value": factor * 6.0e4, "std": std}, 0.0], [0.0, 0.0]]);
        Fixture::from_value(&json!({
            "bodies": { "F1": storey(3.1), "F2": storey(3.9), "F3": storey(3.0) },
            "points": { "1": { "body": "F1", "x": 0.3 }, "2": { "body": "F2", "x": 0.6 }, "3": { "body": "F3", "x": 0.9 } },
            "joints": { "J12": { "from": "1", "to": "2", "stiffness": columns(1.0, 3.0e3) }, "J23": { "from": "2", "to": "3", "stiffness": columns(factor, std) } },
            "supports": { "S": { "point": "1", "stiffness": {"value": 6.0e4, "std": 3.0e3} } },
            "damping": { "modal_ratios": [{"value": 0.010, "std": 0.0025}, {"value": 0.012, "std": 0.003}, {"value": 0.015, "std": 0.00375}] },
        }))
        .unwrap()
    };
    let pairs = transverse(&[("1", "1"), ("2", "1"), ("3", "1"), ("3", "3")]);
    let lines = SpectralLines::even(2.0, 0.125, 400).unwrap();
    for (factor, seed) in [(0.56, 1), (0.73, 2)] {
        let frfs = measured(&frame(factor, 1.0), Vec::new(), (&pairs, &lines), &hammer(seed));
        let diagnosis = Diagnosis::of(&frame(1.0, 3.0e3), &frfs, &DiagnosisOptions::default()).unwrap();
        let said = told(&diagnosis);
        assert_eq!((diagnosis.verdict, diagnosis.findings.len()), (Verdict::Explained, 1), "{said}");
        let found = &diagnosis.findings[0];
        assert_eq!(found.effect.kind, EffectKind::QuantityError, "{said}");
        assert_eq!(found.effect.place.to_string(), "joints/J23/stiffness/0/0");
        assert!((found.estimates[0].value / (factor * 6.0e4) - 1.0).abs() < 0.01, "{said}");
        assert!(found.probability > 0.9, "{said}");
    }
}

#[test]
fn a_quantity_within_its_tolerances_is_no_departure() {
    let (fixture, frfs) = wrong(&[("/bodies/A/x_cg", -0.0302)], 5);
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
    assert!(!diagnosis.is_only_departed() && diagnosis.departures.is_empty());
}

#[test]
fn a_mass_anywhere_on_a_beam_with_many_modes_is_found() {
    let beam = |modulus: f64| {
        Fixture::from_value(&json!({
            "bodies": { "A": { "beam": { "from": 0.0, "to": 0.5, "youngs_modulus": modulus, "second_moment": 2e-9, "mass_per_length": 1.9 } } },
            "points": { "1": { "body": "A", "x": 0.0 }, "2": { "body": "A", "x": 0.15 }, "3": { "body": "A", "x": 0.5 } },
            "damping": { "modal_ratios": [0.003, 0.004] },
        }))
        .unwrap()
    };
    let hidden = Effect::new(EffectKind::AddedMass, Place::Body("A".into()), None, &[0.33, 0.03]);
    let pairs = transverse(&[("1", "1"), ("2", "1"), ("3", "1")]);
    let lines = SpectralLines::even(20.0, 5.0, 397).unwrap();
    let frfs = measured(&beam(2.09e11), vec![hidden], (&pairs, &lines), &hammer(6));
    let diagnosis = Diagnosis::of(&beam(2.07e11), &frfs, &DiagnosisOptions::default()).unwrap();
    let found = &diagnosis.findings[0];
    assert!(
        diagnosis.findings.len() == 1 && found.effect.kind == EffectKind::AddedMass,
        "{}",
        told(&diagnosis)
    );
    let [x, mass] = [found.effect.value(0), found.effect.value(1)];
    assert!((x - 0.33).abs() < 2e-3 && (mass / 0.03 - 1.0).abs() < 0.05, "{mass} kg at {x} m");
}
