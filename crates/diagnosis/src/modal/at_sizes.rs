//! A fitted hypothesis where the sizes of error are given.

use crate::Hypothesis;
use crate::modal::descent::{Descent, settings};
use crate::modal::fit::ModalFit;
use crate::modal::prior::Prior;
use crate::modal::problem::{Iterate, Problem};
use jointscope_inference::{Covariance, DerivativePrecision, LeastSquares, descend};
use jointscope_linalg::Cholesky;
use jointscope_model_error::ErrorSizes;

impl Problem<'_> {
    /// The most probable parameters at given sizes of the error, with the covariance of their coordinates.
    pub(crate) fn at_sizes(
        &self,
        fit: &ModalFit,
        sizes: &ErrorSizes,
    ) -> Option<(Hypothesis, Option<Covariance>)> {
        let descent = self.descent_at(fit, &fit.priors, sizes)?;
        let start = Iterate {
            hypothesis: fit.hypothesis.clone(),
            modelled: fit.paired.modelled.clone(),
            residual: fit.residual.clone(),
        };
        let point = descend(&descent, start, Some(fit.slopes.clone()), &settings(usize::MAX))?.point;
        let slopes = descent.derivatives(&point, DerivativePrecision::Rough)?;
        let equations = descent.equations(&point, &slopes, &());
        let order = equations.order;
        let inverse = Cholesky::of(order, &equations.information).map(|factor| factor.inverse());
        Some((point.hypothesis, inverse.map(|entries| Covariance::new(order, entries))))
    }

    pub(super) fn descent_at<'a>(
        &'a self,
        fit: &'a ModalFit,
        priors: &'a [Prior],
        sizes: &ErrorSizes,
    ) -> Option<Descent<'a>> {
        let paired = &fit.paired;
        let factor = Cholesky::of(paired.comparison.count(), &paired.comparison.covariance(sizes))?;
        Some(Descent { problem: self, paired, factor, priors })
    }
}
