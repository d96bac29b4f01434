//! Which effects modes need that were found on lines.
//!
//! The noise of lines knows no error of the model: where a body is a little softer than rigid, or a strip's foot gives way, some effect of the list takes that
//! up, at a size that means nothing, and a χ² little above the noise asks for it. Modes tell such an imitation from what is there. If the model may be in error as models are, what is
//! there still gains 7 in ln p and more (effects hidden in lumped structures), and what imitates an error gains 3 at the most and mostly loses.

use crate::Hypothesis;
use crate::candidate::Candidate;
use crate::evidence::explains;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::modal::features::Features;
use crate::modal::fit::ModalFit;
use crate::modal::judgement::ModalJudgement;
use crate::modal::prior::priors_among;
use crate::penalty::{parameter_penalty, penalty};
use crate::search::Search;
use jointscope_fixture::{Effect, EffectKind};

/// Multiple of the usual error of gains beyond which a channel's is no error of them: one record of many that is a tenth too large is the very thing that a name says.
const BEYOND_ERRORS: f64 = 4.0;

/// Whether an effect is a gain larger than records' gains are wrong by: no error of a model is one, and to allow for errors as large would be to hold it against itself.
fn is_gain_beyond_errors(effect: &Effect, usual: f64) -> bool {
    effect.kind == EffectKind::ChannelGain && (effect.value(0) - 1.0).abs() > BEYOND_ERRORS * usual
}

/// A search on lines but for the effects that modes do not need and lines hardly miss; `None` where there are none, or modes do not tell. Modes that the comparison `by_modes` of
/// the same recording explains tell in any case, others only where errors of the usual size would do in an effect's stead.
pub(crate) fn without_imitations(
    fitter: &Fitter,
    search: &Search,
    by_modes: Option<&ModalJudgement>,
) -> Option<Search> {
    if search.repaired.hypothesis.effect_count() == 0 {
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
    if features.tells_little(settings) || explains_more_than_errors(fitter, search, features) {
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

/// Standard deviations of χ² for so many unknowns that an effect must leave less than errors of the model do.
const CERTAIN: f64 = 3.0;

/// Whether one effect brings the lines down to their noise and errors of a structure's model, however large, do not: what a filter does to a mass line, or a sensor that loads one
/// FRF and not the other, no mode tells, and no error imitates.
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
    let needed = penalty(&settings.selection, parameters, search.candidates.len());
    errors - chi2 > needed * repaired.inflation(observation)
}

/// What one effect gains in ln p on lines that modes leave out, those of a suspension, where it brings all lines down to their noise: over values that err there all by the size that suits
/// them best, without it.
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

/// The effect of a hypothesis that modes need least, by its index; `None` where each gains as much as is `needed`. That it is one name of many has been paid for on lines.
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
mod tests {
    use super::*;
    use jointscope_fixture::Place;

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
