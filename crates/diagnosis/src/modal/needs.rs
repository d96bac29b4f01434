//! Which effects modes need that were found on lines.
//!
//! The noise of lines knows no error of the model: where a body is a little softer than rigid, or a strip's foot gives way, some effect of the list takes that
//! up, at a size that means nothing, and a χ² little above the noise asks for it. Modes tell such an imitation from what is there. If the model may be in error as models are, what is
//! there still gains 7 in ln p and more (effects hidden in lumped structures), and what imitates an error gains 3 at the most and mostly loses.

use crate::Hypothesis;
use crate::candidate::Candidate;
use crate::fitter::Fitter;
use crate::modal::features::Features;
use crate::modal::fit::ModalFit;
use crate::modal::prior::priors;
use crate::search::Search;
use jointscope_fixture::Effect;

/// A search on lines but for the effects that modes do not need and lines hardly miss; `None` where there are none, or modes do not tell. Modes that are `explained`
/// by other names tell in any case, others only where errors of the usual size would do in an effect's stead.
pub(crate) fn without_imitations(fitter: &Fitter, search: &Search, explained: bool) -> Option<Search> {
    if search.repaired.hypothesis.effect_count() == 0 {
        return None;
    }
    let settings = &fitter.settings.modal;
    let features = Features::of(fitter.observation, &search.nominal.hypothesis, settings)?;
    if features.tells_little(settings) {
        return None;
    }
    let mut repaired = search.repaired.clone();
    let of = (&features, explained);
    while let Some(index) = least_needed(fitter, of, &search.candidates, &repaired.hypothesis) {
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

/// The effect of a hypothesis that modes need least, by its index; `None` where they need all. That it is one name of many has been paid for on lines.
fn least_needed(
    fitter: &Fitter,
    (features, explained): (&Features, bool),
    candidates: &[Candidate],
    hypothesis: &Hypothesis,
) -> Option<usize> {
    let settings = &fitter.settings.modal;
    let problem = features.problem(fitter.observation.work());
    let fitted = |hypothesis: &Hypothesis| {
        let named = |effect: &Effect| candidates.iter().find(|candidate| candidate.names(effect));
        let company: Option<Vec<&Candidate>> = hypothesis.effects().iter().map(named).collect();
        problem.fitted(hypothesis, &priors(hypothesis, &company?))
    };
    let with = fitted(hypothesis)?.ln;
    let tells = |fit: &ModalFit| explained || problem.is_adequate(fit, settings.adequate);
    let gain = |index: usize| {
        let without = fitted(&hypothesis.without(index)).filter(tells)?;
        Some((index, with - without.ln))
    };
    let gains = (0..hypothesis.effect_count()).filter_map(gain);
    let (index, gain) = gains.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (gain < settings.odds.ln()).then_some(index)
}
