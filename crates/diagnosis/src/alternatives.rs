//! What else could explain the same recordings, and how probable each hypothesis is.

use crate::Hypothesis;
use crate::evidence::{cost, probabilities};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::penalty::parameter_penalty;
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

/// The hypotheses for effect `index` of the repaired fit, the most probable first, each fitted in the company
/// of the other effects.
pub(crate) fn alternatives(fitter: &Fitter, search: &Search, index: usize) -> Vec<Alternative> {
    fitter.watch.stage("asking what else would explain a finding");
    let repaired = &search.repaired;
    let own = &repaired.hypothesis.effects()[index];
    let inflation = repaired.inflation(fitter.observation);
    let listed = fitter.settings.evidence.listed;
    let base = repaired.hypothesis.without(index);
    // What stays above it is not listed, of one parameter though it be.
    let selection = &fitter.settings.selection;
    let penalties = parameter_penalty(selection, &base) + selection.parameter_penalty;
    let limit = inflation * (cost(fitter, repaired, inflation) + listed - penalties);
    let mut fits = match fitter.observation.work().allows("look-alikes of effects found") {
        true => match imitated(fitter, search, &base, inflation) {
            Some(imitated) => search.small_look_alikes(fitter, &imitated, limit),
            None => search.look_alikes(fitter, &base, limit),
        },
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

/// Where the quantities stand that make up for nearly all of an effect, if they do, with the noise of this
/// variance `inflation`.
fn imitated(fitter: &Fitter, search: &Search, without: &Hypothesis, inflation: f64) -> Option<Hypothesis> {
    let small = search.repaired.objective + fitter.settings.ranking.small * inflation;
    match without.effect_count() {
        0 => (search.refitted.objective < small).then(|| search.refitted.hypothesis.clone()),
        _ => fitter.local(without, None, small).filter(|fit| fit.objective < small).map(|fit| fit.hypothesis),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Watch;
    use crate::settings::Settings;
    use crate::simulated::simulated;
    use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
    use jointscope_spectra::{FrfPair, SpectralLines};

    const BLOCKS: &str = r#"{
        "bodies": {
            "A": { "mass": {"value": 1.1, "std": 0.002}, "inertia": {"value": 9.5e-4, "std": 9.5e-6}, "x_cg": -0.03 },
            "B": { "mass": {"value": 1.2, "std": 0.002}, "inertia": {"value": 9.5e-4, "std": 9.5e-6}, "x_cg": 0.095 } },
        "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0.0 }, "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.125 } },
        "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": {"value": 2e11, "std": 2e9}, "second_moment": 4e-10 } } },
        "damping": { "modal_ratios": [{"value": 0.003, "std": 0.0006}, {"value": 0.004, "std": 0.0008}] }
    }"#;

    #[test]
    fn what_quantities_nearly_make_up_for_has_the_look_alikes_of_a_search_from_afar() {
        let fixture = Fixture::from_json(BLOCKS).unwrap();
        let bracket = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.12, 0.008]);
        let truth = fixture.clone().with_physics(vec![bracket]).unwrap();
        let pairs = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(o, i)| FrfPair::transverse(o, i));
        let lines = SpectralLines::even(10.0, 5.0, 200).unwrap();
        let observation = simulated(&truth, &pairs, &lines, 1.1e-2);
        let settings = Settings::default();
        let fitter = Fitter { observation: &observation, settings: &settings, watch: Watch::default() };
        let search = Search::of(&fixture, &observation, true).unwrap();
        let repaired = &search.repaired;
        assert_eq!(repaired.hypothesis.effect_count(), 1, "{:?}", repaired.hypothesis.effects());
        let base = repaired.hypothesis.without(0);
        let without = imitated(&fitter, &search, &base, repaired.inflation(&observation)).unwrap();
        let limit = repaired.objective + settings.evidence.listed;
        let below = |fits: Vec<(usize, Fit)>| {
            let mut below: Vec<(usize, f64)> = fits
                .into_iter()
                .filter(|(_, fit)| fit.objective < limit)
                .map(|(candidate, fit)| (candidate, fit.objective))
                .collect();
            below.sort_by_key(|(candidate, _)| *candidate);
            below
        };
        let near = below(search.small_look_alikes(&fitter, &without, limit));
        let afar = below(search.look_alikes(&fitter, &base, limit));
        assert!(near.len() > 4, "{near:?}");
        let pairs = near.iter().zip(&afar);
        let alike =
            |((a, own), (b, other)): (&(usize, f64), &(usize, f64))| a == b && (own - other).abs() < 0.1;
        assert!(near.len() == afar.len() && pairs.into_iter().all(alike), "{near:?} {afar:?}");
    }
}
