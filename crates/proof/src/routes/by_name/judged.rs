//! Truth and answer side by side.

use super::Nameable;
use crate::size::Size;
use crate::strength::leading_parameter;
use crate::{Found, Judged, Name};

/// Stated probability from which a name counts as given.
pub(super) const LIKELY: f64 = 0.5;

impl<T: Nameable> Judged<T> {
    /// Whether a finding is what was hidden: kind, place and dof.
    pub(super) fn is_hidden(&self, found: &Found) -> bool {
        self.truth.concealed().is_some_and(|hidden| Name::of(hidden) == Name::of(&found.effect))
    }

    /// Whether a finding is what was hidden, or says the same.
    fn is_accepted(&self, found: &Found) -> bool {
        let (truth, effect) = (&self.truth, &found.effect);
        self.is_hidden(found) || truth.is_the_same(effect) || truth.stands_for(effect, &self.fits)
    }

    /// Whether a finding is in the structure, hidden or not.
    pub(super) fn is_in_it(&self, found: &Found) -> bool {
        self.is_accepted(found) || self.truth.is_true(&found.effect)
    }

    /// Whether what was hidden is the first name.
    pub(super) fn is_first(&self) -> bool {
        self.findings().first().is_some_and(|found| self.is_accepted(found))
    }

    /// Whether a name of this probability or more is untrue.
    pub(super) fn is_untrue_from(&self, probability: f64) -> bool {
        self.findings().iter().any(|found| found.probability >= probability && !self.is_in_it(found))
    }

    /// Whether what was hidden is the first name, and nothing untrue stands beside it.
    pub(super) fn is_right(&self) -> bool {
        self.is_first() && !self.is_untrue_from(0.0)
    }

    /// Whether what was hidden is the one name given.
    pub(super) fn is_alone(&self) -> bool {
        self.findings().len() == 1 && self.is_first()
    }

    /// Whether the one name given is the hidden one, or exactly the same thing.
    pub(super) fn is_its_own(&self) -> bool {
        matches!(self.findings(), [found] if self.is_hidden(found) || self.truth.is_the_same(&found.effect))
    }

    /// Whether what was hidden is asked for.
    pub(super) fn is_asked(&self) -> bool {
        self.truth.concealed().is_some() && T::shows(self)
    }

    /// The size of what was hidden, where it was found.
    pub(super) fn found_size(&self) -> Option<Size> {
        let hidden = self.truth.concealed()?;
        let found = self.findings().iter().find(|found| self.is_hidden(found))?;
        let leading = leading_parameter(hidden.kind);
        let dof = hidden.dof.map_or_else(String::new, |dof| format!(" in {}", dof.name()));
        Some(Size {
            what: format!("{}{dof}: {}", hidden.kind.name(), hidden.kind.spec().parameters[leading].name),
            truth: hidden.value(leading),
            found: found.effect.value(leading),
            interval: found.intervals.get(leading).copied().flatten(),
        })
    }

    /// What went wrong, in a phrase each.
    pub(super) fn errors(&self) -> Vec<String> {
        let Ok(answer) = &self.answer else { return vec!["no answer".to_owned()] };
        let mut faults = Vec::new();
        let mut fault = |is_one: bool, what: &str| faults.extend(is_one.then(|| what.to_owned()));
        if self.is_asked() && !self.is_first() {
            let what = match answer.findings.as_slice() {
                [] => "missed",
                all if all.iter().any(|found| self.is_accepted(found)) => "not named first",
                all if all.iter().all(|found| self.is_in_it(found)) => "something true named in its place",
                _ => "wrong name",
            };
            fault(true, what);
        }
        fault(self.is_untrue_from(0.9), "an untrue name with 0.9 or more");
        let likely = self.is_untrue_from(LIKELY) && !self.is_untrue_from(0.9);
        fault(likely, "an untrue name with 0.5 or more");
        let beside = self.is_first() && !self.is_right() && !self.is_untrue_from(LIKELY);
        fault(beside, "an untrue name beside it");
        fault(self.is_asked() && self.is_consistent(), "called consistent");
        fault(self.found_size().is_some_and(|size| !size.is_right()), "a size off by more than 10 %");
        faults.extend(self.faults_of_prediction());
        faults
    }
}
