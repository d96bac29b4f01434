//! Which effects a recording needs: forward selection with exchange, every candidate fitted with the tolerances.

use crate::catalogue::{Candidate, catalogue};
use crate::fit::{Fit, Linearisation};
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Effect, EffectKind, Fixture};
use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;
use rayon::prelude::*;

/// Candidates fitted in full after the scan.
const SHORTLIST: usize = 12;
/// Candidates in front of the list that are fitted from several starts, and how many.
const FRONT: usize = 6;
const STARTS: usize = 4;
/// Rounds of adding and dropping, at the most.
const ROUNDS: usize = 5;
/// Effects at the most.
const MOST_EFFECTS: usize = 3;

/// What an effect must gain in χ² to be believed, given the price of its parameters. A search over `names` candidates at several starts each gains
/// 2 ln(names) more by its best one: the price of looking.
pub(crate) fn price(parameters: f64, names: usize) -> f64 {
    8.0 + parameters + 2.0 * (names as f64).ln()
}

/// What the effects of a hypothesis cost in χ² when names are compared: every parameter gains something by chance, and one
/// that is searched over a range (a frequency, a time) has as many chances as the range has resolvable values.
pub(crate) fn parameter_price(hypothesis: &Hypothesis) -> f64 {
    let searched = |effect: &Effect| match effect.kind {
        EffectKind::AttachedResonator => 8.0,
        EffectKind::BodyFlexibility | EffectKind::Relaxation => 3.0,
        _ => 0.0,
    };
    3.0 * hypothesis.effect_parameters() as f64 + hypothesis.effects().iter().map(searched).sum::<f64>()
}

/// The outcome of a search.
#[derive(Debug, Clone)]
pub struct Search {
    /// The fixture as it stands.
    pub nominal: Fit,
    /// The fixture refitted within its tolerances.
    pub refitted: Fit,
    /// With the effects that were found.
    pub repaired: Fit,
    /// All names that were tried.
    pub candidates: Vec<Candidate>,
}

impl Search {
    /// Searches for effects. `None` where the fixture predicts no finite FRFs.
    pub fn of(fixture: &Fixture, observation: &Observation, exact: bool) -> Option<Self> {
        let start = Hypothesis::nominal(fixture, exact);
        let predicted = start.predict(observation).ok()?;
        let chi2 = observation.chi2(&predicted);
        let nominal = Fit { hypothesis: start.clone(), predicted, chi2, objective: chi2 };
        let refitted = best([Fit::of(&start, observation, true), Fit::of(&start, observation, false)])?;
        let candidates = catalogue(fixture, observation);
        let mut search = Search { nominal, repaired: refitted.clone(), refitted, candidates };
        for _ in 0..ROUNDS {
            if search.repaired.hypothesis.effect_count() >= MOST_EFFECTS {
                break;
            }
            let Some(better) = search.extended(observation) else { break };
            search.repaired = better;
            search.exchange(observation);
            search.prune(observation);
        }
        Some(search)
    }

    /// The scale of χ² that the best fit leaves: above one, gains count for less.
    fn scale(&self, fit: &Fit, observation: &Observation) -> f64 {
        fit.chi2_per_dof(observation).max(1.0)
    }

    /// Whether `with` is worth its parameters over `without`.
    fn is_worth(&self, with: &Fit, without: &Fit, observation: &Observation) -> bool {
        let parameters = parameter_price(&with.hypothesis) - parameter_price(&without.hypothesis);
        let gain = (without.objective - with.objective) / self.scale(with, observation);
        gain > price(parameters, self.candidates.len())
    }

    /// The present fit with the one more effect that helps most, if it is worth it.
    fn extended(&self, observation: &Observation) -> Option<Fit> {
        let best = self.ranked(&self.repaired, observation).into_iter().next()?.1;
        self.is_worth(&best, &self.repaired, observation).then_some(best)
    }

    /// Fits of `base` with one more effect, best first (by objective and price of parameters), with the
    /// candidate's index.
    pub fn ranked(&self, base: &Fit, observation: &Observation) -> Vec<(usize, Fit)> {
        let far = base.hypothesis.with_tolerances_of(&self.nominal.hypothesis);
        let scans = [
            Scan::about(base.hypothesis.clone(), observation, 0.0, true).map(|scan| (scan, false)),
            Scan::about(far.clone(), observation, 0.1, true).map(|scan| (scan, true)),
        ];
        let mut shortlist = self.shortlist(base, scans.into_iter().flatten(), observation);
        // Where an effect moves peaks by many widths no scan is to be trusted: everybody gets one fit from afar.
        if let Some(scan) = Scan::about(far, observation, 0.3, false) {
            let starts = self.starts(base);
            for (c, effect) in self.everybody(&starts, &scan.scores(&starts, &self.candidates, observation)) {
                if !shortlist.iter().any(|(other, _, from_nominal)| *other == c && *from_nominal) {
                    shortlist.push((c, effect, true));
                }
            }
        }
        self.fitted(base, shortlist, observation)
    }

    /// As [`Search::ranked`], for a `base` whose quantities stand already where the effect that is looked for would leave
    /// them: names that do what it did are found there, whatever the fixture alone looks like.
    pub fn look_alikes(&self, base: &Fit, observation: &Observation) -> Vec<(usize, Fit)> {
        let scan = Scan::about(base.hypothesis.clone(), observation, 0.03, false).map(|scan| (scan, false));
        self.fitted(base, self.shortlist(base, scan.into_iter(), observation), observation)
    }

    fn fitted(
        &self,
        base: &Fit,
        shortlist: Vec<(usize, Effect, bool)>,
        observation: &Observation,
    ) -> Vec<(usize, Fit)> {
        let fits = shortlist.par_iter().filter_map(|(index, effect, from_nominal)| {
            let hypothesis = base.hypothesis.with(effect.clone());
            let fit = if *from_nominal {
                Fit::of(&hypothesis.with_tolerances_of(&self.nominal.hypothesis), observation, true)
            } else {
                Fit::of(&hypothesis, observation, false)
            };
            fit.map(|fit| (*index, fit))
        });
        let mut fits: Vec<(usize, Fit)> = fits.collect();
        let cost = |fit: &Fit| fit.objective + parameter_price(&fit.hypothesis);
        fits.sort_by(|a, b| cost(&a.1).total_cmp(&cost(&b.1)));
        let mut seen = vec![false; self.candidates.len()];
        fits.retain(|(index, _)| !std::mem::replace(&mut seen[*index], true));
        fits
    }

    /// (candidate, the effect to start from, whether to set out from the nominal quantities) of the most promising
    /// starts of each scan.
    fn shortlist(
        &self,
        base: &Fit,
        scans: impl Iterator<Item = (Scan, bool)>,
        observation: &Observation,
    ) -> Vec<(usize, Effect, bool)> {
        let starts = self.starts(base);
        let mut chosen: Vec<(usize, Effect, bool)> = Vec::new();
        for (scan, from_nominal) in scans {
            let scores = scan.scores(&starts, &self.candidates, observation);
            chosen.extend(
                self.promising(&scan, &starts, &scores, observation)
                    .into_iter()
                    .map(|(c, effect)| (c, effect, from_nominal)),
            );
        }
        chosen
    }

    /// (candidate, start) of everything that `base` does not have yet.
    fn starts(&self, base: &Fit) -> Vec<(usize, usize)> {
        let effects = base.hypothesis.effects();
        (0..self.candidates.len())
            .filter(|&c| !effects.iter().any(|e| self.candidates[c].names(e)))
            .flat_map(|c| (0..self.candidates[c].starts.len()).map(move |s| (c, s)))
            .collect()
    }

    /// The best start of every candidate.
    fn everybody(&self, starts: &[(usize, usize)], scores: &[f64]) -> Vec<(usize, Effect)> {
        let mut best: Vec<Option<(f64, usize)>> = vec![None; self.candidates.len()];
        for (&(c, s), &score) in starts.iter().zip(scores) {
            if best[c].is_none_or(|(lowest, _)| score < lowest) {
                best[c] = Some((score, s));
            }
        }
        let effect =
            |(c, best): (usize, Option<(f64, usize)>)| best.map(|(_, s)| (c, self.candidates[c].effect(s)));
        best.into_iter().enumerate().filter_map(effect).collect()
    }

    /// The best starts of the best candidates of a scan, polished: several for those in front, whose fits may end in
    /// different minima, one for those behind.
    fn promising(
        &self,
        scan: &Scan,
        starts: &[(usize, usize)],
        scores: &[f64],
        observation: &Observation,
    ) -> Vec<(usize, Effect)> {
        let mut by_candidate: Vec<Vec<(f64, usize)>> = vec![Vec::new(); self.candidates.len()];
        for (&(c, s), &score) in starts.iter().zip(scores) {
            by_candidate[c].push((score, s));
        }
        let mut order: Vec<usize> =
            (0..by_candidate.len()).filter(|&c| !by_candidate[c].is_empty()).collect();
        by_candidate.iter_mut().for_each(|starts| starts.sort_by(|a, b| a.0.total_cmp(&b.0)));
        order.sort_by(|&a, &b| by_candidate[a][0].0.total_cmp(&by_candidate[b][0].0));
        let mut tried: Vec<(usize, f64, Effect)> = Vec::new();
        for &c in order.iter().take(2 * SHORTLIST) {
            let several = by_candidate[c].iter().take(STARTS);
            tried.extend(several.map(|&(score, s)| (c, score, self.candidates[c].effect(s))));
        }
        let mut polished: Vec<(usize, f64, Effect)> = tried
            .into_par_iter()
            .map(|(c, score, effect)| {
                let (score, effect) = scan.refined(effect, score, observation);
                (c, score, effect)
            })
            .collect();
        polished.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut taken = vec![0; self.candidates.len()];
        let mut chosen = Vec::new();
        for (c, _, effect) in polished {
            let distinct = taken.iter().filter(|t| **t > 0).count();
            let allowed = if distinct <= FRONT { STARTS } else { 1 };
            if taken[c] < allowed && (taken[c] > 0 || distinct < SHORTLIST) {
                taken[c] += 1;
                chosen.push((c, effect));
            }
        }
        chosen
    }

    /// Replaces each effect by whatever serves better in the company of the others, until nothing does.
    fn exchange(&mut self, observation: &Observation) {
        if self.repaired.hypothesis.effect_count() < 2 {
            return;
        }
        for _ in 0..2 {
            let mut changed = false;
            for index in 0..self.repaired.hypothesis.effect_count() {
                let Some(without) = Fit::of(&self.repaired.hypothesis.without(index), observation, false)
                else {
                    continue;
                };
                let Some((_, other)) = self.ranked(&without, observation).into_iter().next() else {
                    continue;
                };
                let parameters = |fit: &Fit| parameter_price(&fit.hypothesis);
                if other.objective + parameters(&other) + 1.0
                    < self.repaired.objective + parameters(&self.repaired)
                {
                    (self.repaired, changed) = (other, true);
                }
            }
            if !changed {
                return;
            }
        }
    }

    /// Drops effects that no longer earn their place, the last one included: from the quantities that the effect led to, the
    /// fixture alone may do as well, where its own refit had ended in a false minimum.
    fn prune(&mut self, observation: &Observation) {
        let mut index = 0;
        while index < self.repaired.hypothesis.effect_count() {
            let without = self.repaired.hypothesis.without(index);
            let Some(fewer) = best([false, true].map(|far| Fit::of(&without, observation, far))) else {
                index += 1;
                continue;
            };
            if without.effect_count() == 0 && fewer.objective < self.refitted.objective {
                self.refitted = fewer.clone();
            }
            if self.is_worth(&self.repaired, &fewer, observation) {
                index += 1;
            } else {
                (self.repaired, index) = (fewer, 0);
            }
        }
    }
}

fn best(fits: [Option<Fit>; 2]) -> Option<Fit> {
    fits.into_iter().flatten().min_by(|a, b| a.objective.total_cmp(&b.objective))
}

/// A base about which effects are tried with the tolerances linearised, or held where they are.
struct Scan {
    base: Hypothesis,
    linear: Linearisation,
    weights: Vec<f64>,
    matrix: Vec<f64>,
}

impl Scan {
    fn about(base: Hypothesis, observation: &Observation, epsilon: f64, yielding: bool) -> Option<Self> {
        let predicted = base.predict(observation).ok()?;
        let weights: Vec<f64> =
            predicted.iter().enumerate().map(|(i, p)| observation.softened(i, *p, epsilon)).collect();
        let linear = if yielding { Linearisation::of(&base, observation) } else { Linearisation::rigid() };
        let zero = vec![Complex64::ZERO; predicted.len()];
        let (matrix, _) = linear.normal(&base, &weights, &zero);
        Some(Scan { base, linear, weights, matrix })
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
        let with = self.base.with(effect);
        let Ok(predicted) = with.predict(observation) else { return f64::INFINITY };
        let residual: Vec<Complex64> =
            observation.values().iter().zip(&predicted).map(|(m, p)| m - p).collect();
        let misfit: f64 = residual.iter().zip(&self.weights).map(|(r, w)| w * r.norm_sqr()).sum();
        let n = self.linear.derivatives.len();
        let right: Vec<f64> = (0..n)
            .map(|m| {
                let slope = self.linear.derivatives[m].iter().zip(&residual).zip(&self.weights);
                slope.map(|((d, r), w)| w * (d.re * r.re + d.im * r.im)).sum::<f64>()
                    - self.base.prior(m) * self.base.coordinates[m]
            })
            .collect();
        let (mut matrix, mut step) = (self.matrix.clone(), right.clone());
        if !solve_positive_definite(&mut matrix, &mut step) {
            return misfit;
        }
        let gain: f64 = step.iter().zip(&right).map(|(s, r)| s * r).sum();
        misfit + self.base.penalty() - gain
    }

    /// The effect moved, a parameter at a time, to where its score is lowest nearby.
    fn refined(&self, effect: Effect, score: f64, observation: &Observation) -> (f64, Effect) {
        let (mut best, mut lowest) = (effect, score);
        let mut reach = 0.6;
        for _ in 0..4 {
            for index in 0..best.parameters.len() {
                for share in [-1.0, -0.5, 0.5, 1.0] {
                    let mut other = best.clone();
                    let value = other.parameters[index].value;
                    // An abscissa may be zero: it moves by tenths of a metre at first.
                    let step = if best.kind.spec().parameters[index].name == "x" { 0.1 } else { value };
                    other.parameters[index].value = value + share * reach * step;
                    let score = self.score(other.clone(), observation);
                    if score < lowest {
                        (best, lowest) = (other, score);
                    }
                }
            }
            reach *= 0.35;
        }
        (lowest, best)
    }
}
