//! What became of one case.

use super::{Concealed, Expected};
use crate::{AS_GOOD, Answer, Found, Name, Size, VISIBLE};
use jointscope_diagnosis::Verdict;

/// Probability from which a name counts as stated with certainty.
const STATED_AS_CERTAIN: f64 = 0.9;

/// What became of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// A control in which nothing was found that the recording does not have of its own.
    Quiet,
    /// A control in which something was.
    FalseAlarm,
    /// Kind, place and degree of freedom of all that was concealed.
    Found,
    /// Of two effects one.
    HalfFound,
    /// Another name, by which the repaired fixture fits as well as the one that explains: the recording
    /// cannot tell them apart.
    AsGood,
    /// The kind, at another place.
    Elsewhere,
    /// Something else.
    Confused,
    /// Nothing.
    Missed,
    /// No effect describes it, and the diagnosis says that something is wrong without naming an effect with
    /// certainty.
    Noticed,
    /// The fixture, refitted within its tolerances, does nearly as well without it: nobody is asked for it.
    DoesNotShow,
    /// The recording has a finding of this name of its own.
    Own,
    /// The diagnosis gave no answer.
    NoAnswer,
}

impl Outcome {
    /// The outcome in words.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Outcome::Quiet => "quiet",
            Outcome::FalseAlarm => "false alarm",
            Outcome::Found => "found",
            Outcome::HalfFound => "one of two found",
            Outcome::AsGood => "another name, as good",
            Outcome::Elsewhere => "kind right, place wrong",
            Outcome::Confused => "taken for something else",
            Outcome::Missed => "missed",
            Outcome::Noticed => "noticed",
            Outcome::DoesNotShow => "does not show",
            Outcome::Own => "the recording has it of its own",
            Outcome::NoAnswer => "no answer",
        }
    }
}

/// What the objectives of a case's fixtures exceed those of the first control by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Excess {
    /// Refitted within tolerances.
    pub refitted: f64,
    /// Repaired.
    pub repaired: f64,
}

/// What became of a case; `own` are the names found in the control.
pub(super) fn outcome(truth: &Concealed, answer: &Answer, own: &[Name], excess: Option<Excess>) -> Outcome {
    let new: Vec<&Found> = answer.findings.iter().filter(|f| !own.contains(&Name::of(&f.effect))).collect();
    if truth.is_control() {
        return if new.is_empty() { Outcome::Quiet } else { Outcome::FalseAlarm };
    }
    let names = answer.names();
    let found: Vec<&Expected> = truth
        .expected
        .iter()
        .filter(|expected| names.iter().any(|name| expected.named(name).is_some()))
        .collect();
    if !found.is_empty() && found.len() == truth.expected.len() {
        let is_own = |expected: &&Expected| own.iter().any(|name| expected.named(name).is_some());
        return if found.iter().any(is_own) { Outcome::Own } else { Outcome::Found };
    }
    let as_good = excess.is_some_and(|excess| excess.repaired <= AS_GOOD);
    if excess.is_some_and(|excess| excess.refitted < VISIBLE) {
        return Outcome::DoesNotShow;
    }
    if !new.is_empty() && as_good {
        return Outcome::AsGood;
    }
    if truth.expected.is_empty() {
        let certain = new.iter().any(|found| found.probability >= STATED_AS_CERTAIN);
        let says_so = matches!(answer.verdict, Verdict::PartlyExplained | Verdict::Unexplained);
        return match (certain, says_so || !new.is_empty()) {
            (true, _) => Outcome::Confused,
            (false, true) => Outcome::Noticed,
            (false, false) => Outcome::Missed,
        };
    }
    let of_kind = |found: &&Found| truth.expected.iter().any(|e| e.effect.kind == found.effect.kind);
    match (new.is_empty(), found.is_empty()) {
        (true, _) => Outcome::Missed,
        (false, false) => Outcome::HalfFound,
        (false, true) if new.iter().any(of_kind) => Outcome::Elsewhere,
        (false, true) => Outcome::Confused,
    }
}

/// Findings that are neither the recording's own nor what was concealed.
pub(super) fn extra(truth: &Concealed, answer: &Answer, own: &[Name]) -> Vec<Name> {
    let is_true = |name: &Name| truth.expected.iter().any(|expected| expected.named(name).is_some());
    answer.names().into_iter().filter(|name| !own.contains(name) && !is_true(name)).collect()
}

/// The parameters of what was found of the truth.
pub(super) fn sizes(truth: &Concealed, answer: &Answer) -> Vec<Size> {
    let mut all = Vec::new();
    for found in &answer.findings {
        let name = Name::of(&found.effect);
        let Some(effect) = truth.expected.iter().find_map(|expected| expected.named(&name)) else { continue };
        for (index, spec) in effect.kind.spec().parameters.iter().enumerate() {
            all.push(Size {
                what: format!("{} {}", spec.name, spec.unit_in(effect.dof)).trim_end().to_owned(),
                truth: effect.value(index),
                found: found.effect.value(index),
                interval: found.intervals.get(index).copied().flatten(),
            });
        }
    }
    all
}
