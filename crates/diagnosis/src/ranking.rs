//! Every candidate fitted beside what a hypothesis has already, the best first.
//!
//! Two searches lead to a candidate's fit. A small effect is found locally, from where the hypothesis stands:
//! its starts are scored with the quantities at their linear best, and the promising ones refined. A large
//! effect has moved the quantities to where no linear step leads back: the global search fits every candidate
//! from the nominal quantities besides, with inflated noise on thinned lines, and those that come near are
//! refined on all lines.

use crate::candidate::Candidate;
use crate::fit::Fit;
use crate::fitter::{Fitter, Iterate};
use crate::penalty::parameter_penalty;
use crate::scan::Scan;
use crate::{Hypothesis, Linearisation};
use jointscope_fixture::Effect;
use jointscope_inference::{each, each_used_up};
use std::collections::BTreeMap;

/// Where a fit of a candidate sets out.
struct Start {
    candidate: usize,
    hypothesis: Hypothesis,
}

/// A candidate's fit on thinned lines, under way.
struct Thinned {
    candidate: usize,
    iterate: Iterate,
    objective: f64,
}

/// Candidates to be fitted beside a base, and where from.
pub(crate) struct Ranking<'a> {
    pub candidates: &'a [Candidate],
    /// Candidates that are out of the question.
    pub excluded: &'a [usize],
    pub nominal: &'a Hypothesis,
    pub fitter: Fitter<'a>,
}

impl Ranking<'_> {
    /// Fits of `base` with one more effect, best first by objective and penalty of parameters, with the
    /// candidate's index. `global` searches from the nominal quantities too. Candidates that will not come
    /// below `limit` are left unfinished or out.
    pub(crate) fn of(&self, base: &Hypothesis, global: bool, limit: f64) -> Vec<(usize, Fit)> {
        let settings = &self.fitter.settings.ranking;
        let starts = self.starts(base);
        let mut fits = Vec::new();
        let mut limit = limit;
        if global {
            let nominal = base.with_tolerances_of(self.nominal);
            let best =
                |fits: &[(usize, Fit)]| fits.iter().map(|f| f.1.objective).fold(f64::INFINITY, f64::min);
            fits = self.fitted(self.global(&nominal, &starts, 1), None, limit);
            // One start of a candidate may end in a false minimum: where nothing explains the FRFs by itself,
            // several are tried.
            let (much, several) = settings.several;
            if base.effect_count() == 0 && best(&fits) > much * self.fitter.observation.degrees() as f64 {
                fits.extend(self.fitted(self.global(&nominal, &starts, several), None, limit));
            }
            limit = limit.min(best(&fits) + settings.margin);
        }
        let (count, each) = settings.local;
        fits.extend(self.local(base, &starts, count, each, limit));
        self.best_of_each(fits)
    }

    /// The same from where `base` stands alone, of few candidates: where nothing large is left out, linear
    /// steps tell which gain most.
    pub(crate) fn nearby(&self, base: &Hypothesis, limit: f64) -> Vec<(usize, Fit)> {
        let few = self.fitter.settings.ranking.few;
        let Some(scan) = Scan::about(self.fitter, base.clone(), 0.0, true) else { return Vec::new() };
        let chosen = self.hopeful(self.first_order(base, &scan, few, 1), &scan, limit);
        self.best_of_each(self.fitted_beside(base, chosen, &scan, limit))
    }

    /// Every candidate fitted from where `base` stands, which is where an effect that is looked for would
    /// leave the quantities; fits that will not come near `limit` are left unfinished.
    pub(crate) fn look_alikes(&self, base: &Hypothesis, limit: f64) -> Vec<(usize, Fit)> {
        let starts = self.starts(base);
        // The quantities stand right already, but no line leads from nothing to an effect that moves peaks by
        // many widths.
        let mut fits = self.fitted(self.global(base, &starts, 1), None, limit);
        fits.extend(self.local(base, &starts, usize::MAX, 1, limit));
        self.best_of_each(fits)
    }

    /// Every candidate fitted from where `base` stands alone, by the sizes and starts that serve best to
    /// first order; fits that will not come near `limit` are left unfinished or out.
    pub(crate) fn of_each(&self, base: &Hypothesis, limit: f64) -> Vec<(usize, Fit)> {
        self.best_of_each(self.local(base, &self.starts(base), usize::MAX, 1, limit))
    }

    /// What serves better than `limit` in the stead of an effect that `base` has lost: from where it left the
    /// quantities, and with `global` from the nominal ones too.
    pub(crate) fn in_stead(&self, base: &Hypothesis, global: bool, limit: f64) -> Vec<(usize, Fit)> {
        let starts = self.starts(base);
        let mut fits = self.local(base, &starts, self.fitter.settings.ranking.local.0, 1, limit);
        if global {
            let nominal = base.with_tolerances_of(self.nominal);
            fits.extend(self.fitted(self.global(&nominal, &starts, 1), None, limit));
        }
        self.best_of_each(fits)
    }

    /// (candidate, start) of everything that `base` does not have yet.
    fn starts(&self, base: &Hypothesis) -> Vec<(usize, usize)> {
        self.names_without(base)
            .flat_map(|c| (0..self.candidates[c].starts.len()).map(move |s| (c, s)))
            .collect()
    }

    /// Fits of the best candidates from the base itself, each at the size that serves to first order, and at
    /// the best start of its grid.
    fn local(
        &self,
        base: &Hypothesis,
        starts: &[(usize, usize)],
        count: usize,
        each: usize,
        limit: f64,
    ) -> Vec<(usize, Fit)> {
        let Some(scan) = Scan::about(self.fitter, base.clone(), 0.0, true) else { return Vec::new() };
        let objective = scan.objective();
        let mut chosen = self.first_order(base, &scan, count, each);
        let scores = scan.scores(starts, self.candidates);
        let grid = self.best_starts(starts, &scores, 1).into_iter().take(count).flatten();
        chosen.extend(grid.map(|(score, c, effect)| (objective - score, c, effect)));
        let chosen = self.hopeful(chosen, &scan, limit);
        self.fitted_beside(base, chosen, &scan, limit)
    }

    /// Those of the effects, with what each gains at first, that may still come below `limit`.
    fn hopeful(
        &self,
        mut gains: Vec<(f64, usize, Effect)>,
        scan: &Scan,
        limit: f64,
    ) -> Vec<(f64, usize, Effect)> {
        let (objective, promises) = (scan.objective(), self.fitter.settings.fit.limit.promises);
        gains.retain(|(gain, _, _)| objective - promises * gain <= limit);
        gains
    }

    /// Fits of `base` with each of the effects beside it, derivatives of the base being those of the scan.
    fn fitted_beside(
        &self,
        base: &Hypothesis,
        effects: Vec<(f64, usize, Effect)>,
        scan: &Scan,
        limit: f64,
    ) -> Vec<(usize, Fit)> {
        let start =
            |(_, candidate, effect): (f64, usize, Effect)| Start { candidate, hypothesis: base.with(effect) };
        self.fitted(effects.into_iter().map(start).collect(), Some(&scan.linear), limit)
    }

    /// Candidates in question that `base` does not have yet.
    fn names_without(&self, base: &Hypothesis) -> impl Iterator<Item = usize> {
        let effects = base.effects();
        let has = move |c: usize| effects.iter().any(|e| self.candidates[c].names(e));
        (0..self.candidates.len()).filter(move |&c| !self.excluded.contains(&c) && !has(c))
    }

    /// Where the best fits with inflated noise lead, from the base and from where a fit without a candidate
    /// leads.
    fn global(&self, base: &Hypothesis, starts: &[(usize, usize)], each: usize) -> Vec<Start> {
        let settings = &self.fitter.settings.ranking;
        let inflation = self.fitter.settings.fit.inflation.0;
        let observation = self.fitter.thinned();
        let thinned = self.fitter.on(&observation);
        let mut begun: Vec<(usize, Hypothesis)> = Vec::new();
        let mut joining: Vec<(usize, Hypothesis)> = Vec::new();
        // Where an effect moves peaks by many widths no linear step of the quantities is to be trusted.
        if let Some(scan) = Scan::about(thinned, base.clone(), inflation[1], false) {
            let scores = scan.scores(starts, self.candidates);
            let best = self.best_starts(starts, &scores, each).into_iter().flatten();
            begun.extend(best.map(|(_, c, effect)| (c, base.with(effect))));
        }
        // A refit with inflated noise is moved less by what the candidate would explain.
        let refit = thinned.on_thinned_lines(base).map(|fit| fit.hypothesis);
        let scan = refit.clone().and_then(|refit| Scan::about(thinned, refit, settings.scored, true));
        if let Some((refit, scan)) = refit.zip(scan) {
            let scores = scan.scores(starts, self.candidates);
            let best = self.best_starts(starts, &scores, 1).into_iter().flatten();
            let small = self.first_order(base, &scan, usize::MAX, 1);
            joining.extend(best.chain(small).map(|(_, c, effect)| (c, refit.with(effect))));
        }
        let held = Scan::about(thinned, base.clone(), settings.scored, true)
            .map_or(Vec::new(), |scan| scan.insensitive());
        let count = self.fitter.watch.count(begun.len() + joining.len());
        let begin = |(candidate, start): (usize, Hypothesis)| {
            count.trying(&self.candidates[candidate]);
            let iterate = thinned.iterate(start.holding(&held))?;
            Some(Thinned { candidate, iterate, objective: f64::INFINITY })
        };
        let improve = |fit: Thinned, inflation: f64| {
            let (iterate, objective) = thinned.improve_among_many(fit.iterate, inflation)?;
            Some(Thinned { iterate, objective, ..fit })
        };
        let mut fits: Vec<Thinned> = each_used_up(begun, begin).into_iter().flatten().collect();
        for (stage, inflation) in inflation.into_iter().enumerate() {
            if stage == settings.joins {
                fits.extend(each_used_up(std::mem::take(&mut joining), begin).into_iter().flatten());
            }
            let work = self.fitter.observation.work();
            fits = work.each(fits, "effects from afar", |fit| improve(fit, inflation));
            let best = fits.iter().map(|fit| fit.objective).fold(f64::INFINITY, f64::min);
            fits.retain(|fit| fit.objective <= settings.dropped[stage] * best + settings.margin);
        }
        let released = |fit: Thinned| (fit.candidate, fit.objective, fit.iterate.hypothesis.holding(&[]));
        let kept = self.front(fits.into_iter().map(released).collect(), settings.thinned);
        let work = self.fitter.observation.work();
        let fits = work.each(kept, "effects from afar", |(candidate, _, hypothesis)| {
            let fit = self.fitter.on_whole_lines(&hypothesis)?;
            Some((candidate, fit.objective, fit.hypothesis))
        });
        let start = |(candidate, _, hypothesis)| Start { candidate, hypothesis };
        self.front(fits, settings.whole).into_iter().map(start).collect()
    }

    /// The candidates that gain most about a scan's base to first order, each at the size that serves best:
    /// (gain, candidate, effect).
    fn first_order(
        &self,
        base: &Hypothesis,
        scan: &Scan,
        count: usize,
        most_each: usize,
    ) -> Vec<(f64, usize, Effect)> {
        let directions: Vec<(usize, usize)> = self
            .names_without(base)
            .flat_map(|c| (0..self.candidates[c].directions.len()).map(move |d| (c, d)))
            .collect();
        let gains: Vec<(f64, Option<Effect>)> =
            each(&directions, |&(c, d)| scan.first_order(&self.candidates[c], d));
        let gains = directions.iter().zip(gains);
        let mut by_gain: Vec<(f64, usize, Effect)> =
            gains.filter_map(|(&(c, _), (gain, effect))| Some((gain, c, effect?))).collect();
        by_gain.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut taken = vec![0; self.candidates.len()];
        let mut chosen = Vec::new();
        for (gain, candidate, effect) in by_gain {
            let distinct = taken.iter().filter(|t| **t > 0).count();
            if taken[candidate] < most_each && (taken[candidate] > 0 || distinct < count) {
                taken[candidate] += 1;
                chosen.push((gain, candidate, effect));
            }
        }
        chosen
    }

    /// The `each` best starts of every candidate, the best candidates first: (score, candidate, effect).
    fn best_starts(
        &self,
        starts: &[(usize, usize)],
        scores: &[f64],
        each: usize,
    ) -> Vec<Vec<(f64, usize, Effect)>> {
        let mut by_candidate: Vec<Vec<(f64, usize)>> = vec![Vec::new(); self.candidates.len()];
        for (&(c, s), &score) in starts.iter().zip(scores) {
            by_candidate[c].push((score, s));
        }
        by_candidate.iter_mut().for_each(|starts| starts.sort_by(|a, b| a.0.total_cmp(&b.0)));
        let mut order: Vec<usize> =
            (0..by_candidate.len()).filter(|&c| !by_candidate[c].is_empty()).collect();
        order.sort_by(|&a, &b| by_candidate[a][0].0.total_cmp(&by_candidate[b][0].0));
        let effects = |c: usize| {
            by_candidate[c]
                .iter()
                .take(each)
                .map(move |&(score, s)| (score, c, self.candidates[c].effect(s)))
                .collect()
        };
        order.into_iter().map(effects).collect()
    }

    /// Fits from all starts, with derivatives of the base where they set out from it. The first few are
    /// fitted to the end, the others only where they come near them; all of them only where they come below
    /// `limit`.
    fn fitted(&self, starts: Vec<Start>, nearby: Option<&Linearisation>, limit: f64) -> Vec<(usize, Fit)> {
        let settings = &self.fitter.settings.ranking;
        let count = self.fitter.watch.count(starts.len());
        let fit = |start: &Start, limit: f64| {
            count.trying(&self.candidates[start.candidate]);
            self.fitter.local(&start.hypothesis, nearby, limit).map(|fit| (start.candidate, fit))
        };
        let (first, rest) = starts.split_at(settings.unlimited.min(starts.len()));
        let mut fits: Vec<(usize, Fit)> = each(first, |s| fit(s, limit)).into_iter().flatten().collect();
        let best = fits.iter().map(|(_, fit)| fit.objective).fold(f64::INFINITY, f64::min);
        let limit = limit.min(best + settings.margin);
        let work = self.fitter.observation.work();
        fits.extend(
            work.each(rest.iter().collect(), "the less promising effects", |start| fit(start, limit)),
        );
        fits
    }

    fn cost(&self, objective: f64, hypothesis: &Hypothesis) -> f64 {
        objective + parameter_penalty(&self.fitter.settings.selection, hypothesis)
    }

    /// The best fit of each candidate, best first.
    fn best_of_each(&self, mut fits: Vec<(usize, Fit)>) -> Vec<(usize, Fit)> {
        let cost = |fit: &Fit| self.cost(fit.objective, &fit.hypothesis);
        fits.sort_by(|a, b| cost(&a.1).total_cmp(&cost(&b.1)));
        let mut seen = vec![false; self.candidates.len()];
        fits.retain(|(index, _)| !std::mem::replace(&mut seen[*index], true));
        fits
    }

    /// Of fits with inflated noise (candidate, objective, hypothesis) those that come near the best: one of
    /// each of at most `count` candidates, two of the best `twice`.
    fn front(
        &self,
        mut fits: Vec<(usize, f64, Hypothesis)>,
        (count, twice): (usize, usize),
    ) -> Vec<(usize, f64, Hypothesis)> {
        let settings = &self.fitter.settings.ranking;
        fits.sort_by(|a, b| self.cost(a.1, &a.2).total_cmp(&self.cost(b.1, &b.2)));
        let last = settings.dropped[settings.dropped.len() - 1];
        let limit = fits.first().map_or(f64::INFINITY, |best| last * best.1 + settings.margin);
        let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
        fits.retain(|(candidate, objective, _)| {
            let own = taken.get(candidate).copied().unwrap_or(0);
            let keep = *objective <= limit
                && own < if taken.len() <= twice { 2 } else { 1 }
                && (own > 0 || taken.len() < count);
            if keep {
                taken.insert(*candidate, own + 1);
            }
            keep
        });
        fits
    }
}
