//! How damping turns the phases of modes' shapes, which nobody knows.

use super::recorded;
use crate::Hypothesis;
use crate::modal::features::Features;
use crate::modal::prior::{Prior, priors};
use crate::settings::Settings;
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};

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
