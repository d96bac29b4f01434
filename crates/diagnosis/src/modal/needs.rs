//! Which effects modes need that were found on lines.
//!
//! The noise of lines knows no error of the model: where a body is a little softer than rigid, or a strip's
//! foot gives way, some effect of the list takes that up, at a size that means nothing, and a χ² little above
//! the noise asks for it. Modes tell such an imitation from what is there. If the model may be in error as
//! models are, what is there still gains 7 in ln p and more (effects hidden in lumped structures), and what
//! imitates an error gains 3 at the most and mostly loses.

use crate::Hypothesis;
use crate::candidate::Candidate;
use crate::evidence::explains;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::modal::features::Features;
use crate::modal::fit::ModalFit;
use crate::modal::judgement::ModalJudgement;
use crate::modal::prior::priors_among;
use crate::penalty::{needed_gain, parameter_penalty};
use crate::search::Search;
use crate::settings::modal::judgement::CERTAIN;
use crate::settings::modal::sizes::BEYOND_ERRORS;
use jointscope_fixture::{Effect, EffectKind};

/// Whether an effect is a gain larger than records' gains are wrong by: no error of a model is one, and to
/// allow for errors as large would be to hold it against itself.
fn is_gain_beyond_errors(effect: &Effect, usual: f64) -> bool {
    effect.kind == EffectKind::ChannelGain && (effect.value(0) - 1.0).abs() > BEYOND_ERRORS * usual
}

/// A search on lines but for the effects that modes do not need and lines hardly miss; `None` where there are
/// none, or modes do not tell. Modes that the comparison `by_modes` of the same recording explains tell in
/// any case, others only where errors of the usual size would do in an effect's stead.
pub(crate) fn without_imitations(
    fitter: &Fitter,
    search: &Search,
    by_modes: Option<&ModalJudgement>,
) -> Option<Search> {
    let is_exact = search.nominal.hypothesis.fixture().model_error().is_exact();
    if is_exact || search.repaired.hypothesis.effect_count() == 0 {
        return None;
    }
    // Of another law of the damping modes tell that it is there, and lines which one it is.
    if by_modes.is_some_and(ModalJudgement::needs_another_law_alone)
        && explains(fitter, &search.repaired, true)
    {
        return None;
    }
    let settings = &fitter.settings.modal;
    let anew;
    let features = match by_modes {
        Some(modal) => &modal.features,
        None => {
            anew = Features::of(fitter.observation, &search.nominal.hypothesis, settings)?;
            &anew
        }
    };
    if features.is_incomplete(settings) || explains_more_than_errors(fitter, search, features) {
        return None;
    }
    let mut repaired = search.repaired.clone();
    let of = (features, by_modes.is_some_and(ModalJudgement::explains));
    let needed = settings.odds.ln() - gain_below_modes(fitter, search, features);
    while let Some(index) = least_needed(fitter, of, (&search.candidates, needed), &repaired.hypothesis) {
        let without = repaired.hypothesis.without(index);
        let without = match without.effect_count() {
            0 => search.refitted.clone(),
            _ => fitter.local(&without, None, f64::INFINITY)?,
        };
        if without.objective > settings.slight * fitter.observation.degrees() as f64 {
            break;
        }
        repaired = without;
    }
    let fewer = repaired.hypothesis.effect_count() < search.repaired.hypothesis.effect_count();
    fewer.then(|| Search { repaired, ..search.clone() })
}

/// Whether one effect brings the lines down to their noise and errors of a structure's model, however large,
/// do not: what a filter does to a mass line, or a sensor that loads one FRF and not the other, no mode
/// tells, and no error imitates.
fn explains_more_than_errors(fitter: &Fitter, search: &Search, features: &Features) -> bool {
    let Fitter { observation, settings, .. } = *fitter;
    let repaired = &search.repaired;
    if repaired.hypothesis.effect_count() != 1 || !explains(fitter, repaired, true) {
        return false;
    }
    let Some(structural) = features.structural(observation) else { return false };
    let (chi2, _) = observation.chi2_from(&repaired.predicted, structural.from);
    // Each unknown takes one from χ² by chance.
    let unknowns = structural.unknowns as f64;
    let errors = structural.chi2 + unknowns - CERTAIN * (2.0 * unknowns).sqrt();
    let parameters = parameter_penalty(&settings.selection, &repaired.hypothesis);
    let needed = needed_gain(&settings.selection, parameters, search.candidates.len());
    errors - chi2 > needed * repaired.inflation(observation)
}

/// What one effect gains in ln p on lines that modes leave out, those of a suspension, where it brings all
/// lines down to their noise: over values that err there all by the size that suits them best, without it.
fn gain_below_modes(fitter: &Fitter, search: &Search, features: &Features) -> f64 {
    let observation = fitter.observation;
    let repaired = &search.repaired;
    if repaired.hypothesis.effect_count() != 1 || !explains(fitter, repaired, true) {
        return 0.0;
    }
    let below = |fit: &Fit| {
        let (above, counted) = observation.chi2_from(&fit.predicted, features.recorded.band.0);
        (fit.chi2 - above, (observation.degrees() - counted) as f64)
    };
    let ((without, values), (with, _)) = (below(&search.refitted), below(repaired));
    if values == 0.0 {
        return 0.0;
    }
    // ln of normal densities of variance 1 and `variance`, which is the most probable one.
    let variance = (without / values).max(1.0);
    (0.5 * (values * variance.ln() + without / variance - with)).max(0.0)
}

/// The effect of a hypothesis that modes need least, by its index; `None` where each gains as much as is
/// `needed`. That it is one name of many has been paid for on lines.
fn least_needed(
    fitter: &Fitter,
    (features, explained): (&Features, bool),
    (candidates, needed): (&[Candidate], f64),
    hypothesis: &Hypothesis,
) -> Option<usize> {
    let settings = &fitter.settings.modal;
    let problem = features.problem(fitter.observation.work());
    let fitted = |hypothesis: &Hypothesis| problem.fitted(hypothesis, &priors_among(hypothesis, candidates)?);
    let with = fitted(hypothesis)?.ln;
    let tells = |fit: &ModalFit| explained || problem.is_adequate(fit, settings.adequate);
    let gain = |index: usize| {
        let without = fitted(&hypothesis.without(index)).filter(tells)?;
        Some((index, with - without.ln))
    };
    let effects = hypothesis.effects();
    let may_imitate = |index: &usize| !is_gain_beyond_errors(&effects[*index], problem.sizes.gain);
    let gains = (0..effects.len()).filter(may_imitate).filter_map(gain);
    let (index, gain) = gains.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (gain < needed).then_some(index)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Watch;
    use crate::settings::Settings;
    use crate::simulated::simulated;
    use jointscope_fixture::{Fixture, Place};
    use jointscope_spectra::{FrfPair, SpectralLines};

    /// Two blocks on a strip, on supports of 2 to 4 Hz where these are `held`.
    fn blocks(held: bool) -> Fixture {
        let known = |value: f64| format!(r#"{{"value": {value}, "std": {}}}"#, 2e-3 * value);
        let supports = r#""supports": { "left": { "point": "1", "stiffness": 600, "damping": 1.0 }, "right": { "point": "4", "stiffness": 600, "damping": 1.0 } },"#;
        let text = format!(
            r#"{{ "bodies": {{ "A": {{ "mass": {}, "inertia": {}, "x_cg": -0.03 }}, "B": {{ "mass": {}, "inertia": {}, "x_cg": 0.095 }} }},
                 "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.125 }} }},
                 "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }}, {}
                 "damping": {{ "modal_ratios": [0.004, 0.006] }} }}"#,
            known(1.1),
            known(9.5e-4),
            known(1.2),
            known(9.9e-4),
            if held { supports } else { "" },
        );
        Fixture::from_json(&text).unwrap()
    }

    /// What is asked of the effect that is hidden in the blocks, fitted to lines: 400 of them to 1 kHz, known
    /// to 0.4 %.
    fn of_hidden<T>(effect: &Effect, held: bool, asked: impl Fn(&Fitter, &Search, &Features) -> T) -> T {
        let truth = blocks(held).with_physics(vec![effect.clone()]).unwrap();
        let pairs = [("3", "1"), ("4", "1")].map(|(o, i)| FrfPair::transverse(o, i));
        let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
        let observation = simulated(&truth, &pairs, &lines, 1.6e-5);
        let settings = Settings::default();
        let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
        let search = Search::without_effects(&fitter, &blocks(held), false).unwrap();
        let nominal = &search.nominal.hypothesis;
        let repaired = fitter.local(&nominal.with(effect.clone()), None, f64::INFINITY).unwrap();
        let features = Features::of(&observation, nominal, &settings.modal).unwrap();
        asked(&fitter, &Search { repaired, ..search }, &features)
    }

    fn high_pass(corner: f64) -> Effect {
        Effect::new(EffectKind::ChannelHighpass, Place::Response("4".into()), None, &[corner])
    }

    #[test]
    fn a_filter_does_what_no_error_of_a_structure_does_and_a_mass_does_not() {
        let mass = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.1, 0.02]);
        for (effect, expected) in [(high_pass(0.6), true), (mass, false)] {
            assert_eq!(of_hidden(&effect, false, explains_more_than_errors), expected, "{:?}", effect.kind);
        }
    }

    #[test]
    fn lines_of_a_suspension_count_for_what_modes_above_do_not_tell() {
        assert!(of_hidden(&high_pass(0.3), true, gain_below_modes) > 10.0);
        assert_eq!(
            of_hidden(&high_pass(0.3), false, gain_below_modes),
            0.0,
            "modes are compared on all lines"
        );
    }

    #[test]
    fn a_gain_of_a_tenth_is_no_error_of_gains_that_are_usually_right_to_one_hundredth() {
        let gain =
            |factor: f64| Effect::new(EffectKind::ChannelGain, Place::Reference("2".into()), None, &[factor]);
        for factor in [0.903, 1.06, -1.0] {
            assert!(is_gain_beyond_errors(&gain(factor), 0.01), "{factor}");
        }
        assert!(!is_gain_beyond_errors(&gain(1.02), 0.01));
        assert!(!is_gain_beyond_errors(&gain(0.9), 0.1), "where records are known to a tenth");
        let delay = Effect::new(EffectKind::ChannelDelay, Place::Force, None, &[1.0]);
        assert!(!is_gain_beyond_errors(&delay, 0.01));
    }
}
