//! A fitted hypothesis where the sizes of error are given.
//!
//! What is said of effects and quantities is said at the sizes that are most probable: a natural frequency that is off by its error is as probable as quantities that are off by theirs.
//! Such a model predicts badly all the same, for beside a resonance a small error of frequency is a large one of an FRF. One that is to predict has the effects that are stated, and quantities that follow
//! recorded natural frequencies and damping more closely, the more so where that takes them no farther from what is stated than chance.

use crate::Hypothesis;
use crate::modal::fit::{Descent, Iterate, ModalFit, Problem, settings};
use crate::modal::prior::Prior;
use jointscope_inference::{Covariance, LeastSquares, Precision, descend};
use jointscope_linalg::Cholesky;
use jointscope_model_error::ErrorSizes;

impl Problem<'_> {
    /// The most probable parameters at given sizes of the error, with the covariance of their coordinates.
    pub fn at_sizes(&self, fit: &ModalFit, sizes: &ErrorSizes) -> Option<(Hypothesis, Option<Covariance>)> {
        let descent = self.descent_at(fit, &fit.priors, sizes)?;
        let start = Iterate {
            hypothesis: fit.hypothesis.clone(),
            modelled: fit.standing.modelled.clone(),
            residual: fit.residual.clone(),
        };
        let point = descend(&descent, start, Some(fit.slopes.clone()), &settings(usize::MAX))?.point;
        let slopes = descent.derivatives(&point, Precision::Rough)?;
        let equations = descent.equations(&point, &slopes, &());
        let order = equations.order;
        let inverse = Cholesky::of(order, &equations.information).map(|factor| factor.inverse());
        Some((point.hypothesis, inverse.map(|entries| Covariance::new(order, entries))))
    }

    /// `found` with the most probable quantities at given sizes of the error, its effects staying as they are; `fit` is of the same names.
    pub fn quantities_at(
        &self,
        fit: &ModalFit,
        found: &Hypothesis,
        sizes: &ErrorSizes,
    ) -> Option<Hypothesis> {
        let count = found.tolerances().len();
        let descent = self.descent_at(fit, &fit.priors[..count], sizes)?;
        let hypothesis = found.with_effects_in_place()?;
        let modelled = self.modelled(&hypothesis, &fit.standing.modelled)?;
        let residual = self.residual(&fit.standing, &modelled);
        let start = Iterate { hypothesis, modelled, residual };
        let slopes = fit.slopes[..count].to_vec();
        let point = descend(&descent, start, Some(slopes), &settings(usize::MAX))?.point;
        Some(found.with_tolerances_of(&point.hypothesis))
    }

    fn descent_at<'a>(
        &'a self,
        fit: &'a ModalFit,
        priors: &'a [Prior],
        sizes: &ErrorSizes,
    ) -> Option<Descent<'a>> {
        let standing = &fit.standing;
        let factor = Cholesky::of(standing.comparison.count(), &standing.comparison.covariance(sizes))?;
        Some(Descent { problem: self, standing, factor, priors })
    }
}
