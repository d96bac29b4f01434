//! How probable a hypothesis makes the recorded features, linear about a point.

use crate::Hypothesis;
use crate::modal::prior::Prior;
use crate::modal::problem::{Iterate, Problem};
use jointscope_model_error::{ErrorSizes, Linear, ModelEvidence, SharedFeatures};

/// ln of the mean of two densities by their logarithms: of what is one or the other, each as probable
/// beforehand.
pub(super) fn ln_of_mean(a: f64, b: f64) -> f64 {
    a.max(b) + (0.5 * (1.0 + (-(a - b).abs()).exp())).ln()
}

impl Problem<'_> {
    /// The linear model at a point and its evidence. Whether an effect's spring is damped beyond the
    /// fixture's damping nobody knows beforehand: it is as probable that it is not, and what has no dashpot
    /// pays for none.
    pub(super) fn evidence(
        &self,
        point: &Iterate,
        priors: &[Prior],
        slopes: &[Vec<f64>],
        at: (&SharedFeatures, Option<&ErrorSizes>),
    ) -> Option<(Linear, ModelEvidence)> {
        let (linear, damped) = self.evidence_within_bounds(point, priors, slopes, at)?;
        let dashpots = point.hypothesis.dashpots();
        if dashpots.is_empty() {
            return Some((linear, damped));
        }
        let mut elastic = priors.to_vec();
        dashpots.iter().for_each(|&index| elastic[index] = Prior { mean: 0.0, std: 0.0 });
        let (_, elastic) = self.evidence_within_bounds(point, &elastic, slopes, at)?;
        let likelier = if elastic.ln > damped.ln { elastic } else { damped };
        let evidence = ModelEvidence {
            ln: ln_of_mean(damped.ln, elastic.ln),
            ln_at_start: ln_of_mean(damped.ln_at_start, elastic.ln_at_start),
            sizes: likelier.sizes,
        };
        Some((linear, evidence))
    }

    /// The linear model at a point and its evidence. Of a coordinate that stopped at its bound the linear
    /// model knows no bound: a spring that would be negative does not explain what only a negative one
    /// explains. The lesser evidence counts, with such coordinates free or where they are.
    fn evidence_within_bounds(
        &self,
        point: &Iterate,
        priors: &[Prior],
        slopes: &[Vec<f64>],
        (comparison, known): (&SharedFeatures, Option<&ErrorSizes>),
    ) -> Option<(Linear, ModelEvidence)> {
        let of = |linear: Linear| {
            let evidence = linear.evidence(comparison, self.prior(), known)?;
            Some((linear, evidence))
        };
        let free = of(linear(&point.hypothesis, priors, &point.residual, slopes))?;
        let stopped = point.hypothesis.stopped();
        if stopped.is_empty() {
            return Some(free);
        }
        let mut slopes = slopes.to_vec();
        stopped.iter().for_each(|&index| slopes[index].fill(0.0));
        let mut held = of(linear(&point.hypothesis, priors, &point.residual, &slopes))?;
        let cost = |&index: &usize| {
            let prior = priors[index];
            if prior.std == 0.0 {
                return 0.0;
            }
            0.5 * ((point.hypothesis.coordinates[index] - prior.mean) / prior.std).powi(2)
        };
        let costs: f64 = stopped.iter().map(cost).sum();
        held.1.ln -= costs;
        held.1.ln_at_start -= costs;
        Some(if held.1.ln < free.1.ln { held } else { free })
    }
}

/// The linearised model, in prior standard deviations.
pub(crate) fn linear(
    hypothesis: &Hypothesis,
    priors: &[Prior],
    residual: &[f64],
    slopes: &[Vec<f64>],
) -> Linear {
    let mut difference = residual.to_vec();
    let mut scaled = Vec::with_capacity(slopes.len());
    for ((slope, prior), at) in slopes.iter().zip(priors).zip(&hypothesis.coordinates) {
        for (value, slope) in difference.iter_mut().zip(slope) {
            *value += slope * (at - prior.mean);
        }
        scaled.push(slope.iter().map(|s| s * prior.std).collect());
    }
    Linear { difference, slopes: scaled }
}
