//! Every FRF by itself: averages, coherence, noise, and how far it is from what the fixture makes of it.

use crate::settings::frfs::{ABSURD_RATIO, NEIGHBOURS, POOR_COHERENCE};
use jointscope_frf::noise::NoiseSource;
use jointscope_screening::median;
use jointscope_spectra::{FrfPair, FrfSet};
use num_complex::Complex64;
use serde::Serialize;

/// Coherence over the lines.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Coherence {
    /// Its median.
    pub median: f64,
    /// Share of the lines on which it is below 0.8.
    pub low: f64,
}

/// An FRF.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FrfCheck {
    /// Response and reference.
    pub frf: FrfPair,
    /// Number of averages, where the file states it.
    pub averages: Option<u32>,
    /// Coherence, where it was recorded.
    pub coherence: Option<Coherence>,
    /// Median over the lines of the noise's standard deviation, relative to the FRF.
    pub noise: f64,
    /// What the noise was taken from.
    pub noise_from: NoiseSource,
    /// √(Σ|Ĥ − H|²/Σ|H|²), Ĥ the fixture's, as it stands; `None` where the fixture has no FRF.
    pub nrmse: Option<f64>,
    /// Median over the lines of |H|/|Ĥ|.
    pub level: Option<f64>,
    /// Mean over the lines of the cosine of the angle between H and Ĥ: 1 alike, −1 turned round.
    pub sign: Option<f64>,
}

/// The FRFs of a set of accelerances with variances, beside the fixture's, FRF after FRF.
pub(crate) fn of(frfs: &FrfSet, sources: &[NoiseSource], modelled: Option<&[Complex64]>) -> Vec<FrfCheck> {
    let count = frfs.lines().len();
    (0..frfs.pairs().len())
        .map(|index| {
            let values = frfs.values(index);
            let variance = frfs.variance(index).unwrap_or_default();
            let noise = values.iter().zip(variance).map(|(v, variance)| variance.sqrt() / v.norm());
            let own = modelled.map(|all| &all[index * count..(index + 1) * count]);
            let coherence = frfs.coherence(index).and_then(|coherence| {
                let low = coherence.iter().filter(|gamma2| **gamma2 < POOR_COHERENCE).count();
                let median = median(coherence.to_vec())?;
                Some(Coherence { median, low: low as f64 / coherence.len() as f64 })
            });
            FrfCheck {
                frf: frfs.pairs()[index].clone(),
                averages: frfs.averages(index),
                coherence,
                noise: median(noise.filter(|noise| noise.is_finite()).collect()).unwrap_or(0.0),
                noise_from: sources.get(index).copied().unwrap_or(NoiseSource::Scatter),
                nrmse: own.and_then(|own| nrmse(values, own)),
                level: own.and_then(|own| {
                    let levels = values.iter().zip(own).map(|(a, b)| a.norm() / b.norm());
                    median(levels.filter(|level| level.is_finite() && *level > 0.0).collect())
                }),
                sign: own.and_then(|own| sign(values, own)),
            }
        })
        .collect()
}

/// √(Σ|a − b|²/Σ|a|²) where `measured` is not zero; in parts of the largest value, for squares of absurd ones
/// overflow.
pub(crate) fn nrmse(measured: &[Complex64], modelled: &[Complex64]) -> Option<f64> {
    let both = || measured.iter().zip(modelled).filter(|(measured, _)| **measured != Complex64::ZERO);
    let largest = both().map(|(a, b)| a.norm().max(b.norm())).fold(0.0, f64::max);
    let apart: f64 = both().map(|(a, b)| ((a - b) / largest).norm_sqr()).sum();
    let size: f64 = both().map(|(a, _)| (a / largest).norm_sqr()).sum();
    (size > 0.0 && apart.is_finite()).then(|| (apart / size).sqrt())
}

/// The frequency (Hz) of a value that no structure has beside the others about it.
pub(crate) fn absurd(frfs: &FrfSet, index: usize) -> Option<f64> {
    let sizes: Vec<f64> = frfs.values(index).iter().map(|value| value.norm()).collect();
    let all = median(sizes.clone())?;
    let is_absurd = |&line: &usize| {
        let about = line.saturating_sub(NEIGHBOURS)..(line + NEIGHBOURS + 1).min(sizes.len());
        let beyond = |usual: f64| usual > 0.0 && sizes[line] > ABSURD_RATIO * usual;
        beyond(all) && median(sizes[about].to_vec()).is_some_and(beyond)
    };
    let line = (0..sizes.len()).find(is_absurd)?;
    Some(frfs.lines().hz()[line])
}

fn sign(measured: &[Complex64], modelled: &[Complex64]) -> Option<f64> {
    let cosines = measured.iter().zip(modelled).map(|(a, b)| (a * b.conj()).re / (a.norm() * b.norm()));
    let cosines: Vec<f64> = cosines.filter(|cosine| cosine.is_finite()).collect();
    (!cosines.is_empty()).then(|| cosines.iter().sum::<f64>() / cosines.len() as f64)
}
