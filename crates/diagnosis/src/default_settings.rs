//! Fits, covariances and derivatives by the default settings, for those who ask for one and search nothing.

use crate::fitter::Fitter;
use crate::settings::Settings;
use crate::{Fit, Hypothesis, Linearisation, Observation, Watch};
use jointscope_inference::Covariance;

impl Fit {
    /// Fits from the hypothesis as it stands with the default settings; from afar (`global`) a share of the
    /// signal counts as noise first.
    ///
    /// `None` where the start itself predicts no finite FRFs.
    pub fn of(start: &Hypothesis, observation: &Observation, global: bool) -> Option<Self> {
        let fitter = Fitter { observation, settings: &Settings::default(), watch: Watch::default() };
        if global { fitter.global(start) } else { fitter.local(start, None, f64::INFINITY) }
    }

    /// Covariance of the coordinates; `None` where the FRFs leave a combination free.
    pub fn covariance(&self, observation: &Observation) -> Option<Covariance> {
        let fitter = Fitter { observation, settings: &Settings::default(), watch: Watch::default() };
        fitter.information(&self.hypothesis).covariance()
    }
}

impl Linearisation {
    /// Central differences about a hypothesis by steps so small that every digit counts which rounding
    /// leaves, of every coordinate.
    pub fn of(at: &Hypothesis, observation: &Observation) -> Self {
        let fitter = Fitter { observation, settings: &Settings::default(), watch: Watch::default() };
        fitter.linearised_exactly(at)
    }
}
