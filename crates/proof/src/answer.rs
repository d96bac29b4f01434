//! What was answered: plain data, as a diagnosis hands it back.

use crate::case::effect_value;
use crate::{Case, Name};
use jointscope_diagnosis::{Diagnosis, DiagnosisError, DiagnosisOptions, Verdict};
use jointscope_fixture::{Effect, Fixture, FixtureError};
use serde_json::{Value, json};

/// An effect that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Kind, place, dof and parameters.
    pub effect: Effect,
    /// 95 % intervals by parameter, where they are stated.
    pub intervals: Vec<Option<[f64; 2]>>,
    /// Stated probability of its name.
    pub probability: f64,
    /// Other names for it with their probabilities.
    pub alternatives: Vec<(Effect, f64)>,
}

impl Found {
    /// Its name and the alternatives' with their probabilities.
    pub fn names(&self) -> impl Iterator<Item = (Name, f64)> {
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
    /// Objectives (χ² and the squared departures of the quantities) of the refitted and the repaired fixture, as stated.
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
pub enum NoAnswer {
    /// The diagnosis refused.
    #[error(transparent)]
    Refused(#[from] DiagnosisError),
    /// What it hands back is no fixture.
    #[error("the fixture handed back is impossible: {0}")]
    Fixture(#[from] FixtureError),
    /// It broke down.
    #[error("the diagnosis broke down")]
    BrokeDown,
}

impl Answer {
    /// What [`Diagnosis`] answers to a case, under its default options.
    ///
    /// # Errors
    /// [`NoAnswer`], where it refuses.
    pub fn of(case: &Case) -> Result<Self, NoAnswer> {
        Answer::from_diagnosis(&Answer::diagnosis_of(case)?)
    }

    /// The diagnosis of a case, under its default options: of fixture and recording, and of nothing else.
    pub(crate) fn diagnosis_of(case: &Case) -> Result<Diagnosis, DiagnosisError> {
        Diagnosis::of(&case.believed, &case.recorded, &DiagnosisOptions::default())
    }

    /// What a diagnosis says, as plain data.
    pub(crate) fn from_diagnosis(diagnosis: &Diagnosis) -> Result<Self, NoAnswer> {
        let found = diagnosis.findings.iter().map(|finding| Found {
            effect: finding.effect.clone(),
            intervals: finding.estimates.iter().map(|estimate| estimate.interval).collect(),
            probability: finding.probability,
            alternatives: finding.alternatives.clone(),
        });
        Ok(Answer {
            verdict: diagnosis.verdict,
            findings: found.collect(),
            objectives: [&diagnosis.search.refitted, &diagnosis.search.repaired].map(|fit| fit.objective),
            chi2_per_dof: diagnosis.chi2_per_dof(),
            refitted: diagnosis.search.refitted.hypothesis.to_fixture()?,
            repaired: diagnosis.search.repaired.hypothesis.to_fixture()?,
            held_out: diagnosis
                .held_out
                .as_ref()
                .map(|held_out| [held_out.nrmse_refitted, held_out.nrmse_repaired]),
        })
    }

    /// The names found, the strongest first.
    pub fn names(&self) -> Vec<Name> {
        self.findings.iter().map(|found| Name::of(&found.effect)).collect()
    }

    /// The answer as JSON.
    pub fn to_value(&self) -> Value {
        let finding = |found: &Found| {
            json!({
                "effect": effect_value(&found.effect),
                "ci95": found.intervals,
                "probability": found.probability,
                "alternatives": found.alternatives.iter()
                    .map(|(effect, p)| json!({ "effect": effect_value(effect), "probability": p })).collect::<Vec<_>>(),
            })
        };
        json!({
            "verdict": self.verdict.name(),
            "findings": self.findings.iter().map(finding).collect::<Vec<_>>(),
            "objectives": { "refitted": self.objectives[0], "repaired": self.objectives[1] },
            "chi2_per_dof": self.chi2_per_dof,
            "held_out": self.held_out,
            "refitted": self.refitted.to_value(),
            "repaired": self.repaired.to_value(),
        })
    }
}
