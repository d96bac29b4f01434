//! The fixture that explains a recording.

use crate::case::describe;
use crate::{Answer, Answers, Case, NoAnswer};
use jointscope_diagnosis::Verdict;
use jointscope_fixture::Fixture;
use jointscope_spectra::FrfSet;
use serde_json::{Value, json};
use std::fmt;

/// The fixture that explains a recording as well as this program can: the given one where that does, else what a diagnosis repairs it to.
#[derive(Debug, Clone, PartialEq)]
pub struct Explained {
    /// The fixture that explains.
    pub fixture: Fixture,
    /// What the diagnosis of the fixture as given answered.
    pub first: Answer,
}

impl Explained {
    /// Diagnoses `recorded` against the fixture as given, once.
    ///
    /// # Errors
    /// [`NoAnswer`], where the diagnosis has none.
    pub fn of(given: &Fixture, recorded: &FrfSet) -> Result<Self, NoAnswer> {
        let case = Case { believed: given.clone(), recorded: recorded.clone() };
        let first = Answer::of(&case)?;
        let fixture = if first.verdict == Verdict::Consistent { given } else { &first.repaired };
        Ok(Explained { fixture: fixture.clone(), first })
    }

    /// Whether the fixture as given explains the recording.
    pub fn as_given(&self) -> bool {
        self.first.verdict == Verdict::Consistent
    }

    /// Diagnoses all cases of this recording, as [`Answers::to`]; the first control not again, where it is what has been diagnosed already.
    pub fn answers(&self, cases: &[Case], threads: usize, told: impl Fn(usize) + Sync) -> Answers {
        let known = cases.first().filter(|_| self.as_given());
        Answers::by(cases, threads, told, |case| match known == Some(case) {
            true => Ok(self.first.clone()),
            false => Answer::of(case),
        })
    }

    /// The explanation as JSON.
    pub fn to_value(&self) -> Value {
        json!({
            "as_given": self.as_given(),
            "verdict": self.first.verdict.name(),
            "chi2_per_dof": self.first.chi2_per_dof,
            "found": self.first.findings.iter().map(|found| describe(&found.effect)).collect::<Vec<_>>(),
            "fixture": self.fixture.to_value(),
        })
    }
}

impl fmt::Display for Explained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [nominal, refitted, repaired] = self.first.chi2_per_dof;
        let found: Vec<String> = self.first.findings.iter().map(|found| describe(&found.effect)).collect();
        let chi2 = format!(
            "chi2 per degree of freedom as stated {nominal:.4}, refitted {refitted:.4}, repaired {repaired:.4}"
        );
        match self.first.verdict {
            Verdict::Consistent => write!(f, "the fixture as given explains the recording; {chi2}"),
            Verdict::Explained => write!(
                f,
                "the fixture as given does not explain the recording, so the repaired one is taken, which adds {}; {chi2}",
                found.join(", ")
            ),
            Verdict::PartlyExplained => write!(
                f,
                "neither the fixture as given nor the repaired one, which adds {} and is taken, explains the recording whole; {chi2}",
                found.join(", ")
            ),
            Verdict::Unexplained => write!(
                f,
                "no effect explains what the recording departs by from the fixture; the refitted fixture is taken, and whatever is found in the \
                 control is the recording's own; {chi2}"
            ),
        }
    }
}
