//! How probable the recorded features are under a model, its error's sizes at their most probable.
//!
//! The parameters of a linear model are integrated out, S + J·Jᵀ; the sizes τ, whose priors are half-normal with scales s, are maximised over:
//! ln Z = max over τ of [ln N(d; 0, S(τ) + J·Jᵀ) − ½ Σ (τ/s)²]. A size that is stated is taken as it is.

use crate::errors::{Comparison, ErrorSizes, GAIN, KINDS, SizePrior};
use crate::settings::evidence::{
    COARSE_SIZES, COARSE_SWEEPS, LEAST_OF_INTERVAL, LEAST_REACH, MOST_STEPS, NEXT_TO_NOTHING,
    REACH_OF_INTERVAL, REACH_OF_MEAN, REFINEMENTS, SIZES_OF_INTERVAL, SIZES_OF_MEAN,
};
use jointscope_linalg::Cholesky;
use std::f64::consts::TAU;

/// A model linearised about its parameters: recorded features less those of the model at the parameters' prior means, and how the model's
/// features move with each parameter, in prior standard deviations.
#[derive(Debug, Clone)]
pub struct Linear {
    /// Recorded less modelled, at the prior means.
    pub difference: Vec<f64>,
    /// Derivatives of the model's features by each parameter, for a prior standard deviation.
    pub slopes: Vec<Vec<f64>>,
}

/// The most probable sizes of a model's error, and the logarithm of the evidence there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// ln p(features), nats, the sizes' prior included, without its normalisation.
    pub ln: f64,
    /// The most probable sizes, [`ErrorSizes::LEAST`] of the prior's at least.
    pub sizes: ErrorSizes,
    /// The same logarithm at the sizes that the search for these set out from.
    pub ln_at_start: f64,
}

impl Linear {
    /// ln N(difference; 0, S + J·Jᵀ), nats; `None` where that covariance is not positive definite.
    pub fn ln_density(&self, comparison: &Comparison, sizes: &ErrorSizes) -> Option<f64> {
        Density::of(self, comparison).ln(sizes)
    }

    /// Root mean squares of each size over its posterior, the others at their most probable: with few modes a size may well be larger than the
    /// most probable one, and intervals must know it.
    pub fn mean_sizes(
        &self,
        comparison: &Comparison,
        prior: impl Into<SizePrior>,
        best: &Evidence,
    ) -> ErrorSizes {
        let SizePrior { scales, stated } = prior.into();
        let (prior, at) = (scales.to_array(), best.sizes.to_array());
        let mut density = Density::of(self, comparison);
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

    /// The interval that holds a size of this kind, by its place in [`ErrorSizes`], with a probability of 95 %, the others at their most probable. It starts at zero where the
    /// most probable size is next to nothing.
    pub fn size_interval(
        &self,
        comparison: &Comparison,
        prior: impl Into<SizePrior>,
        best: &Evidence,
        kind: usize,
    ) -> [f64; 2] {
        let SizePrior { scales, stated } = prior.into();
        let (prior, at) = (scales.to_array(), best.sizes.to_array());
        if stated[kind] {
            return [at[kind]; 2];
        }
        let mut density = Density::of(self, comparison);
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

    /// The evidence at the most probable sizes, whose priors have the scales `prior`; searched from `start`, or over five decades of each. What is stated stays.
    pub fn evidence(
        &self,
        comparison: &Comparison,
        prior: impl Into<SizePrior>,
        start: Option<&ErrorSizes>,
    ) -> Option<Evidence> {
        let SizePrior { scales, stated } = prior.into();
        let prior = scales.to_array();
        let free = (0..KINDS).filter(|kind| !stated[*kind]);
        let mut density = Density::of(self, comparison);
        let mut value = |sizes: &[f64; KINDS]| -> f64 {
            let density = density.ln(&ErrorSizes::from_array(*sizes));
            density.map_or(f64::NEG_INFINITY, |density| density + ln_prior(sizes, &prior, &stated))
        };
        let start_at = start.map_or(prior, |sizes| sizes.to_array());
        let mut best: [f64; KINDS] =
            std::array::from_fn(|kind| if stated[kind] { prior[kind] } else { start_at[kind] });
        let mut ln = value(&best);
        let ln_at_start = ln;
        let mut try_size = |best: &mut [f64; KINDS], ln: &mut f64, kind: usize, size: f64| {
            let size = size.max(ErrorSizes::LEAST * prior[kind]);
            if size == best[kind] {
                return false;
            }
            let mut other = *best;
            other[kind] = size;
            let found = value(&other);
            let better = found > *ln;
            if better {
                (*best, *ln) = (other, found);
            }
            better
        };
        if start.is_none() {
            for _ in 0..COARSE_SWEEPS {
                for kind in free.clone() {
                    for times in COARSE_SIZES {
                        try_size(&mut best, &mut ln, kind, times * prior[kind]);
                    }
                }
            }
        }
        for factor in REFINEMENTS {
            for kind in free.clone() {
                for step in [factor, 1.0 / factor] {
                    let mut left = MOST_STEPS;
                    while left > 0 && best[kind] > ErrorSizes::LEAST * prior[kind] * 0.999 {
                        let size = best[kind] * step;
                        if !try_size(&mut best, &mut ln, kind, size) {
                            break;
                        }
                        left -= 1;
                    }
                }
            }
        }
        ln.is_finite().then(|| Evidence { ln, sizes: ErrorSizes::from_array(best), ln_at_start })
    }
}

/// ln of the sizes' prior but for its normalisation: half-normal, and half-Cauchy for gains, of which a test may have any.
fn ln_prior(sizes: &[f64; KINDS], scales: &[f64; KINDS], stated: &[bool; KINDS]) -> f64 {
    let of = |kind: usize| {
        let squared = (sizes[kind] / scales[kind]).powi(2);
        if kind == GAIN { -(1.0 + squared).ln() } else { -0.5 * squared }
    };
    (0..KINDS).filter(|kind| !stated[*kind]).map(of).sum()
}

/// The density at many sizes of the error: what does not depend on them is formed once.
struct Density<'a> {
    comparison: &'a Comparison,
    difference: &'a [f64],
    /// Noise and J·Jᵀ, lower triangle.
    fixed: Vec<f64>,
    covariance: Vec<f64>,
    factor: Cholesky,
    white: Vec<f64>,
}

impl<'a> Density<'a> {
    fn of(linear: &'a Linear, comparison: &'a Comparison) -> Self {
        let n = comparison.count();
        let mut fixed = comparison.noise.to_vec();
        for slope in &linear.slopes {
            for i in 0..n {
                let a = slope[i];
                if a != 0.0 {
                    fixed[i * n..=i * n + i].iter_mut().zip(slope).for_each(|(entry, b)| *entry += a * b);
                }
            }
        }
        let covariance = vec![0.0; n * n];
        let (factor, white) = (Cholesky::identity(n), vec![0.0; n]);
        Density { comparison, difference: &linear.difference, fixed, covariance, factor, white }
    }

    fn ln(&mut self, sizes: &ErrorSizes) -> Option<f64> {
        self.covariance.copy_from_slice(&self.fixed);
        self.comparison.add_errors(sizes, &mut self.covariance);
        let factor = self.factor.anew(&self.covariance)?;
        self.white.copy_from_slice(self.difference);
        factor.solve_lower_in_place(&mut self.white);
        let chi2: f64 = self.white.iter().map(|v| v * v).sum();
        Some(-0.5 * (chi2 + factor.ln_determinant() + self.white.len() as f64 * TAU.ln()))
    }
}
