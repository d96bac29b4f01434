//! Truth and answer side by side, with the objectives that decide which names are right.

use crate::case_line::{in_full, is_worse, marked, named};
use crate::judge::Judge;
use crate::name::describe;
use crate::objective::relative_error;
use crate::sealable::Sealable;
use crate::workers::on_workers;
use crate::{Answer, Answers, Case, CaseLine, Found, Name, NoAnswer, Role};
use jointscope_diagnosis::Verdict;
use jointscope_fixture::{Effect, Fixture};
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::FrfSet;
use serde::{Serialize, Serializer};
use serde_json::json;
use std::collections::BTreeMap;

/// A name whose best fit comes within this of the truth's cannot be told from it.
pub const AS_GOOD: f64 = 9.0;
/// What a hidden effect must cost the refitted fixture to be asked for.
pub const VISIBLE: f64 = 50.0;
/// What it must cost for its name to be expected with certainty.
pub const PLAIN: f64 = 200.0;
/// Stated probability at which a wrong name is a fault.
const CLAIMED: f64 = 0.9;

/// What is true of a case whose recording is FRFs, and how answers to it are judged.
pub trait Judgeable: Sealable {
    /// The case's number among all.
    fn index(&self) -> usize;
    /// How much was hidden.
    fn role(&self) -> Role;
    /// The hidden effects.
    fn effects(&self) -> &[Effect];
    /// What independent fits say of an answer; `None` where recording or answer cannot be evaluated.
    fn independent_fits(&self, case: &Case, answer: &Answer) -> Option<IndependentFits>;

    /// What was hidden, in words.
    fn hidden(&self) -> String {
        let all: Vec<String> = self.effects().iter().map(describe).collect();
        if all.is_empty() { "nothing".to_owned() } else { all.join(" and ") }
    }
}

/// A case after the truth was opened.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged<T = crate::Truth> {
    /// What was true.
    pub truth: T,
    /// What was answered.
    pub answer: Result<Answer, NoAnswer>,
    /// What independent fits say of both.
    pub fits: IndependentFits,
}

/// Objectives (χ² and squared departures of the quantities) and errors by which an answer is judged.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct IndependentFits {
    /// Of the refitted fixture that was handed back.
    pub refitted: f64,
    /// Of the repaired fixture that was handed back.
    pub repaired: f64,
    /// Of the best fit about the truth; of a solid, of its own noise-free FRFs.
    pub truth: f64,
    /// Of the best lumped fixture that has what is hidden in a solid, started at its closed form.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lumped: Option<f64>,
    /// Cramér–Rao bound of each hidden effect's parameters, one standard deviation.
    #[serde(skip)]
    pub bounds: Vec<Vec<Option<f64>>>,
    /// Of every other name that was given, fitted alone (one hidden effect only).
    #[serde(serialize_with = "by_name")]
    pub others: BTreeMap<Name, f64>,
    /// Of the best fit without each hidden effect; of a solid only where there are two.
    pub without: Vec<f64>,
    /// Errors on FRFs that nobody recorded: refitted and repaired.
    #[serde(skip)]
    pub unseen: Option<[f64; 2]>,
    /// Number of recorded values, real and imaginary parts counted apart, where that is asked for.
    #[serde(skip)]
    pub values: usize,
    /// Quantities of the repaired fixture that lie far from what was stated, in standard deviations.
    #[serde(skip)]
    pub beyond_tolerance: Vec<(String, f64)>,
}

fn by_name<S: Serializer>(others: &BTreeMap<Name, f64>, serializer: S) -> Result<S::Ok, S::Error> {
    let entry = |(name, objective): (&Name, &f64)| json!({ "name": name, "objective": objective });
    serializer.collect_seq(others.iter().map(entry))
}

impl IndependentFits {
    /// Objectives of what was handed back; those of the truth are still to come.
    pub(crate) fn of_answer(judge: &Judge, answer: &Answer) -> Option<Self> {
        let (refitted, repaired) = (judge.objective(&answer.refitted)?, judge.objective(&answer.repaired)?);
        Some(IndependentFits { refitted, repaired, ..IndependentFits::default() })
    }
}

/// Error √(Σ|ΔH|²/Σ|H|²) of a fixture on noise-free FRFs, as a perfect instrument would read them.
pub(crate) fn error_on(exact: &FrfSet, fixture: &Fixture) -> Option<f64> {
    let set = synthesize(fixture, exact.pairs(), exact.lines(), Instrument::Perfect).ok()?;
    Some(relative_error(&set, exact))
}

impl<T: Judgeable + Sync> Judged<T> {
    /// Judges all cases on `threads` workers.
    pub fn all(
        cases: &[Case],
        truths: Vec<T>,
        answers: &Answers,
        threads: usize,
        progress: impl Fn(usize) + Sync,
    ) -> Vec<Self> {
        let work: Vec<_> = cases.iter().zip(&truths).zip(answers.all()).collect();
        let fits = on_workers(&work, threads, progress, |((case, truth), answer)| {
            answer.as_ref().ok().and_then(|answer| truth.independent_fits(case, answer))
        });
        let judged = truths.into_iter().zip(answers.all()).zip(fits);
        judged
            .map(|((truth, answer), fits)| Judged {
                truth,
                answer: answer.clone(),
                fits: fits.flatten().unwrap_or_default(),
            })
            .collect()
    }
}

impl<T: Judgeable> Judged<T> {
    /// The hidden names.
    pub fn hidden(&self) -> Vec<Name> {
        self.truth.effects().iter().map(Name::of).collect()
    }

    /// What was found, the strongest first; nothing where there is no answer.
    pub(crate) fn findings(&self) -> &[Found] {
        self.answer.as_ref().map_or(&[], |answer| &answer.findings)
    }

    /// The names found, the strongest first.
    pub fn found(&self) -> Vec<Name> {
        self.findings().iter().map(|found| Name::of(&found.effect)).collect()
    }

    /// What the hidden physics costs a fit that does without: Δχ², of two effects the smaller one's. A refit
    /// that ended in a false minimum does not make an effect look larger than it is.
    pub fn size(&self) -> f64 {
        let IndependentFits { refitted, truth, without, .. } = &self.fits;
        without.iter().copied().fold(*refitted, f64::min) - truth
    }

    /// Whether what was hidden shows: one effect, or each of two.
    pub fn is_visible(&self) -> bool {
        self.truth.role() != Role::Null && self.size() >= VISIBLE
    }

    /// Whether the answer says that nothing is amiss.
    pub(crate) fn is_consistent(&self) -> bool {
        self.answer.as_ref().is_ok_and(|answer| answer.verdict == Verdict::Consistent)
    }

    /// Whether the answer says that something is amiss.
    pub(crate) fn is_noticed(&self) -> bool {
        self.answer.is_ok() && !self.is_consistent()
    }

    /// The findings that are named with certainty.
    pub(crate) fn claims(&self) -> impl Iterator<Item = &Found> {
        self.findings().iter().filter(|found| found.probability >= CLAIMED)
    }

    /// Errors of the refitted and the repaired fixture on what no fit saw.
    pub(crate) fn held_out(&self) -> Option<[f64; 2]> {
        self.answer.as_ref().ok()?.held_out
    }

    /// Faults of the repaired fixture, whatever was hidden.
    pub(crate) fn faults_of_prediction(&self) -> Vec<String> {
        let errors = [("unseen FRFs worse", self.fits.unseen), ("held-out lines worse", self.held_out())];
        let worse = errors.into_iter().filter(|(_, errors)| errors.is_some_and(is_worse));
        worse.filter(|_| !self.findings().is_empty()).map(|(fault, _)| fault.to_owned()).collect()
    }

    /// The case in a line, with the findings that count as right; details are the findings.
    pub(crate) fn line_of(&self, faults: Vec<String>, is_right: impl Fn(&Found) -> bool) -> CaseLine {
        let hidden = self.hidden();
        let mark = |found: &Found| match (hidden.contains(&Name::of(&found.effect)), is_right(found)) {
            (true, _) => "= ",
            (false, true) => "≈ ",
            (false, false) => "",
        };
        let is_null = self.truth.role() == Role::Null;
        CaseLine {
            index: self.truth.index(),
            role: String::new(),
            hidden: self.truth.hidden(),
            size: if is_null { String::new() } else { format!("{:.0}", self.size()) },
            verdict: match &self.answer {
                Ok(answer) => answer.verdict.name().replace('_', " "),
                Err(why) => format!("no answer: {why}"),
            },
            found: marked(self.findings(), mark),
            answered: self.answer.is_ok(),
            asked: is_null || self.is_visible() || !self.findings().is_empty(),
            details: in_full(self.findings()),
            value: json!({
                "truth": self.truth.to_value(),
                "verdict": self.answer.as_ref().map(|answer| answer.verdict.name()).ok(),
                "found": named(self.findings(), &is_right),
                "visible": self.is_visible(),
                "faults": faults,
                "objectives": self.fits,
                "unseen": self.fits.unseen,
            }),
            faults,
        }
    }
}
