//! The decision at the end of a comparison by modes: verdict, probabilities, errors.

use crate::Hypothesis;
use crate::modal::along::Along;
use crate::modal::features::Features;
use crate::modal::fit::ModalFit;
use crate::modal::judgement::ModalJudgement;
use crate::modal::places::Places;
use crate::modal::search::ModalSearch;
use crate::modal::searcher::{Named, Searcher};
use crate::settings::modal::sizes::STANDING_SHAPE;
use jointscope_findings::Verdict;

fn squares(sizes: &[f64]) -> f64 {
    sizes.iter().map(|size| size * size).sum()
}

/// A comparison by modes that is to be judged.
pub(super) struct Judge<'a> {
    pub searcher: Searcher<'a>,
    pub search: ModalSearch,
}

impl Judge<'_> {
    /// What it comes to.
    pub(super) fn judged(mut self, features: Features) -> ModalJudgement {
        let verdict = self.verdict();
        if matches!(verdict, Verdict::Consistent | Verdict::Unexplained) {
            self.search.best = self.searcher.alone(self.search.none.clone());
            self.search.alternatives.clear();
            self.search.elsewhere.clear();
            self.search.without.clear();
        }
        let adequate = self.searcher.settings.adequate.0;
        let error = |fit: &ModalFit| self.searcher.problem.error(fit, adequate);
        let best = &self.search.best.fit;
        let problem = &self.searcher.problem;
        let widened = self.searcher.widened(best);
        let nearest = |fit: &ModalFit| {
            let fitted = problem.at_sizes(fit, &fit.evidence.sizes);
            fitted.map_or_else(|| fit.hypothesis.clone(), |(hypothesis, _)| hypothesis)
        };
        let covariance = problem.at_sizes(best, &widened).and_then(|(_, covariance)| covariance);
        let none = &self.search.none;
        let mut stated = [none, best].map(nearest);
        let names = self.search.alternatives.iter().zip(&self.search.elsewhere);
        let names = self.search.best.names.iter().zip(names);
        let names = names.map(|(&own, (all, elsewhere))| self.probabilities(own, all, elsewhere)).collect();
        let places: Vec<Places> = (0..self.search.best.names.len())
            .map(|index| self.searcher.places(&self.search, index))
            .collect();
        if let [Places { own: Some(Along { middle: Some(middle), .. }), .. }] = &places[..] {
            stated[1] = middle.clone();
        }
        ModalJudgement {
            verdict,
            places,
            candidates: self.searcher.candidates.to_vec(),
            names,
            free_fit_chi2_per_dof: self.searcher.problem.recorded.chi2_per_dof,
            excess_residual_terms: self.searcher.problem.recorded.has_excess_residual_terms(),
            errors: [&self.search.none, &self.search.best.fit].map(error),
            states_gain: false,
            is_exact_but_for_its_law: problem.is_exact_but_for_its_law(best, self.searcher.settings.exact),
            since_baseline: self.searcher.calibrated,
            misses_below: false,
            stated,
            covariance,
            features,
            search: self.search,
        }
    }

    fn verdict(&self) -> Verdict {
        let (none, best) = (&self.search.none, &self.search.best);
        let adequate = self.searcher.stands(&best.fit) || self.outweighs_adequate_fixture();
        // Of a recording that no poles explain, names say nothing, but for what has changed since another one
        // like it.
        let hopeless = self.searcher.problem.recorded.chi2_per_dof > self.searcher.settings.hopeless;
        if hopeless && !self.searcher.calibrated && !(best.names.is_empty() && adequate) {
            return Verdict::Unexplained;
        }
        // Errors of the model, or these and those of the records' gains: a channel of the wrong sign looks
        // like gains that are off by all they are.
        let model = |fit: &ModalFit| squares(&self.searcher.problem.relative_sizes(fit));
        let all = |fit: &ModalFit| squares(&self.searcher.problem.relative_sizes_with_gains(fit));
        // Or those of the modes in the band alone, if no others grow for that: what lies above the band is
        // the model's affair too, but not what a name is about.
        let modes = |fit: &ModalFit| squares(&self.searcher.problem.relative_sizes_of_modes(fit));
        let part = self.searcher.settings.part;
        let in_part = || {
            model(&best.fit) < part * model(none)
                || best.fit.is_of_signals() && !self.made_up_for_by_signals(&best.fit).is_empty()
                || all(&best.fit) < part * all(none)
                || modes(&best.fit) < part * modes(none) && model(&best.fit) < model(none)
        };
        // Gains of records may be off by anything beside a name, and from one test to the next. By themselves
        // they are what is left out.
        let gains = best.fit.has_gains_beyond(self.searcher.problem.sizes) && !self.searcher.calibrated;
        match (best.names.is_empty(), adequate) {
            (true, true) if !gains => Verdict::Consistent,
            (true, _) => Verdict::Unexplained,
            (false, true) => Verdict::Explained,
            (false, false) if in_part() => Verdict::PartlyExplained,
            (false, false) => Verdict::Unexplained,
        }
    }

    /// Whether a name that asks for errors a little larger than usual gains as much as it must over a fixture
    /// that is adequate without it, even with its errors held at what is usual: a size is known to some
    /// tenths of itself only, and what is more probable than something adequate is no worse for it. Other
    /// than `is_as_probable_with_errors_within`, by which a fit is adequate by itself, it compares two fits,
    /// and the density of the features alone pays for the errors that are held.
    fn outweighs_adequate_fixture(&self) -> bool {
        let (none, best) = (&self.search.none, &self.search.best);
        let (largest, departure) = self.searcher.settings.adequate;
        if best.names.is_empty() || best.fit.largest_departure() > departure || !self.searcher.stands(none) {
            return false;
        }
        let usual = self.searcher.problem.no_larger(&best.fit, (largest, STANDING_SHAPE));
        let density = |sizes| best.fit.linear.ln_density(&best.fit.paired.comparison, sizes);
        let Some((before, now)) = density(&best.fit.evidence.sizes).zip(density(&usual)) else {
            return false;
        };
        let gained = best.fit.ln - (before - now).max(0.0) - none.ln;
        gained > self.searcher.needed_over(&self.searcher.alone(none.clone()), best)
    }

    /// What is left, as multiples of what is usual, of the kinds of error in whose stead factors on channels'
    /// signals stand: those that are beyond what is usual without them, and with them no more than the lesser
    /// part. A signal has no part in natural frequencies, a gain none in what lies above the band: whatever
    /// these are wrong by, the factor may be all that the others lack. Nothing where others grow for it.
    fn made_up_for_by_signals(&self, best: &ModalFit) -> Vec<f64> {
        let of = |fit: &ModalFit| self.searcher.problem.relative_sizes_of_signals(fit);
        let (without, with) = (of(&self.search.none), of(best));
        if squares(&with) > squares(&without) {
            return Vec::new();
        }
        let part = self.searcher.settings.part;
        let both = without.iter().zip(with);
        both.filter(|(without, with)| **without > 1.0 && with * with < part * *without * *without)
            .map(|(_, with)| with)
            .collect()
    }

    /// Probabilities of the names that may stand in one effect's stead, the best one's at all of its places;
    /// the rest to one is something not listed.
    fn probabilities(&self, own: usize, all: &[Named], elsewhere: &[Named]) -> Vec<(usize, f64, Hypothesis)> {
        let highest = all.iter().map(|n| n.fit.ln).fold(f64::NEG_INFINITY, f64::max);
        let weight = |named: &Named| {
            let other = |place: &Named| (place.fit.ln - highest).exp();
            let others = elsewhere.iter().filter(|_| named.names.last() == Some(&own)).map(other);
            (named.fit.ln - highest).exp() + others.sum::<f64>()
        };
        let total = all.iter().map(weight).sum::<f64>() + self.unlisted(&self.search.best.fit);
        let of = |named: &Named| {
            let (name, hypothesis) = self.named_at(own, named)?;
            Some((name, weight(named) / total, hypothesis))
        };
        all.iter().filter_map(of).collect()
    }

    /// The name by which a hypothesis stands in the stead of `own`, and the hypothesis with that effect as
    /// its last: of a kind at every joint the one at the same joint, else what was added last.
    fn named_at(&self, own: usize, named: &Named) -> Option<(usize, Hypothesis)> {
        let last = named.names.len().checked_sub(1)?;
        let candidates = self.searcher.candidates;
        let statements = self.searcher.statements(&named.names);
        let added = statements.iter().find(|statement| statement.contains(&last))?;
        let is_here = |&&at: &&usize| candidates[named.names[at]].place == candidates[own].place;
        let at = added.iter().find(is_here).copied().unwrap_or(last);
        let hypothesis = &named.fit.hypothesis;
        let with_it_last = match at == last {
            true => hypothesis.clone(),
            false => hypothesis.without(at).with(hypothesis.effects().swap_remove(at)),
        };
        Some((named.names[at], with_it_last))
    }

    /// The weight, against one for the best hypothesis, of physics that none covers: the larger the errors
    /// and departures that even the best needs, the more.
    fn unlisted(&self, best: &ModalFit) -> f64 {
        let (usual, most) = self.searcher.settings.unlisted;
        let problem = &self.searcher.problem;
        let sizes = match best.is_of_signals() {
            true => self.made_up_for_by_signals(best),
            false => problem.relative_sizes_as_stated(best, STANDING_SHAPE),
        };
        let errors: f64 = sizes.iter().map(|s| 0.5 * (s * s - 1.0).max(0.0)).sum();
        let departures =
            0.5 * (best.largest_departure().powi(2) - self.searcher.settings.adequate.1.powi(2)).max(0.0);
        // What no poles explain in the recording itself is nothing that a name could be held against.
        let unmodelled = 0.5 * self.searcher.problem.recorded.chi2_per_dof.max(1.0).ln();
        // Several effects together imitate much, as among lines.
        let statements = self.searcher.statements(&self.search.best.names).len();
        let company = self.searcher.settings.company * statements.saturating_sub(1) as f64;
        (usual + company + errors + departures + unmodelled).min(most).exp()
    }
}
