//! One law after the other, while what is left is much and the next one is worth it.

use super::fit::Fit;
use super::hypothesis::Hypothesis;
use super::judge::Step;
use super::misfit::View;
use super::needed::needed;
use super::search::{Search, Span};
use crate::settings::search::{LEAST_GAIN, SEEK_MORE, SEEK_MORE_ERROR, WORTH};
use jointscope_fixture::Fixture;

/// The laws found so far.
pub(super) struct Laws<'s, 'a> {
    search: &'s Search<'a>,
    fixture: &'s Fixture,
    /// The best fit with them.
    pub best: Fit,
    /// Each of them, as it was added.
    pub steps: Vec<Step>,
    /// How much of the records decided on them.
    pub span: Span,
    /// What was compared last.
    whole: View<'a>,
}

impl<'s, 'a> Laws<'s, 'a> {
    /// Searches beside the fixture as stated and as refitted, and keeps those that the hits need; `None` for a
    /// fixture without a finite motion.
    pub(super) fn found(
        search: &'s Search<'a>,
        fixture: &'s Fixture,
        nominal: &Hypothesis,
        refitted: &Fit,
    ) -> Option<Self> {
        let span = Span::default();
        let whole = search.view(&span);
        let mut laws = Laws { search, fixture, best: refitted.clone(), steps: Vec::new(), span, whole };
        for worth in WORTH {
            if !laws.steps.is_empty() && laws.leave_little() || !laws.add_one(nominal, worth)? {
                break;
            }
        }
        (laws.best, laws.steps) = needed(&search.view(&laws.span), laws.best, laws.steps)?;
        Some(laws)
    }

    fn leave_little(&self) -> bool {
        self.best.chi2 / self.whole.degrees() < SEEK_MORE
            || self.whole.nrmse(&self.best.hypothesis).is_none_or(|e| e < SEEK_MORE_ERROR)
    }

    /// Whether one more was found that explains the share `worth` of what is left. From quantities that hold
    /// what is left out the first may not be seen, from the stated ones not where these are wrong.
    fn add_one(&mut self, nominal: &Hypothesis, worth: f64) -> Option<bool> {
        let fitted = self.best.hypothesis.clone();
        if !self.steps.is_empty() {
            return self.add_one_beside(&fitted, worth);
        }
        let is_found = self.add_one_beside(nominal, worth)?;
        Some(is_found || fitted.has_departed() && self.add_one_beside(&fitted, worth)?)
    }

    /// The same from the quantities and laws of `base`.
    fn add_one_beside(&mut self, base: &Hypothesis, worth: f64) -> Option<bool> {
        let model = base.to_fixture().unwrap_or_else(|_| self.fixture.clone());
        let (fits, followed) = self.search.hypotheses(&model, base);
        if fits.is_empty() {
            return Some(false);
        }
        // What is not followed counts for neither.
        self.whole = self.search.view(&followed);
        let mut before = Fit::of(&self.whole, &self.best.hypothesis, 1)?;
        let (fits, freed) = self.search.acting(&self.whole, fits);
        if let Some(freed) = freed.filter(|freed| freed.objective < before.objective) {
            if let Some(step) = self.steps.last_mut() {
                step.gain += before.objective - freed.objective;
                step.fits.iter_mut().take(1).for_each(|fit| *fit = freed.clone());
            }
            self.best = freed.clone();
            before = freed;
        }
        let excess = |fit: &Fit| (fit.objective - self.whole.degrees()).max(0.0);
        let is_worth_it = |first: &&Fit| {
            excess(first) <= (1.0 - worth) * excess(&before)
                && first.objective + LEAST_GAIN <= before.objective
        };
        let Some(first) = fits.first().filter(is_worth_it).cloned() else { return Some(false) };
        self.steps.push(Step { gain: before.objective - first.objective, fits });
        (self.best, self.span) = (first, followed);
        Some(true)
    }
}
