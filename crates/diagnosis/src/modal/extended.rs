//! Fits of what a search has, with one effect more or with fewer, and from where other fits ended.

use crate::Hypothesis;
use crate::candidate::Candidate;
use crate::modal::fit::{ANY, ModalFit, SetOut};
use crate::modal::searcher::{Named, STARTS, Searcher};
use crate::modal::starts::{Start, own_frequency};
use std::collections::{BTreeMap, BTreeSet};

/// A hypothesis whose last effect came to the end of its start's reach, with the reach about where it stands;
/// `None` where it did not, or where that lies outside of what the candidate's starts span.
fn farther(hypothesis: &Hypothesis, candidate: &Candidate) -> Option<Hypothesis> {
    let last = hypothesis.effect_count().checked_sub(1)?;
    let own = hypothesis.range_of(last);
    let stopped: Vec<usize> = hypothesis.stopped().into_iter().filter(|at| own.contains(at)).collect();
    let effect = hypothesis.effects().pop()?;
    let spanned = own_frequency(candidate.kind).is_some_and(|place| {
        let starts = || candidate.starts.iter().map(|start| start[place]);
        let (low, high) = (starts().fold(f64::INFINITY, f64::min), starts().fold(0.0, f64::max));
        (low..=high).contains(&effect.value(place))
    });
    let moved = hypothesis.without(last).with(effect);
    let released = stopped.iter().any(|at| !moved.stopped().contains(at));
    (spanned && released).then_some(moved)
}

/// The best fit of each name that was added last, the most probable first.
pub(super) fn best_of_each(mut fits: Vec<Named>) -> Vec<Named> {
    fits.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
    let mut seen = BTreeSet::new();
    fits.retain(|named| named.names.last().is_some_and(|&name| seen.insert(name)));
    fits
}

impl Searcher<'_> {
    /// Fits of `base` with one effect more, the most probable first: the `refined` best candidates, each from
    /// so many starts; and the candidates all of whose starts lie too far below the best of these to be
    /// fitted.
    pub(super) fn extended(&self, base: &Named, refined: usize, each: usize) -> (Vec<Named>, Vec<usize>) {
        if let Some(known) = self.known {
            return (self.fitted(base, self.starts_at(base, known), SetOut::Both), Vec::new());
        }
        let starts = self.starts(base);
        let mut densities: BTreeMap<usize, f64> = BTreeMap::new();
        for start in &starts {
            let own = densities.entry(start.candidate).or_insert(f64::NEG_INFINITY);
            *own = own.max(start.density);
        }
        let mut chosen = self.chosen(starts, refined, each);
        let (first, far) = self.settings.foremost;
        let rest = chosen.split_off(first.min(chosen.len()));
        let is_costly = || self.problem.work.spent() > self.settings.costly;
        let set_out = if is_costly() { SetOut::Usual } else { SetOut::Both };
        let mut fits = self.fitted(base, chosen, set_out);
        // Only what explains the modes shows that others need not be fitted; where fits are cheap they all
        // are, for some may lead the fixture itself out of a false minimum.
        let explains =
            fits.first().filter(|best| self.is_adequate(&best.fit)).map_or(ANY, |best| best.fit.ln);
        let best = if is_costly() { explains } else { ANY };
        let near = rest.into_iter().filter(|start| best - start.density < far).collect();
        fits = self.with_these(base, fits, near, explains);
        let unfitted = |c: &usize| fits.iter().all(|named| named.names.last() != Some(c));
        let below = densities.into_iter().filter(|(_, density)| best - density >= far).map(|(c, _)| c);
        let far = below.filter(unfitted).collect();
        (fits, far)
    }

    /// The best fit of each candidate, these and from starts that follow the foremost: one of each first.
    /// Where something `explains` the modes, with this ln p, only what came near it sets out from elsewhere
    /// too.
    fn with_these(
        &self,
        base: &Named,
        mut fits: Vec<Named>,
        starts: Vec<Start>,
        explains: f64,
    ) -> Vec<Named> {
        let mut seen: BTreeSet<usize> = fits.iter().filter_map(|named| named.names.last().copied()).collect();
        let (first, mut others): (Vec<Start>, Vec<Start>) =
            starts.into_iter().partition(|start| seen.insert(start.candidate) || explains == ANY);
        fits.extend(self.fitted(base, first, SetOut::Usual));
        others.retain(|start| {
            let mut own = fits.iter().filter(|named| named.names.last() == Some(&start.candidate));
            own.all(|named| explains - named.fit.ln < self.settings.exchanged.2)
        });
        fits.extend(self.fitted(base, others, SetOut::Usual));
        best_of_each(fits)
    }

    /// Fits from starts with one effect more than `base`, the best of each candidate, the most probable
    /// first. What lies far below the first of them is not fitted closely.
    fn fitted(&self, base: &Named, starts: Vec<Start>, set_out: SetOut) -> Vec<Named> {
        let tried = self.watch.count(starts.len());
        let fit = |start: Start, least: f64| {
            tried.trying(&self.candidates[start.candidate]);
            self.fitted_from(base, start, set_out, least)
        };
        let mut starts = starts.into_iter();
        let first: Vec<Start> = starts.by_ref().take(1).collect();
        let mut fits = self.problem.work.each(first, STARTS, |start| fit(start, ANY));
        let far = fits.first().map_or(ANY, |first| first.fit.ln - self.settings.foremost.1);
        let least = far.max(self.least_beside(base));
        fits.extend(self.problem.work.each(starts.collect(), STARTS, |start| fit(start, least)));
        best_of_each(fits)
    }

    /// ln p below which no fit with more than `base` matters: what that explains needs nothing that explains
    /// less.
    pub(super) fn least_beside(&self, base: &Named) -> f64 {
        if self.is_adequate(&base.fit) { base.fit.ln } else { ANY }
    }

    /// One fit of a start with one effect more than `base`; `None` where it will not come up to `least`.
    pub(super) fn fitted_from(
        &self,
        base: &Named,
        Start { candidate: c, hypothesis, .. }: Start,
        set_out: SetOut,
        least: f64,
    ) -> Option<Named> {
        let Named { names, mut fit, .. } = self.fitted_with(base, &[c], &hypothesis, (set_out, least))?;
        // The end of a reach is no place to rest, whatever the evidence says that has a parameter less there.
        for _ in 0..self.settings.farther {
            let next = farther(&fit.hypothesis, &self.candidates[c]).and_then(|start| {
                let paired = self.problem.paired_modes(&start)?;
                let priors = self.priors(&start, &names);
                self.problem.fitted_from(&start, paired, &priors, (None, set_out, least))
            });
            let Some(next) = next else { break };
            fit = next;
        }
        // Modes that both recordings show are modes of both: no change loses one.
        let pairs = |fit: &ModalFit| fit.paired.pairing.pairs.len();
        let loses_modes = self.calibrated && pairs(&fit) < pairs(&base.fit);
        (!loses_modes).then(|| Named { names, exact: self.is_exact(&fit), fit })
    }

    /// One fit of `hypothesis`, which is `base` with effects of these names `added`.
    pub(super) fn fitted_with(
        &self,
        base: &Named,
        added: &[usize],
        hypothesis: &Hypothesis,
        (set_out, least): (SetOut, f64),
    ) -> Option<Named> {
        let names: Vec<usize> = base.names.iter().chain(added).copied().collect();
        let paired = self.problem.paired_modes(hypothesis)?;
        let nearby = self.nearby(hypothesis, &paired, &base.fit);
        let priors = self.priors(hypothesis, &names);
        let fit = self.problem.fitted_from(hypothesis, paired, &priors, (nearby, set_out, least))?;
        Some(Named { names, exact: self.is_exact(&fit), fit })
    }

    /// The same without its effects at these places in ascending order, from where it stands and with errors
    /// as large: what gains much at a size of nothing has only led out of a false minimum. What stays below
    /// `least` in ln p is not followed to its rest.
    pub(super) fn without(&self, named: &Named, statement: &[usize], least: f64) -> Option<Named> {
        let mut names = named.names.clone();
        let mut start = named.fit.hypothesis.clone();
        for &index in statement.iter().rev() {
            names.remove(index);
            start = start.without(index);
        }
        let set_out = (None, SetOut::Beside(named.fit.evidence.sizes), least);
        let paired = self.problem.paired_modes(&start)?;
        let fit = self.problem.fitted_from(&start, paired, &self.priors(&start, &names), set_out)?;
        Some(Named { names, exact: self.is_exact(&fit), fit })
    }

    /// Singles with the most probable ones fitted from each other's quantities and sizes of error too: names
    /// are compared where all have set out alike.
    pub(super) fn exchanged(&self, singles: Vec<Named>) -> Vec<Named> {
        let (targets, sources, _) = self.settings.exchanged;
        let sources = singles[..singles.len().min(sources)].to_vec();
        self.fitted_beside(&sources, singles, targets)
    }

    /// Singles with the most probable ones, so many at the most, fitted from the quantities and sizes of
    /// error of these fits too.
    pub(super) fn fitted_beside(&self, sources: &[Named], singles: Vec<Named>, targets: usize) -> Vec<Named> {
        let far = self.settings.exchanged.2;
        let best = singles.first().map_or(0.0, |first| first.fit.ln);
        let close = singles.iter().take(targets).filter(|single| best - single.fit.ln < far);
        let starts: Vec<(&Named, &Named)> = close
            .flat_map(|to| sources.iter().map(move |from| (to, from)))
            .filter(|(to, from)| to.names != from.names && !(to.exact && from.exact))
            .collect();
        let fit = |(to, from): (&Named, &Named)| {
            let start = to.fit.hypothesis.with_tolerances_of(&from.fit.hypothesis);
            let paired = self.problem.paired_modes(&start)?;
            // What comes to no more than is known already is not followed to its rest.
            let set_out = (None, SetOut::Beside(from.fit.evidence.sizes), to.fit.ln);
            let fit = self.problem.fitted_from(&start, paired, &to.fit.priors, set_out)?;
            Some(Named { names: to.names.clone(), exact: self.is_exact(&fit), fit })
        };
        let anew = self.problem.work.each(starts, STARTS, fit);
        best_of_each(singles.into_iter().chain(anew).collect())
    }
}
