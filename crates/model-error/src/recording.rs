//! FRFs with a weight for each value.

use crate::settings::recorded::RESOLVED_LINES;
use jointscope_spectra::FrfSet;

/// FRFs to take the modes of: accelerances, with a weight for each value.
#[derive(Debug, Clone, Copy)]
pub struct WeightedFrfs<'a> {
    /// Accelerances with their variances, on lines above 0 Hz.
    pub frfs: &'a FrfSet,
    /// 1/variance of the real part, and of the imaginary part, of each value, FRF after FRF: 2/E|ε|². Zero
    /// where a value does not count.
    pub weights: &'a [f64],
}

impl WeightedFrfs<'_> {
    /// Number of real values that count.
    pub(crate) fn degrees(&self) -> f64 {
        2.0 * self.weights.iter().filter(|weight| **weight > 0.0).count() as f64
    }
}

/// Frequency, Hz, from which on modes are told from residual terms: so many lines above the lowest one, as
/// lines lie there. Of many lines those are compared that tell most, most of them near resonances.
pub(crate) fn resolved_from(hz: &[f64]) -> f64 {
    hz[RESOLVED_LINES.min(hz.len() - 1)]
}
