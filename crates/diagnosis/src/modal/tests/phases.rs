//! How damping turns the phases of modes' shapes, which nobody knows.

use super::recorded;
use crate::Hypothesis;
use crate::catalogue::catalogue;
use crate::modal::features::Features;
use crate::modal::prior::{Prior, priors, priors_among};
use crate::settings::Settings;
use crate::simulated::simulated;
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_spectra::{FrfPair, SpectralLines};

/// Two blocks on a strip, held by springs with dashpots of so many N·s/m; its damping ratios are those of all
/// this as it stands.
fn held(dashpot: f64) -> Fixture {
    let support = |body: &str, x: f64| {
        format!(r#"{{ "body": "{body}", "x": {x}, "stiffness": 4e5, "damping": {dashpot} }}"#)
    };
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }}, "B": {{ "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 }} }},
             "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.125 }} }},
             "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
             "supports": {{ "a": {}, "b": {} }},
             "damping": {{ "modal_ratios": [0.03, 0.03, 0.03, 0.03] }} }}"#,
        support("A", -0.05),
        support("B", 0.06),
    ))
    .unwrap()
}

#[test]
fn an_effect_of_no_size_explains_no_more_of_the_phases_than_the_fixture_alone() {
    let observation = recorded(&Hypothesis::nominal(&held(0.0), true));
    let nominal = Hypothesis::nominal(&held(60.0), true);
    let features = Features::of(&observation, &nominal, &Settings::default().modal).unwrap();
    let problem = features.problem(observation.work());
    let nothing = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 1e-9]);
    let beside = nominal.with(nothing);
    let own = beside.coordinates[nominal.coordinates.len()..].iter().map(|at| Prior { mean: *at, std: 1e-6 });
    let alone = priors(&nominal, &[]);
    let with_own: Vec<Prior> = alone.iter().copied().chain(own).collect();
    let [alone, beside] = [(&nominal, &alone), (&beside, &with_own)]
        .map(|(hypothesis, priors)| problem.fitted(hypothesis, priors).unwrap());
    assert!((beside.ln - alone.ln).abs() < 0.5, "{:.2} beside {:.2}", beside.ln, alone.ln);
    let quadrature = alone.evidence.sizes.quadrature / problem.sizes.quadrature;
    assert!(quadrature < 0.3, "shapes' phases are off by {quadrature:.2} times what is usual");
    assert!(
        !problem.is_exact(&alone, Settings::default().modal.exact),
        "its dashpots turn phases that nobody recorded"
    );
}

/// Four storeys on columns, the topmost of so many N/m, all known to 6 %, and damping ratios to 25 %.
fn storeys(topmost: f64) -> Fixture {
    let known = |value: f64, share: f64| format!(r#"{{ "value": {value}, "std": {} }}"#, share * value);
    let list = |of: &dyn Fn(usize) -> String| (1..=4).map(of).collect::<Vec<_>>().join(", ");
    let joint = |k: usize| {
        let stiffness = known(if k == 4 { topmost } else { 4.2e5 }, 0.06);
        format!(r#""C{k}": {{ "from": "{}", "to": "{k}", "stiffness": [[{stiffness}, 0], [0, 0]] }}"#, k - 1)
    };
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ {} }}, "points": {{ {} }}, "joints": {{ {} }},
             "supports": {{ "ground": {{ "point": "1", "stiffness": {} }} }},
             "damping": {{ "modal_ratios": [{}, {}, {}, {}] }} }}"#,
        list(&|k| format!(r#""F{k}": {{ "mass": {}, "rotates": false }}"#, known(6.0, 0.003))),
        list(&|k| format!(r#""{k}": {{ "body": "F{k}", "x": {k} }}"#)),
        [2, 3, 4].map(joint).join(", "),
        known(4.2e5, 0.06),
        known(0.0027, 0.25),
        known(0.003, 0.2),
        known(0.002, 0.25),
        known(0.0045, 0.25),
    ))
    .unwrap()
}

#[test]
fn a_softer_joint_is_found_where_the_structures_damping_turns_no_shape() {
    // An effect leaves the fixture's damping matrix as it stands, and that couples the modes that the softer
    // joint makes: by phases that are recorded far more sharply than anybody knows them.
    let pairs: Vec<FrfPair> =
        ["1", "4"].iter().flat_map(|i| ["1", "2", "3", "4"].map(|o| FrfPair::transverse(o, i))).collect();
    let lines = SpectralLines::even(10.0, 0.25, 480).unwrap();
    const FACTOR: f64 = 0.7;
    let observation = simulated(&storeys(FACTOR * 4.2e5), &pairs, &lines, 1e-6);
    let fixture = storeys(4.2e5);
    let nominal = Hypothesis::nominal(&fixture, false);
    let features = Features::of(&observation, &nominal, &Settings::default().modal).unwrap();
    let problem = features.problem(observation.work());
    let candidates = catalogue(&fixture, &observation);
    let fitted = |effects: Vec<Effect>| {
        let start = effects.into_iter().fold(nominal.clone(), |rest, effect| rest.with(effect));
        problem.fitted(&start, &priors_among(&start, &candidates).unwrap()).unwrap()
    };
    let softer = |by| Effect::new(EffectKind::StiffnessChange, Place::Joint("C4".into()), None, &[by]);
    let (alone, named) = (fitted(vec![]), fitted(vec![softer(0.85)]));
    let factor = named.hypothesis.effects()[0].value(0);
    assert!((factor / FACTOR - 1.0).abs() < 0.06, "{factor:.3} times as stiff");
    assert!(named.largest_departure() < 2.5, "{:.1} deviations beside it", named.largest_departure());
    assert!(named.ln > alone.ln + 3.0, "gains {:.2} in ln p", named.ln - alone.ln);
}
