//! What is answered to hits: by the same route that `diagnose` takes.

use crate::answer::{Found, Reply};
use crate::{Answer, Answers};
use jointscope_nonlinear::Verdict;
use jointscope_pipeline::{Answer as Diagnosed, Outcome};
use serde_json::{Value, json};

/// The answers to all cases of hits, in their order.
pub type StruckAnswers = Answers<StruckAnswer>;

/// An answer to hits, as plain data.
#[derive(Debug, Clone, PartialEq)]
pub struct StruckAnswer {
    /// What it comes to.
    pub verdict: Verdict,
    /// Probability of a difference between levels as large by chance; `None` where that was not judged.
    pub p_value: Option<f64>,
    /// Laws found, the strongest first.
    pub findings: Vec<Found>,
    /// χ² per degree of freedom: as stated, refitted, repaired; where something depends on amplitude.
    pub chi2_per_dof: Option<[f64; 3]>,
    /// Errors of the refitted and the repaired fixture on hits that no fit saw.
    pub held_out: Option<[f64; 2]>,
    /// The answer to the FRFs, where nothing depends on amplitude.
    pub linear: Option<Answer>,
}

impl Reply for StruckAnswer {
    fn of_diagnosed(diagnosed: &Diagnosed) -> Option<Self> {
        let mut answer = StruckAnswer {
            verdict: Verdict::Consistent,
            p_value: diagnosed.homogeneity,
            findings: Vec::new(),
            chi2_per_dof: None,
            held_out: None,
            linear: Answer::of_diagnosed(diagnosed),
        };
        if let Outcome::Hits(law) = &diagnosed.outcome {
            let found = law.findings.iter().map(|finding| Found {
                effect: finding.effect.clone(),
                intervals: finding.estimates.iter().map(|estimate| estimate.interval).collect(),
                probability: finding.probability,
                alternatives: finding.alternatives.clone(),
            });
            answer.verdict = law.verdict;
            answer.findings = found.collect();
            answer.chi2_per_dof = law.models.as_ref().map(|models| models.each_ref().map(|m| m.chi2_per_dof));
            answer.held_out = law.held_out.as_ref().map(|held| [held.nrmse_refitted, held.nrmse_repaired]);
        }
        Some(answer)
    }

    fn to_value(&self) -> Value {
        json!({
            "verdict": self.verdict,
            "p_value": self.p_value,
            "findings": self.findings,
            "chi2_per_dof": self.chi2_per_dof,
            "held_out": self.held_out,
            "linear": self.linear.as_ref().map(Answer::to_value),
        })
    }
}
