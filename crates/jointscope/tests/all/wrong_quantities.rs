//! Quantities that are wrong beyond their stated deviations, and effects that are not to be taken for them.

use crate::common::{self, believed, four_pairs, hammer, lines, measured};
use crate::model_error::told;
use jointscope::diagnosis::{Diagnosis, DiagnosisOptions, Verdict};
use jointscope::fixture::{Effect, EffectKind, Place};
use jointscope::{Fixture, FrfPair, FrfSet, SpectralLines};
use serde_json::json;

/// What is believed of two blocks, and a recording of blocks with other values at these places of the file.
fn wrong(values: &[(&str, f64)], seed: u64) -> (Fixture, FrfSet) {
    let believed = believed(common::RATIOS);
    let mut truth = believed.to_value();
    for (path, value) in values {
        truth.pointer_mut(path).unwrap()["value"] = json!(value);
    }
    let truth = Fixture::from_value(&truth).unwrap();
    let frfs = measured(&truth, Vec::new(), (&four_pairs(), &lines()), &hammer(seed));
    (believed, frfs)
}

/// Diagnoses, and expects nothing but departures at these paths.
#[track_caller]
fn only_departed(values: &[(&str, f64)], seed: u64) {
    let (fixture, frfs) = wrong(values, seed);
    let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default()).unwrap();
    let said = told(&diagnosis);
    assert!(diagnosis.findings.is_empty() && diagnosis.is_only_departed(), "{said}");
    for (path, value) in values {
        let path = path.trim_start_matches('/');
        let departure = diagnosis.departures.iter().find(|departure| departure.path == path);
        let departure = departure.unwrap_or_else(|| panic!("{path} of {:?}", diagnosis.departures));
        assert!(departure.remains() && (departure.repaired / value - 1.0).abs() < 0.05, "{departure:?}");
    }
}

#[test]
fn a_centre_of_gravity_that_is_elsewhere_is_a_departure_and_no_pair_of_masses() {
    only_departed(&[("/bodies/A/x_cg", -0.0325)], 3);
}

#[test]
fn damping_that_is_far_from_what_is_stated_is_a_departure() {
    only_departed(&[("/damping/modal_ratios/0", 0.02), ("/damping/modal_ratios/1", 0.028)], 4);
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
    let pairs = [("1", "1"), ("2", "1"), ("3", "1")].map(|(o, i)| FrfPair::transverse(o, i));
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
