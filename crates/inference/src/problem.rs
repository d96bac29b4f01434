//! What a descent minimises: a weighted sum of squared residuals with priors, and what a problem has to tell
//! of it.

/// How exactly derivatives are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DerivativePrecision {
    /// Good enough to find the way: forward differences, say.
    Rough,
    /// Good enough to decide between nearly collinear parameters: central differences or closed forms.
    Exact,
}

/// A weighted sum of squared residuals with priors, to be minimised.
pub trait LeastSquares {
    /// Coordinates with everything that the model computes from them.
    type Point;
    /// Weights of the residuals, frozen while a step is made so that it is judged by what it was made for.
    type Weights;
    /// What the coordinates do to the residuals, near the point where it was found.
    type Derivatives;
    /// Normal equations at a point.
    type Equations;

    /// Whether the weights are the same everywhere.
    const FIXED_WEIGHTS: bool;

    /// The weights that hold about a point.
    fn weights(&self, point: &Self::Point) -> Self::Weights;

    /// Weighted squared residuals and squared deviations from the priors.
    fn objective(&self, point: &Self::Point, weights: &Self::Weights) -> f64;

    /// Derivatives at a point; `None` where it has none.
    fn derivatives(&self, point: &Self::Point, precision: DerivativePrecision) -> Option<Self::Derivatives>;

    /// The normal equations at a point, from derivatives taken there or nearby.
    fn equations(
        &self,
        point: &Self::Point,
        derivatives: &Self::Derivatives,
        weights: &Self::Weights,
    ) -> Self::Equations;

    /// The normal equations of what is left at `at`, from derivatives that were all taken at `from`. To be said
    /// where [`LeastSquares::equations`] takes some anew at each point: beside others from elsewhere, what one
    /// coordinate does no longer makes up for what another does.
    fn equations_from(
        &self,
        at: &Self::Point,
        _from: &Self::Point,
        derivatives: &Self::Derivatives,
        weights: &Self::Weights,
    ) -> Self::Equations {
        self.equations(at, derivatives, weights)
    }

    /// The point that a step with the given relative damping leads to; `None` where there is none.
    fn stepped(&self, point: &Self::Point, equations: &Self::Equations, damping: f64) -> Option<Self::Point>;

    /// The point at a share of an undamped step; `None` where there is none. Needed for
    /// [`Settings::curved_valley`](crate::Settings::curved_valley).
    fn shortened(
        &self,
        _point: &Self::Point,
        _equations: &Self::Equations,
        _share: f64,
    ) -> Option<Self::Point> {
        None
    }

    /// From `at`, to which [`LeastSquares::shortened`] led from another point: moved across the valley by
    /// what an undamped step from here differs from what is left of the first one; `None` where there is
    /// none. The equations are those of both points, from the same derivatives.
    fn corrected(
        &self,
        _at: &Self::Point,
        _from: &Self::Point,
        _equations: [&Self::Equations; 2],
        _share: f64,
    ) -> Option<Self::Point> {
        None
    }

    /// Decrease of the objective that an undamped step promises where the model follows its derivatives.
    /// Needed for [`Settings::limit`](crate::Settings::limit) and
    /// [`Settings::valleys`](crate::Settings::valleys).
    fn promised(&self, _point: &Self::Point, _equations: &Self::Equations) -> f64 {
        0.0
    }
}
