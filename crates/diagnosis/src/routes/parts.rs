//! What every route is given, and what it decides.

use crate::finding::{Finding, Tried};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::held_out::Division;
use crate::location::Location;
use crate::modal::ModelError;
use crate::named::{re_estimated, verdict};
use crate::search::Search;
use crate::{Baseline, Hypothesis, Observation};
use jointscope_findings::{HeldOut, Verdict};
use jointscope_fixture::Fixture;
use jointscope_inference::normal_above;

/// The recording as `fitter` sees it, and the fixture as it is given.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    pub fitter: &'a Fitter<'a>,
    pub fixture: &'a Fixture,
    /// Whether the fixture's bare numbers are exact.
    pub exact: bool,
    /// Whether lines may decide: not where the recording was made one of the structure without its sensors, which
    /// leaves lines less than their noise says.
    pub lines_decide: bool,
    /// What is held out, where anything is.
    pub division: Option<&'a Division>,
}

impl Given<'_> {
    /// The fixture as it stands and refitted.
    pub(super) fn without_effects(self) -> Option<Search> {
        Search::without_effects(self.fitter, self.fixture, self.exact)
    }
}

/// What a route decides. `Diagnosis::of_parts` adds what follows from it.
pub(crate) struct Parts {
    pub verdict: Verdict,
    pub search: Search,
    /// What is said of the quantities of the refitted and the repaired model, where these are to predict.
    pub stated: Option<[Hypothesis; 2]>,
    pub findings: Vec<Finding>,
    pub locations: Vec<Location>,
    pub held_out: Option<HeldOut>,
    pub model_error: Option<[ModelError; 2]>,
    pub baseline_error: Option<ModelError>,
    pub baseline: Option<Baseline>,
    pub tried: Vec<Tried>,
}

impl Parts {
    /// What is said of the quantities of the refitted and the repaired model.
    pub(crate) fn models(&self) -> [Hypothesis; 2] {
        let models = || [&self.search.refitted, &self.search.repaired].map(|fit| fit.hypothesis.clone());
        self.stated.clone().unwrap_or_else(models)
    }

    /// The same on all FRFs of a recording of which a part was searched: models that were fitted to lines are
    /// fitted to all of them.
    pub(crate) fn on_all(mut self, fitter: &Fitter) -> Self {
        let by_lines = self.model_error.is_none();
        let again = |fit: &Fit| match by_lines {
            true => fitter.local(&fit.hypothesis, None, f64::INFINITY),
            false => Fit::at(fit.hypothesis.clone(), fitter.observation),
        };
        let Search { nominal, refitted, repaired, candidates, told_apart, is_sure } = self.search;
        let nominal = Fit::at(nominal.hypothesis.clone(), fitter.observation).unwrap_or(nominal);
        let refitted = again(&refitted).unwrap_or(refitted);
        let repaired = again(&repaired).unwrap_or(repaired);
        self.search = Search { nominal, refitted, repaired, candidates, told_apart, is_sure };
        if by_lines {
            self.findings = re_estimated(fitter, &self.search, self.findings);
            self.verdict = verdict(fitter, &self.search, &self.findings);
        }
        self
    }
}

/// χ² per degree of freedom that a fit leaves, and the probability of one as large by chance.
pub(crate) fn chance(observation: &Observation, fit: &Fit) -> (f64, f64) {
    let chi2_per_dof = fit.chi2_per_dof(observation);
    (chi2_per_dof, normal_above(observation.excess(chi2_per_dof)))
}
