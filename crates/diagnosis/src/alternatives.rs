//! What else could explain the same recordings, and how probable each hypothesis is.

use crate::evidence::{cost, probabilities};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::search::Search;

/// A hypothesis for a finding with its probability.
#[derive(Debug, Clone)]
pub struct Alternative {
    /// Index in the search's candidates.
    pub candidate: usize,
    /// Probability of kind, place and dof together.
    pub probability: f64,
    /// The fit with this candidate in the finding's stead.
    pub fit: Fit,
}

/// The hypotheses for effect `index` of the repaired fit, the most probable first, each fitted in the company of the other
/// effects.
pub(crate) fn alternatives(fitter: &Fitter, search: &Search, index: usize) -> Vec<Alternative> {
    fitter.watch.stage("asking what else would explain a finding");
    let repaired = &search.repaired;
    let own = &repaired.hypothesis.effects()[index];
    // Look-alikes are found from the solution's quantities: there the fixture alone does badly, and whatever serves as well takes few steps.
    let inflation = repaired.inflation(fitter.observation);
    let listed = fitter.settings.evidence.listed;
    let base = repaired.hypothesis.without(index);
    let mut fits = match fitter.observation.work().allows("look-alikes of effects found") {
        true => search.look_alikes(fitter, &base, repaired.objective + 2.0 * listed * inflation),
        false => Vec::new(),
    };
    if let Some(candidate) = search.candidates.iter().position(|c| c.names(own)) {
        fits.retain(|(c, _)| *c != candidate);
        fits.push((candidate, repaired.clone()));
    }
    let lowest = fits.iter().map(|(_, fit)| cost(fitter, fit, inflation)).fold(f64::INFINITY, f64::min);
    fits.retain(|(_, fit)| cost(fitter, fit, inflation) - lowest < listed);
    let costs: Vec<f64> = fits.iter().map(|(_, fit)| cost(fitter, fit, inflation)).collect();
    let probabilities = probabilities(fitter, repaired, &costs);
    let mut all: Vec<Alternative> = fits
        .into_iter()
        .zip(probabilities)
        .map(|((candidate, fit), probability)| Alternative { candidate, probability, fit })
        .collect();
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    all
}
