//! Which effects a recording needs: forward selection with exchange, every candidate fitted with the tolerances.

use crate::catalogue::{Candidate, catalogue};
use crate::evidence::is_beyond_names;
use crate::fit::Fit;
use crate::ranking::Ranking;
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Effect, EffectKind, Fixture};

/// Standard deviations by which χ² and the priors' share may exceed the degrees of freedom where nothing large is left to be found.
const FITS: (f64, f64) = (0.7, 2.0);
/// The same for the departures of the fixture's quantities by themselves.
const BENT: f64 = 8.0;
/// Prices that an effect must be worth, faded, to be kept without further ado.
const CLEAR: f64 = 2.0;
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
    /// The fixture as it stands and refitted, and nothing searched for yet. `None` where it predicts no finite FRFs.
    pub(crate) fn without_effects(fixture: &Fixture, observation: &Observation, exact: bool) -> Option<Self> {
        let start = Hypothesis::nominal(fixture, exact);
        let predicted = start.predict(observation).ok()?;
        let chi2 = observation.chi2(&predicted);
        let nominal = Fit { hypothesis: start.clone(), predicted, chi2, objective: chi2 };
        let refitted = Fit::searched(&start, observation)?;
        let candidates = catalogue(fixture, observation);
        Some(Search { nominal, repaired: refitted.clone(), refitted, candidates })
    }

    /// Searches for effects. `None` where the fixture predicts no finite FRFs.
    pub fn of(fixture: &Fixture, observation: &Observation, exact: bool) -> Option<Self> {
        let mut search = Search::without_effects(fixture, observation, exact)?;
        search.extend(observation);
        Some(search)
    }

    /// As [`Search::of`], from what was found in a part of the observation: its names are fitted to the whole, exchanged, dropped and
    /// added to as the whole demands.
    pub(crate) fn continued(
        part: &Search,
        fixture: &Fixture,
        observation: &Observation,
        exact: bool,
    ) -> Option<Self> {
        let mut search = Search::without_effects(fixture, observation, exact)?;
        let near = |fit: &Fit| Fit::of(&fit.hypothesis, observation, false);
        if let Some(refitted) = near(&part.refitted).filter(|fit| fit.objective < search.refitted.objective) {
            search.refitted = refitted;
        }
        search.repaired = search.refitted.clone();
        let repaired_effects = part.repaired.hypothesis.effect_count();
        if repaired_effects > 0
            && let Some(repaired) = near(&part.repaired)
        {
            search.repaired = repaired;
            // As many names as there may be that explain neither the part nor the whole need not be exchanged once more.
            if repaired_effects < MOST_EFFECTS || !is_beyond_names(&search, observation) {
                search.improve(observation);
            }
        }
        search.extend(observation);
        Some(search)
    }

    /// Adds effects one at a time as long as they are worth it.
    fn extend(&mut self, observation: &Observation) {
        for _ in 0..ROUNDS {
            if self.repaired.hypothesis.effect_count() >= MOST_EFFECTS {
                break;
            }
            let Some(better) = self.extended(observation) else { break };
            self.repaired = better;
            self.improve(observation);
        }
    }

    /// The effects at hand at their best, in each other's company, those left out that are not needed.
    fn improve(&mut self, observation: &Observation) {
        self.polish(observation);
        self.exchange(observation);
        self.prune(observation);
    }

    /// Fits the effects that were found again from the nominal quantities: along a flat valley the way that led here may have
    /// stopped short.
    fn polish(&mut self, observation: &Observation) {
        let found = &self.repaired.hypothesis;
        let starts = [(found.with_tolerances_of(&self.nominal.hypothesis), true), (found.clone(), false)];
        let fits = starts.iter().filter_map(|(start, far)| Fit::of(start, observation, *far));
        let best = fits.min_by(|a, b| a.objective.total_cmp(&b.objective));
        if let Some(best) = best.filter(|best| best.objective < self.repaired.objective) {
            self.repaired = best;
        }
    }

    /// Whether `with` is worth its parameters over `without`.
    fn is_worth(&self, with: &Fit, without: &Fit, observation: &Observation) -> bool {
        let parameters = parameter_price(&with.hypothesis) - parameter_price(&without.hypothesis);
        let gain = (without.objective - with.objective) / with.scale(observation);
        gain > price(parameters, self.candidates.len())
    }

    /// The present fit with the one more effect that helps most, if it is worth it.
    fn extended(&self, observation: &Observation) -> Option<Fit> {
        let best = self.ranked(&self.repaired, observation).into_iter().next()?.1;
        self.is_worth(&best, &self.repaired, observation).then_some(best)
    }

    /// Whether a fit may still lack something large; what fits already can only lack something small, which the near way finds.
    fn lacks_much(&self, fit: &Fit, observation: &Observation) -> bool {
        let degrees = observation.degrees() as f64;
        let fits = if fit.hypothesis.effect_count() == 0 { FITS.0 } else { FITS.1 };
        // With effects the noise's own uncertainty counts too: what they leave may be no more than that.
        let noise = if fit.hypothesis.effect_count() == 0 { 0.0 } else { observation.noise_uncertainty() };
        // Quantities that had to bend are a misfit too, which a χ² that is small by chance must not hide.
        let quantities = fit.hypothesis.tolerances().len() as f64;
        fit.objective > degrees * (1.0 + fits * (2.0 / degrees).sqrt().hypot(noise))
            || fit.hypothesis.penalty() > quantities + BENT * (2.0 * quantities).sqrt()
    }

    /// Fits of `base` with one more effect, best first by objective and price of parameters, with the candidate's index.
    pub fn ranked(&self, base: &Fit, observation: &Observation) -> Vec<(usize, Fit)> {
        // What gains less than the price of looking is not believed.
        let limit = base.objective - price(0.0, self.candidates.len());
        self.ranking(observation).of(&base.hypothesis, self.lacks_much(base, observation), limit)
    }

    /// As [`Search::ranked`], for a `base` whose quantities stand already where the effect that is looked for would leave
    /// them; fits that will not come near `limit` are left unfinished.
    pub(crate) fn look_alikes(
        &self,
        base: &Hypothesis,
        limit: f64,
        observation: &Observation,
    ) -> Vec<(usize, Fit)> {
        self.ranking(observation).look_alikes(base, limit)
    }

    fn ranking<'a>(&'a self, observation: &'a Observation) -> Ranking<'a> {
        Ranking { candidates: &self.candidates, nominal: &self.nominal.hypothesis, observation }
    }

    /// Replaces each effect by whatever serves better in the company of the others, until nothing does.
    fn exchange(&mut self, observation: &Observation) {
        if self.repaired.hypothesis.effect_count() < 2 {
            return;
        }
        for _ in 0..2 {
            let mut changed = false;
            for index in 0..self.repaired.hypothesis.effect_count() {
                let without = self.repaired.hypothesis.without(index);
                // Three names at once that still miss much are no physics in need of a fourth opinion.
                let far = self.repaired.hypothesis.effect_count() == 2
                    && self.lacks_much(&self.repaired, observation);
                let ranking = self.ranking(observation);
                let Some((_, other)) =
                    ranking.in_stead(&without, far, self.repaired.objective).into_iter().next()
                else {
                    continue;
                };
                let parameters = |fit: &Fit| parameter_price(&fit.hypothesis);
                if other.objective + parameters(&other) + 1.0
                    < self.repaired.objective + parameters(&self.repaired)
                {
                    (self.repaired, changed) = (other, true);
                    self.polish(observation);
                }
            }
            if !changed {
                return;
            }
        }
    }

    /// Drops effects that no longer earn their place, the last one included: from the quantities that the effect led to, the
    /// fixture alone may do as well, where its own refit had ended in a false minimum.
    pub(crate) fn prune(&mut self, observation: &Observation) {
        let mut index = 0;
        while index < self.repaired.hypothesis.effect_count() {
            // A quarter of an effect misses a sixteenth of what the whole does: what that makes clear needs no more fits.
            let scale = self.repaired.scale(observation);
            let clear = self.repaired.objective + CLEAR * scale * price(0.0, self.candidates.len());
            let faded = Fit::faded(&self.repaired.hypothesis, index, observation, clear);
            let Some(fewer) = faded else {
                index += 1;
                continue;
            };
            if fewer.hypothesis.effect_count() == 0 && fewer.objective < self.refitted.objective {
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
