//! What errors of a model's modes make of the lines.
//!
//! Where a natural frequency is off by more than its peak is wide, the lines of the peak say that it is, and
//! next to nothing else: a factor that all lines ask for alike may make them worse, for two peaks that miss
//! each other are the nearer the smaller one of them is. What a line says beside such errors is told by how
//! much they make of it. To first order an error of all natural frequencies by a share moves an FRF along its
//! lines by that share.

use crate::Observation;
use crate::modal::sizes::ModelError;
use num_complex::Complex64;

impl ModelError {
    /// The observation with what these errors make of its values as variance beside their noise, by the slopes
    /// of what was recorded and of what is `modelled`: both have peaks where the other may have none.
    pub(crate) fn beside_noise(&self, observation: &Observation, modelled: &[Complex64]) -> Observation {
        let hz = observation.lines().hz();
        let lines = hz.len();
        let slope = |values: &[Complex64], at: usize| {
            let (line, first) = (at % lines, at - at % lines);
            let (from, to) = (line.saturating_sub(1), (line + 1).min(lines - 1));
            let change = (values[first + to] - values[first + from]).norm_sqr();
            if to > from { change / (hz[to] / hz[from]).ln().powi(2) } else { 0.0 }
        };
        let measured = observation.values();
        let variance = |at: usize| {
            let slopes = 0.5 * (slope(measured, at) + slope(modelled, at));
            let sizes = 0.5 * (measured[at].norm_sqr() + modelled[at].norm_sqr());
            self.frequency.powi(2) * slopes + self.residue.powi(2) * sizes
        };
        let variances: Vec<f64> = (0..measured.len()).map(variance).collect();
        observation.with_variance_added(&variances)
    }
}
