//! Every candidate fitted beside what a hypothesis has already, the best first.
//!
//! Two ways lead to a candidate's fit. A small effect is found from where the hypothesis stands: its starts are scored with the tolerances at
//! their linear best, and the promising ones refined. A large effect has bent the tolerances where no linear step leads back: every candidate
//! is fitted from the nominal quantities besides, with softened weights on thinned lines, and those that come near are refined on all lines.

use crate::catalogue::Candidate;
use crate::fit::{COARSE, COARSE_LINES, Fit, Linearisation};
use crate::normal::{dot, whitened};
use crate::search::parameter_price;
use crate::under_way::{PROMISE, Softening};
use crate::{Hypothesis, Observation};
use jointscope_fixture::Effect;
use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Candidates of the near way that are refined, and starts of each.
const NEAR: usize = 12;
const NEAR_STARTS: usize = 2;
/// Candidates of the far way that are kept after the coarse fits, and after those on all lines; those of them that are kept from two
/// starts.
const HALF: usize = 16;
const HALF_TWICE: usize = 6;
const FAR: usize = 10;
const FAR_TWICE: usize = 3;
/// Softened fits that leave this many times what the best one leaves are not followed, after each stage of [`COARSE`]: one in a false minimum
/// may still win, the likelier the softer the stage.
const SOFT: [f64; COARSE.len()] = [12.0, 10.0, 4.0, 3.0];
/// The stage at which starts join that a coarse fit of something similar has led to.
const LED: usize = 2;
/// χ² per degree of freedom above which the best single effect leaves too much, and starts of each candidate that are then tried.
const UNEXPLAINED: f64 = 1.3;
const SEVERAL: usize = 3;
/// Softened χ² of one deviation below which a quantity stays where it is in a coarse fit.
const UNFELT: f64 = 8.0;
/// Fits made without a limit before the others are measured against the best of them.
const UNLIMITED: usize = 4;
/// A fit whose objective will stay this far above the best is not finished.
const MARGIN: f64 = 60.0;

/// Where a fit of a candidate sets out.
struct Start {
    candidate: usize,
    hypothesis: Hypothesis,
}

/// A candidate's coarse fit under way.
struct Coarse {
    candidate: usize,
    fit: Softening,
    objective: f64,
}

/// Candidates to be fitted beside a base, and where from.
pub(crate) struct Ranking<'a> {
    pub candidates: &'a [Candidate],
    pub nominal: &'a Hypothesis,
    pub observation: &'a Observation,
}

impl Ranking<'_> {
    /// Fits of `base` with one more effect, best first by objective and price of parameters, with the candidate's index. `far` takes
    /// the way from the nominal quantities too. Candidates that will not come below `limit` are left unfinished or out.
    pub fn of(&self, base: &Hypothesis, far: bool, limit: f64) -> Vec<(usize, Fit)> {
        let starts = self.starts(base);
        let mut fits = Vec::new();
        let mut limit = limit;
        if far {
            let nominal = base.with_tolerances_of(self.nominal);
            let best =
                |fits: &[(usize, Fit)]| fits.iter().map(|f| f.1.objective).fold(f64::INFINITY, f64::min);
            fits = self.fitted(self.far(&nominal, &starts, 1), None, limit);
            // One start of a candidate may end in a false minimum: where nothing explains the FRFs by itself, several are tried.
            if base.effect_count() == 0 && best(&fits) > UNEXPLAINED * self.observation.degrees() as f64 {
                fits.extend(self.fitted(self.far(&nominal, &starts, SEVERAL), None, limit));
            }
            limit = limit.min(best(&fits) + MARGIN);
        }
        fits.extend(self.near(base, &starts, NEAR, NEAR_STARTS, limit));
        self.best_of_each(fits)
    }

    /// Every candidate fitted from where `base` stands, which is where an effect that is looked for would leave the quantities; fits that
    /// will not come near `limit` are left unfinished.
    pub fn look_alikes(&self, base: &Hypothesis, limit: f64) -> Vec<(usize, Fit)> {
        let starts = self.starts(base);
        // The quantities stand right already, but no line leads from nothing to an effect that moves peaks by many widths.
        let mut fits = self.fitted(self.far(base, &starts, 1), None, limit);
        fits.extend(self.near(base, &starts, usize::MAX, 1, limit));
        self.best_of_each(fits)
    }

    /// What serves better than `limit` in the stead of an effect that `base` has lost: from where it left the quantities, and with `far`
    /// by the way from the nominal ones.
    pub fn in_stead(&self, base: &Hypothesis, far: bool, limit: f64) -> Vec<(usize, Fit)> {
        let starts = self.starts(base);
        let mut fits = self.near(base, &starts, NEAR, 1, limit);
        if far {
            fits.extend(self.fitted(
                self.far(&base.with_tolerances_of(self.nominal), &starts, 1),
                None,
                limit,
            ));
        }
        self.best_of_each(fits)
    }

    /// (candidate, start) of everything that `base` does not have yet.
    fn starts(&self, base: &Hypothesis) -> Vec<(usize, usize)> {
        self.names_without(base)
            .flat_map(|c| (0..self.candidates[c].starts.len()).map(move |s| (c, s)))
            .collect()
    }

    /// Fits of the best candidates from the base itself, each at the size that serves to first order, and at the best start of its grid.
    fn near(
        &self,
        base: &Hypothesis,
        starts: &[(usize, usize)],
        count: usize,
        each: usize,
        limit: f64,
    ) -> Vec<(usize, Fit)> {
        let Some(scan) = Scan::about(base.clone(), self.observation, 0.0, true) else { return Vec::new() };
        let objective = scan.objective();
        let hopeful = |gain: f64| objective - PROMISE * gain <= limit;
        let mut chosen = self.first_order(base, &scan, count, each, self.observation);
        chosen.retain(|(gain, _, _)| hopeful(*gain));
        let scores = scan.scores(starts, self.candidates, self.observation);
        let grid = self.best_starts(starts, &scores, 1).into_iter().take(count).flatten();
        chosen.extend(grid.map(|(score, c, effect)| (objective - score, c, effect)).filter(|g| hopeful(g.0)));
        let start =
            |(_, candidate, effect): (f64, usize, Effect)| Start { candidate, hypothesis: base.with(effect) };
        self.fitted(chosen.into_iter().map(start).collect(), Some(&scan.linear), limit)
    }

    /// Candidates that `base` does not have yet.
    fn names_without(&self, base: &Hypothesis) -> impl Iterator<Item = usize> {
        let effects = base.effects();
        (0..self.candidates.len()).filter(move |&c| !effects.iter().any(|e| self.candidates[c].names(e)))
    }

    /// The best softened fits from where the base stands and from where a softened fit leads without a candidate.
    fn far(&self, base: &Hypothesis, starts: &[(usize, usize)], each: usize) -> Vec<Start> {
        let coarse = self.observation.thinned(COARSE_LINES);
        let mut begun: Vec<(usize, Hypothesis)> = Vec::new();
        let mut led_to: Vec<(usize, Hypothesis)> = Vec::new();
        // Where an effect moves peaks by many widths no linear step of the tolerances is to be trusted.
        if let Some(scan) = Scan::about(base.clone(), &coarse, 0.3, false) {
            let scores = scan.scores(starts, self.candidates, &coarse);
            let best = self.best_starts(starts, &scores, each).into_iter().flatten();
            begun.extend(best.map(|(_, c, effect)| (c, base.with(effect))));
        }
        // A softened refit is bent less by what the candidate would explain.
        let led = Fit::coarse(base, &coarse).map(|fit| fit.hypothesis);
        if let Some((led, scan)) =
            led.and_then(|led| Some((led.clone(), Scan::about(led, &coarse, 0.1, true)?)))
        {
            let scores = scan.scores(starts, self.candidates, &coarse);
            let best = self.best_starts(starts, &scores, 1).into_iter().flatten();
            let small = self.first_order(base, &scan, usize::MAX, 1, &coarse);
            led_to.extend(best.chain(small).map(|(_, c, effect)| (c, led.with(effect))));
        }
        let stiff = Scan::about(base.clone(), &coarse, 0.1, true).map_or(Vec::new(), |scan| scan.unfelt());
        let begin = |(candidate, start): (usize, Hypothesis)| {
            let fit = Softening::begin(start.holding(&stiff), &coarse)?;
            Some(Coarse { candidate, fit, objective: f64::INFINITY })
        };
        let mut fits: Vec<Coarse> = begun.into_par_iter().filter_map(begin).collect();
        for (stage, share) in COARSE.into_iter().enumerate() {
            if stage == LED {
                fits.par_extend(std::mem::take(&mut led_to).into_par_iter().filter_map(begin));
            }
            fits.par_iter_mut().for_each(|coarse_fit| {
                coarse_fit.objective = coarse_fit.fit.stage(&coarse, share);
            });
            let best = fits.iter().map(|fit| fit.objective).fold(f64::INFINITY, f64::min);
            fits.retain(|fit| fit.objective <= SOFT[stage] * best + MARGIN);
        }
        let led_by = |fit: Coarse| (fit.candidate, fit.objective, fit.fit.hypothesis().holding(&[]));
        let kept = front(fits.into_iter().map(led_by).collect(), HALF, HALF_TWICE);
        let fits = kept.into_par_iter().filter_map(|(candidate, _, hypothesis)| {
            let fit = Fit::middle(&hypothesis, self.observation)?;
            Some((candidate, fit.objective, fit.hypothesis))
        });
        let start = |(candidate, _, hypothesis)| Start { candidate, hypothesis };
        front(fits.collect(), FAR, FAR_TWICE).into_iter().map(start).collect()
    }

    /// The candidates that gain most about a scan's base to first order, each at the size that serves best: (gain, candidate, effect).
    fn first_order(
        &self,
        base: &Hypothesis,
        scan: &Scan,
        count: usize,
        each: usize,
        observation: &Observation,
    ) -> Vec<(f64, usize, Effect)> {
        let directions: Vec<(usize, usize)> = self
            .names_without(base)
            .flat_map(|c| (0..self.candidates[c].directions.len()).map(move |d| (c, d)))
            .collect();
        let gains: Vec<(f64, Option<Effect>)> = directions
            .par_iter()
            .map(|&(c, d)| scan.first_order(&self.candidates[c], d, observation))
            .collect();
        let gains = directions.iter().zip(gains);
        let mut by_gain: Vec<(f64, usize, Effect)> =
            gains.filter_map(|(&(c, _), (gain, effect))| Some((gain, c, effect?))).collect();
        by_gain.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut taken = vec![0; self.candidates.len()];
        let mut chosen = Vec::new();
        for (gain, candidate, effect) in by_gain {
            let distinct = taken.iter().filter(|t| **t > 0).count();
            if taken[candidate] < each && (taken[candidate] > 0 || distinct < count) {
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

    /// Fits from all starts, with derivatives of the base where they set out from it. The first few are fitted to the end, the others only
    /// where they come near them; all of them only where they come below `limit`.
    fn fitted(&self, starts: Vec<Start>, nearby: Option<&Linearisation>, limit: f64) -> Vec<(usize, Fit)> {
        let fit = |start: &Start, limit: f64| {
            let fit = Fit::refined_with(&start.hypothesis, nearby, self.observation, limit);
            fit.map(|fit| (start.candidate, fit))
        };
        let (first, rest) = starts.split_at(UNLIMITED.min(starts.len()));
        let mut fits: Vec<(usize, Fit)> = first.par_iter().filter_map(|s| fit(s, limit)).collect();
        let best = fits.iter().map(|(_, fit)| fit.objective).fold(f64::INFINITY, f64::min);
        let limit = limit.min(best + MARGIN);
        fits.extend(rest.par_iter().filter_map(|s| fit(s, limit)).collect::<Vec<_>>());
        fits
    }

    /// The best fit of each candidate, best first.
    fn best_of_each(&self, mut fits: Vec<(usize, Fit)>) -> Vec<(usize, Fit)> {
        fits.sort_by(|a, b| cost(&a.1).total_cmp(&cost(&b.1)));
        let mut seen = vec![false; self.candidates.len()];
        fits.retain(|(index, _)| !std::mem::replace(&mut seen[*index], true));
        fits
    }
}

/// Of softened fits (candidate, objective, where it stands) those that come near the best: one of each of at most `count` candidates, two of the
/// best `twice`.
fn front(
    mut fits: Vec<(usize, f64, Hypothesis)>,
    count: usize,
    twice: usize,
) -> Vec<(usize, f64, Hypothesis)> {
    let cost = |fit: &(usize, f64, Hypothesis)| fit.1 + parameter_price(&fit.2);
    fits.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    let limit = fits.first().map_or(f64::INFINITY, |best| SOFT[COARSE.len() - 1] * best.1 + MARGIN);
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

fn cost(fit: &Fit) -> f64 {
    fit.objective + parameter_price(&fit.hypothesis)
}

/// A base about which effects are tried with the tolerances linearised, or held where they are.
struct Scan {
    base: Hypothesis,
    linear: Linearisation,
    /// √w·derivative by coordinate.
    columns: Vec<Vec<f64>>,
    weights: Vec<f64>,
    matrix: Vec<f64>,
    predicted: Vec<Complex64>,
    /// What the base leaves, √w·residual, and what the tolerances make of it.
    residual: Vec<f64>,
    step: Vec<f64>,
}

impl Scan {
    fn about(base: Hypothesis, observation: &Observation, epsilon: f64, yielding: bool) -> Option<Self> {
        let predicted = base.predict(observation).ok()?;
        let weights = observation.softened_weights(&predicted, epsilon);
        let linear = if yielding { Linearisation::of(&base, observation) } else { Linearisation::rigid() };
        let residual = observation.residual(&predicted);
        let (matrix, pull) = linear.normal(&base, &weights, &residual);
        let columns = linear.derivatives.iter().map(|d| whitened(d, &weights)).collect();
        let (mut factors, mut step) = (matrix.clone(), pull);
        if !solve_positive_definite(&mut factors, &mut step) {
            step.fill(0.0);
        }
        let residual = whitened(&residual, &weights);
        Some(Scan { base, linear, columns, weights, matrix, predicted, residual, step })
    }

    /// Coordinates of the fixture's quantities that a deviation moves by less than the softened FRFs can tell.
    fn unfelt(&self) -> Vec<usize> {
        let felt = |m: &usize| dot(&self.columns[*m], &self.columns[*m]) < UNFELT * self.base.prior(*m);
        (0..self.base.tolerances().len()).filter(felt).collect()
    }

    /// What the base leaves.
    fn objective(&self) -> f64 {
        dot(&self.residual, &self.residual) + self.base.penalty()
    }

    /// What direction `index` of a candidate gains at its best size, to first order with the tolerances yielding, and the effect
    /// of that size.
    fn first_order(
        &self,
        candidate: &Candidate,
        index: usize,
        observation: &Observation,
    ) -> (f64, Option<Effect>) {
        let nothing = (0.0, None);
        let Some(small) = candidate.scaled(index, 1.0) else { return nothing };
        let Ok(moved) = self.base.with(small).predict(observation) else { return nothing };
        let change: Vec<Complex64> = moved.iter().zip(&self.predicted).map(|(m, p)| m - p).collect();
        let change = whitened(&change, &self.weights);
        let shared: Vec<f64> = self.columns.iter().map(|column| dot(column, &change)).collect();
        let (mut matrix, mut absorbed) = (self.matrix.clone(), shared.clone());
        if !solve_positive_definite(&mut matrix, &mut absorbed) {
            return nothing;
        }
        let own = dot(&change, &change);
        let left = own - dot(&shared, &absorbed);
        // What the tolerances can imitate to nine digits is not to be told from them.
        if left <= 1e-9 * own {
            return nothing;
        }
        let slope = dot(&change, &self.residual) - dot(&shared, &self.step);
        (slope * slope / left, candidate.scaled(index, slope / left))
    }

    /// The score of each start.
    fn scores(
        &self,
        starts: &[(usize, usize)],
        candidates: &[Candidate],
        observation: &Observation,
    ) -> Vec<f64> {
        starts.par_iter().map(|&(c, s)| self.score(candidates[c].effect(s), observation)).collect()
    }

    /// The objective with `effect` added and everything else at its linear best.
    fn score(&self, effect: Effect, observation: &Observation) -> f64 {
        let Ok(predicted) = self.base.with(effect).predict(observation) else { return f64::INFINITY };
        let residual = whitened(&observation.residual(&predicted), &self.weights);
        let misfit = dot(&residual, &residual);
        let pull = |m: usize| self.base.prior(m) * self.base.coordinates[m];
        let right: Vec<f64> =
            self.columns.iter().enumerate().map(|(m, column)| dot(column, &residual) - pull(m)).collect();
        let (mut matrix, mut step) = (self.matrix.clone(), right.clone());
        if !solve_positive_definite(&mut matrix, &mut step) {
            return misfit;
        }
        misfit + self.base.penalty() - dot(&step, &right)
    }
}
