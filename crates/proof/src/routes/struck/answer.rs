//! What is answered to hits: the same steps that `diagnose` takes.

use super::StruckCase;
use crate::answer::Found;
use crate::answers::on_workers;
use crate::case::effect_value;
use crate::{Answer, NoAnswer};
use jointscope_diagnosis::{Diagnosis, DiagnosisError, DiagnosisOptions};
use jointscope_estimation::{Estimate, EstimateError, EstimateOptions, ResponseWindow};
use jointscope_fixture::{Effect, EffectKind, Fixture, FixtureError, Place};
use jointscope_hits::Hit;
use jointscope_nonlinear::{DiagnoseError, NonlinearDiagnosis, NonlinearOptions, Verdict};
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// A diagnosis of hits, as it is drawn on a page.
#[derive(Debug)]
pub struct StruckDiagnosis {
    /// FRFs and what became of each hit.
    pub estimate: Estimate,
    /// Whether anything depends on amplitude, and what.
    pub amplitude: NonlinearDiagnosis,
    /// What follows.
    pub outcome: StruckOutcome,
}

/// What follows from the test of homogeneity.
#[derive(Debug)]
pub enum StruckOutcome {
    /// Something depends on amplitude, as the diagnosis says.
    Changes,
    /// Nothing does: the FRFs, and the fixture as they show it (with their window), are diagnosed.
    Linear(Box<(Fixture, Diagnosis)>),
}

/// Why hits got no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StruckNoAnswer {
    /// No FRFs could be estimated.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    /// The hammer excites no line.
    #[error("the hits excite no spectral line")]
    NoLines,
    /// Amplitude could not be judged.
    #[error(transparent)]
    Amplitude(#[from] DiagnoseError),
    /// The FRFs could not be diagnosed.
    #[error(transparent)]
    Linear(#[from] DiagnosisError),
    /// What is handed back is no fixture.
    #[error("the fixture handed back is impossible: {0}")]
    Fixture(#[from] FixtureError),
    /// The linear diagnosis gave no answer.
    #[error(transparent)]
    Answer(#[from] NoAnswer),
    /// It broke down.
    #[error("the diagnosis broke down")]
    BrokeDown,
}

impl StruckDiagnosis {
    /// Diagnoses a case under the default options: of fixture and hits, and of nothing else.
    ///
    /// # Errors
    /// See [`StruckNoAnswer`].
    pub fn of(case: &StruckCase) -> Result<Self, StruckNoAnswer> {
        let options = EstimateOptions {
            response_window: ResponseWindow::Auto,
            zero_padding: 1,
            ..EstimateOptions::default()
        };
        let estimate = Estimate::of(&case.hits, &options)?;
        let in_use = case.hits.iter().zip(&estimate.hits).filter(|(_, report)| report.used);
        let hits: Vec<Hit> = in_use.map(|(hit, _)| hit.clone()).collect();
        let amplitude = NonlinearDiagnosis::of(&case.believed, &hits, &NonlinearOptions::default())?;
        if amplitude.verdict != Verdict::Homogeneous {
            return Ok(StruckDiagnosis { estimate, amplitude, outcome: StruckOutcome::Changes });
        }
        let frfs = estimate.usable().ok_or(StruckNoAnswer::NoLines)?;
        let fixture = match estimate.decay {
            0.0 => case.believed.clone(),
            decay => {
                let window = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[decay]);
                case.believed.clone().with_physics(vec![window])?
            }
        };
        let diagnosis = Diagnosis::of(&fixture, &frfs, &DiagnosisOptions::default())?;
        let outcome = StruckOutcome::Linear(Box::new((fixture, diagnosis)));
        Ok(StruckDiagnosis { estimate, amplitude, outcome })
    }
}

/// An answer to hits, as plain data.
#[derive(Debug, Clone, PartialEq)]
pub struct StruckAnswer {
    /// What it comes to.
    pub verdict: Verdict,
    /// Probability of a difference between levels as large by chance.
    pub p_value: f64,
    /// Laws found, the strongest first.
    pub findings: Vec<Found>,
    /// χ² per degree of freedom: as stated, refitted, repaired; where something depends on amplitude.
    pub chi2_per_dof: Option<[f64; 3]>,
    /// Errors of the refitted and the repaired fixture on hits that no fit saw.
    pub held_out: Option<[f64; 2]>,
    /// The answer to the FRFs, where nothing depends on amplitude.
    pub linear: Option<Answer>,
}

impl StruckAnswer {
    /// What a diagnosis says, as plain data.
    pub(crate) fn from_diagnosis(diagnosis: &StruckDiagnosis) -> Result<Self, StruckNoAnswer> {
        let amplitude = &diagnosis.amplitude;
        let found = amplitude.findings.iter().map(|finding| Found {
            effect: finding.effect.clone(),
            intervals: finding.estimates.iter().map(|estimate| estimate.interval).collect(),
            probability: finding.probability,
            alternatives: finding.alternatives.clone(),
        });
        Ok(StruckAnswer {
            verdict: amplitude.verdict,
            p_value: amplitude.homogeneity.p_value,
            findings: found.collect(),
            chi2_per_dof: amplitude.models.as_ref().map(|models| models.each_ref().map(|m| m.chi2_per_dof)),
            held_out: amplitude.held_out.as_ref().map(|held| [held.nrmse_refitted, held.nrmse_repaired]),
            linear: match &diagnosis.outcome {
                StruckOutcome::Changes => None,
                StruckOutcome::Linear(linear) => Some(Answer::from_diagnosis(&linear.1)?),
            },
        })
    }

    /// The answer as JSON.
    pub fn to_value(&self) -> Value {
        json!({
            "verdict": self.verdict.name(),
            "p_value": self.p_value,
            "findings": self.findings.iter().map(|found| json!({
                "effect": effect_value(&found.effect),
                "ci95": found.intervals,
                "probability": found.probability,
                "alternatives": found.alternatives.iter()
                    .map(|(effect, p)| json!({ "effect": effect_value(effect), "probability": p })).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
            "chi2_per_dof": self.chi2_per_dof,
            "held_out": self.held_out,
            "linear": self.linear.as_ref().map(Answer::to_value),
        })
    }
}

/// An answer to hits, and the seconds it took.
pub(crate) type Timed = (Result<StruckAnswer, StruckNoAnswer>, f64);

/// The answers to all cases of hits, in their order.
#[derive(Debug, Default)]
pub struct StruckAnswers {
    all: Vec<Result<StruckAnswer, StruckNoAnswer>>,
    seconds: Vec<f64>,
}

impl StruckAnswers {
    /// The answer to one case, and the seconds it took; `watch` sees the diagnosis after its time was taken.
    pub(crate) fn one(case: &StruckCase, watch: impl Fn(&StruckDiagnosis)) -> Timed {
        let answered = catch_unwind(AssertUnwindSafe(|| {
            let start = Instant::now();
            let diagnosis = StruckDiagnosis::of(case);
            let seconds = start.elapsed().as_secs_f64();
            let answer = diagnosis.and_then(|diagnosis| {
                watch(&diagnosis);
                StruckAnswer::from_diagnosis(&diagnosis)
            });
            (answer, seconds)
        }));
        answered.unwrap_or((Err(StruckNoAnswer::BrokeDown), 0.0))
    }

    /// What workers gave; from one that died there is no answer.
    pub(crate) fn collected(given: impl IntoIterator<Item = Option<Timed>>) -> Self {
        let (all, seconds) =
            given.into_iter().map(|a| a.unwrap_or((Err(StruckNoAnswer::BrokeDown), 0.0))).unzip();
        StruckAnswers { all, seconds }
    }

    /// Answers given by another than the diagnosis.
    pub fn by(
        cases: &[StruckCase],
        threads: usize,
        answer: impl Fn(&StruckCase) -> Result<StruckAnswer, StruckNoAnswer> + Sync,
    ) -> Self {
        Self::collected(on_workers(
            cases,
            threads,
            |_| (),
            |case| {
                let answered = catch_unwind(AssertUnwindSafe(|| answer(case)));
                (answered.unwrap_or(Err(StruckNoAnswer::BrokeDown)), 0.0)
            },
        ))
    }

    /// The answers.
    pub fn all(&self) -> &[Result<StruckAnswer, StruckNoAnswer>] {
        &self.all
    }

    /// Seconds that each answer took, on one core.
    pub fn seconds(&self) -> &[f64] {
        &self.seconds
    }

    /// The answers as JSON.
    pub fn to_value(&self) -> Value {
        let value = |answer: &Result<StruckAnswer, StruckNoAnswer>| match answer {
            Ok(answer) => answer.to_value(),
            Err(why) => json!({ "no_answer": why.to_string() }),
        };
        Value::Array(self.all.iter().map(value).collect())
    }
}
