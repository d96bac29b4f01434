//! Which effects a recording needs: forward selection with exchange, every candidate fitted with the
//! tolerances.

use crate::candidate::Candidate;
use crate::catalogue::{catalogue, with_all_wrong_quantities, with_wrong_quantities};
use crate::departures::has_departed;
use crate::evidence::{cost, explained, explains, lacks_much, nothing_can_be_stated};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::odd_record::OddRecord;
use crate::penalty::{needed_gain, parameter_penalty};
use crate::ranking::Ranking;
use crate::settings::Settings;
use crate::together::as_one;
use crate::{Hypothesis, Observation, Watch};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_spectra::FrfPair;

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
    /// Those that modes tell from what was found: they need not be asked for on lines.
    pub(crate) told_apart: Vec<usize>,
    /// Whether modes are sure of what was found, so that nothing large can be left out beside it.
    pub(crate) is_sure: bool,
}

/// The gain of the record that is another multiple of what the fixture as it stands makes of it than all
/// others, as a name; that of a channel where it is the only record.
fn odd_record(observation: &Observation, nominal: &Fit) -> Option<Candidate> {
    let pairs = observation.pairs();
    let odd = OddRecord::of(pairs, observation.values(), &nominal.predicted)?;
    let has_another = |same: &dyn Fn(&FrfPair) -> bool| pairs.iter().filter(|pair| same(pair)).count() > 1;
    let is_one_of_several = has_another(&|pair| pair.response == odd.frf.response)
        && has_another(&|pair| pair.reference == odd.frf.reference);
    is_one_of_several.then(|| odd.as_a_name())
}

impl Search {
    /// The fixture as it stands, not refitted, and nothing searched for yet. `None` where it predicts no
    /// finite FRFs.
    pub(crate) fn as_stated(fitter: &Fitter, fixture: &Fixture, exact: bool) -> Option<Self> {
        let nominal = Fit::at(Hypothesis::nominal(fixture, exact), fitter.observation)?;
        let mut candidates = catalogue(fixture, fitter.observation);
        let odd = odd_record(fitter.observation, &nominal);
        candidates.extend(odd.filter(|odd| candidates.iter().all(|known| known.place != odd.place)));
        Some(Search {
            refitted: nominal.clone(),
            repaired: nominal.clone(),
            nominal,
            candidates,
            told_apart: Vec::new(),
            is_sure: false,
        })
    }

    /// The fixture as it stands and refitted, and nothing searched for yet. `None` where it predicts no
    /// finite FRFs.
    pub(crate) fn without_effects(fitter: &Fitter, fixture: &Fixture, exact: bool) -> Option<Self> {
        let start = Search::as_stated(fitter, fixture, exact)?;
        fitter.watch.stage("refitting the fixture within its tolerances");
        let refitted = fitter.refitted(&start.nominal.hypothesis)?;
        Some(Search { repaired: refitted.clone(), refitted, ..start })
    }

    /// The same, the fixture refitted from more starts: where no modes lead out of a false minimum.
    pub(crate) fn refitted_widely(self, fitter: &Fitter) -> Self {
        let refitted = fitter.refitted_widely(&self.nominal.hypothesis, self.refitted);
        Search { repaired: refitted.clone(), refitted, ..self }
    }

    /// The same with quantities that had to depart among the candidates.
    pub(crate) fn with_wrong_quantities(self, fitter: &Fitter) -> Self {
        let count = fitter.settings.selection.wrong;
        let candidates = with_wrong_quantities(&self.candidates, &self.refitted.hypothesis, count);
        Search { candidates, ..self }
    }

    /// The fixture with one quantity wrong as it is stated, where that explains the lines down to their noise
    /// and no effect that says the same of it does; `strictly` not a tenth of the noise more.
    pub(crate) fn explained_by_wrong_quantity(&self, fitter: &Fitter, strictly: bool) -> Option<Search> {
        let known = self.candidates.len();
        let count = fitter.settings.selection.wrong;
        let candidates = with_all_wrong_quantities(&self.candidates, &self.refitted.hypothesis, count);
        let with = Search { candidates, ..self.clone() };
        let found =
            with.candidates[known..].iter().filter_map(|name| with.explained_by(fitter, name, strictly));
        found.min_by(|a, b| a.repaired.objective.total_cmp(&b.repaired.objective))
    }

    /// The fixture with the gain of the one record that stands alone, where that explains the lines down to
    /// their noise: all that an odd record spoils is spared then.
    pub(crate) fn explained_by_odd_record(&self, fitter: &Fitter) -> Option<Search> {
        self.explained_by(fitter, &odd_record(fitter.observation, &self.nominal)?, true)
    }

    /// The fixture with the sensor's mass that natural frequencies `tell` which differ from response to
    /// response, else with that of one sensor that goes from response to response, where that explains the
    /// lines down to their noise: the poles that all FRFs share are of no structure then, and modes tell
    /// nothing.
    pub(crate) fn explained_by_moved_sensor(&self, fitter: &Fitter, told: Option<&Effect>) -> Option<Search> {
        let is_moved =
            |name: &Candidate| name.kind == EffectKind::SensorMass && name.place == Place::Responses;
        let is_named = |name: &&Candidate| told.map_or(is_moved(name), |sensor| name.names(sensor));
        let mut name = self.candidates.iter().find(is_named)?.clone();
        if let Some(sensor) = told {
            name.starts = vec![vec![sensor.value(0)]];
        }
        self.explained_by(fitter, &name, true)
    }

    /// The fixture with this name alone, from each of its starts, where that explains the lines down to their
    /// noise, `strictly` not a tenth of the noise more, and gains what it must.
    fn explained_by(&self, fitter: &Fitter, name: &Candidate, strictly: bool) -> Option<Search> {
        let fit = |start: usize| fitter.refitted(&self.nominal.hypothesis.with(name.effect(start)));
        let fits = (0..name.starts.len()).filter_map(fit);
        let repaired = fits.min_by(|a, b| a.objective.total_cmp(&b.objective))?;
        let explained =
            explains(fitter, &repaired, strictly) && self.is_worth(fitter, &repaired, &self.refitted);
        explained.then(|| Search { repaired, ..self.clone() })
    }

    /// What explains the lines down to their noise among few names, for a share of all work; `None` where
    /// nothing does.
    pub(crate) fn explained_among(&self, fitter: &Fitter, names: Vec<Candidate>) -> Option<Search> {
        if names.is_empty() {
            return None;
        }
        let (share, effects) = fitter.settings.selection.among_few;
        let mut settings = fitter.settings.clone();
        settings.selection.effects = effects;
        let few = Search { candidates: names, ..self.clone() };
        let fewer = Fitter { settings: &settings, ..*fitter };
        let found = fitter.observation.work().aside(share, || Search::searched(&fewer, few));
        let explained =
            found.repaired.hypothesis.effect_count() > 0 && explains(fitter, &found.repaired, true);
        explained.then(|| Search { candidates: self.candidates.clone(), ..found })
    }

    /// The same, the fixture refitted from elsewhere too, with all the time that takes: from where broad modes
    /// lead to, lines may have far to go.
    pub(crate) fn refitted_from(self, fitter: &Fitter, start: &Hypothesis) -> Self {
        let found = fitter.local(start, None, f64::INFINITY);
        match found.filter(|fit| fit.objective < self.refitted.objective) {
            Some(refitted) => Search { repaired: refitted.clone(), refitted, ..self },
            None => self,
        }
    }

    /// Searches for effects with the default settings. `None` where the fixture predicts no finite FRFs.
    pub fn of(fixture: &Fixture, observation: &Observation, exact: bool) -> Option<Self> {
        let fitter = Fitter { observation, settings: &Settings::default(), watch: Watch::default() };
        let start = Search::without_effects(&fitter, fixture, exact)?.refitted_widely(&fitter);
        Some(Search::searched(&fitter, start))
    }

    /// Searches for effects from the fixture as it stands and refitted.
    pub(crate) fn searched(fitter: &Fitter, start: Search) -> Self {
        let mut search = start;
        search.extend(fitter, |_| false);
        search
    }

    /// As [`Search::searched`], from `start`, which is the fixture as it stands and refitted, and from what
    /// was found elsewhere: in a part of the observation, or among its modes. The effects are fitted to the
    /// whole, exchanged, dropped and added to as the whole demands.
    pub(crate) fn continued(fitter: &Fitter, start: Search, part: &Search) -> Self {
        Search::continued_until(fitter, start, part, |_| false)
    }

    /// The same, at an end as soon as what was found has `led_astray`.
    pub(crate) fn continued_until(
        fitter: &Fitter,
        start: Search,
        part: &Search,
        led_astray: impl Fn(&Search) -> bool,
    ) -> Self {
        let mut search = start;
        let local = |fit: &Fit| fitter.local(&fit.hypothesis, None, f64::INFINITY);
        if let Some(refitted) = local(&part.refitted).filter(|fit| fit.objective < search.refitted.objective)
        {
            search.refitted = refitted;
        }
        search.repaired = search.refitted.clone();
        let found = part.repaired.hypothesis.effect_count();
        if found > 0
            && let Some(repaired) = local(&part.repaired)
        {
            search.repaired = repaired;
            // As many effects as there may be that explain neither the part nor the whole need not be
            // exchanged once more.
            let full = found >= fitter.settings.selection.effects;
            if !full || !nothing_can_be_stated(fitter, &search.repaired, search.candidates.len()) {
                search.improve(fitter);
            }
            if led_astray(&search) {
                return search;
            }
        }
        search.extend(fitter, led_astray);
        search
    }

    /// Adds effects one at a time as long as they are worth it and have not `led_astray`.
    fn extend(&mut self, fitter: &Fitter, led_astray: impl Fn(&Search) -> bool) {
        let settings = &fitter.settings.selection;
        for _ in 0..settings.rounds {
            fitter.watch.stage(match self.repaired.hypothesis.effect_count() {
                0 => "searching the lines for an effect",
                _ => "searching the lines for one more effect",
            });
            if self.repaired.hypothesis.effect_count() >= settings.effects
                || !fitter.observation.work().allows("more effects, by lines")
            {
                break;
            }
            let best = self.ranked(fitter, &self.repaired).into_iter().next().map(|(_, fit)| fit);
            let Some(better) = best.filter(|best| self.is_worth(fitter, best, &self.repaired)) else { break };
            self.repaired = better;
            // Beside what modes are sure of, an effect that they do not need is not worth being fitted
            // closely.
            if self.is_sure && led_astray(self) {
                break;
            }
            self.improve(fitter);
            if led_astray(self) {
                break;
            }
        }
    }

    /// The effects at hand at their best, in each other's company, those left out that are not needed.
    fn improve(&mut self, fitter: &Fitter) {
        self.polish(fitter);
        self.exchange(fitter);
        self.prune(fitter);
        self.merge(fitter);
    }

    /// Puts one effect in the stead of several on channels that are together exactly that one, where it does
    /// as well: no exchange of one for another leads there.
    fn merge(&mut self, fitter: &Fitter) {
        let several =
            as_one(&self.repaired.hypothesis.effects(), &self.candidates, fitter.observation.pairs());
        let fits = several.into_iter().filter_map(|(indices, one)| {
            let rest = indices
                .iter()
                .rev()
                .fold(self.repaired.hypothesis.clone(), |rest, index| rest.without(*index));
            fitter.local(&rest.with(one), None, f64::INFINITY)
        });
        let cost = |fit: &Fit| cost(fitter, fit, 1.0);
        let best = fits.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        if let Some(fewer) = best.filter(|fewer| !self.is_worth(fitter, &self.repaired, fewer)) {
            self.repaired = fewer;
        }
    }

    /// Fits the effects that were found again from the nominal quantities: along a flat valley the way that
    /// led here may have stopped short.
    fn polish(&mut self, fitter: &Fitter) {
        let found = &self.repaired.hypothesis;
        let fits = [
            fitter.global(&found.with_tolerances_of(&self.nominal.hypothesis)),
            fitter.local(found, None, f64::INFINITY),
        ];
        let best = fits.into_iter().flatten().min_by(|a, b| a.objective.total_cmp(&b.objective));
        if let Some(best) = best.filter(|best| best.objective < self.repaired.objective) {
            self.repaired = best;
        }
    }

    /// Whether `with` is worth its parameters over `without`.
    fn is_worth(&self, fitter: &Fitter, with: &Fit, without: &Fit) -> bool {
        let settings = &fitter.settings.selection;
        let cost = |fit: &Fit| parameter_penalty(settings, &fit.hypothesis);
        let gain = (without.objective - with.objective) / with.inflation(fitter.observation);
        let leaves_noise = without.chi2_per_dof(fitter.observation)
            < explained(fitter.observation, fitter.settings)
            && !has_departed(&without.hypothesis);
        let least = if leaves_noise { settings.beside_noise } else { 0.0 };
        gain > needed_gain(settings, cost(with) - cost(without), self.candidates.len()).max(least)
    }

    /// Fits of `base` with one more effect, best first by objective and penalty of parameters, with the
    /// candidate's index.
    fn ranked(&self, fitter: &Fitter, base: &Fit) -> Vec<(usize, Fit)> {
        // What gains less than the price of looking is not believed.
        let limit = base.objective - needed_gain(&fitter.settings.selection, 0.0, self.candidates.len());
        if self.is_sure {
            return self.ranking(fitter).nearby(&base.hypothesis, limit);
        }
        self.ranking(fitter).of(&base.hypothesis, lacks_much(fitter, base), limit)
    }

    /// As [`Search::ranked`], for a `base` whose quantities stand already where the effect that is looked for
    /// would leave them: there the fixture alone does badly, and whatever serves as well takes few steps.
    /// Fits that will not come near `limit` are left unfinished.
    pub(crate) fn look_alikes(&self, fitter: &Fitter, base: &Hypothesis, limit: f64) -> Vec<(usize, Fit)> {
        Ranking { excluded: &self.told_apart, ..self.ranking(fitter) }.look_alikes(base, limit)
    }

    /// The same for an effect that quantities make up for, but for little, where `base` stands: whatever
    /// explains that little is small too, and near.
    pub(crate) fn small_look_alikes(
        &self,
        fitter: &Fitter,
        base: &Hypothesis,
        limit: f64,
    ) -> Vec<(usize, Fit)> {
        let mut settings = fitter.settings.clone();
        settings.fit.limit.reach = settings.ranking.small_reach;
        let fitter = Fitter { settings: &settings, ..*fitter };
        Ranking { excluded: &self.told_apart, ..self.ranking(&fitter) }.of_each(base, limit)
    }

    fn ranking<'a>(&'a self, fitter: &Fitter<'a>) -> Ranking<'a> {
        Ranking {
            candidates: &self.candidates,
            excluded: &[],
            nominal: &self.nominal.hypothesis,
            fitter: *fitter,
        }
    }

    /// Replaces each effect by whatever serves better in the company of the others, until nothing does.
    fn exchange(&mut self, fitter: &Fitter) {
        if self.repaired.hypothesis.effect_count() < 2 {
            return;
        }
        let cost = |fit: &Fit| cost(fitter, fit, 1.0);
        for _ in 0..fitter.settings.selection.exchanges {
            let mut changed = false;
            for index in 0..self.repaired.hypothesis.effect_count() {
                if !fitter.observation.work().allows("others in the stead of effects found") {
                    return;
                }
                let without = self.repaired.hypothesis.without(index);
                // Three effects that leave a large misfit: skip the global search.
                let global =
                    self.repaired.hypothesis.effect_count() == 2 && lacks_much(fitter, &self.repaired);
                let better = self.ranking(fitter).in_stead(&without, global, self.repaired.objective);
                let Some((_, other)) = better.into_iter().next() else { continue };
                if cost(&other) + 1.0 < cost(&self.repaired) {
                    (self.repaired, changed) = (other, true);
                    self.polish(fitter);
                }
            }
            if !changed {
                return;
            }
        }
    }

    /// Drops effects that no longer earn their place, the last one included: from the quantities that the
    /// effect led to, the fixture alone may do as well, where its own refit had ended in a false minimum.
    pub(crate) fn prune(&mut self, fitter: &Fitter) {
        let settings = &fitter.settings.selection;
        let mut index = 0;
        while index < self.repaired.hypothesis.effect_count() {
            // A quarter of an effect misses a sixteenth of what the whole does: what that makes clear needs
            // no more fits.
            let inflation = self.repaired.inflation(fitter.observation);
            let needed = settings.clear * inflation * needed_gain(settings, 0.0, self.candidates.len());
            let faded = fitter.faded(&self.repaired.hypothesis, index, self.repaired.objective + needed);
            let Some(fewer) = faded else {
                index += 1;
                continue;
            };
            if fewer.hypothesis.effect_count() == 0 && fewer.objective < self.refitted.objective {
                self.refitted = fewer.clone();
            }
            if self.is_worth(fitter, &self.repaired, &fewer) {
                index += 1;
            } else {
                (self.repaired, index) = (fewer, 0);
            }
        }
    }
}
