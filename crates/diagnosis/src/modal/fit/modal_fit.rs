//! What a fit of one hypothesis ends with, and what it says of itself.

use crate::Hypothesis;
use crate::modal::evidence::ln_of_mean;
use crate::modal::prior::Prior;
use crate::modal::problem::PairedModes;
use crate::settings::modal::fit::BY_CHANCE;
use jointscope_fixture::Entry;
use jointscope_inference::{Covariance, dot};
use jointscope_linalg::Cholesky;
use jointscope_model_error::{ErrorSizes, Linear, ModelEvidence};

/// A hypothesis at its most probable parameters.
#[derive(Debug, Clone)]
pub(crate) struct ModalFit {
    pub hypothesis: Hypothesis,
    pub priors: Vec<Prior>,
    pub paired: PairedModes,
    pub linear: Linear,
    pub evidence: ModelEvidence,
    /// Derivatives of the model's features by each coordinate, for a step of one.
    pub slopes: Vec<Vec<f64>>,
    /// Recorded less modelled features.
    pub residual: Vec<f64>,
    /// ln of the evidence, modes without a partner included.
    pub ln: f64,
}

impl ModalFit {
    /// The largest departure of the fixture's quantities, in standard deviations.
    pub(crate) fn largest_departure(&self) -> f64 {
        let departures = self.hypothesis.coordinates.iter().zip(&self.priors);
        let departures = departures.take(self.hypothesis.tolerances().len());
        departures.map(|(at, prior)| ((at - prior.mean) / prior.std).abs()).fold(0.0, f64::max)
    }

    /// Whether all that it adds to the fixture are factors on channels' signals.
    pub(crate) fn is_of_signals(&self) -> bool {
        let effects = self.hypothesis.effects();
        !effects.is_empty() && effects.iter().all(|effect| effect.kind.spec().entry == Entry::Signal)
    }

    /// Whether the features' misfit, errors of the model at their sizes and departures counted, is no larger
    /// than chance makes it.
    pub(crate) fn leaves_chance(&self) -> bool {
        let comparison = &self.paired.comparison;
        let Some(factor) = Cholesky::of(comparison.count(), &comparison.covariance(&self.evidence.sizes))
        else {
            return false;
        };
        let mut white = self.residual.clone();
        factor.solve_lower_in_place(&mut white);
        let degrees = comparison.count() as f64;
        dot(&white, &white) < degrees + BY_CHANCE * (2.0 * degrees).sqrt()
    }

    /// Covariance of the coordinates of the linear model where an error has these sizes.
    pub(crate) fn covariance_at(&self, sizes: &ErrorSizes) -> Option<Covariance> {
        let comparison = &self.paired.comparison;
        let factor = Cholesky::of(comparison.count(), &comparison.covariance(sizes))?;
        let white = |slope: &Vec<f64>| {
            let mut white = slope.clone();
            factor.solve_lower_in_place(&mut white);
            white
        };
        let white: Vec<Vec<f64>> = self.linear.slopes.iter().map(white).collect();
        let order = white.len();
        let entry = |e: usize| {
            let own = if e / order == e % order { 1.0 } else { 0.0 };
            own + dot(&white[e / order], &white[e % order])
        };
        let information: Vec<f64> = (0..order * order).map(entry).collect();
        let mut entries = Cholesky::of(order, &information)?.inverse();
        for (e, entry) in entries.iter_mut().enumerate() {
            *entry *= self.priors[e / order].std * self.priors[e % order].std;
        }
        Some(Covariance::new(order, entries))
    }
}

/// The more probable of two fits, as far as there are any.
pub(super) fn more_probable(a: Option<ModalFit>, b: Option<ModalFit>) -> Option<ModalFit> {
    a.into_iter().chain(b).reduce(|best, fit| if fit.ln > best.ln { fit } else { best })
}

/// What two fits come to of which one or the other is so, each as probable beforehand: the more probable one,
/// with the probability of either.
pub(super) fn one_of_two(a: Option<ModalFit>, b: Option<ModalFit>) -> Option<ModalFit> {
    let ln = |fit: &Option<ModalFit>| fit.as_ref().map_or(f64::NEG_INFINITY, |fit| fit.ln);
    let ln = ln_of_mean(ln(&a), ln(&b));
    more_probable(a, b).map(|best| ModalFit { ln, ..best })
}
