//! Derivatives of the FRFs by quantities and effects: from one solution of the model where it has them, else
//! by differences.

use crate::{Hypothesis, Observation};
use jointscope_inference::NormalEquations;
use jointscope_lumped::Vicinity;
use num_complex::Complex64;

/// What the coordinates of a hypothesis do to the FRFs, to first order.
#[derive(Debug, Clone, Default)]
pub struct Linearisation {
    /// Derivatives by coordinate, each FRF after FRF.
    pub derivatives: Vec<Vec<Complex64>>,
}

impl Linearisation {
    /// These derivatives for the first coordinates of `at`, and those of one solution for the rest; where
    /// that has none, central differences by `steps`, or one-sided ones where a coordinate lies on its bound,
    /// such as a dashpot of zero. A coordinate that cannot be moved gets zeros.
    pub(crate) fn extended(
        mut self,
        at: &Hypothesis,
        observation: &Observation,
        steps: impl Fn(usize) -> f64,
    ) -> Self {
        let first = self.derivatives.len();
        let solution = if first < at.coordinates.len() { at.tangent(observation) } else { None };
        let about = if first < at.coordinates.len() { at.vicinity(observation) } else { None };
        for m in first..at.coordinates.len() {
            let exact = solution.as_ref().and_then(|solution| at.derivative(m, solution, observation, 2));
            self.derivatives
                .push(exact.unwrap_or_else(|| central((at, about.as_ref()), observation, m, steps(m))));
        }
        self
    }

    /// The derivatives of one solution; where that has none, forward differences from `predicted`, which `at`
    /// predicts: half the price of central ones, right to a thousandth, which is enough to find the way but
    /// not to state an uncertainty.
    pub(crate) fn forward(
        at: &Hypothesis,
        predicted: &[Complex64],
        observation: &Observation,
        difference: f64,
    ) -> Self {
        let solution = at.tangent(observation);
        let about = at.vicinity(observation);
        let derivatives = (0..at.coordinates.len()).map(|m| {
            if at.is_held(m) {
                return vec![Complex64::ZERO; predicted.len()];
            }
            if let Some(exact) =
                solution.as_ref().and_then(|solution| at.derivative(m, solution, observation, 1))
            {
                return exact;
            }
            let step = at.inward(m, difference);
            match at.predict_moved(m, step, (Some(predicted), about.as_ref()), observation) {
                Ok(moved) => moved.iter().zip(predicted).map(|(u, p)| (u - p) / step).collect(),
                Err(_) => vec![Complex64::ZERO; predicted.len()],
            }
        });
        Linearisation { derivatives: derivatives.collect() }
    }

    /// The normal equations with the priors of `at`, whose held coordinates stay.
    pub(crate) fn equations(
        &self,
        at: &Hypothesis,
        weights: &[f64],
        residual: &[Complex64],
    ) -> NormalEquations {
        let prior = |m: usize| (at.prior(m), at.coordinates[m]);
        NormalEquations::of_columns(&self.derivatives, residual, weights, |m| at.is_held(m), prior)
    }
}

/// Central differences by coordinate `m`.
fn central(
    (at, about): (&Hypothesis, Option<&Vicinity>),
    observation: &Observation,
    m: usize,
    step: f64,
) -> Vec<Complex64> {
    let moved = |sign: f64| at.predict_moved(m, sign * step, (None, about), observation);
    let slope = |up: Vec<Complex64>, down: Vec<Complex64>, width: f64| {
        up.iter().zip(&down).map(|(u, d)| (u - d) / width).collect()
    };
    let derivative = match (moved(1.0), moved(-1.0)) {
        (Ok(up), Ok(down)) => Some(slope(up, down, 2.0 * step)),
        (Ok(up), Err(_)) => moved(0.0).ok().map(|here| slope(up, here, step)),
        (Err(_), Ok(down)) => moved(0.0).ok().map(|here| slope(here, down, step)),
        (Err(_), Err(_)) => None,
    };
    derivative.unwrap_or(vec![Complex64::ZERO; observation.values().len()])
}
