//! Maximum of likelihood and prior.

use super::hypothesis::Hypothesis;
use super::misfit::{Jacobian, Residuals, View, sum_of_squares};
use crate::settings::fit::{CONVERGED, MOST_STEPS, REUSE, STEP_DAMPING};
use jointscope_inference::{
    Covariance, DerivativePrecision, LeastSquares, NormalEquations, Settings, descend,
};

/// A hypothesis at which likelihood and prior are largest.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub hypothesis: Hypothesis,
    /// χ² of the data.
    pub chi2: f64,
    /// χ² and priors.
    pub objective: f64,
    /// JᵀJ of the data, row-major.
    information: Vec<f64>,
}

impl Fit {
    /// From `start`, derivatives being taken `renewals` times at the most; `None` where the start has no
    /// finite motion.
    pub(super) fn of(view: &View, start: &Hypothesis, renewals: usize) -> Option<Self> {
        Self::sloped(view, view, start, renewals)
    }

    /// The same, with derivatives of a view of the same records that steps more coarsely: they need not be as
    /// exact as what they lead to.
    pub(super) fn sloped(view: &View, slopes: &View, start: &Hypothesis, renewals: usize) -> Option<Self> {
        let start = Iterate::at(view, start.clone())?;
        let fit = descend(&Problem { view, slopes }, start, None, &settings(renewals))?;
        Some(Self::with(fit.point, fit.derivatives))
    }

    /// A hypothesis as it is, with what a view tells of it.
    pub(super) fn at(view: &View, slopes: &View, hypothesis: &Hypothesis) -> Option<Self> {
        let point = Iterate::at(view, hypothesis.clone())?;
        let derivatives = Problem { view, slopes }.derivatives(&point, DerivativePrecision::Rough)?;
        Some(Self::with(point, derivatives))
    }

    fn with(Iterate { hypothesis, objective, .. }: Iterate, derivatives: Jacobian) -> Self {
        let chi2 = objective - hypothesis.squared_departures();
        Fit { hypothesis, chi2, objective, information: derivatives.information }
    }

    /// Covariance of the coordinates, the data's noise being `scale` times what was assumed; `None` where
    /// neither data nor priors determine them.
    pub(super) fn covariance(&self, scale: f64) -> Option<Covariance> {
        let information = self.information.iter().map(|e| e / scale).collect();
        equations(&self.hypothesis, information, vec![0.0; self.hypothesis.coordinates.len()]).covariance()
    }
}

/// Simulated against recorded responses, with derivatives of a view that may step more coarsely.
struct Problem<'a> {
    view: &'a View<'a>,
    slopes: &'a View<'a>,
}

/// A hypothesis with its residuals.
struct Iterate {
    hypothesis: Hypothesis,
    residuals: Residuals,
    objective: f64,
}

impl Iterate {
    fn at(view: &View, hypothesis: Hypothesis) -> Option<Self> {
        let residuals = view.residuals(&hypothesis)?;
        let objective = sum_of_squares(&residuals) + hypothesis.squared_departures();
        Some(Iterate { hypothesis, residuals, objective })
    }
}

impl LeastSquares for Problem<'_> {
    type Point = Iterate;
    type Weights = ();
    type Derivatives = Jacobian;
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Iterate) {}

    fn objective(&self, point: &Iterate, _: &()) -> f64 {
        point.objective
    }

    fn derivatives(&self, point: &Iterate, _: DerivativePrecision) -> Option<Jacobian> {
        match std::ptr::eq(self.view, self.slopes) {
            true => self.view.jacobian(&point.hypothesis, &point.residuals),
            false => self.slopes.jacobian(&point.hypothesis, &self.slopes.residuals(&point.hypothesis)?),
        }
    }

    fn equations(&self, point: &Iterate, derivatives: &Jacobian, _: &()) -> NormalEquations {
        equations(&point.hypothesis, derivatives.information.clone(), derivatives.descent(&point.residuals))
    }

    fn stepped(&self, point: &Iterate, equations: &NormalEquations, damping: f64) -> Option<Iterate> {
        let step = equations.step(damping)?;
        Iterate::at(self.view, point.hypothesis.stepped(&step))
    }
}

fn equations(hypothesis: &Hypothesis, information: Vec<f64>, right: Vec<f64>) -> NormalEquations {
    let mut equations = NormalEquations { order: right.len(), information, right };
    for (i, (parameter, at)) in hypothesis.parameters().iter().zip(&hypothesis.coordinates).enumerate() {
        equations.add_prior(i, parameter.precision, *at);
    }
    equations
}

/// A simulation costs seconds, its derivatives many of them: they are taken anew as seldom as a twentieth of
/// their first gain allows, and a tenth in χ² is no gain.
fn settings(renewals: usize) -> Settings {
    Settings {
        steps: MOST_STEPS,
        derivatives: renewals,
        damping: STEP_DAMPING,
        convergence: CONVERGED,
        reuse: Some(REUSE),
        ..Settings::default()
    }
}
