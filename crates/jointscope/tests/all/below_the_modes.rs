//! What shows on the lowest lines alone, below all modes that can be compared.

use crate::common::{believed, four_pairs, hammer, measured};
use crate::model_error::told;
use jointscope::diagnosis::{Diagnosis, DiagnosisOptions, Verdict};
use jointscope::fixture::{Effect, EffectKind, Place};
use jointscope::{Fixture, FrfSet, Says, SpectralLines};
use jointscope_rig::{HammerSetup, Instrument, drawn_within_tolerance, frfs, generator};
use serde_json::json;

/// Two blocks on a strip that hang on soft springs.
fn hung_up() -> Fixture {
    let hung = |point: &str| {
        json!({ "point": point, "stiffness": { "value": 700.0, "std": 90.0 },
                "damping": { "value": 1.5, "std": 0.3 } })
    };
    let mut value = believed([0.004, 0.004]).to_value();
    value["supports"] = json!({ "left": hung("1"), "right": hung("4") });
    Fixture::from_value(&value).unwrap()
}

/// What is told of FRFs every 14 Hz with effects hidden: a block on a spring of 25 kN/m resonates at the second
/// line.
fn diagnosed(effects: Vec<Effect>, seed: u64) -> Diagnosis {
    let lines = SpectralLines::even(14.0, 14.0, 100).unwrap();
    let frfs = measured(&hung_up(), effects, (&four_pairs(), &lines), &hammer(seed));
    Diagnosis::of(&hung_up(), &frfs, &DiagnosisOptions::default()).unwrap()
}

#[test]
fn a_spring_to_ground_is_named_by_the_lowest_lines_alone() {
    for seed in [1, 2] {
        let held = Effect::new(EffectKind::Support, Place::Body("A".into()), None, &[-0.045, 25e3, 0.0]);
        let diagnosis = diagnosed(vec![held.clone()], seed);
        let [found] = &diagnosis.findings[..] else { panic!("{}", told(&diagnosis)) };
        assert_eq!(diagnosis.verdict, Verdict::Explained, "{}", told(&diagnosis));
        assert!((found.effect.kind, &found.effect.place) == (held.kind, &held.place), "{}", told(&diagnosis));
        let estimate = found.estimate("stiffness").unwrap();
        assert!((estimate.value / 25e3 - 1.0).abs() < 0.1, "{estimate:?}");
    }
}

#[test]
fn nothing_is_named_for_suspensions_that_lie_below_all_lines() {
    let diagnosis = diagnosed(Vec::new(), 3);
    assert_eq!(diagnosis.verdict, Verdict::Consistent, "{}", told(&diagnosis));
}

#[test]
fn what_has_changed_on_the_lowest_lines_alone_is_told_of_them_too() {
    let lines = SpectralLines::even(14.0, 14.0, 100).unwrap();
    // One structure, in two tests.
    let own = drawn_within_tolerance(&hung_up(), &mut generator(5)).unwrap();
    let tested = |effects: Vec<Effect>, seed: u64| {
        let state = own.clone().with_physics(effects).unwrap();
        let quiet = HammerSetup { noise_response: 2e-4, noise_force: 1e-4, ..hammer(seed) };
        quiet.measure(&frfs(&state, &four_pairs(), &lines, Instrument::AsDescribed).unwrap()).unwrap()
    };
    let since = |now: FrfSet| {
        let baseline = Some(tested(Vec::new(), 6));
        let options = DiagnosisOptions { baseline, ..DiagnosisOptions::default() };
        Diagnosis::of(&hung_up(), &now, &options).unwrap()
    };
    let same = since(tested(Vec::new(), 7));
    assert_eq!(same.verdict, Verdict::Consistent, "{}", told(&same));
    // A test that is repeated shows natural frequencies and residues that differ by as much.
    let light = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.11, 0.0015]);
    let repeated = since(tested(vec![light], 9));
    assert_eq!(repeated.verdict, Verdict::Consistent, "{}", told(&repeated));
    let held = Effect::new(EffectKind::Support, Place::Body("A".into()), None, &[-0.045, 25e3, 0.0]);
    let changed = since(tested(vec![held], 8));
    let [found] = &changed.findings[..] else { panic!("{}", told(&changed)) };
    assert!(found.effect.kind == EffectKind::Support && found.effect.place == Place::Body("A".into()));
    let as_stated = Fixture::to_json(&changed.search.nominal.hypothesis.to_fixture().unwrap());
    assert_eq!(as_stated, hung_up().to_json(), "the fixture as stated, not as the baseline has it");
    assert!(
        changed.says().contains("Since the baseline this has changed: support of body A"),
        "{}",
        changed.says()
    );
}
