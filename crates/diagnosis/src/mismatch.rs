//! How a model disagrees with a recording, by FRF and band.

use crate::Observation;
use jointscope_spectra::FrfPair;
use num_complex::Complex64;
use serde::Serialize;

/// How one FRF disagrees with the refitted fixture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrfMismatch {
    /// The FRF.
    pub frf: FrfPair,
    /// √(Σ|H_model − H_measured|²/Σ|H_measured|²) of this FRF.
    pub nrmse: f64,
    /// Shares of this FRF's χ², ascending.
    pub bands: Vec<BandShare>,
}

/// What one band holds of an FRF's χ².
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BandShare {
    /// Lower end, Hz.
    pub from: f64,
    /// Upper end, Hz.
    pub to: f64,
    /// Share, 0 to 1.
    pub share: f64,
}

/// Mismatch of a prediction by FRF and band.
pub(crate) fn mismatch(observation: &Observation, predicted: &[Complex64], bands: usize) -> Vec<FrfMismatch> {
    let n = observation.lines().len();
    let hz = observation.lines().hz();
    let bands = bands.min(n);
    let edge = |band: usize| band * n / bands;
    let of = |(index, pair): (usize, &FrfPair)| {
        let at = |line: usize| index * n + line;
        let residual = |line: usize| (observation.values()[at(line)] - predicted[at(line)]).norm_sqr();
        let chi2 = |range: std::ops::Range<usize>| {
            range.map(|l| observation.weights()[at(l)] * residual(l)).sum::<f64>()
        };
        let whole = chi2(0..n).max(f64::MIN_POSITIVE);
        let band = |b: usize| BandShare {
            from: hz[edge(b)],
            to: hz[edge(b + 1) - 1],
            share: chi2(edge(b)..edge(b + 1)) / whole,
        };
        let nrmse = observation.nrmse_of(predicted, (0..n).map(at));
        FrfMismatch { frf: pair.clone(), nrmse, bands: (0..bands).map(band).collect() }
    };
    observation.pairs().iter().enumerate().map(of).collect()
}
