//! How probable it is that a hypothesis is right, against others and against physics that none covers.

use crate::departures::has_departed;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::observation::excess;
use crate::penalty::parameter_penalty;
use crate::settings::Settings;
use crate::settings::evidence::strictly::{MOST_EXCESS, UNCERTAINTY_SHARE};
use crate::settings::evidence::unlisted::MOST_UNLISTED;
use crate::{Hypothesis, Observation};

/// χ² per degree of freedom up to which a fit leaves no more than noise.
pub(crate) fn explained(observation: &Observation, settings: &Settings) -> f64 {
    let (coherence, scatter) = settings.evidence.explained;
    if observation.has_scatter_for_noise() { scatter } else { coherence }
}

/// Whether a hypothesis' quantities lie no farther from what is stated than chance takes them.
pub(crate) fn deviates_by_chance(fitter: &Fitter, hypothesis: &Hypothesis) -> bool {
    let quantities = hypothesis.tolerances().len() as f64;
    hypothesis.squared_departures_of_quantities()
        <= quantities + fitter.settings.selection.deviated * (2.0 * quantities).sqrt()
}

/// Minus twice the logarithm of the evidence, up to a constant: χ² and priors, divided by the variance
/// `inflation`, and a penalty for every parameter.
pub(crate) fn cost(fitter: &Fitter, fit: &Fit, inflation: f64) -> f64 {
    fit.objective / inflation + parameter_penalty(&fitter.settings.selection, &fit.hypothesis)
}

/// The weight, against one for the best hypothesis, of physics that none covers: the worse the best fit is,
/// the likelier it is that none is right.
fn unlisted(fitter: &Fitter, best: &Fit) -> f64 {
    let Fitter { observation, settings, .. } = fitter;
    let chi2_per_dof = best.chi2_per_dof(observation);
    let misfit = observation.excess(chi2_per_dof).max(0.0);
    let company = best.hypothesis.effect_count().saturating_sub(1) as f64;
    let cost = settings.evidence.unlisted - settings.evidence.company * company - misfit * misfit;
    (-0.5 * cost.max(-2.0 * MOST_UNLISTED)).exp()
}

/// The probabilities of hypotheses of these costs, of which `best` is one. They sum to less than one: the
/// rest is something not listed.
pub(crate) fn probabilities(fitter: &Fitter, best: &Fit, costs: &[f64]) -> Vec<f64> {
    let lowest = costs.iter().copied().fold(f64::INFINITY, f64::min);
    let weight = |cost: &f64| (-0.5 * (cost - lowest)).exp();
    let total = costs.iter().map(weight).sum::<f64>() + unlisted(fitter, best);
    costs.iter().map(|cost| weight(cost) / total).collect()
}

/// Whether what the best fit leaves is so much that nothing can be stated: not even if all of `candidates`
/// were as good as the best. That is known without a fit of any of them.
pub(crate) fn nothing_can_be_stated(fitter: &Fitter, best: &Fit, candidates: usize) -> bool {
    let hypotheses = candidates as f64 + 1.0;
    hypotheses / (hypotheses + unlisted(fitter, best)) < fitter.settings.evidence.stated
}

/// Whether a fit leaves no more than noise, its quantities no farther than chance; `strictly` not a tenth of
/// the noise more.
pub(crate) fn explains(fitter: &Fitter, fit: &Fit, strictly: bool) -> bool {
    let observation = fitter.observation;
    let chi2_per_dof = fit.chi2_per_dof(observation);
    let fits = match strictly && !observation.has_scatter_for_noise() {
        true => {
            excess(chi2_per_dof, observation.degrees(), UNCERTAINTY_SHARE * observation.noise_uncertainty())
                < MOST_EXCESS
        }
        false => chi2_per_dof < explained(fitter.observation, fitter.settings),
    };
    fits && deviates_by_chance(fitter, &fit.hypothesis)
}

/// Whether a fit may still lack something large; what fits already can only lack something small, which
/// the local search finds.
pub(crate) fn lacks_much(fitter: &Fitter, fit: &Fit) -> bool {
    let (observation, settings) = (fitter.observation, &fitter.settings.selection);
    let degrees = observation.degrees() as f64;
    // With effects the noise's own uncertainty counts too: what they leave may be no more than that.
    let (fits, noise) = match fit.hypothesis.effect_count() {
        0 => (settings.fits.0, 0.0),
        _ => (settings.fits.1, observation.noise_uncertainty()),
    };
    // Quantities that had to deviate are a misfit too, which a χ² that is small by chance must not hide.
    fit.objective > degrees * (1.0 + fits * (2.0 / degrees).sqrt().hypot(noise))
        || !deviates_by_chance(fitter, &fit.hypothesis)
        || has_departed(&fit.hypothesis)
}
