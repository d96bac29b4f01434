//! What an analyst states of effects, of the measuring chain and of the model's own error, and what a
//! diagnosis makes of it.

use crate::common;
use crate::model_error::{solid, told};
use jointscope::diagnosis::{Diagnosis, DiagnosisOptions, Verdict};
use jointscope::fixture::{Effect, EffectKind, Place};
use jointscope::{Fixture, FrfSet, diagnosis_file};
use serde_json::{Value, json};

/// The fixture with one more key.
fn stating(fixture: &Fixture, key: &str, entry: Value) -> Fixture {
    let mut file = fixture.to_value();
    file[key] = entry;
    Fixture::from_value(&file).unwrap()
}

fn gain(factor: f64) -> Effect {
    Effect::new(EffectKind::ChannelGain, Place::Response("3".into()), None, &[factor])
}

/// A gain of response 3, known to 5 %, in one key or the other.
fn known_gains(fixture: &Fixture) -> [(String, Fixture); 2] {
    let known = json!({"value": 1.0, "std": 0.05});
    let mut physics = fixture.to_value()["physics"].as_array().cloned().unwrap_or_default();
    let path = format!("physics/{}/factor", physics.len());
    physics.push(json!({"kind": "channel_gain", "place": "response 3", "factor": known}));
    let channels = json!({"response 3": {"gain": known}});
    [
        (path, stating(fixture, "physics", json!(physics))),
        ("channels/response 3/gain".to_owned(), stating(fixture, "channels", channels)),
    ]
}

fn diagnosed(fixture: &Fixture, frfs: &FrfSet) -> Diagnosis {
    Diagnosis::of(fixture, frfs, &DiagnosisOptions::default()).unwrap()
}

/// Where the repaired fixture has the quantity at `path`.
#[track_caller]
fn ended_at(diagnosis: &Diagnosis, path: &str) -> f64 {
    let hypothesis = &diagnosis.search.repaired.hypothesis;
    let index = hypothesis.tolerances().iter().position(|t| t.quantity.path == path);
    hypothesis.ended_at(index.unwrap_or_else(|| panic!("{path} is no tolerance")))
}

/// The effect that stands at a place in a written fixture.
fn written(diagnosis: &Diagnosis, path: &str) -> f64 {
    let fixture = diagnosis.search.repaired.hypothesis.to_fixture().unwrap();
    fixture.to_value().pointer(&format!("/{path}/value")).and_then(Value::as_f64).unwrap()
}

/// A recording whose FRFs have gains.
fn misread(frfs: &FrfSet, gain: impl Fn(usize) -> f64) -> FrfSet {
    let scaled = |index: usize| {
        let gain = gain(index);
        frfs.values(index).iter().map(move |value| value * gain)
    };
    let count = frfs.pairs().len();
    let values = (0..count).flat_map(scaled).collect();
    let mut other = FrfSet::new(frfs.lines().clone(), frfs.form(), frfs.pairs().to_vec(), values).unwrap();
    for index in 0..count {
        other.set_averages(index, frfs.averages(index));
        if let Some(coherence) = frfs.coherence(index) {
            other.set_coherence(index, coherence.to_vec()).unwrap();
        }
    }
    other
}

/// Recordings with a gain of response 3: of a lumped structure, and of a solid beside the workspace, of which
/// any lumped model has an error.
fn recordings(factor: f64) -> Vec<(Fixture, FrfSet)> {
    let lumped = common::recorded(vec![gain(factor)], 11);
    let of_a_solid = |(fixture, frfs): (Fixture, FrfSet)| {
        let reads = |index: usize| if frfs.pairs()[index].response.is_named("3") { factor } else { 1.0 };
        (fixture, misread(&frfs, reads))
    };
    let solid = solid("null-steel").map(of_a_solid);
    [lumped].into_iter().chain(solid).collect()
}

#[test]
fn a_gain_within_what_is_stated_of_it_is_refitted_and_is_no_finding() {
    for (fixture, frfs) in recordings(1.03) {
        for (path, fixture) in known_gains(&fixture) {
            let diagnosis = diagnosed(&fixture, &frfs);
            assert_eq!(diagnosis.verdict, Verdict::Consistent, "{path}: {}", told(&diagnosis));
            assert!(diagnosis.departures.is_empty(), "{path}: {:?}", diagnosis.departures);
            let found = ended_at(&diagnosis, &path);
            assert!((found / 1.03 - 1.0).abs() < 0.01, "{path}: {found}");
            assert_eq!(written(&diagnosis, &path), found, "{path}");
        }
    }
}

#[test]
fn a_gain_far_from_what_is_stated_of_it_is_named_or_a_departure() {
    for (fixture, frfs) in recordings(1.3) {
        for (path, fixture) in known_gains(&fixture) {
            let diagnosis = diagnosed(&fixture, &frfs);
            let named = diagnosis.findings.iter().any(|f| {
                f.effect.kind == EffectKind::ChannelGain && f.effect.place == Place::Response("3".into())
            });
            let departed = diagnosis.departures.iter().any(|departure| departure.path == path);
            assert!(named || departed, "{path}: {} {:?}", told(&diagnosis), diagnosis.departures);
        }
    }
}

#[test]
fn a_stated_error_of_the_model_is_taken_as_it_is() {
    let Some((fixture, frfs)) = solid("null-steel") else { return };
    let stated = stating(&fixture, "model_error", json!({"frequency": 0.004, "residue": 0.02}));
    let diagnosis = diagnosed(&stated, &frfs);
    let [_, error] = diagnosis.model_error.unwrap_or_else(|| panic!("{}", told(&diagnosis)));
    assert_eq!((error.frequency, error.residue), (0.004, 0.02), "{}", told(&diagnosis));
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
    let file = diagnosis_file(&diagnosis);
    assert_eq!(file["model_error"]["stated"], json!({"frequency": 0.004, "residue": 0.02}));
    assert!(file["says"].as_str().unwrap().contains("(as stated)"), "{}", file["says"]);
}

#[test]
fn a_model_that_is_farther_off_than_stated_is_not_consistent() {
    let Some((fixture, frfs)) = solid("null-clamped") else { return };
    let stated =
        stating(&fixture, "model_error", json!({"frequency": 1e-6, "damping": 1e-4, "residue": 1e-5}));
    let diagnosis = diagnosed(&stated, &frfs);
    assert!(
        diagnosis.verdict != Verdict::Consistent || !diagnosis.departures.is_empty(),
        "{} {:?}",
        told(&diagnosis),
        diagnosis.departures
    );
}

#[test]
fn gains_of_records_that_scatter_as_stated_are_no_finding() {
    let Some((fixture, frfs)) = solid("null-steel") else { return };
    let strikes = [1.08, 0.93, 1.04, 0.9];
    let roved = misread(&frfs, |index| strikes[index % strikes.len()]);
    let stated = stating(&fixture, "channels", json!({"*": {"gain": {"value": 1, "std": 0.1}}}));
    let diagnosis = diagnosed(&stated, &roved);
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
    assert!(diagnosis.departures.is_empty(), "{:?}", diagnosis.departures);
}
