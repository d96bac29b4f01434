//! The fixture that explains a recording.

use crate::name::describe;
use crate::{Answer, Answers, Case, NoAnswer};
use jointscope_diagnosis::Verdict;
use jointscope_fixture::Fixture;
use jointscope_spectra::FrfSet;
use serde_json::{Value, json};
use std::fmt;

/// The fixture that explains a recording as well as this program can: the given one where that does, else
/// what diagnoses repair it to.
#[derive(Debug, Clone, PartialEq)]
pub struct Explained {
    /// The fixture that explains.
    pub fixture: Fixture,
    /// What the diagnoses answered: of the fixture as given, then of what the one before repaired it to.
    pub rounds: Vec<Answer>,
}

impl Explained {
    /// Diagnoses `recorded` against the fixture as given, and against what that repairs it to, until nothing
    /// is left to be found; `rounds` times at the most, and once at the least. A diagnosis names three
    /// effects and no more, and of a recording long enough others may be left.
    ///
    /// # Errors
    /// [`NoAnswer`], where the diagnosis has none.
    pub fn of(given: &Fixture, recorded: &FrfSet, rounds: usize) -> Result<Self, NoAnswer> {
        let mut explained = Explained { fixture: given.clone(), rounds: Vec::new() };
        while explained.rounds.len() < rounds.max(1) && !explained.is_settled() {
            let case = Case { believed: explained.fixture.clone(), recorded: recorded.clone() };
            let answer = Answer::of(&case)?;
            if answer.verdict != Verdict::Consistent {
                explained.fixture = answer.repaired.clone();
            }
            explained.rounds.push(answer);
        }
        Ok(explained)
    }

    /// Whether the fixture as given explains the recording.
    pub fn as_given(&self) -> bool {
        self.rounds.len() == 1 && self.is_settled()
    }

    /// Whether the last diagnosis found nothing more.
    pub(crate) fn is_settled(&self) -> bool {
        self.rounds.last().is_some_and(|last| last.verdict == Verdict::Consistent)
    }

    /// Diagnoses all cases of this recording, as [`Answers::by`]; the first control not again, where it is
    /// what has been diagnosed already.
    pub fn answers(&self, cases: &[Case], threads: usize, progress: impl Fn(usize) + Sync) -> Answers {
        let known = cases.first().zip(self.rounds.last().filter(|_| self.is_settled()));
        Answers::by(cases, threads, progress, |case| match known {
            Some((control, answer)) if control == case => Ok(answer.clone()),
            _ => Answer::of(case),
        })
    }

    /// The explanation as JSON.
    pub fn to_value(&self) -> Value {
        let round = |answer: &Answer| {
            json!({
                "verdict": answer.verdict.name(),
                "chi2_per_dof": answer.chi2_per_dof,
                "found": answer.findings.iter().map(|found| describe(&found.effect)).collect::<Vec<_>>(),
            })
        };
        json!({
            "as_given": self.as_given(),
            "settled": self.is_settled(),
            "rounds": self.rounds.iter().map(round).collect::<Vec<_>>(),
            "fixture": self.fixture.to_value(),
        })
    }
}

impl fmt::Display for Explained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, answer) in self.rounds.iter().enumerate() {
            let which = if index == 0 { "the fixture as given" } else { "the fixture repaired so far" };
            let separator = if index == 0 { "" } else { "\n" };
            write!(f, "{separator}{}", round(which, answer))?;
        }
        Ok(())
    }
}

/// What a diagnosis says of a fixture, and what is made of it.
fn round(which: &str, answer: &Answer) -> String {
    let [nominal, refitted, repaired] = answer.chi2_per_dof;
    let found: Vec<String> = answer.findings.iter().map(|found| describe(&found.effect)).collect();
    let found = found.join(", ");
    let taken = match answer.verdict {
        Verdict::Consistent => "explains the recording".to_owned(),
        Verdict::Explained => {
            format!("does not explain the recording, so the repaired one is taken, which adds {found}")
        }
        Verdict::PartlyExplained => format!(
            "does not explain the recording; nor does the repaired one whole, which adds {found} and is taken"
        ),
        Verdict::Unexplained => "does not explain the recording, and no effect does: \
                                 it is taken refitted within its tolerances"
            .to_owned(),
    };
    let chi2 = format!("as stated {nominal:.4}, refitted {refitted:.4}, repaired {repaired:.4}");
    format!("{which} {taken}; chi2 per degree of freedom {chi2}")
}
