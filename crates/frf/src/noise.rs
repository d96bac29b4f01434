//! Variances of FRFs: from coherence and averages where they were recorded, from the FRFs themselves where
//! not.
//!
//! With n averages the variance of one complex value is (1 − γ²)/((n − 1) γ²)·|H|², but as an estimate line
//! by line it has so few degrees of freedom that weights taken from it are worthless. The physics behind it
//! is smooth: response noise is a floor in the accelerance, force noise is a share of |H|².
//! [`with_variances`] therefore fits var = S + N·|H|² with S and N slowly varying over the lines.

mod by_coherence;
mod by_scatter;
mod smoothing;
#[cfg(test)]
mod tests;

pub(crate) use by_coherence::from_coherence;
pub use by_coherence::of_lines;
pub use by_scatter::from_scatter;
pub(crate) use by_scatter::{FOLLOWED, NEIGHBOURS};
pub(crate) use smoothing::FLOOR;
pub use smoothing::smoothed;

use jointscope_spectra::{FrfForm, FrfSet, SpectraError, median};
use num_complex::Complex64;
use serde::Serialize;
use smoothing::FEWEST;

/// Where variances came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum NoiseSource {
    /// Coherence and number of averages of the recording.
    #[serde(rename = "coherence and averages")]
    Coherence,
    /// Coherence, with a number of averages that scatter tells: files seldom state it.
    #[serde(rename = "coherence, averages by scatter")]
    CoherenceAlone,
    /// The scatter of the FRF about its course from line to line.
    #[serde(rename = "scatter over the lines")]
    Scatter,
}

impl NoiseSource {
    /// Whether the size of the noise is told by the scatter of the FRF, which is known to a fifth or so.
    pub fn is_by_scatter(self) -> bool {
        self != NoiseSource::Coherence
    }

    /// What it is, in a few words.
    pub fn says(self) -> &'static str {
        match self {
            NoiseSource::Coherence => "coherence and averages",
            NoiseSource::CoherenceAlone => "coherence, averages by scatter",
            NoiseSource::Scatter => "scatter over the lines",
        }
    }
}

/// The set with its own variances, or where it has none with those of [`with_variances`]; and where these
/// came from, nothing for its own.
///
/// # Errors
/// Those of [`with_variances`].
pub fn known(frfs: &FrfSet) -> Result<(FrfSet, Vec<NoiseSource>), SpectraError> {
    match frfs.variance(0) {
        Some(_) => Ok((frfs.clone(), Vec::new())),
        None => with_variances(frfs),
    }
}

/// The set with variances by line, estimated on the accelerance and smoothed over the lines, and where
/// each FRF's came from.
///
/// Variances that the set carries already are replaced. Lines at 0 Hz get the variance of their neighbours.
///
/// # Errors
/// Only those of a set that cannot be converted.
pub fn with_variances(frfs: &FrfSet) -> Result<(FrfSet, Vec<NoiseSource>), SpectraError> {
    let n = frfs.lines().len();
    let mut variance = Vec::with_capacity(n * frfs.pairs().len());
    let mut sources = Vec::new();
    for index in 0..frfs.pairs().len() {
        // |accelerance| = |value| ω^(2 − order): where noise floors are flat.
        let scale: Vec<f64> =
            frfs.lines().omegas().map(|w| w.max(1e-3).powi(2 - frfs.form().order())).collect();
        let values: Vec<Complex64> = frfs
            .values(index)
            .iter()
            .zip(frfs.lines().omegas())
            .map(|(v, w)| v * frfs.form().factor_to(FrfForm::Accelerance, w).unwrap_or(Complex64::ZERO))
            .collect();
        let (estimate, source) = variances(frfs, index, &values);
        variance.extend(estimate.iter().zip(&scale).map(|(v, s)| v / (s * s)));
        sources.push(source);
    }
    Ok((frfs.clone().with_variance(variance)?, sources))
}

/// Variances of an FRF's `values`, accelerances, by the best that is known of them.
fn variances(frfs: &FrfSet, index: usize, values: &[Complex64]) -> (Vec<f64>, NoiseSource) {
    let averages = frfs.averages(index);
    if let (Some(coherence), Some(averages @ 2..)) = (frfs.coherence(index), averages) {
        return (from_coherence(values, coherence, averages), NoiseSource::Coherence);
    }
    let scatter = from_scatter(frfs.lines().hz(), values);
    if let (Some(coherence), None) = (frfs.coherence(index), averages)
        && let Some(averages) = averages_by_scatter(values, coherence, &scatter)
    {
        return (from_coherence(values, coherence, averages), NoiseSource::CoherenceAlone);
    }
    (scatter, NoiseSource::Scatter)
}

/// Averages that a recording may have.
const AVERAGES: (f64, f64) = (1.5, 1000.0);

/// The number of averages with which a coherence states the noise that the `scatter` over the lines shows;
/// `None` where they do not go together.
fn averages_by_scatter(values: &[Complex64], coherence: &[f64], scatter: &[f64]) -> Option<u32> {
    // One less than the averages, line by line: (1 − γ²)/γ²·|H|² over the variance.
    let stated = of_lines(values, coherence, 2);
    let usable =
        stated.iter().zip(scatter).zip(coherence).filter(|(_, gamma2)| **gamma2 > 0.0 && **gamma2 < 1.0);
    let mut ratios: Vec<f64> = usable.map(|((stated, scatter), _)| stated / scatter).collect();
    if ratios.len() < FEWEST.max(coherence.len() / 2) {
        return None;
    }
    let averages = 1.0 + median(&mut ratios)?;
    (AVERAGES.0..AVERAGES.1).contains(&averages).then(|| averages.round() as u32)
}
