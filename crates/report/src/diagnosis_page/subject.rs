//! What the sections of the page are made from.

use jointscope_diagnosis::{Diagnosis, Fit, Hypothesis};
use jointscope_fixture::Fixture;

/// What the sections of the page are made from.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) diagnosis: &'a Diagnosis,
    pub(super) fixture: &'a Fixture,
}

impl<'a> Subject<'a> {
    /// The models that are compared, by name. The repaired one is there only where it is another than the
    /// refitted.
    pub(super) fn models(&self) -> Vec<(&'static str, &'a Fit)> {
        let search = &self.diagnosis.search;
        let mut models = vec![("nominal", &search.nominal), ("refitted", &search.refitted)];
        if !self.diagnosis.findings.is_empty() {
            models.push(("repaired", &search.repaired));
        }
        models
    }

    /// The refitted and, where it is another, the repaired model, as quantities are stated of them.
    pub(super) fn stated(&self) -> Vec<(&'static str, &'a Hypothesis)> {
        let [refitted, repaired] = &self.diagnosis.stated;
        let found = (!self.diagnosis.findings.is_empty()).then_some(("repaired", repaired));
        [("refitted", refitted)].into_iter().chain(found).collect()
    }
}
