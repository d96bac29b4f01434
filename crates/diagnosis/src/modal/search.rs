//! Which effects the recorded modes need: every candidate fitted to them, alone and beside others.

use crate::catalogue::Candidate;
use crate::modal::fit::{ModalFit, Problem, SetOut, Standing, linear};
use crate::modal::prior::{Prior, priors};
use crate::settings::ModalSettings;
use crate::{Hypothesis, Watch};
use jointscope_fixture::{Effect, EffectKind, Starts};
use jointscope_model_error::{ErrorSizes, Linear};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// Standard deviation, in stated ones, that a calibrated quantity keeps.
const CALIBRATED: f64 = 1e-4;

/// ln of a start's density.
enum Score {
    /// With the derivatives of its base.
    Alike(f64),
    /// Without any: it compares other modes than its base.
    Apart(f64),
}

/// Name of what a search may not come to any more.
const STARTS: &str = "the less promising effects, by modes";

/// Effects by their candidates' indices, and their fit.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    pub names: Vec<usize>,
    pub fit: ModalFit,
    /// Whether the evidence is hardly less without any error of the model.
    pub exact: bool,
}

/// The outcome of a search among modes.
#[derive(Debug, Clone)]
pub(crate) struct ModalSearch {
    /// The fixture by itself.
    pub none: ModalFit,
    /// What the recording needs beyond it, nothing included.
    pub best: Named,
    /// Every candidate by itself, the most probable first.
    pub singles: Vec<Named>,
    /// Candidates that by themselves start too far below the best of these to be fitted.
    pub far: Vec<usize>,
    /// The best with one effect more, whether or not that is needed.
    pub more: Vec<Named>,
    /// What else may stand in the stead of each effect of the best, itself included, the most probable first.
    pub alternatives: Vec<Vec<Named>>,
    /// ln p of the best without each of its effects.
    pub without: Vec<f64>,
}

/// Where among the parameters of a kind the frequency is at which it resonates by itself, if it does.
fn own_frequency(kind: EffectKind) -> Option<usize> {
    kind.spec().parameters.iter().position(|parameter| matches!(parameter.starts, Starts::OverBand { .. }))
}

/// The starts of something that resonates by itself, at these frequencies (Hz).
fn resonating_at(candidate: &Candidate, hz: &[f64]) -> Vec<Effect> {
    let Some(frequency) = own_frequency(candidate.kind) else { return Vec::new() };
    let first = candidate.starts.first().map(|start| start[frequency]);
    // Every abscissa, mass and damping ratio once.
    let others = candidate.starts.iter().filter(|start| Some(start[frequency]) == first);
    let at = |start: &Vec<f64>, hz: f64| {
        let mut start = start.clone();
        start[frequency] = hz;
        Effect::new(candidate.kind, candidate.place.clone(), candidate.dof, &start)
    };
    others.flat_map(|start| hz.iter().map(move |hz| at(start, *hz))).collect()
}

/// A hypothesis whose last effect came to the end of its start's reach, with the reach about where it stands; `None` where it did not, or where that lies
/// outside of what the candidate's starts span.
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
fn best_of_each(mut fits: Vec<Named>) -> Vec<Named> {
    fits.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
    let mut seen = BTreeSet::new();
    fits.retain(|named| named.names.last().is_some_and(|&name| seen.insert(name)));
    fits
}

impl ModalSearch {
    /// Whether each of several effects gains as much as `needed` in ln p over the others, as far as these were tried: one that does not may imitate an error of
    /// the model.
    pub fn needs_all_of(&self, named: &Named, needed: f64) -> bool {
        let part = |fewer: &&Named| {
            fewer.names.len() + 1 == named.names.len() && fewer.names.iter().all(|c| named.names.contains(c))
        };
        self.singles.iter().chain(&self.more).filter(part).all(|fewer| named.fit.ln - fewer.fit.ln >= needed)
    }
}

/// A search under way.
#[derive(Clone, Copy)]
pub(crate) struct Searcher<'a> {
    pub problem: Problem<'a>,
    pub candidates: &'a [Candidate],
    pub nominal: &'a Hypothesis,
    pub settings: &'a ModalSettings,
    /// Where to set out from in place of all candidates' starts: the effects found in more than what is searched here.
    pub known: Option<&'a [Effect]>,
    /// Whether the fixture's quantities are where another recording of the structure put them, and stay there.
    pub calibrated: bool,
    /// Whether a hypothesis leaves no more than noise on lines.
    pub suffices: &'a (dyn Fn(&Named) -> bool + Sync),
    pub watch: Watch<'a>,
}

impl Searcher<'_> {
    /// The fixture by itself; `None` where it has no modes that could be compared.
    pub fn fixture_alone(&self) -> Option<ModalFit> {
        self.watch.stage("fitting the fixture to the modes");
        self.problem.fitted(self.nominal, &self.priors(self.nominal, &[]))
    }

    /// Searches for effects beside the fixture `alone`.
    pub fn search(&self, alone: ModalFit) -> ModalSearch {
        let none = alone;
        let start = Named { names: Vec::new(), exact: self.is_exact(&none), fit: none };
        self.watch.stage("comparing effects by modes");
        let (mut singles, mut far) = self.extended(&start, self.settings.refined.0, self.settings.starts.0);
        let start = self.at_its_best(start, &singles);
        let none = start.fit.clone();
        // Where neither the fixture nor any effect explains the modes, the right one may have set out from the wrong place.
        let explains = |named: &Named| {
            named.fit.ln - none.ln > self.needed()
                && self.is_adequate(&named.fit)
                && self.is_told(named, &none)
        };
        let little = self.problem.work.spent() < self.settings.again;
        if little && !self.is_adequate(&none) && !singles.iter().any(explains) {
            let (again, _) = self.extended(&start, self.settings.tried, self.settings.starts.1);
            singles = best_of_each(singles.into_iter().chain(again).collect());
            far.retain(|c| singles.iter().all(|single| single.names.last() != Some(c)));
        }
        let mut best = start.clone();
        let mut more = Vec::new();
        for count in 1..=self.settings.effects {
            // What the fixture itself explains, and no effect alone improves, needs no pair.
            if count > 1 && best.names.is_empty() && self.is_adequate(&none) {
                break;
            }
            // What explains modes and lines needs no company that modes could tell.
            if count > 1 && !best.names.is_empty() && (self.suffices)(&best) {
                break;
            }
            if count > 1 {
                if !self.problem.work.allows("several effects together, by modes") {
                    break;
                }
                self.watch.stage("comparing several effects together by modes");
            }
            let ranked = match count {
                1 => singles.clone(),
                2 => self.pairs(&singles),
                _ => self.extended(&best, self.settings.refined.1, 1).0,
            };
            let Some(first) =
                ranked.iter().take(self.settings.tried).find(|named| self.is_told(named, &none))
            else {
                break;
            };
            if count > 1 {
                more.extend(ranked.iter().take(self.settings.bases.0).cloned());
            }
            // A pair may be needed where neither effect alone is.
            let added = (count - best.names.len()) as f64;
            if first.fit.ln - best.fit.ln > added * self.needed() {
                best = first.clone();
            } else if count > 1 {
                break;
            }
        }
        self.watch.stage("asking by modes what else would explain a finding");
        let (alternatives, without) = self.alternatives(&best, &singles, &none);
        ModalSearch { none, best, singles, far, more, alternatives, without }
    }

    /// The fixture by itself from where the best effects left its quantities too: what gains much at a size of nothing has only led out of a false minimum.
    fn at_its_best(&self, none: Named, singles: &[Named]) -> Named {
        let priors = self.priors(self.nominal, &[]);
        let without = |named: &Named| self.problem.fitted(&named.fit.hypothesis.without(0), &priors);
        let fits = singles.iter().take(self.settings.bases.0).filter_map(without);
        match fits.max_by(|a, b| a.ln.total_cmp(&b.ln)).filter(|fit| fit.ln > none.fit.ln) {
            Some(fit) => Named { exact: self.is_exact(&fit), fit, ..none },
            None => none,
        }
    }

    /// Priors of a hypothesis whose effects go by the names of `company`.
    fn priors(&self, hypothesis: &Hypothesis, company: &[&Candidate]) -> Vec<Prior> {
        let mut all = priors(hypothesis, company);
        if self.calibrated {
            let stay = all.iter_mut().zip(&self.nominal.coordinates);
            stay.for_each(|(prior, at)| *prior = Prior { mean: *at, std: CALIBRATED });
        }
        all
    }

    /// What an effect must gain in ln p.
    fn needed(&self) -> f64 {
        self.settings.needed(self.candidates.len())
    }

    /// The best singles each with one effect more; all but the best only where that leaves an error of the model.
    fn pairs(&self, singles: &[Named]) -> Vec<Named> {
        let Some(first) = singles.first() else { return Vec::new() };
        let close = |s: &&Named| first.fit.ln - s.fit.ln < self.settings.bases.1;
        let count = if first.exact { 1 } else { self.settings.bases.0 };
        let mut all: Vec<Named> = singles
            .iter()
            .take(count)
            .filter(close)
            .flat_map(|s| self.extended(s, self.settings.refined.1, 1).0)
            .collect();
        all.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
        all
    }

    /// For each effect what may stand in its stead in the company of the others, and ln p without it.
    fn alternatives(&self, best: &Named, singles: &[Named], none: &ModalFit) -> (Vec<Vec<Named>>, Vec<f64>) {
        let count = best.names.len();
        let of = |index: usize| {
            let own = best.names[index];
            let (mut all, without) = if count == 1 {
                (singles.to_vec(), none.ln)
            } else {
                let mut names = best.names.clone();
                names.remove(index);
                let hypothesis = best.fit.hypothesis.without(index);
                let company: Vec<&Candidate> = names.iter().map(|&c| &self.candidates[c]).collect();
                let fit = self.problem.fitted(&hypothesis, &self.priors(&hypothesis, &company));
                match fit.map(|fit| Named { names, exact: self.is_exact(&fit), fit }) {
                    Some(base) => (self.extended(&base, self.settings.refined.1, 1).0, base.fit.ln),
                    None => (Vec::new(), f64::NEG_INFINITY),
                }
            };
            all.retain(|other| other.names.last() != Some(&own));
            all.push(Named { names: vec![own], fit: best.fit.clone(), exact: best.exact });
            all.sort_by(|a, b| b.fit.ln.total_cmp(&a.fit.ln));
            all.retain(|other| {
                let close = best.fit.ln - other.fit.ln < self.settings.listed;
                other.names.last() == Some(&own) || (close && self.is_told(other, none))
            });
            (all, without)
        };
        (0..count).map(of).unzip()
    }

    /// Whether the size of every effect is told from nothing, the model's errors as large as they may well be: with few modes the most probable errors are
    /// none, and whatever fits them exactly seems to be needed. What gains very much over nothing is told in any case.
    fn is_told(&self, named: &Named, none: &ModalFit) -> bool {
        let fit = &named.fit;
        if fit.ln - none.ln > self.settings.undoubted * named.names.len() as f64 {
            return true;
        }
        let sizes = fit.linear.mean_sizes(&fit.standing.comparison, self.problem.prior(), &fit.evidence);
        let Some(covariance) = fit.covariance_at(&sizes) else { return false };
        let least = self.settings.least;
        (0..fit.hypothesis.effect_count())
            .all(|index| fit.hypothesis.deviations_of(index, &covariance) >= least)
    }

    /// Whether what a fit needs of errors and departures is no more than chance makes.
    pub fn is_adequate(&self, fit: &ModalFit) -> bool {
        self.problem.is_adequate(fit, self.settings.adequate)
    }

    /// Whether the evidence is hardly less without any error of the model.
    pub fn is_exact(&self, fit: &ModalFit) -> bool {
        fit.standing.pairing.alone() == 0.0 && self.gained_by_errors(fit) < self.settings.exact
    }

    /// What errors of the model gain in ln p.
    fn gained_by_errors(&self, fit: &ModalFit) -> f64 {
        let without =
            fit.linear.ln_density(&fit.standing.comparison, &self.problem.sizes.times(ErrorSizes::LEAST));
        without.map_or(f64::INFINITY, |ln| self.problem.seen(fit).ln - ln)
    }

    /// Fits of `base` with one effect more, the most probable first: the `refined` best candidates, each from so many starts; and the candidates all of whose starts
    /// lie too far below the best of these to be fitted.
    fn extended(&self, base: &Named, refined: usize, each: usize) -> (Vec<Named>, Vec<usize>) {
        if let Some(known) = self.known {
            return (self.fitted(base, self.starts_at(base, known), SetOut::Both), Vec::new());
        }
        // What resonates makes a mode more: where every mode has its partner, nothing of the kind is there.
        let partners = base.fit.standing.pairing.alone() == 0.0;
        let idle = |c: usize| partners && self.candidates[c].kind == EffectKind::AttachedResonator;
        let free = |c: &usize| !base.names.contains(c) && !idle(*c);
        let bases = match base.names.is_empty() {
            true => vec![self.nominal, &base.fit.hypothesis],
            false => vec![&base.fit.hypothesis],
        };
        let unmatched = self.unmatched(&base.fit);
        let count = bases.len();
        let starts: Vec<(usize, Effect, usize)> = (0..self.candidates.len())
            .filter(free)
            .flat_map(|c| {
                let candidate = &self.candidates[c];
                let own = (0..candidate.starts.len()).map(|start| candidate.effect(start));
                let all = own.chain(resonating_at(candidate, &unmatched));
                all.flat_map(move |effect| (0..count).map(move |b| (c, effect.clone(), b)))
            })
            .collect();
        let tried = self.watch.count(starts.len());
        let work = self.problem.work;
        let scored: Vec<(Score, usize, Hypothesis)> = work.each(starts, STARTS, |(c, effect, b)| {
            tried.trying(&self.candidates[c]);
            let hypothesis = bases[b].with(effect);
            Some((self.score(&hypothesis, &base.fit)?, c, hypothesis))
        });
        let scored = self.rescored(scored);
        let mut densities: BTreeMap<usize, f64> = BTreeMap::new();
        for (density, c, _) in &scored {
            let own = densities.entry(*c).or_insert(f64::NEG_INFINITY);
            *own = own.max(*density);
        }
        let mut taken = vec![0; self.candidates.len()];
        let mut chosen = Vec::new();
        for (density, c, hypothesis) in scored {
            let distinct = taken.iter().filter(|t| **t > 0).count();
            if taken[c] < each && (taken[c] > 0 || distinct < refined) {
                taken[c] += 1;
                chosen.push((density, c, hypothesis));
            }
        }
        let (first, far) = self.settings.foremost;
        let rest = chosen.split_off(first.min(chosen.len()));
        let start = |(_, c, hypothesis)| (c, hypothesis);
        let is_costly = || self.problem.work.spent() > self.settings.costly;
        let set_out = if is_costly() { SetOut::Usual } else { SetOut::Both };
        let mut fits = self.fitted(base, chosen.into_iter().map(start).collect(), set_out);
        // Only what explains the modes shows that others need not be fitted; where fits are cheap they all are, for some may lead the fixture itself out of a false minimum.
        let best = fits.first().filter(|best| is_costly() && self.is_adequate(&best.fit));
        let best = best.map_or(f64::NEG_INFINITY, |best| best.fit.ln);
        let near = rest.into_iter().filter(|(density, _, _)| best - density < far).map(start).collect();
        fits.extend(self.fitted(base, near, SetOut::Usual));
        let fits = best_of_each(fits);
        let unfitted = |c: &usize| fits.iter().all(|named| named.names.last() != Some(c));
        let below = densities.into_iter().filter(|(_, density)| best - density >= far).map(|(c, _)| c);
        let far = below.filter(unfitted).collect();
        (fits, far)
    }

    /// Frequencies (Hz) at which the recording has a mode that a fit has not, and halfway from there to the next one that it has: what resonates beside a mode parts
    /// the two.
    fn unmatched(&self, fit: &ModalFit) -> Vec<f64> {
        let Standing { modelled, pairing, .. } = &fit.standing;
        let recorded = &self.problem.recorded.modes;
        let alone = (0..recorded.len()).filter(|&r| pairing.pairs.iter().all(|(other, _)| *other != r));
        let both = |r: usize| {
            let own = recorded[r].pole.omega;
            let next = modelled.modes.iter().map(|mode| mode.pole.omega);
            let next = next.min_by(|a, b| (a / own).ln().abs().total_cmp(&(b / own).ln().abs()));
            [own, next.map_or(own, |next| (own * next).sqrt())]
        };
        alone.flat_map(both).map(|omega| omega / TAU).collect()
    }

    /// Starts at effects that are known, of names that `base` does not have.
    fn starts_at(&self, base: &Named, known: &[Effect]) -> Vec<(usize, Hypothesis)> {
        let start = |effect: &Effect| {
            let c = self.candidates.iter().position(|candidate| candidate.names(effect))?;
            (!base.names.contains(&c)).then(|| (c, base.fit.hypothesis.with(effect.clone())))
        };
        known.iter().filter_map(start).collect()
    }

    /// Fits from starts with one effect more than `base`, the best of each candidate, the most probable first.
    fn fitted(&self, base: &Named, starts: Vec<(usize, Hypothesis)>, set_out: SetOut) -> Vec<Named> {
        let tried = self.watch.count(starts.len());
        let fit = |(c, hypothesis): (usize, Hypothesis)| {
            tried.trying(&self.candidates[c]);
            let names: Vec<usize> = base.names.iter().copied().chain([c]).collect();
            let company: Vec<&Candidate> = names.iter().map(|&c| &self.candidates[c]).collect();
            let standing = self.problem.standing(&hypothesis)?;
            let nearby = self.nearby(&hypothesis, &standing, &base.fit);
            let priors = self.priors(&hypothesis, &company);
            let mut fit = self.problem.fitted_from(&hypothesis, standing, &priors, (nearby, set_out))?;
            // The end of a reach is no place to rest, whatever the evidence says that has a parameter less there.
            for _ in 0..self.settings.farther {
                let next = farther(&fit.hypothesis, &self.candidates[c]).and_then(|start| {
                    let standing = self.problem.standing(&start)?;
                    self.problem.fitted_from(&start, standing, &priors, (None, set_out))
                });
                let Some(next) = next else { break };
                fit = next;
            }
            Some(Named { names, exact: self.is_exact(&fit), fit })
        };
        best_of_each(self.problem.work.each(starts, STARTS, fit))
    }

    /// Starts by their density, the highest first. Those that compare other modes than their base, of which the base's derivatives say nothing, are compared with the
    /// others by their own derivatives, the best of all and the best of each candidate; the rest are left out.
    fn rescored(&self, scored: Vec<(Score, usize, Hypothesis)>) -> Vec<(f64, usize, Hypothesis)> {
        let (mut alike, mut apart) = (Vec::new(), Vec::new());
        for (score, c, hypothesis) in scored {
            match score {
                Score::Alike(density) => alike.push((density, c, hypothesis)),
                Score::Apart(density) => apart.push((density, c, hypothesis)),
            }
        }
        let by_density = |all: &mut Vec<(f64, usize, Hypothesis)>| all.sort_by(|a, b| b.0.total_cmp(&a.0));
        by_density(&mut apart);
        let mut seen = vec![false; self.candidates.len()];
        let mut rank = 0;
        apart.retain(|(_, c, _)| {
            rank += 1;
            !std::mem::replace(&mut seen[*c], true) || rank <= self.settings.apart
        });
        let anew = self.problem.work.each(apart, STARTS, |(_, c, hypothesis)| {
            Some((self.score_by_itself(&hypothesis)?, c, hypothesis))
        });
        alike.extend(anew);
        by_density(&mut alike);
        alike
    }

    /// The density at a start by derivatives taken there.
    fn score_by_itself(&self, hypothesis: &Hypothesis) -> Option<f64> {
        let problem = &self.problem;
        let standing = problem.standing(hypothesis)?;
        let residual = problem.residual(&standing, &standing.modelled);
        let own = |at: &f64| Prior { mean: *at, std: self.settings.near };
        let mut local: Vec<Prior> = hypothesis.coordinates.iter().map(own).collect();
        let tolerances = self.priors(self.nominal, &[]);
        local[..tolerances.len()].copy_from_slice(&tolerances);
        let all = 0..local.len();
        let slopes = problem.slopes(hypothesis, &standing, &standing.modelled, &residual, &local, all)?;
        let linear = linear(hypothesis, &local, &residual, &slopes);
        Some(linear.ln_density(&standing.comparison, problem.sizes)? + standing.pairing.alone())
    }

    /// The density of the recorded features with one more effect at a start, everything else linear about `base`.
    fn score(&self, hypothesis: &Hypothesis, base: &ModalFit) -> Option<Score> {
        let problem = &self.problem;
        let standing = problem.standing(hypothesis)?;
        let residual = problem.residual(&standing, &standing.modelled);
        let alone = standing.pairing.alone();
        if standing.pairing.pairs != base.standing.pairing.pairs {
            // Derivatives of the base are of other features: none at all, and errors so much larger.
            let linear = Linear { difference: residual, slopes: Vec::new() };
            let wide = problem.sizes.times(self.settings.wide);
            return Some(Score::Apart(linear.ln_density(&standing.comparison, &wide)? + alone));
        }
        let slopes = self.slopes(hypothesis, &standing, &residual, base)?;
        let linear = linear(hypothesis, &self.local_priors(hypothesis, base), &residual, &slopes);
        Some(Score::Alike(linear.ln_density(&standing.comparison, problem.sizes)? + alone))
    }

    /// Priors of the base, and of what it does not have a factor of two about where it stands.
    fn local_priors(&self, hypothesis: &Hypothesis, base: &ModalFit) -> Vec<Prior> {
        let own = |at: &f64| Prior { mean: *at, std: self.settings.near };
        let prior = |(i, at): (usize, &f64)| base.priors.get(i).copied().unwrap_or_else(|| own(at));
        hypothesis.coordinates.iter().enumerate().map(prior).collect()
    }

    /// Derivatives of the base, and of what it does not have where `hypothesis` stands.
    fn slopes(
        &self,
        hypothesis: &Hypothesis,
        standing: &Standing,
        residual: &[f64],
        base: &ModalFit,
    ) -> Option<Vec<Vec<f64>>> {
        let known = base.slopes.len();
        let local = self.local_priors(hypothesis, base);
        let own = known..hypothesis.coordinates.len();
        let own = self.problem.slopes(hypothesis, standing, &standing.modelled, residual, &local, own)?;
        Some(base.slopes.iter().cloned().chain(own).collect())
    }

    /// [`Searcher::slopes`] where the base compares the same modes.
    fn nearby(&self, hypothesis: &Hypothesis, standing: &Standing, base: &ModalFit) -> Option<Vec<Vec<f64>>> {
        if standing.pairing.pairs != base.standing.pairing.pairs {
            return None;
        }
        let residual = self.problem.residual(standing, &standing.modelled);
        self.slopes(hypothesis, standing, &residual, base)
    }
}
