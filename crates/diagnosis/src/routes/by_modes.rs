//! The diagnosis where the model's own error decides.

use super::parts::{Given, Parts};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::held_out::{Division, JUDGEMENT_STEP};
use crate::location::{LOCATION_STEP, Location, located};
use crate::modal::{Known, ModalJudgement, ModelError};
use crate::search::Search;
use crate::settings::modal::judgement::AS_WELL_WITHOUT;
use crate::settings::work::shares::OF_HELD_OUT;
use jointscope_findings::{HeldOut, Verdict};

/// The diagnosis where the model's own error decides. `on_lines` is what lines made of the recording: the
/// fixture refitted, or a search.
pub(super) fn by_modes(given: Given, on_lines: &Search, modal: &ModalJudgement) -> Parts {
    judged_by_modes(given, on_lines, modal, &|part, known| {
        ModalJudgement::of(part, &on_lines.nominal.hypothesis, &on_lines.candidates, Some(known))
    })
}

/// The same; `without` compares a part of the recording by modes, among what is known of the whole.
pub(super) fn judged_by_modes(
    given: Given,
    on_lines: &Search,
    modal: &ModalJudgement,
    without: &dyn Fn(&Fitter, &Known) -> Option<ModalJudgement>,
) -> Parts {
    let work = given.fitter.observation.work();
    let (modal, search) = telling_of_lines(given.fitter, on_lines, modal);
    let division = given.division.filter(|_| work.allows(JUDGEMENT_STEP));
    let held_out = division.and_then(|division| {
        let judged = || judged_on_held_out(given, division, on_lines, &modal, &search, without);
        work.within_rest(OF_HELD_OUT, judged)
    });
    let locations = places_of_what_is_left(given, &modal, &search);
    Parts {
        verdict: modal.verdict,
        findings: modal.findings(&modal.candidates),
        locations,
        held_out,
        search,
        stated: Some(modal.stated.clone()),
        model_error: Some(modal.errors),
        baseline_error: None,
        baseline: None,
        tried: modal.tried(),
    }
}

/// The comparison by modes, and its models on lines, all of whose names these miss where they are left out:
/// what does nothing to the lines stands for an error of features, a gain among them. What a calibrated model
/// is off by in both states decides nothing on lines.
fn telling_of_lines(fitter: &Fitter, on_lines: &Search, modal: &ModalJudgement) -> (ModalJudgement, Search) {
    let (mut modal, mut search) = modal.predicted(fitter, on_lines);
    if modal.since_baseline {
        return (modal, search);
    }
    while let Some(index) = idlest(fitter, &search.repaired, &modal.errors[1]) {
        let mut needed = search.repaired.hypothesis.effects();
        needed.remove(index);
        (modal, search) = match modal.among(fitter, &on_lines.nominal.hypothesis, &needed) {
            Some(again) => again.predicted(fitter, on_lines),
            None => {
                let none = Search { repaired: search.refitted.clone(), ..search };
                return (modal.withdrawn(), none);
            }
        };
    }
    (modal, search)
}

/// The effect of a model, by its index, that its lines miss least, where they are met as well without it, beside
/// what `errors` of its modes make of them.
fn idlest(fitter: &Fitter, repaired: &Fit, errors: &ModelError) -> Option<usize> {
    let hypothesis = &repaired.hypothesis;
    let lines = errors.beside_lines(fitter.observation, &repaired.predicted);
    let chi2 = |fit: &Fit| lines.chi2(&fit.predicted);
    let without =
        |index: usize| Some((index, chi2(&Fit::at(hypothesis.without(index), fitter.observation)?)));
    let missed = (0..hypothesis.effect_count()).filter_map(without);
    let (index, without) = missed.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (without < AS_WELL_WITHOUT * chi2(repaired)).then_some(index)
}

/// How well what modes tell of the recording without what is held out predicts that. `search` is what was
/// found in the whole.
fn judged_on_held_out(
    given: Given,
    division: &Division,
    on_lines: &Search,
    modal: &ModalJudgement,
    search: &Search,
    without: &dyn Fn(&Fitter, &Known) -> Option<ModalJudgement>,
) -> Option<HeldOut> {
    let fitter = given.fitter;
    fitter.watch.stage("comparing by modes without what is held out");
    let blind = fitter.on(&division.seen);
    // Of what names nothing, only the refitted fixture is judged.
    let named = search.repaired.hypothesis.effect_count() > 0;
    let names = if named { modal.known(&fitter.settings.modal) } else { Known::default() };
    let (_, blind) = without(&blind, &names)?.predicted(&blind, on_lines);
    division.judge(&blind, search, fitter.observation)
}

/// The places of what modes do not explain.
fn places_of_what_is_left(given: Given, modal: &ModalJudgement, search: &Search) -> Vec<Location> {
    let observation = given.fitter.observation;
    if modal.verdict != Verdict::Unexplained || !observation.work().allows(LOCATION_STEP) {
        return Vec::new();
    }
    let refitted = Fit::at(modal.stated[0].clone(), observation);
    located(*given.fitter, &search.nominal.hypothesis, refitted.as_ref().unwrap_or(&search.refitted))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use crate::simulated::simulated;
    use crate::{Hypothesis, Watch};
    use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
    use jointscope_spectra::{FrfPair, SpectralLines};

    const BLOCKS: &str = r#"{ "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 } },
         "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.125 } },
         "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } },
         "damping": { "modal_ratios": [0.004, 0.006] } }"#;

    #[test]
    fn a_name_without_which_lines_are_met_as_well_is_idle() {
        let fixture = Fixture::from_json(BLOCKS).unwrap();
        let mass = |grams: f64| {
            Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 1e-3 * grams])
        };
        let gain =
            |factor: f64| Effect::new(EffectKind::ChannelGain, Place::Response("4".into()), None, &[factor]);
        let pairs = [FrfPair::transverse("3", "1"), FrfPair::transverse("4", "1")];
        let lines = SpectralLines::even(20.0, 2.5, 380).unwrap();
        let truth = fixture.clone().with_physics(vec![mass(20.0)]).unwrap();
        let observation = simulated(&truth, &pairs, &lines, 1e-6);
        let settings = Settings::default();
        let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
        let nominal = Hypothesis::nominal(&fixture, false);
        for (effects, expected) in [
            (vec![mass(18.0)], None),
            (vec![mass(1e-4)], Some(0)),
            (vec![mass(19.9), gain(0.9999)], Some(1)),
            (vec![gain(1.3), mass(18.0)], Some(0)),
        ] {
            let with = effects.iter().fold(nominal.clone(), |rest, effect| rest.with(effect.clone()));
            let repaired = Fit::at(with, &observation).unwrap();
            assert_eq!(idlest(&fitter, &repaired, &ModelError::default()), expected, "{effects:?}");
        }
    }

    #[test]
    fn a_gain_is_not_idle_because_peaks_of_a_wrong_model_miss_each_other() {
        // The smaller a peak is that misses another one, the nearer the two are.
        let fixture =
            |modulus: f64| Fixture::from_json(&BLOCKS.replace("2.07e11", &format!("{modulus}"))).unwrap();
        let gain = Effect::new(EffectKind::ChannelGain, Place::Response("4".into()), None, &[1.08]);
        let pairs = [FrfPair::transverse("3", "1"), FrfPair::transverse("4", "1")];
        let lines = SpectralLines::even(20.0, 1.0, 950).unwrap();
        let truth = fixture(2.07e11).with_physics(vec![gain.clone()]).unwrap();
        let observation = simulated(&truth, &pairs, &lines, 1e-6);
        let settings = Settings::default();
        let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
        // Natural frequencies are off by a per cent.
        let wrong = Hypothesis::nominal(&fixture(2.028e11), false);
        let idlest_of = |effect: Effect, error: f64| {
            let errors = ModelError { frequency: error, residue: 0.5 * error, ..ModelError::default() };
            idlest(&fitter, &Fit::at(wrong.with(effect), &observation).unwrap(), &errors)
        };
        assert_eq!(idlest_of(gain.clone(), 0.0), Some(0), "by their noise lines are nearer without it");
        assert_eq!(idlest_of(gain, 0.01), None);
        let nothing = Effect::new(EffectKind::ChannelGain, Place::Response("4".into()), None, &[1.0 + 1e-5]);
        assert_eq!(idlest_of(nothing, 0.01), Some(0));
    }
}
