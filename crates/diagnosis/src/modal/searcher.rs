//! A comparison by modes under way: what all its steps share, and when a fit says enough.

use crate::candidate::Candidate;
use crate::modal::fit::ModalFit;
use crate::modal::known::Known;
use crate::modal::prior::{Prior, priors};
use crate::modal::problem::Problem;
use crate::settings::ModalSettings;
use crate::settings::modal::judgement::NOTHING;
use crate::settings::modal::prior::CALIBRATED_QUANTITY;
use crate::{Hypothesis, Watch};
use jointscope_fixture::Effect;
use jointscope_model_error::ErrorSizes;

/// What a search that runs out of work leaves out, as `stopped` says it.
pub(super) const STARTS: &str = "the less promising effects, by modes";

/// Effects by their candidates' indices, and their fit.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    pub names: Vec<usize>,
    pub fit: ModalFit,
    /// Whether the evidence is hardly less without any error of the model.
    pub exact: bool,
}

/// A search under way.
#[derive(Clone, Copy)]
pub(crate) struct Searcher<'a> {
    pub problem: Problem<'a>,
    pub candidates: &'a [Candidate],
    pub nominal: &'a Hypothesis,
    pub settings: &'a ModalSettings,
    /// Where to set out from in place of all candidates' starts: the effects found in more than what is
    /// searched here.
    pub known: Option<&'a Known>,
    /// Whether the fixture's quantities are where another recording of the structure put them, and stay
    /// there.
    pub calibrated: bool,
    /// Whether a hypothesis leaves no more than noise on lines.
    pub suffices: &'a (dyn Fn(&Named) -> bool + Sync),
    pub watch: Watch<'a>,
}

impl Searcher<'_> {
    /// A fit of the fixture by itself.
    pub(super) fn alone(&self, fit: ModalFit) -> Named {
        Named { names: Vec::new(), exact: self.is_exact(&fit), fit }
    }

    /// The name that an effect goes by.
    pub(super) fn name_of(&self, effect: &Effect) -> Option<usize> {
        self.candidates.iter().position(|candidate| candidate.names(effect))
    }

    /// Where one effect more may be put: where `base` stands, and beside the fixture by itself at its stated
    /// quantities too.
    pub(super) fn bases<'b>(&'b self, base: &'b Named) -> Vec<&'b Hypothesis> {
        match base.names.is_empty() {
            true => vec![self.nominal, &base.fit.hypothesis],
            false => vec![&base.fit.hypothesis],
        }
    }

    /// Priors of a hypothesis whose effects go by these names.
    pub(super) fn priors(&self, hypothesis: &Hypothesis, names: &[usize]) -> Vec<Prior> {
        let candidates: Vec<&Candidate> = names.iter().map(|&c| &self.candidates[c]).collect();
        let mut all = priors(hypothesis, &candidates);
        if self.calibrated {
            let stay = all.iter_mut().zip(&self.nominal.coordinates);
            stay.for_each(|(prior, at)| *prior = Prior { mean: *at, std: CALIBRATED_QUANTITY });
        }
        all
    }

    /// What each statement that `more` has beyond `fewer` must gain in ln p: less where errors and departures
    /// beyond chance refute what has fewer and not what has more.
    fn needed_beyond(&self, fewer: &Named, more: &Named) -> f64 {
        let refuted = !self.is_adequate(&fewer.fit) && self.is_adequate(&more.fit);
        let odds = if refuted { self.settings.odds_over_refuted } else { self.settings.odds };
        (self.candidates.len() as f64).ln() + odds.ln()
    }

    /// What `more` must gain in ln p over `fewer`: for each statement that it makes beyond those the odds of
    /// one name among all, and for each effect that only completes one its own.
    pub(super) fn needed_over(&self, fewer: &Named, more: &Named) -> f64 {
        let [before, after] = [fewer, more].map(|named| self.statements(&named.names).len());
        let beyond = after.saturating_sub(before);
        let completing = more.names.len().saturating_sub(fewer.names.len() + beyond);
        beyond as f64 * self.needed_beyond(fewer, more) + completing as f64 * self.settings.odds.ln()
    }

    /// Whether the size of every effect is told from nothing, the model's errors as large as they may well
    /// be: with few modes the most probable errors are none, and whatever fits them exactly seems to be
    /// needed. What gains very much over nothing is told in any case, for a fixture may have ended in a false
    /// minimum; not over a calibrated one, which stays where it is.
    pub(super) fn is_told(&self, named: &Named, none: &ModalFit) -> bool {
        let fit = &named.fit;
        let sizes = self.widened(fit);
        // Of a calibrated fixture nothing else moves: what the effect gains is its own.
        let alone = self.calibrated && named.names.len() == 1;
        if alone && self.gains_at(&sizes, fit, none) > self.odds_of_one() {
            return true;
        }
        let Some(covariance) = fit.covariance_at(&sizes) else { return false };
        let effects = 0..fit.hypothesis.effect_count();
        let deviations = effects.map(|index| fit.hypothesis.deviations_of(index, &covariance));
        let deviations = deviations.fold(f64::INFINITY, f64::min);
        let undoubted = self.settings.undoubted * self.statements(&named.names).len() as f64;
        let gains_much = !self.calibrated && fit.ln - none.ln > undoubted;
        deviations >= if gains_much { NOTHING } else { self.settings.least }
    }

    /// Sizes of the model's error that may be larger than the most probable ones: what uncertainties are
    /// stated with.
    pub(super) fn widened(&self, fit: &ModalFit) -> ErrorSizes {
        fit.linear.mean_sizes(&fit.paired.comparison, self.problem.prior(), &fit.evidence)
    }

    /// What a fit gains in ln p over another where errors of the model have these sizes; nothing where the
    /// two compare other modes. Along the ridge of a mass that grows as it comes nearer to a clamp its
    /// deviation says little, and this all the same that it is there.
    fn gains_at(&self, sizes: &ErrorSizes, fit: &ModalFit, none: &ModalFit) -> f64 {
        let density = |fit: &ModalFit| fit.linear.ln_density(&fit.paired.comparison, sizes);
        let alike = fit.paired.pairing.pairs == none.paired.pairing.pairs;
        density(fit).zip(density(none)).filter(|_| alike).map_or(0.0, |(with, without)| with - without)
    }

    /// ln of the odds that one effect among all candidates has to gain.
    fn odds_of_one(&self) -> f64 {
        (self.candidates.len() as f64).ln() + self.settings.odds.ln()
    }

    /// Whether what a fit needs of errors and departures is no more than chance makes.
    pub(super) fn is_adequate(&self, fit: &ModalFit) -> bool {
        self.problem.is_adequate(fit, self.settings.adequate)
    }

    /// Whether a verdict may rest on it.
    pub(super) fn stands(&self, fit: &ModalFit) -> bool {
        self.problem.stands(fit, self.settings.adequate)
    }

    /// Whether the evidence is hardly less without any error of the model.
    pub(super) fn is_exact(&self, fit: &ModalFit) -> bool {
        self.problem.is_exact(fit, self.settings.exact)
    }
}
