//! A fixture compared with a recording by modes, or with what has changed since a baseline.

use crate::candidate::Candidate;
use crate::catalogue::{with_changed_supports, with_wrong_quantities};
use crate::fitter::Fitter;
use crate::modal::beside_lines::fitted_to_lines;
use crate::modal::changes::States;
use crate::modal::features::{Features, recorded};
use crate::modal::judge::Judge;
use crate::modal::judgement::ModalJudgement;
use crate::modal::known::Known;
use crate::modal::prior::priors;
use crate::modal::searcher::Searcher;
use crate::modal::sizes::ModelError;
use crate::{Hypothesis, ModeChange, Observation};
use jointscope_fixture::Effect;
use jointscope_model_error::{ErrorSizes, KINDS, Pairing, SizePrior};
use std::collections::BTreeSet;
use std::f64::consts::SQRT_2;

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

/// A fixture by itself, its quantities fitted to a recording's modes, and its error; `None` where there are no
/// modes to compare.
pub(crate) fn fixture_by_modes(fitter: &Fitter, nominal: &Hypothesis) -> Option<(Hypothesis, ModelError)> {
    let Fitter { observation, settings, .. } = fitter;
    let features = Features::of(observation, nominal, &settings.modal)?;
    let problem = features.problem(observation.work());
    let fit = problem.fitted(nominal, &priors(nominal, &[]))?;
    let error = problem.error(&fit, settings.modal.adequate.0);
    Some((fit.hypothesis, error))
}

impl ModalJudgement {
    /// Compares a fixture with a recording by modes; `None` where there are no modes to compare. Of a
    /// recording that lacks what is held out of another, those effects are tried that were `known` there.
    pub(crate) fn of(
        fitter: &Fitter,
        nominal: &Hypothesis,
        candidates: &[Candidate],
        known: Option<&Known>,
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

    /// The same comparison of a fixture with a recording once more, among what may stand in the stead of these
    /// effects, themselves included; `None` where there are none, or nothing is left to compare.
    pub(crate) fn among(&self, fitter: &Fitter, nominal: &Hypothesis, effects: &[Effect]) -> Option<Self> {
        let is_named = |c: usize| effects.iter().any(|effect| self.candidates[c].names(effect));
        let kept = self.names.iter().filter(|all| all.iter().any(|(c, _, _)| is_named(*c)));
        let names: BTreeSet<usize> = kept.flatten().map(|(c, _, _)| *c).collect();
        let candidates: Vec<Candidate> = names.into_iter().map(|c| self.candidates[c].clone()).collect();
        if candidates.is_empty() {
            return None;
        }
        let searcher = Searcher {
            problem: self.features.problem(fitter.observation.work()),
            candidates: &candidates,
            nominal,
            settings: &fitter.settings.modal,
            known: None,
            calibrated: false,
            suffices: &|_| false,
            watch: fitter.watch,
        };
        let search = searcher.search(searcher.fixture_alone()?);
        let judged = Judge { searcher, search }.judged(self.features.clone());
        Some(ModalJudgement { states_gain: self.states_gain, ..judged })
    }

    /// What has changed since a `baseline` of the same structure: the fixture is calibrated on it, its error
    /// there is taken off, and what differs beyond repetition is searched for, as in [`ModalJudgement::of`]
    /// among what is `known`. `None` where the two have no modes in common.
    pub(crate) fn since(
        fitter: &Fitter,
        baseline: &Observation,
        nominal: &Hypothesis,
        candidates: &[Candidate],
        known: Option<&Known>,
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
        let model = &calibrated.paired.modelled;
        let own = Pairing::of(&now, model);
        let change = now.relative_to(&before.recorded, model, [&own, &calibrated.paired.pairing])?;
        // What is stated is the error that both states share; the change has its own.
        let shared = before.known.scales;
        // Sensors sit and hammers strike beside their points in both.
        let strike = SQRT_2 * shared.strike;
        let scales = ErrorSizes { gain: shared.gain, strike, ..settings.modal.repeated };
        let features = Features::new(change, SizePrior { scales, stated: [false; KINDS] });
        let nominal = &calibrated.hypothesis;
        let candidates = with_changed_supports(candidates, nominal);
        let searcher = Searcher {
            problem: features.problem(observation.work()),
            candidates: &candidates,
            nominal,
            settings: &settings.modal,
            known,
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
