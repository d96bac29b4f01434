//! Truth and answer of a case of hits side by side.

use super::{StruckAnswer, StruckAnswers, StruckRole, StruckTruth};
use crate::case_line::is_worse;
use crate::size::Size;
use crate::{Found, Name, NoAnswer};
use jointscope_diagnosis::Verdict as LinearVerdict;
use jointscope_nonlinear::Verdict;

/// A case of hits after its truth was opened.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StruckJudged {
    /// What was true.
    pub truth: StruckTruth,
    /// What was answered.
    pub answer: Result<StruckAnswer, NoAnswer>,
}

impl StruckJudged {
    /// Lays truths and answers side by side.
    pub(crate) fn all(truths: Vec<StruckTruth>, answers: &StruckAnswers) -> Vec<StruckJudged> {
        let pairs = truths.into_iter().zip(answers.all());
        pairs.map(|(truth, answer)| StruckJudged { truth, answer: answer.clone() }).collect()
    }

    /// The laws found, the strongest first.
    pub(crate) fn findings(&self) -> &[Found] {
        self.answer.as_ref().map_or(&[], |answer| &answer.findings)
    }

    /// Whether FRFs were said to change with the strength of the hits.
    pub(crate) fn is_noticed(&self) -> bool {
        self.answer.as_ref().is_ok_and(|answer| answer.verdict != Verdict::Consistent)
    }

    /// Whether a law that was found is the hidden one: kind, joint and degree of freedom.
    pub(crate) fn is_hidden(&self, found: &Found) -> bool {
        self.truth.law().is_some_and(|law| Name::of(law) == Name::of(&found.effect))
    }

    /// Whether the hidden law was found, and nothing else.
    pub(crate) fn is_named(&self) -> bool {
        matches!(self.findings(), [found] if self.is_hidden(found))
    }

    /// Whether a law was found that is not there.
    pub(crate) fn has_extra(&self) -> bool {
        self.findings().iter().any(|found| !self.is_hidden(found))
    }

    /// Of hits in which nothing was seen to depend on amplitude: whether the fixture was called consistent
    /// with their FRFs.
    pub(crate) fn is_linearly_consistent(&self) -> Option<bool> {
        let linear = self.answer.as_ref().ok()?.linear.as_ref()?;
        Some(linear.verdict == LinearVerdict::Consistent)
    }

    /// Sizes of the hidden law, where it was found.
    pub(crate) fn sizes(&self) -> Vec<Size> {
        let (Some(law), Some(found)) = (self.truth.law(), self.findings().iter().find(|f| self.is_hidden(f)))
        else {
            return Vec::new();
        };
        Size::of_each(law, found, &format!("{}: ", law.kind.name()))
    }

    /// What went wrong, in a phrase each.
    pub(crate) fn faults(&self) -> Vec<String> {
        if self.answer.is_err() {
            return vec!["no answer".to_owned()];
        }
        let mut faults = Vec::new();
        match self.truth.role {
            StruckRole::Linear if self.is_noticed() => faults.push("called non-linear"),
            StruckRole::Idle if !self.findings().is_empty() => faults.push("named what was not exercised"),
            StruckRole::Idle if self.is_noticed() => faults.push("called non-linear"),
            StruckRole::Law if !self.is_noticed() => faults.push("not noticed"),
            StruckRole::Law if self.findings().is_empty() => faults.push("no name"),
            StruckRole::Law if !self.findings().iter().any(|found| self.is_hidden(found)) => {
                faults.push("wrong name")
            }
            StruckRole::Law if self.has_extra() => faults.push("extra law"),
            _ => {}
        }
        if self.sizes().iter().any(|size| !size.is_right()) {
            faults.push("a size off by more than 10 %");
        }
        if self.is_linearly_consistent() == Some(false) && self.truth.role == StruckRole::Linear {
            faults.push("its FRFs called inconsistent");
        }
        let held_out = self.answer.as_ref().ok().and_then(|answer| answer.held_out);
        if !self.findings().is_empty() && held_out.is_some_and(is_worse) {
            faults.push("held-out hits worse");
        }
        faults.into_iter().map(str::to_owned).collect()
    }
}
