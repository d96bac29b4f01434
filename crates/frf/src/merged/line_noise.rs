//! The noise of single lines, as a recording states or shows it.

use crate::noise::{FLOOR, from_coherence, from_scatter, of_lines};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;
use std::ops::Range;

/// Lines on either side that the noise of lines kept is taken from too.
const AROUND: usize = 30;

/// What is known of an FRF's noise.
pub(super) enum LineNoise<'a> {
    Variance(&'a [f64]),
    Coherence(&'a [f64], u32),
    Scatter,
}

impl<'a> LineNoise<'a> {
    pub(super) fn of(frfs: &'a FrfSet, index: usize) -> Self {
        match (frfs.variance(index), frfs.coherence(index), frfs.averages(index)) {
            (Some(variance), ..) => LineNoise::Variance(variance),
            (None, Some(coherence), Some(averages @ 2..)) => LineNoise::Coherence(coherence, averages),
            _ => LineNoise::Scatter,
        }
    }

    /// Variance of a line in the mean over some, of which `left` is that of what a polynomial leaves.
    pub(super) fn over(&self, lines: Range<usize>, values: &[Complex64], left: f64) -> f64 {
        let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
        match self {
            LineNoise::Variance(variance) => mean(&variance[lines]),
            LineNoise::Coherence(coherence, averages) => {
                let (values, coherence) = (&values[lines.clone()], &coherence[lines]);
                mean(&of_lines(values, coherence, *averages)).max(believed(values))
            }
            LineNoise::Scatter => left,
        }
    }

    /// Variances of lines that are kept.
    pub(super) fn by_line(&self, lines: Range<usize>, hz: &[f64], values: &[Complex64]) -> Vec<f64> {
        let near = lines.start.saturating_sub(AROUND)..(lines.end + AROUND).min(hz.len());
        let own = lines.start - near.start..lines.end - near.start;
        let all = match self {
            LineNoise::Variance(variance) => return variance[lines].to_vec(),
            LineNoise::Coherence(coherence, averages) => {
                from_coherence(&values[near.clone()], &coherence[near], *averages)
            }
            LineNoise::Scatter => from_scatter(&hz[near.clone()], &values[near]),
        };
        all[own].to_vec()
    }
}

/// Smallest variance that is believed of a line.
pub(super) fn believed(values: &[Complex64]) -> f64 {
    let size = values.iter().map(|v| v.norm_sqr()).sum::<f64>() / values.len() as f64;
    (FLOOR * FLOOR * size).max(f64::MIN_POSITIVE)
}
