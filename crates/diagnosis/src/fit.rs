//! A fitted hypothesis with χ² and objective, as searches and comparisons pass it on.

use crate::penalty::parameter_penalty;
use crate::settings::Settings;
use crate::{Hypothesis, Observation};
use jointscope_inference::variance_inflation;
use num_complex::Complex64;

/// A hypothesis at its best, and how good that is.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The hypothesis at the optimum.
    pub hypothesis: Hypothesis,
    /// What it predicts, FRF after FRF.
    pub predicted: Vec<Complex64>,
    /// χ² of the FRFs.
    pub chi2: f64,
    /// χ² and the squared departures of the fixture's quantities: what was minimised.
    pub objective: f64,
}

impl Fit {
    /// A hypothesis as it stands; `None` where it predicts no finite FRFs.
    pub(crate) fn at(hypothesis: Hypothesis, observation: &Observation) -> Option<Self> {
        let predicted = hypothesis.predict(observation).ok()?;
        let chi2 = observation.chi2(&predicted);
        Some(Fit { objective: chi2 + hypothesis.squared_departures(), hypothesis, predicted, chi2 })
    }

    /// χ² over the real values that count less the effects' free parameters.
    pub fn chi2_per_dof(&self, observation: &Observation) -> f64 {
        self.chi2 / (observation.degrees().saturating_sub(self.hypothesis.effect_parameters())).max(1) as f64
    }

    /// Minus twice the logarithm of the evidence by the default settings, up to a constant: what was
    /// minimised, divided by the variance `inflation`, and a penalty for every parameter. Names are weighed
    /// by it.
    pub fn cost(&self, inflation: f64) -> f64 {
        self.objective / inflation + parameter_penalty(&Settings::default().selection, &self.hypothesis)
    }

    /// Variance inflation of the residuals that it leaves.
    pub fn inflation(&self, observation: &Observation) -> f64 {
        variance_inflation(self.chi2_per_dof(observation), observation.residual_correlation(&self.predicted))
    }
}
