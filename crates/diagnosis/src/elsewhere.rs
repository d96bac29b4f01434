//! Where else along a beam what was found by lines explains them as well.
//!
//! A beam that is alike at both ends has places that mirror each other: FRFs between mirrored points are the
//! same whichever of the two carries a mass.

use crate::Hypothesis;
use crate::along_body::{Abscissae, is_on_beam, place_of_last};
use crate::estimates::estimates;
use crate::finding::Elsewhere;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::search::Search;

/// Effect `index` of the repaired fit at other places of its beam, where these explain the lines nearly as
/// well beside the rest: the most probable of each place first.
pub(crate) fn elsewhere(fitter: &Fitter, search: &Search, index: usize) -> Vec<Elsewhere> {
    let repaired = &search.repaired;
    let effect = &repaired.hypothesis.effects()[index];
    let candidate = search.candidates.iter().find(|candidate| candidate.names(effect));
    let Some(along) = candidate.and_then(|candidate| Abscissae::of(candidate, effect)) else {
        return Vec::new();
    };
    if !is_on_beam(repaired.hypothesis.fixture(), effect) {
        return Vec::new();
    }
    let here = effect.value(along.at);
    let base = repaired.hypothesis.without(index);
    let inflation = repaired.inflation(fitter.observation);
    let listed = 2.0 * fitter.settings.evidence.listed * inflation;
    let moved = |place: f64| {
        let mut effect = effect.clone();
        effect.parameters[along.at].value = place;
        base.with(effect)
    };
    let others: Vec<Hypothesis> = along
        .places
        .iter()
        .filter(|place| along.are_apart(**place, here))
        .map(|place| moved(*place))
        .collect();
    let fit = |start: Hypothesis| {
        let near = fitter.global(&start)?;
        (near.objective - repaired.objective < listed).then_some(near)
    };
    let mut fits = fitter.observation.work().each(others, "other places of effects found", fit);
    fits.sort_by(|a, b| a.objective.total_cmp(&b.objective));
    let fits = along.each_once(here, fits, |fit| place_of_last(&fit.hypothesis));
    let weight = |fit: &Fit| (-0.5 * (fit.objective - repaired.objective) / inflation).exp();
    let total = 1.0 + fits.iter().map(weight).sum::<f64>();
    let of = |fit: &Fit| {
        let covariance = fitter.information(&fit.hypothesis).covariance();
        let effect = fit.hypothesis.effects().pop()?;
        let last = fit.hypothesis.effect_count() - 1;
        let widening = fit.inflation(fitter.observation).sqrt();
        let estimates = estimates(&fit.hypothesis, last, &effect, covariance.as_ref(), widening);
        Some(Elsewhere { estimates, share: weight(fit) / total })
    };
    fits.iter().filter_map(of).collect()
}
