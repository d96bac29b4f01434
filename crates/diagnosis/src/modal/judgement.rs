//! What a comparison by modes comes to.

use crate::candidate::Candidate;
use crate::catalogue::with_wrong_quantities;
use crate::estimates::estimates;
use crate::evidence::{cost, explained, explains};
use crate::finding::{Elsewhere, Evidence, Finding, Tried};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::modal::along::Along;
use crate::modal::changes::States;
use crate::modal::features::{Features, recorded};
use crate::modal::fit::ModalFit;
use crate::modal::needs::BEYOND_ERRORS;
use crate::modal::prior::priors;
use crate::modal::search::ModalSearch;
use crate::modal::searcher::{Named, Searcher};
use crate::modal::sizes::ModelError;
use crate::search::Search;
use crate::settings::ModalSettings;
use crate::{Hypothesis, ModeChange, Observation};
use jointscope_findings::Verdict;
use jointscope_fixture::{Effect, EffectKind, Entry};
use jointscope_inference::Covariance;
use jointscope_model_error::{ErrorSizes, KINDS, Pairing, SizePrior};

/// The outcome of a comparison by modes.
#[derive(Debug, Clone)]
pub(crate) struct ModalJudgement {
    pub search: ModalSearch,
    /// All names that were tried.
    pub candidates: Vec<Candidate>,
    pub verdict: Verdict,
    /// By effect of the best hypothesis: probability of its name, and other names with theirs.
    pub names: Vec<Vec<(usize, f64, Hypothesis)>>,
    /// By effect of the best hypothesis: what is known of it along its body.
    pub places: Vec<Places>,
    /// χ² per degree of freedom of the free fit that the recorded modes are from.
    pub free_fit: f64,
    /// Whether that fit took all the residual terms it may.
    pub strained: bool,
    /// Error of the refitted and of the repaired model.
    pub errors: [ModelError; 2],
    /// Whether the fixture states how well the gains of its records are known.
    pub states_gain: bool,
    /// The fixture by itself and the best hypothesis, at the most probable sizes of error: what is said of quantities and effects.
    pub stated: [Hypothesis; 2],
    /// Covariance of the best one's coordinates with sizes that may be larger.
    pub covariance: Option<Covariance>,
    /// What hypotheses were held against.
    pub features: Features,
}

/// Where along its body an effect may sit.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    /// About the most probable place; `None` where derivatives there tell as much.
    own: Option<Along>,
    /// The other places.
    elsewhere: Vec<Elsewhere>,
}

/// A hypothesis found among the modes, fitted to lines.
#[derive(Debug, Clone)]
pub(crate) struct Explaining {
    pub fit: Fit,
    /// Whether it explains the modes without any error of the model, so that nothing large can be left out beside it.
    pub is_sure: bool,
}

/// What a baseline says of the fixture.
#[derive(Debug, Clone)]
pub(crate) struct Before {
    /// The fixture as calibrated on it.
    pub calibrated: Hypothesis,
    /// Error of that model.
    pub error: ModelError,
    /// The modes then and now.
    pub modes: Vec<ModeChange>,
}

impl ModalJudgement {
    /// Compares a fixture with a recording by modes; `None` where there are no modes to compare. Of a recording that lacks what is held out of
    /// another, those effects are tried that were `known` there.
    pub(crate) fn of(
        fitter: &Fitter,
        nominal: &Hypothesis,
        candidates: &[Candidate],
        known: Option<&[Effect]>,
    ) -> Option<Self> {
        let Fitter { observation, settings, watch } = fitter;
        watch.stage("fitting the modes of the recording");
        let features = Features::of(observation, nominal, &settings.modal)?;
        let searcher = Searcher {
            problem: features.problem(observation.work()),
            candidates,
            nominal,
            settings: &settings.modal,
            known,
            calibrated: false,
            suffices: &|named| fitted_to_lines(fitter, named).is_some(),
            watch: fitter.watch,
        };
        let alone = searcher.fixture_alone()?;
        let candidates = with_wrong_quantities(candidates, &alone.hypothesis, settings.selection.wrong);
        let searcher = Searcher { candidates: &candidates, ..searcher };
        let search = searcher.search(alone);
        let states_gain = nominal.to_fixture().is_ok_and(|fixture| fixture.record_gain().is_some());
        Some(ModalJudgement { states_gain, ..Judge { searcher, search }.judged(features.clone()) })
    }

    /// What has changed since a `baseline` of the same structure: the fixture is calibrated on it, its error there is taken off, and what differs beyond
    /// repetition is searched for. `None` where the two have no modes in common.
    pub(crate) fn since(
        fitter: &Fitter,
        baseline: &Observation,
        nominal: &Hypothesis,
        candidates: &[Candidate],
    ) -> Option<(Self, Before)> {
        let Fitter { observation, settings, watch } = fitter;
        watch.stage("fitting the modes of the baseline");
        let before = Features::of(baseline, nominal, &settings.modal)?;
        let problem = before.problem(observation.work());
        watch.stage("calibrating the fixture on the baseline");
        let calibrated = problem.fitted(nominal, &priors(nominal, &[]))?;
        let before_error = problem.error(&calibrated, settings.modal.adequate.0);
        watch.stage("fitting the modes of the recording");
        let now = recorded(observation, &calibrated.hypothesis)?;
        let model = &calibrated.standing.modelled;
        let own = Pairing::of(&now, model);
        let change = now.relative_to(&before.recorded, model, [&own, &calibrated.standing.pairing])?;
        // What is stated is the error that both states share; the change has its own.
        let shared = before.known.scales;
        let scales = ErrorSizes { gain: shared.gain, ..settings.modal.repeated };
        let features = Features::new(change, SizePrior { scales, stated: [false; KINDS] });
        let nominal = &calibrated.hypothesis;
        let searcher = Searcher {
            problem: features.problem(observation.work()),
            candidates,
            nominal,
            settings: &settings.modal,
            known: None,
            calibrated: true,
            suffices: &|_| false,
            watch: fitter.watch,
        };
        let search = searcher.search(searcher.fixture_alone()?);
        let judged = Judge { searcher, search }.judged(features.clone());
        let states = States { before: &before.recorded, now: &now, own: &own, calibrated: &calibrated };
        let modes = states.modes(&judged.search.best);
        Some((judged, Before { calibrated: calibrated.hypothesis.clone(), error: before_error, modes }))
    }
}

/// What the modes led to, fitted to lines, where that leaves no more than noise: the more strictly if the modes seem to need an error of the model.
fn fitted_to_lines(fitter: &Fitter, named: &Named) -> Option<Fit> {
    // What will hardly come down to the noise is given up.
    let noise = explained(fitter.observation, fitter.settings) * fitter.observation.degrees() as f64;
    let fit = fitter.local(&named.fit.hypothesis, None, noise)?;
    explains(fitter, &fit, !named.exact).then_some(fit)
}

/// Whether all that a fit adds to the fixture are factors on channels' signals.
fn is_of_signals(fit: &ModalFit) -> bool {
    let effects = fit.hypothesis.effects();
    !effects.is_empty() && effects.iter().all(|effect| effect.kind.spec().entry == Entry::Signal)
}

/// Probability of names that explain the modes, and not the lines: what a usual finding has beside the largest weight of something that is not listed.
const AT_ODDS: f64 = 2.0 / 3.0;

fn squares(sizes: &[f64]) -> f64 {
    sizes.iter().map(|size| size * size).sum()
}

struct Judge<'a> {
    searcher: Searcher<'a>,
    search: ModalSearch,
}

impl Judge<'_> {
    fn judged(mut self, features: Features) -> ModalJudgement {
        let verdict = self.verdict();
        if matches!(verdict, Verdict::Consistent | Verdict::Unexplained) {
            let exact = self.searcher.is_exact(&self.search.none);
            self.search.best = Named { names: Vec::new(), fit: self.search.none.clone(), exact };
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
        let stated = [none, best].map(nearest);
        let names = self.search.alternatives.iter().zip(&self.search.elsewhere);
        let names = names.map(|(all, elsewhere)| self.probabilities(all, elsewhere)).collect();
        let places = (0..self.search.best.names.len()).map(|index| self.places(index)).collect();
        ModalJudgement {
            verdict,
            places,
            candidates: self.searcher.candidates.to_vec(),
            names,
            free_fit: self.searcher.problem.recorded.chi2_per_dof,
            strained: self.searcher.problem.recorded.is_strained(),
            errors: [&self.search.none, &self.search.best.fit].map(error),
            states_gain: false,
            stated,
            covariance,
            features,
            search: self.search,
        }
    }

    fn verdict(&self) -> Verdict {
        let (none, best) = (&self.search.none, &self.search.best);
        let adequate = self.searcher.is_adequate(&best.fit);
        // Of a recording that no poles explain, names say nothing, but for what has changed since another one like it.
        let hopeless = self.searcher.problem.recorded.chi2_per_dof > self.searcher.settings.hopeless;
        if hopeless && !self.searcher.calibrated && !(best.names.is_empty() && adequate) {
            return Verdict::Unexplained;
        }
        // Errors of the model, or these and those of the records' gains: a channel of the wrong sign looks like gains that are off by all they are.
        let model = |fit: &ModalFit| squares(&self.searcher.problem.relative_sizes(fit));
        let all = |fit: &ModalFit| squares(&self.searcher.problem.relative_sizes_with_gains(fit));
        // Or those of the modes in the band alone, if no others grow for that: what lies above the band is the model's affair too, but not what a name is about.
        let modes = |fit: &ModalFit| squares(&self.searcher.problem.relative_sizes_of_modes(fit));
        let part = self.searcher.settings.part;
        let in_part = || {
            model(&best.fit) < part * model(none)
                || is_of_signals(&best.fit) && !self.made_up_for_by_signals(&best.fit).is_empty()
                || all(&best.fit) < part * all(none)
                || modes(&best.fit) < part * modes(none) && model(&best.fit) < model(none)
        };
        match (best.names.is_empty(), adequate) {
            (true, true) => Verdict::Consistent,
            (true, false) => Verdict::Unexplained,
            (false, true) => Verdict::Explained,
            (false, false) if in_part() => Verdict::PartlyExplained,
            (false, false) => Verdict::Unexplained,
        }
    }

    /// What is left, as multiples of what is usual, of the kinds of error in whose stead factors on channels' signals stand: those that are beyond what is usual without them,
    /// and with them no more than the lesser part. A signal has no part in natural frequencies, a gain none in what lies above the band: whatever these are wrong by, the factor may
    /// be all that the others lack. Nothing where others grow for it.
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

    /// Probabilities of the names that may stand in one effect's stead, the best one's at all of its places; the rest to one is something not listed.
    fn probabilities(&self, all: &[Named], elsewhere: &[Named]) -> Vec<(usize, f64, Hypothesis)> {
        let highest = all.iter().map(|n| n.fit.ln).fold(f64::NEG_INFINITY, f64::max);
        let own = elsewhere.first().and_then(|place| place.names.last());
        let weight = |named: &Named| {
            let other = |place: &Named| (place.fit.ln - highest).exp();
            let others = elsewhere.iter().filter(|_| named.names.last() == own).map(other);
            (named.fit.ln - highest).exp() + others.sum::<f64>()
        };
        let total = all.iter().map(weight).sum::<f64>() + self.unlisted(&self.search.best.fit);
        let of =
            |named: &Named| Some((*named.names.last()?, weight(named) / total, named.fit.hypothesis.clone()));
        all.iter().filter_map(of).collect()
    }

    /// Where along its body effect `index` of the best hypothesis may sit, each place with its share of the probability of all.
    fn places(&self, index: usize) -> Places {
        let best = &self.search.best;
        let own = self.searcher.along(best, index);
        let last = |named: &Named| named.fit.hypothesis.effect_count() - 1;
        // What the ridge about the best place leads to is no other place.
        let apart = |named: &&Named| {
            own.as_ref().is_none_or(|along| !along.holds(&named.fit.hypothesis, last(named)))
        };
        let others: Vec<(&Named, Option<Along>)> = self.search.elsewhere[index]
            .iter()
            .filter(apart)
            .map(|named| (named, self.searcher.along(named, last(named))))
            .collect();
        let ln = |named: &Named, along: &Option<Along>| match (along, &own) {
            (Some(along), Some(own)) => along.ln - own.ln,
            _ => named.fit.ln - best.fit.ln,
        };
        let total = 1.0 + others.iter().map(|(named, along)| ln(named, along).exp()).sum::<f64>();
        let elsewhere = |(named, along): &(&Named, Option<Along>)| {
            let hypothesis = &named.fit.hypothesis;
            let effect = hypothesis.effects().pop()?;
            let estimates = match along {
                Some(along) => along.estimates(hypothesis, last(named), &effect),
                None => {
                    let covariance = named.fit.covariance_at(&self.searcher.widened(&named.fit));
                    estimates(hypothesis, last(named), &effect, covariance.as_ref(), 1.0)
                }
            };
            Some(Elsewhere { estimates, share: ln(named, along).exp() / total })
        };
        Places { elsewhere: others.iter().filter_map(elsewhere).collect(), own }
    }

    /// The weight, against one for the best hypothesis, of physics that none covers: the larger the errors and departures that even the best
    /// needs, the more.
    fn unlisted(&self, best: &ModalFit) -> f64 {
        let (usual, most) = self.searcher.settings.unlisted;
        let problem = &self.searcher.problem;
        let sizes = match is_of_signals(best) {
            true => self.made_up_for_by_signals(best),
            false => problem.relative_sizes_as_stated(best),
        };
        let strain: f64 = sizes.iter().map(|s| 0.5 * (s * s - 1.0).max(0.0)).sum();
        let pull = 0.5 * (best.largest_pull().powi(2) - self.searcher.settings.adequate.1.powi(2)).max(0.0);
        // What no poles explain in the recording itself is nothing that a name could be held against.
        let untold = 0.5 * self.searcher.problem.recorded.chi2_per_dof.max(1.0).ln();
        // Several effects together imitate much, as among lines.
        let company =
            self.searcher.settings.company * best.hypothesis.effect_count().saturating_sub(1) as f64;
        (usual + company + strain + pull + untold).min(most).exp()
    }
}

impl ModalJudgement {
    /// The same with nothing stated beyond the fixture by itself.
    pub(super) fn withdrawn(&self) -> Self {
        let best = Named { names: Vec::new(), fit: self.search.none.clone(), exact: false };
        let nothing = ModalSearch {
            best,
            alternatives: Vec::new(),
            elsewhere: Vec::new(),
            without: Vec::new(),
            ..self.search.clone()
        };
        ModalJudgement {
            verdict: Verdict::Unexplained,
            names: Vec::new(),
            places: Vec::new(),
            errors: [self.errors[0]; 2],
            stated: [self.stated[0].clone(), self.stated[0].clone()],
            covariance: None,
            search: nothing,
            ..self.clone()
        }
    }

    /// The same where lines are at odds with it: stated as a part, and something that is not listed as probable as it is at the most.
    pub(crate) fn doubted(&self) -> Self {
        let names = self.names.iter().map(|all| {
            let stated: f64 = all.iter().map(|(_, probability, _)| probability).sum();
            let share = (AT_ODDS / stated.max(f64::MIN_POSITIVE)).min(1.0);
            all.iter().map(|(name, p, hypothesis)| (*name, share * p, hypothesis.clone())).collect()
        });
        ModalJudgement { verdict: Verdict::PartlyExplained, names: names.collect(), ..self.clone() }
    }

    /// Whether the modes need nothing, neither an effect nor an error of the model: what is left, if anything, only lines can show.
    pub(crate) fn needs_nothing(&self) -> bool {
        self.verdict == Verdict::Consistent && self.search.best.exact
    }

    /// Whether errors of the usual size explain the modes, with what was found or but for the lesser part.
    pub(crate) fn explains(&self) -> bool {
        self.verdict != Verdict::Unexplained
    }

    /// Whether effects explain the modes.
    pub(crate) fn names_all(&self) -> bool {
        self.verdict == Verdict::Explained
    }

    /// Whether the comparison rests on modes that may not be all there are, a free fit short of the noise or modes without a partner, or on records that
    /// are not alike, and a search by lines may do better.
    pub(crate) fn is_dubious(&self, fitter: &Fitter) -> bool {
        let alone = self.search.best.fit.standing.pairing.alone();
        // Records taken one after another, their noise told by scatter alone: an outlier among their gains passes for an error of all gains.
        let unsure = self.is_unexplained() && fitter.observation.has_scatter_for_noise();
        let told = self.free_fit <= fitter.settings.modal.hopeless;
        // Errors of gains may be of any size among modes, one channel's gain for instance, which then is held against itself.
        let gain = self.search.best.fit.evidence.sizes.gain > BEYOND_ERRORS * self.features.known.scales.gain;
        let told_otherwise = || alone != 0.0 || unsure || gain || self.is_beyond_errors(fitter);
        self.tells_little(fitter) || (told && told_otherwise())
    }

    /// Whether errors of a structure's model, however large, leave more than noise: a sensor that loads some FRFs and others not gives these other poles, which no hypothesis without it
    /// has, and names that stand for errors are no better.
    fn is_beyond_errors(&self, fitter: &Fitter) -> bool {
        let observation = fitter.observation;
        let Some(structural) = self.features.structural(observation) else { return false };
        let (_, count) = observation.chi2_from(observation.values(), structural.from);
        let degrees = count.saturating_sub(structural.unknowns).max(1) as f64;
        structural.chi2 / degrees > explained(observation, fitter.settings)
    }

    /// Whether frequencies, damping and shapes of the best hypothesis are right to the noise, and gains of records are not known to be wrong: lines know of none.
    pub(crate) fn has_right_modes(&self) -> bool {
        self.errors[1].is_none() && !self.states_gain
    }

    /// Whether modes tell a part of the recording only.
    pub(crate) fn tells_little(&self, fitter: &Fitter) -> bool {
        let ModalSettings { free_fit, hopeless, .. } = fitter.settings.modal;
        (self.free_fit > free_fit || self.strained) && self.free_fit <= hopeless
    }

    /// Whether a free fit that needed all it may for the noise, as what relaxes or damps heavily makes it need, leaves no doubt of the names, and these explain the modes.
    pub(crate) fn stands_out(&self, fitter: &Fitter) -> bool {
        self.verdict == Verdict::Explained && self.has_no_rival(fitter)
    }

    /// Whether modes are far less probable without any of the names, at least in part explained by them, and by no others nearly as well.
    pub(crate) fn has_no_rival(&self, fitter: &Fitter) -> bool {
        let ModalSettings { free_fit, told, .. } = fitter.settings.modal;
        let best = &self.search.best;
        let alone = |index: usize| {
            let others = self.search.alternatives[index]
                .iter()
                .filter(|other| other.names.last() != Some(&best.names[index]));
            others.count() == 0 && best.fit.ln - self.search.without[index] > told
        };
        !best.names.is_empty() && self.free_fit <= free_fit && (0..best.names.len()).all(alone)
    }

    /// Whether errors of the usual size explain the modes of no hypothesis.
    pub(crate) fn is_unexplained(&self) -> bool {
        !matches!(self.verdict, Verdict::Consistent | Verdict::Explained)
    }

    /// What explains the recording without any error of the model, by its modes and down to the noise of its lines: the best of those that do. Where
    /// errors of the usual size do not explain the modes either, or these are dubious or right whatever their evidence says, lines decide alone, but more strictly.
    pub(crate) fn exact(&self, fitter: &Fitter) -> Option<Explaining> {
        let by_lines = self.is_unexplained() || self.is_dubious(fitter) || self.has_right_modes();
        // What modes tell from the best is no better on lines.
        let best = self.search.best.fit.ln;
        let close = |named: &&Named| best - named.fit.ln < fitter.settings.modal.told;
        let singles = self.search.singles.iter().take(fitter.settings.modal.tried);
        let all = singles.chain(&self.search.more).filter(close).chain([&self.search.best]);
        let odds = fitter.settings.modal.odds;
        let all: Vec<&Named> = all
            .filter(|named| by_lines || named.exact && self.search.needs_all_of(named, odds.ln()))
            .collect();
        let explaining =
            |named: &&Named| Some(Explaining { fit: fitted_to_lines(fitter, named)?, is_sure: named.exact });
        let cost = |found: &Explaining| cost(fitter, &found.fit, 1.0);
        // More effects than explain the lines are for the lines to ask for.
        (0..=fitter.settings.modal.effects).find_map(|count| {
            let of_count = all.iter().filter(|named| named.names.len() == count);
            of_count.filter_map(explaining).min_by(|a, b| cost(a).total_cmp(&cost(b)))
        })
    }

    /// What explains the modes, fitted to lines, where it leaves little more than noise there: lines show what is beside the modes of a real structure too, and need not refute what
    /// these say.
    pub(crate) fn nearly_exact(&self, fitter: &Fitter) -> Option<Explaining> {
        if !self.names_all() {
            return None;
        }
        let Named { fit, exact, .. } = &self.search.best;
        let slight = fitter.settings.modal.slight;
        let most = slight * fitter.observation.degrees() as f64;
        let on_lines = fitter.local(&fit.hypothesis, None, most)?;
        let is_near = on_lines.chi2_per_dof(fitter.observation) < slight;
        is_near.then_some(Explaining { fit: on_lines, is_sure: *exact })
    }

    /// Names that lines may be asked for where errors of the usual size do not explain the modes: the most probable by themselves, and quantities that are wrong.
    pub(crate) fn in_question(&self, fitter: &Fitter) -> Vec<Candidate> {
        if !self.is_unexplained() {
            return Vec::new();
        }
        let tried = self.search.singles.iter().take(fitter.settings.modal.tried);
        let probable: Vec<usize> = tried.flat_map(|single| single.names.clone()).collect();
        let of = |(index, candidate): (usize, &Candidate)| {
            let asked = probable.contains(&index) || candidate.kind == EffectKind::QuantityError;
            asked.then(|| candidate.clone())
        };
        self.candidates.iter().enumerate().filter_map(of).collect()
    }

    /// What was found, and the most probable effects by themselves: what a search of a part of the recording may choose from.
    pub(crate) fn known(&self, settings: &ModalSettings) -> Vec<Effect> {
        let singles = &self.search.singles;
        let least = singles.first().map_or(0.0, |first| first.fit.ln) - settings.told;
        let probable = singles.iter().take(settings.blind).filter(|single| single.fit.ln >= least);
        let singles = probable.flat_map(|single| single.fit.hypothesis.effects());
        self.search.best.fit.hypothesis.effects().into_iter().chain(singles).collect()
    }

    /// The most probable effects by themselves.
    pub(crate) fn tried(&self, count: usize) -> Vec<Tried> {
        let of = |single: &Named| {
            let ln_gain = single.fit.ln - self.search.none.ln;
            Some(Tried { effect: single.fit.hypothesis.effects().pop()?, ln_gain })
        };
        self.search.singles.iter().take(count).filter_map(of).collect()
    }

    /// The models that the comparison ended with, as stated or as they predict, on lines; `within` is the fixture refitted on lines.
    pub(crate) fn search_on(
        &self,
        observation: &Observation,
        within: &Search,
        models: &[Hypothesis; 2],
    ) -> Search {
        let on_lines = |hypothesis: &Hypothesis| Fit::at(hypothesis.clone(), observation);
        let nominal = on_lines(&within.nominal.hypothesis).unwrap_or_else(|| within.nominal.clone());
        let refitted = on_lines(&models[0]).unwrap_or_else(|| nominal.clone());
        let repaired = on_lines(&models[1]).unwrap_or_else(|| refitted.clone());
        Search { nominal, refitted, repaired, ..within.clone() }
    }

    /// Candidates that modes tell from the one effect of `hypothesis`, each fitted to them by itself, by more than `told` in ln p, or not even fitted, so far below
    /// did it start.
    pub(crate) fn told_from(
        &self,
        hypothesis: &Hypothesis,
        candidates: &[Candidate],
        told: f64,
    ) -> Vec<usize> {
        let [effect] = &hypothesis.effects()[..] else { return Vec::new() };
        let of = |named: &&Named| named.names.iter().any(|&c| candidates[c].names(effect));
        let Some(own) = self.search.singles.iter().find(of) else { return Vec::new() };
        let told = |named: &&Named| own.fit.ln - named.fit.ln > told;
        let fitted = self.search.singles.iter().filter(told).flat_map(|named| named.names.clone());
        // What is far below the best is told from what comes first, not from any other.
        let first = self.search.singles.first().is_some_and(|first| first.names == own.names);
        let far = self.search.far.iter().copied().filter(|_| first);
        fitted.chain(far).collect()
    }

    /// The findings, the strongest first.
    pub(crate) fn findings(&self, candidates: &[Candidate]) -> Vec<Finding> {
        let ([_, hypothesis], covariance) = (&self.stated, &self.covariance);
        let finding = |(index, effect): (usize, Effect)| {
            let names = self.names.get(index)?;
            let own = |candidate: usize| candidates[candidate].names(&effect);
            let other = |(c, probability, hypothesis): &(usize, f64, Hypothesis)| {
                (!own(*c)).then(|| Some((hypothesis.effects().pop()?, *probability)))?
            };
            let places = self.places.get(index)?;
            let along = places.own.as_ref().map(|along| along.estimates(hypothesis, index, &effect));
            let linear = || estimates(hypothesis, index, &effect, covariance.as_ref(), 1.0);
            Some(Finding {
                estimates: along.unwrap_or_else(linear),
                probability: names.iter().find(|(c, _, _)| own(*c)).map_or(0.0, |(_, p, _)| *p),
                alternatives: names.iter().filter_map(other).collect(),
                evidence: Evidence {
                    gain: 2.0 * (self.search.best.fit.ln - self.search.without[index]),
                    elsewhere: places.elsewhere.clone(),
                    measured: None,
                },
                effect,
            })
        };
        let mut all: Vec<Finding> =
            hypothesis.effects().into_iter().enumerate().filter_map(finding).collect();
        all.sort_by(|a, b| b.evidence.gain.total_cmp(&a.evidence.gain));
        all
    }
}
