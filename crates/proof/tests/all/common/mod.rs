//! Answerers of known worth, and cases judged without fits.

use jointscope_diagnosis::Verdict;
use jointscope_fixture::Effect;
use jointscope_proof::{Answer, Answers, Case, Found, IndependentFits, Judged, NoAnswer, Plan, Role, Truth};

/// Cases of a plan with their truths, opened against answers that say nothing.
pub(crate) fn opened(plan: &Plan) -> (Vec<Case>, Vec<Truth>) {
    let (cases, sealed) = plan.draw().unwrap();
    let silent = Answers::by(&cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
    let truths = sealed.open(&silent).unwrap();
    (cases, truths)
}

/// A finding with its intervals half as wide as `half` says, about the values.
pub(crate) fn found(effect: &Effect, probability: f64, half: impl Fn(f64) -> f64) -> Found {
    let interval = |value: f64| Some([value - half(value), value + half(value)]);
    Found {
        effect: effect.clone(),
        intervals: effect.parameters.iter().map(|q| interval(q.value)).collect(),
        probability,
        alternatives: Vec::new(),
    }
}

/// An answer that finds the given effects.
pub(crate) fn answer(truth: &Truth, findings: Vec<Found>) -> Answer {
    let physics = findings.iter().map(|found| found.effect.clone()).collect();
    Answer {
        verdict: if findings.is_empty() { Verdict::Consistent } else { Verdict::Explained },
        findings,
        objectives: [1000.0, 100.0],
        chi2_per_dof: [10.0, 5.0, 1.0],
        refitted: truth.fixture.clone().with_physics(Vec::new()).unwrap(),
        repaired: truth.fixture.clone().with_physics(physics).unwrap(),
        held_out: Some([0.2, 0.01]),
    }
}

/// Fits by which the hidden effects show, and a bound of a hundredth on each parameter.
pub(crate) fn fits(truth: &Truth) -> IndependentFits {
    let bound = |effect: &Effect| effect.parameters.iter().map(|q| Some(0.01 * q.value.abs())).collect();
    let nothing = truth.role == Role::Null;
    IndependentFits {
        refitted: if nothing { 100.0 } else { 1000.0 },
        repaired: 100.0,
        truth: 100.0,
        bounds: truth.effects().iter().map(bound).collect(),
        without: truth.effects().iter().map(|_| 500.0).collect(),
        unseen: Some(if nothing { [0.01, 0.01] } else { [0.2, 0.01] }),
        ..IndependentFits::default()
    }
}

/// The effects that `answered` gives, found with certainty.
pub(crate) fn judged(truth: &Truth, answered: &[Effect]) -> Judged {
    let findings = answered.iter().map(|effect| found(effect, 0.99, |v| 0.0196 * v.abs())).collect();
    Judged { truth: truth.clone(), answer: Ok(answer(truth, findings)), fits: fits(truth) }
}
