//! What a comparison by modes comes to.

use crate::candidate::Candidate;
use crate::estimates::estimates;
use crate::finding::{Finding, FrfEvidence, Tried};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::modal::features::Features;
use crate::modal::known::Known;
use crate::modal::places::Places;
use crate::modal::search::ModalSearch;
use crate::modal::searcher::Named;
use crate::modal::sizes::ModelError;
use crate::search::Search;
use crate::settings::ModalSettings;
use crate::settings::modal::judgement::AT_ODDS;
use crate::{Hypothesis, Observation};
use jointscope_findings::{Estimate, Verdict};
use jointscope_fixture::Effect;
use jointscope_inference::Covariance;

/// The outcome of a comparison by modes.
#[derive(Debug, Clone)]
pub(crate) struct ModalJudgement {
    pub search: ModalSearch,
    /// All names that were tried.
    pub candidates: Vec<Candidate>,
    pub verdict: Verdict,
    /// By effect of the best hypothesis: probability of its name, and other names with theirs.
    pub names: Vec<Vec<(usize, f64, Hypothesis)>>,
    /// By effect of the best hypothesis: what is known of it along its body.
    pub places: Vec<Places>,
    /// χ² per degree of freedom of the free fit that the recorded modes are from.
    pub free_fit_chi2_per_dof: f64,
    /// Whether that fit took all the residual terms it may, and the model needs fewer.
    pub excess_residual_terms: bool,
    /// Error of the refitted and of the repaired model.
    pub errors: [ModelError; 2],
    /// Whether the fixture states how well the gains of its records are known.
    pub states_gain: bool,
    /// Whether the best needs no error of the model beside another law of its damping.
    pub is_exact_but_for_its_law: bool,
    /// Whether it is of what has changed since a baseline.
    pub since_baseline: bool,
    /// Whether the fixture refitted to lines misses those below all modes that were compared, by more than a
    /// model may err.
    pub misses_below: bool,
    /// The fixture by itself and the best hypothesis, at the most probable sizes of error: what is said of
    /// quantities and effects.
    pub stated: [Hypothesis; 2],
    /// Covariance of the best one's coordinates with sizes that may be larger.
    pub covariance: Option<Covariance>,
    /// What hypotheses were held against.
    pub features: Features,
}

impl ModalJudgement {
    /// The same with nothing stated beyond the fixture by itself.
    pub(crate) fn withdrawn(&self) -> Self {
        let best = Named { names: Vec::new(), fit: self.search.none.clone(), exact: false };
        let nothing = ModalSearch {
            best,
            alternatives: Vec::new(),
            elsewhere: Vec::new(),
            without: Vec::new(),
            ..self.search.clone()
        };
        ModalJudgement {
            verdict: Verdict::Unexplained,
            names: Vec::new(),
            places: Vec::new(),
            errors: [self.errors[0]; 2],
            stated: [self.stated[0].clone(), self.stated[0].clone()],
            covariance: None,
            search: nothing,
            ..self.clone()
        }
    }

    /// The same where lines are at odds with it: stated as a part, and something that is not listed as
    /// probable as it is at the most.
    pub(crate) fn doubted(&self) -> Self {
        let names = self.names.iter().map(|all| {
            let stated: f64 = all.iter().map(|(_, probability, _)| probability).sum();
            let share = (AT_ODDS / stated.max(f64::MIN_POSITIVE)).min(1.0);
            all.iter().map(|(name, p, hypothesis)| (*name, share * p, hypothesis.clone())).collect()
        });
        ModalJudgement { verdict: Verdict::PartlyExplained, names: names.collect(), ..self.clone() }
    }

    /// The same where lines find nothing either, and modes may not tell all there is: what a free fit leaves of
    /// the recording, a mode of its own, or what lines show below all modes, is no error of a model that is
    /// usual.
    pub(crate) fn where_incomplete(&self, fitter: &Fitter) -> Self {
        let leaves = self.free_fit_chi2_per_dof > fitter.settings.modal.slight;
        let alone = self.search.best.fit.paired.pairing.alone() != 0.0;
        match self.verdict == Verdict::Consistent && (leaves || alone || self.misses_below) {
            true => self.withdrawn(),
            false => self.clone(),
        }
    }

    /// Whether the modes need nothing, neither an effect nor an error of the model: what is left, if
    /// anything, only lines can show.
    pub(crate) fn needs_nothing(&self) -> bool {
        self.verdict == Verdict::Consistent && self.search.best.exact
    }

    /// The same as if modes were explained by nothing, where all that they need is another law of the damping
    /// than the model has: which one, and whether it is that, lines are asked.
    pub(crate) fn with_its_law_in_question(&self) -> Option<Self> {
        let unexplained = || ModalJudgement { verdict: Verdict::Unexplained, ..self.clone() };
        self.needs_another_law_alone().then(unexplained)
    }

    /// Whether another law of the damping than the model has is all that modes need.
    pub(crate) fn needs_another_law_alone(&self) -> bool {
        self.verdict == Verdict::Consistent && !self.search.best.exact && self.is_exact_but_for_its_law
    }

    /// Whether errors of the usual size explain the modes, with what was found or but for the lesser part.
    pub(crate) fn explains(&self) -> bool {
        self.verdict != Verdict::Unexplained
    }

    /// Whether effects explain the modes.
    pub(crate) fn names_all(&self) -> bool {
        self.verdict == Verdict::Explained
    }

    /// What was found, and the most probable effects by themselves: what a search of a part of the recording
    /// may choose from.
    pub(crate) fn known(&self, settings: &ModalSettings) -> Known {
        let singles = &self.search.singles;
        let least = singles.first().map_or(0.0, |first| first.fit.ln) - settings.no_rival_within;
        let probable = singles.iter().take(settings.blind).filter(|single| single.fit.ln >= least);
        Known {
            found: self.search.best.fit.hypothesis.effects(),
            probable: probable.flat_map(|single| single.fit.hypothesis.effects()).collect(),
        }
    }

    /// The effects that were fitted by themselves, each kind at each place once and at its best, the most
    /// probable first.
    pub(crate) fn tried(&self) -> Vec<Tried> {
        let mut all: Vec<Tried> = Vec::new();
        for single in &self.search.singles {
            let Some(effect) = single.fit.hypothesis.effects().pop() else { continue };
            if !all.iter().any(|other| other.effect.is_named_as(&effect)) {
                all.push(Tried { effect, ln_gain: single.fit.ln - self.search.none.ln });
            }
        }
        all
    }

    /// The models that the comparison ended with, as stated or as they predict, on lines; `within` is the
    /// fixture refitted on lines.
    pub(crate) fn search_on(
        &self,
        observation: &Observation,
        within: &Search,
        models: &[Hypothesis; 2],
    ) -> Search {
        let on_lines = |hypothesis: &Hypothesis| Fit::at(hypothesis.clone(), observation);
        let nominal = on_lines(&within.nominal.hypothesis).unwrap_or_else(|| within.nominal.clone());
        let refitted = on_lines(&models[0]).unwrap_or_else(|| nominal.clone());
        let repaired = on_lines(&models[1]).unwrap_or_else(|| refitted.clone());
        Search { nominal, refitted, repaired, ..within.clone() }
    }

    /// Candidates that modes tell from the one effect of `hypothesis`, each fitted to them by itself, by more
    /// than `needed` in ln p, or not even fitted, so far below did it start.
    pub(crate) fn told_from(
        &self,
        hypothesis: &Hypothesis,
        candidates: &[Candidate],
        needed: f64,
    ) -> Vec<usize> {
        let [effect] = &hypothesis.effects()[..] else { return Vec::new() };
        let of = |named: &&Named| named.names.iter().any(|&c| candidates[c].names(effect));
        let Some(own) = self.search.singles.iter().find(of) else { return Vec::new() };
        let is_told = |named: &&Named| own.fit.ln - named.fit.ln > needed;
        let fitted = self.search.singles.iter().filter(is_told).flat_map(|named| named.names.clone());
        // What is far below the best is told from what comes first, not from any other.
        let first = self.search.singles.first().is_some_and(|first| first.names == own.names);
        let far = self.search.far.iter().copied().filter(|_| first);
        fitted.chain(far).collect()
    }

    /// The findings, the strongest first.
    pub(crate) fn findings(&self, candidates: &[Candidate]) -> Vec<Finding> {
        let ([_, hypothesis], covariance) = (&self.stated, &self.covariance);
        let finding = |(index, effect): (usize, Effect)| {
            let names = self.names.get(index)?;
            let own = |candidate: usize| candidates[candidate].names(&effect);
            let other = |(c, probability, hypothesis): &(usize, f64, Hypothesis)| {
                (!own(*c)).then(|| Some((hypothesis.effects().pop()?, *probability)))?
            };
            let places = self.places.get(index)?;
            let along = places.own.as_ref().map(|along| along.estimates(hypothesis, index, &effect));
            // Beside other effects what is stated is the most probable place, and may lie outside the middle of
            // its ridge.
            let along = along.filter(|all| all.iter().all(Estimate::holds_its_value));
            let linear = || estimates(hypothesis, index, &effect, covariance.as_ref(), 1.0);
            Some(Finding {
                estimates: along.unwrap_or_else(linear),
                probability: names.iter().find(|(c, _, _)| own(*c)).map_or(0.0, |(_, p, _)| *p),
                alternatives: names.iter().filter_map(other).collect(),
                evidence: FrfEvidence {
                    gain: 2.0 * (self.search.best.fit.ln - self.search.without[index]),
                    elsewhere: places.elsewhere.clone(),
                    measured: None,
                },
                effect,
            })
        };
        let mut all: Vec<Finding> =
            hypothesis.effects().into_iter().enumerate().filter_map(finding).collect();
        all.sort_by(|a, b| b.evidence.gain.total_cmp(&a.evidence.gain));
        all
    }
}
