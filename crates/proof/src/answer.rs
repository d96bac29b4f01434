//! What was answered: plain data, as a diagnosis hands it back.

use crate::effect_file::{effect_value, in_file};
use crate::{Case, Name};
use jointscope_diagnosis::{Estimate, Verdict};
use jointscope_fixture::{Effect, Fixture};
use jointscope_pipeline::{Answer as Diagnosed, Measurement, Options, Outcome, diagnose};
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

/// An effect that was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Found {
    /// Kind, place, dof and parameters.
    #[serde(serialize_with = "in_file")]
    pub effect: Effect,
    /// 95 % intervals by parameter, where they are stated.
    #[serde(rename = "ci95")]
    pub intervals: Vec<Option<[f64; 2]>>,
    /// Stated probability of its name.
    pub probability: f64,
    /// Other names for it with their probabilities.
    #[serde(serialize_with = "with_probabilities")]
    pub alternatives: Vec<(Effect, f64)>,
}

fn with_probabilities<S: Serializer>(names: &[(Effect, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    let name = |(effect, p): &(Effect, f64)| json!({ "effect": effect_value(effect), "probability": p });
    serializer.collect_seq(names.iter().map(name))
}

impl Found {
    /// Its name and the alternatives' with their probabilities.
    pub(crate) fn names(&self) -> impl Iterator<Item = (Name, f64)> {
        let own = std::iter::once((&self.effect, self.probability));
        own.chain(self.alternatives.iter().map(|(e, p)| (e, *p))).map(|(e, p)| (Name::of(e), p))
    }
}

/// A diagnosis' answer to a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// What it comes to.
    pub verdict: Verdict,
    /// What was found, the strongest first.
    pub findings: Vec<Found>,
    /// Objectives (χ² and the squared departures of the quantities) of the refitted and the repaired fixture,
    /// as stated.
    pub objectives: [f64; 2],
    /// χ² per degree of freedom: nominal, refitted, repaired.
    pub chi2_per_dof: [f64; 3],
    /// The fixture refitted within its tolerances.
    pub refitted: Fixture,
    /// The same with the effects found.
    pub repaired: Fixture,
    /// Errors of the refitted and the repaired fixture on what the fit did not see.
    pub held_out: Option<[f64; 2]>,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoAnswer {
    /// The diagnosis refused.
    #[error(transparent)]
    Refused(#[from] jointscope_pipeline::Error),
    /// It broke down.
    #[error("the diagnosis broke down")]
    BrokeDown,
}

/// An answer as plain data.
pub trait Reply: Sized {
    /// What a diagnosis says; `None` where it says nothing of this kind.
    fn of_diagnosed(diagnosed: &Diagnosed) -> Option<Self>;

    /// The answer as JSON.
    fn to_value(&self) -> Value;
}

/// What the program's own route answers under its default options: to fixture and recording, and to nothing
/// else.
pub(crate) fn diagnosed<R: Clone + Into<Measurement>>(case: &Case<R>) -> Result<Diagnosed, NoAnswer> {
    Ok(diagnose(&case.believed, &case.recorded.clone().into(), &Options::default(), |_| ())?)
}

impl Reply for Answer {
    /// Of the FRFs; none where the answer is the law of a joint.
    fn of_diagnosed(diagnosed: &Diagnosed) -> Option<Self> {
        let Outcome::Linear(diagnosis) = &diagnosed.outcome else { return None };
        let found = diagnosis.findings.iter().map(|finding| Found {
            effect: finding.effect.clone(),
            intervals: intervals(&finding.effect, &finding.estimates),
            probability: finding.probability,
            alternatives: finding.alternatives.clone(),
        });
        Some(Answer {
            verdict: diagnosis.verdict,
            findings: found.collect(),
            objectives: [&diagnosis.search.refitted, &diagnosis.search.repaired].map(|fit| fit.objective),
            chi2_per_dof: diagnosis.chi2_per_dof(),
            refitted: diagnosed.refitted.clone(),
            repaired: diagnosed.repaired.clone(),
            held_out: diagnosis.held_out.as_ref().map(|held| [held.nrmse_refitted, held.nrmse_repaired]),
        })
    }

    fn to_value(&self) -> Value {
        let [refitted, repaired] = self.objectives;
        json!({
            "verdict": self.verdict,
            "findings": self.findings,
            "objectives": { "refitted": refitted, "repaired": repaired },
            "chi2_per_dof": self.chi2_per_dof,
            "held_out": self.held_out,
            "refitted": self.refitted,
            "repaired": self.repaired,
        })
    }
}

/// The 95 % interval of each of an effect's parameters: what holds a block against rotation has no abscissa,
/// and none is stated.
fn intervals(effect: &Effect, estimates: &[Estimate]) -> Vec<Option<[f64; 2]>> {
    let own = |name: &str| estimates.iter().find(|estimate| estimate.parameter.name == name);
    let parameters = effect.kind.spec().parameters.iter();
    parameters.map(|spec| own(spec.name).and_then(|estimate| estimate.interval)).collect()
}

impl Answer {
    /// What is answered to a case.
    ///
    /// # Errors
    /// [`NoAnswer`], where the diagnosis refuses.
    pub(crate) fn of(case: &Case) -> Result<Self, NoAnswer> {
        Answer::of_diagnosed(&diagnosed(case)?).ok_or(NoAnswer::BrokeDown)
    }

    /// The names found, the strongest first.
    pub(crate) fn names(&self) -> Vec<Name> {
        self.findings.iter().map(|found| Name::of(&found.effect)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_fixture::{Dof, EffectKind, Place};

    #[test]
    fn intervals_are_those_of_their_own_parameters() {
        let place = Place::Body("A".into());
        let effect = Effect::new(EffectKind::Support, place, Some(Dof::Rotation), &[0.0, 800.0, 0.2]);
        let parameters = &EffectKind::Support.spec().parameters[1..];
        let estimate = |index: usize, value: f64| {
            Estimate::of(parameters[index], effect.dof, value).within(0.01 * value)
        };
        let all = intervals(&effect, &[estimate(0, 800.0), estimate(1, 0.2)]);
        assert_eq!(all[0], None, "a spring against rotation has no abscissa");
        let holds =
            |index: usize, value: f64| all[index].is_some_and(|[low, high]| low < value && value < high);
        assert!(holds(1, 800.0) && holds(2, 0.2), "{all:?}");
    }
}
