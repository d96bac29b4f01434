//! What a model leaves out of every joint, and what was found looked for again.

use super::with_errors_of_shapes;
use crate::catalogue::catalogue;
use crate::fitter::Fitter;
use crate::modal::judgement::ModalJudgement;
use crate::modal::known::Known;
use crate::settings::Settings;
use crate::{Hypothesis, Observation, Watch};
use jointscope_findings::Verdict;
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_spectra::{FrfPair, SpectralLines};

/// Three blocks on two strips of different sections.
fn chain() -> Fixture {
    let known = |value: f64, relative: f64| format!(r#"{{"value": {value}, "std": {}}}"#, relative * value);
    let at = |x: f64| format!(r#"{{"value": {x}, "std": 1e-4}}"#);
    let text = format!(
        r#"{{ "bodies": {{ "A": {{ "mass": {}, "inertia": {}, "x_cg": {} }}, "B": {{ "mass": {}, "inertia": {}, "x_cg": {} }}, "C": {{ "mass": {}, "inertia": {}, "x_cg": {} }} }},
             "points": {{ "1": {{ "body": "A", "x": {} }}, "2": {{ "body": "A", "x": {} }}, "3": {{ "body": "B", "x": {} }}, "4": {{ "body": "B", "x": {} }}, "5": {{ "body": "C", "x": {} }}, "6": {{ "body": "C", "x": {} }},
                          "10": {{ "body": "A", "x": 0.052 }}, "11": {{ "body": "B", "x": 0.092 }}, "12": {{ "body": "B", "x": 0.148 }}, "13": {{ "body": "C", "x": 0.184 }} }},
             "joints": {{ "J": {{ "from": "10", "to": "11", "beam": {{ "youngs_modulus": {}, "second_moment": 1.72e-10 }} }},
                          "K": {{ "from": "12", "to": "13", "beam": {{ "youngs_modulus": {}, "second_moment": 2.25e-10 }} }} }},
             "damping": {{ "modal_ratios": [{}, {}, {}, {}] }} }}"#,
        known(0.70, 2e-3),
        known(2.72e-4, 5e-3),
        at(0.026),
        known(0.54, 2e-3),
        known(1.83e-4, 5e-3),
        at(0.12),
        known(0.59, 2e-3),
        known(2.09e-4, 5e-3),
        at(0.212),
        at(0.006),
        at(0.045),
        at(0.099),
        at(0.14),
        at(0.19),
        at(0.234),
        known(2.07e11, 0.01),
        known(2.07e11, 0.01),
        known(0.002, 0.3),
        known(0.005, 0.3),
        known(0.0024, 0.3),
        known(0.0015, 0.3),
    );
    Fixture::from_json(&text).unwrap()
}

/// Both strips weigh and shear.
fn omissions() -> Vec<Effect> {
    let at = |kind, joint: &str, value: f64| Effect::new(kind, Place::Joint(joint.into()), None, &[value]);
    vec![
        at(EffectKind::JointMass, "J", 0.015),
        at(EffectKind::JointMass, "K", 0.017),
        at(EffectKind::ShearDeformation, "J", 1.2e6),
        at(EffectKind::ShearDeformation, "K", 1.5e6),
    ]
}

/// The recording of hits on 1, with noise of a quarter of a per cent and errors of the shapes of half of one,
/// which no two FRFs share.
fn recorded(truth: &Fixture) -> Observation {
    let responses = ["1", "2", "3", "4", "5", "6"];
    let pairs: Vec<FrfPair> =
        ["1"].iter().flat_map(|i| responses.iter().map(move |o| FrfPair::transverse(o, i))).collect();
    let lines = SpectralLines::even(40.0, 7.0, 480).unwrap();
    with_errors_of_shapes(truth, &pairs, &lines)
}

fn judged(known: Option<&Known>) -> ModalJudgement {
    let fixture = chain();
    let observation = recorded(&fixture.clone().with_physics(omissions()).unwrap());
    let settings = Settings::default();
    let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
    let nominal = Hypothesis::nominal(&fixture, false);
    // A few names, which search as all do.
    let kinds =
        [EffectKind::JointMass, EffectKind::ShearDeformation, EffectKind::Footing, EffectKind::AddedMass];
    let mut candidates = catalogue(&fixture, &observation);
    candidates.retain(|candidate| kinds.contains(&candidate.kind));
    ModalJudgement::of(&fitter, &nominal, &candidates, known).unwrap()
}

fn named(judged: &ModalJudgement) -> Vec<(EffectKind, String)> {
    let effects = judged.search.best.fit.hypothesis.effects();
    let mut names: Vec<_> = effects.iter().map(|effect| (effect.kind, effect.place.to_string())).collect();
    names.sort_by_key(|(kind, place)| (kind.name(), place.clone()));
    names
}

fn expected() -> Vec<(EffectKind, String)> {
    let mut names: Vec<_> =
        omissions().iter().map(|effect| (effect.kind, effect.place.to_string())).collect();
    names.sort_by_key(|(kind, place)| (kind.name(), place.clone()));
    names
}

#[test]
fn what_a_model_leaves_out_of_every_joint_is_found_at_every_joint() {
    let judged = judged(None);
    assert_eq!(judged.verdict, Verdict::Explained);
    assert_eq!(named(&judged), expected());
    for (effect, name) in judged.search.best.fit.hypothesis.effects().iter().zip(&judged.names) {
        let truth = omissions().into_iter().find(|truth| truth.is_named_as(effect)).unwrap();
        assert!((effect.value(0) / truth.value(0) - 1.0).abs() < 0.15, "{effect:?}");
        assert!(name[0].1 > 0.5, "{name:?}");
    }
}

#[test]
fn several_effects_found_before_are_found_again_but_for_those_that_nothing_needs() {
    let lump = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.12, 0.004]);
    let found = omissions().into_iter().chain([lump]).collect();
    let known = Known { found, probable: Vec::new() };
    assert_eq!(named(&judged(Some(&known))), expected());
}
