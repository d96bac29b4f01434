//! How probable the recorded features are under a model, its error's sizes at their most probable.
//!
//! The parameters of a linear model are integrated out, S + J·Jᵀ; the sizes τ, whose priors are half-normal
//! with scales s, are maximised over: ln Z = max over τ of [ln N(d; 0, S(τ) + J·Jᵀ) − ½ Σ (τ/s)²]. A size
//! that is stated is taken as it is.

use crate::density::Density;
use crate::errors::{ErrorSizes, KINDS, SharedFeatures, SizePrior};
use crate::most_probable::{MostProbable, ln_prior};
use crate::settings::evidence::{
    LEAST_OF_INTERVAL, LEAST_REACH, NEXT_TO_NOTHING, REACH_OF_INTERVAL, REACH_OF_MEAN, SIZES_OF_INTERVAL,
    SIZES_OF_MEAN,
};

/// A model linearised about its parameters: recorded features less those of the model at the parameters'
/// prior means, and how the model's features move with each parameter, in prior standard deviations.
#[derive(Debug, Clone)]
pub struct Linear {
    /// Recorded less modelled, at the prior means.
    pub difference: Vec<f64>,
    /// Derivatives of the model's features by each parameter, for a prior standard deviation.
    pub slopes: Vec<Vec<f64>>,
}

/// The most probable sizes of a model's error, and the logarithm of the evidence there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelEvidence {
    /// ln p(features), nats, the sizes' prior included, without its normalisation.
    pub ln: f64,
    /// The most probable sizes, [`ErrorSizes::LEAST`] of the prior's at least.
    pub sizes: ErrorSizes,
    /// The same logarithm at the sizes that the search for these set out from.
    pub ln_at_start: f64,
}

impl Linear {
    /// ln N(difference; 0, S + J·Jᵀ), nats; `None` where that covariance is not positive definite.
    pub fn ln_density(&self, comparison: &SharedFeatures, sizes: &ErrorSizes) -> Option<f64> {
        self.density(comparison).ln(sizes)
    }

    fn density<'a>(&'a self, comparison: &'a SharedFeatures) -> Density<'a> {
        Density::of(&self.difference, &self.slopes, comparison)
    }

    /// What [`Linear::evidence`] maximises over the sizes, at these: ln of the density and of the sizes'
    /// prior, without its normalisation.
    pub fn ln_evidence_at(
        &self,
        comparison: &SharedFeatures,
        prior: impl Into<SizePrior>,
        sizes: &ErrorSizes,
    ) -> Option<f64> {
        let SizePrior { scales, stated } = prior.into();
        Some(self.ln_density(comparison, sizes)? + ln_prior(&sizes.to_array(), &scales.to_array(), &stated))
    }

    /// Root mean squares of each size over its posterior, the others at their most probable: with few modes a
    /// size may well be larger than the most probable one, and intervals must know it.
    pub fn mean_sizes(
        &self,
        comparison: &SharedFeatures,
        prior: impl Into<SizePrior>,
        best: &ModelEvidence,
    ) -> ErrorSizes {
        let SizePrior { scales, stated } = prior.into();
        let (prior, at) = (scales.to_array(), best.sizes.to_array());
        let mut density = self.density(comparison);
        let mut mean = |kind: usize| {
            if stated[kind] {
                return at[kind];
            }
            let (mut total, mut squares) = (0.0, 0.0);
            let widest = (LEAST_REACH * prior[kind]).max(REACH_OF_MEAN * at[kind]);
            for k in 0..SIZES_OF_MEAN {
                let size = widest * (k as f64 + 0.5) / SIZES_OF_MEAN as f64;
                let mut sizes = at;
                sizes[kind] = size;
                let Some(density) = density.ln(&ErrorSizes::from_array(sizes)) else { continue };
                let weight = (density + ln_prior(&sizes, &prior, &stated) - best.ln).min(50.0).exp();
                total += weight;
                squares += weight * size * size;
            }
            if total > 0.0 { (squares / total).sqrt() } else { at[kind] }
        };
        ErrorSizes::from_array(std::array::from_fn(&mut mean))
    }

    /// The interval that holds a size of this kind, by its place in [`ErrorSizes`], with a probability of
    /// 95 %, the others at their most probable. It starts at zero where the most probable size is next to
    /// nothing.
    pub fn size_interval(
        &self,
        comparison: &SharedFeatures,
        prior: impl Into<SizePrior>,
        best: &ModelEvidence,
        kind: usize,
    ) -> [f64; 2] {
        let SizePrior { scales, stated } = prior.into();
        let (prior, at) = (scales.to_array(), best.sizes.to_array());
        if stated[kind] {
            return [at[kind]; 2];
        }
        let mut density = self.density(comparison);
        let low = LEAST_OF_INTERVAL * prior[kind];
        let high = (LEAST_REACH * prior[kind]).max(REACH_OF_INTERVAL * at[kind]);
        let size = |k: usize| low * (high / low).powf(k as f64 / (SIZES_OF_INTERVAL - 1) as f64);
        let mut weight = |size: f64| {
            let mut sizes = at;
            sizes[kind] = size;
            let density = density.ln(&ErrorSizes::from_array(sizes));
            density.map_or(0.0, |d| (d + ln_prior(&sizes, &prior, &stated) - best.ln).min(50.0).exp())
        };
        // Below the first size the density is that at none.
        let mut ends = vec![(0.0, 0.0)];
        let (mut before, mut total) = ((0.0, weight(low)), 0.0);
        for k in 0..SIZES_OF_INTERVAL {
            let at = (size(k), weight(size(k)));
            total += 0.5 * (at.0 - before.0) * (at.1 + before.1);
            ends.push((at.0, total));
            before = at;
        }
        let quantile = |share: f64| {
            let found = ends.windows(2).find(|pair| pair[1].1 >= share * total);
            found.map_or(at[kind], |pair| {
                let [(a, below), (b, above)] = [pair[0], pair[1]];
                let part = (share * total - below) / (above - below).max(f64::MIN_POSITIVE);
                a + (b - a) * part.clamp(0.0, 1.0)
            })
        };
        match at[kind] > NEXT_TO_NOTHING * prior[kind] {
            true => [quantile(0.025).min(at[kind]), quantile(0.975).max(at[kind])],
            false => [0.0, quantile(0.95)],
        }
    }

    /// The evidence at the most probable sizes, whose priors have the scales `prior`; searched from `start`,
    /// or over five decades of each. What is stated stays.
    pub fn evidence(
        &self,
        comparison: &SharedFeatures,
        prior: impl Into<SizePrior>,
        start: Option<&ErrorSizes>,
    ) -> Option<ModelEvidence> {
        let prior = prior.into();
        let mut density = self.density(comparison);
        let scales = prior.scales.to_array();
        let is_cold = start.is_none();
        let start = start.map_or(scales, |sizes| sizes.to_array());
        let from: [f64; KINDS] =
            std::array::from_fn(|kind| if prior.stated[kind] { scales[kind] } else { start[kind] });
        let mut search = MostProbable::about(&mut density, prior, from);
        let ln_at_start = search.ln;
        if is_cold {
            search.over_decades();
        }
        search.climb();
        let sizes = ErrorSizes::from_array(search.sizes);
        search.ln.is_finite().then_some(ModelEvidence { ln: search.ln, sizes, ln_at_start })
    }
}
