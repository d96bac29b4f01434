//! What else could explain the same recordings, and how probable each name is.

use crate::fit::Fit;
use crate::search::{Search, parameter_price};
use crate::{Hypothesis, Observation};

/// Names farther in cost from the best than this are not listed.
const LISTED: f64 = 16.0;
/// Cost, above the best name's, of physics that no name covers: a few in a hundred where the fit is good.
const UNLISTED: f64 = 7.0;
/// How much nearer that is for every further effect: several effects at once are rare, and with a pair of names much can be imitated.
const COMPANY: f64 = 3.2;

/// Probability that a finding and its look-alikes must have together for it to be named.
pub(crate) const NAMED: f64 = 0.5;

/// A name for a finding with its probability.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// Index in the search's candidates.
    pub candidate: usize,
    /// Probability of kind, place and dof together.
    pub probability: f64,
    /// The fit with this name in the finding's stead.
    pub fit: Fit,
}

/// Minus twice the logarithm of the evidence, up to a constant: χ² and priors, scaled by what χ² per degree of freedom
/// exceeds one, and a price for every parameter.
fn cost(fit: &Fit, scale: f64) -> f64 {
    fit.objective / scale + parameter_price(&fit.hypothesis)
}

/// Standard deviations by which χ² per degree of freedom exceeds one, the relative uncertainty of the noise's variances included.
pub(crate) fn excess(chi2_per_dof: f64, degrees: usize, noise_uncertainty: f64) -> f64 {
    (chi2_per_dof - 1.0) / (2.0 / degrees.max(1) as f64).sqrt().hypot(noise_uncertainty)
}

/// The weight, against one for the best name, of physics that no name covers: the worse the best fit is, the likelier it is that no name is
/// right.
fn unlisted(repaired: &Fit, observation: &Observation) -> f64 {
    let strain =
        excess(repaired.chi2_per_dof(observation), observation.degrees(), observation.noise_uncertainty())
            .max(0.0);
    let company = repaired.hypothesis.effect_count().saturating_sub(1) as f64;
    (-0.5 * (UNLISTED - COMPANY * company - strain * strain).max(-10.0)).exp()
}

/// Whether what the repaired fit leaves is so much that nothing can be named: not even if all its look-alikes were as good as the best. That
/// is known without a fit of any of them.
pub(crate) fn is_beyond_names(search: &Search, observation: &Observation) -> bool {
    let names = search.candidates.len() as f64 + 1.0;
    names / (names + unlisted(&search.repaired, observation)) < NAMED
}

/// The names for effect `index` of the repaired fit, the most probable first. Each is fitted in the company of the other
/// effects. The probabilities sum to less than one: the rest is something not listed.
pub fn alternatives(search: &Search, index: usize, observation: &Observation) -> Vec<Alternative> {
    let repaired = &search.repaired;
    let own = &repaired.hypothesis.effects()[index];
    // Look-alikes are found from the solution's quantities: there the fixture alone does badly, and whatever serves as well takes few steps.
    let scale = repaired.scale(observation);
    let near = repaired.hypothesis.without(index);
    let mut fits = search.look_alikes(&near, repaired.objective + 2.0 * LISTED * scale, observation);
    if let Some(candidate) = search.candidates.iter().position(|c| c.names(own)) {
        fits.retain(|(c, _)| *c != candidate);
        fits.push((candidate, repaired.clone()));
    }
    let lowest = fits.iter().map(|(_, fit)| cost(fit, scale)).fold(f64::INFINITY, f64::min);
    fits.retain(|(_, fit)| cost(fit, scale) - lowest < LISTED);
    let weight = |fit: &Fit| (-0.5 * (cost(fit, scale) - lowest)).exp();
    let unlisted = unlisted(repaired, observation);
    let total: f64 = fits.iter().map(|(_, fit)| weight(fit)).sum::<f64>() + unlisted;
    let mut all: Vec<Alternative> = fits
        .into_iter()
        .map(|(candidate, fit)| Alternative { candidate, probability: weight(&fit) / total, fit })
        .collect();
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    all
}

/// Whether two hypotheses have the same kinds of effects at the same places.
pub(crate) fn same_names(a: &Hypothesis, b: &Hypothesis) -> bool {
    let names = |h: &Hypothesis| {
        let mut all: Vec<_> = h.effects().into_iter().map(|e| (e.kind, e.place, e.dof)).collect();
        all.sort();
        all
    };
    names(a) == names(b)
}
