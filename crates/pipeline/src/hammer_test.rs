//! Hammer hits with the FRFs estimated from them.

use jointscope_estimation::{Estimate, EstimateError, EstimateOptions, Estimator};
use jointscope_hits::Hit;
use jointscope_spectra::{FrfSet, in_text};
use jointscope_wording::counted;

/// Hammer hits and what was estimated from them.
#[derive(Debug, Clone, PartialEq)]
pub struct HammerTest {
    /// The hits.
    pub hits: Vec<Hit>,
    /// FRFs, and what became of each hit.
    pub estimate: Estimate,
}

impl HammerTest {
    /// Estimates the FRFs of `hits`.
    ///
    /// # Errors
    /// See [`EstimateError`].
    pub fn of(hits: &[Hit], options: &EstimateOptions) -> Result<Self, EstimateError> {
        let estimate = Estimate::of(hits, options)?;
        Ok(HammerTest { hits: hits.to_vec(), estimate })
    }

    /// The hits that the estimate uses, without hum and baselines: what differs from hit to hit changes FRFs
    /// of single hits under a window, as no law of a joint does.
    pub(crate) fn hits_in_use(&self) -> Vec<Hit> {
        let prepared = self.estimate.prepared(&self.hits).into_iter().zip(&self.estimate.hits);
        prepared.filter(|(_, report)| report.used).map(|(hit, _)| hit).collect()
    }

    /// `FRFs were estimated from the hits: H1, 9 hits at 1, 9 at 2, on 1975 lines from 0.78125 to 1543 Hz`,
    /// of those FRFs that are used.
    pub fn says(&self, frfs: &FrfSet, estimator: Estimator) -> String {
        let excitations = self.estimate.excitations.iter();
        let points: Vec<String> =
            excitations.map(|e| format!("{} at {}", counted(e.hits.len(), "hit"), e.struck)).collect();
        let hz = frfs.lines().hz();
        let (first, last) = (hz.first().copied().unwrap_or(0.0), hz.last().copied().unwrap_or(0.0));
        format!(
            "FRFs were estimated from the hits: {}, {}, on {} lines from {} to {} Hz",
            estimator.name(),
            points.join(", "),
            hz.len(),
            in_text(first),
            in_text(last)
        )
    }
}
