//! Spectra of recorded signals, and the noise in them.

use num_complex::Complex64;
use realfft::{RealFftPlanner, RealToComplex};
use std::sync::Arc;

/// Discrete Fourier transform of real signals of one length, unnormalised.
#[derive(Clone)]
pub(crate) struct Transform {
    plan: Arc<dyn RealToComplex<f64>>,
}

impl Transform {
    pub fn new(length: usize) -> Self {
        Transform { plan: RealFftPlanner::<f64>::new().plan_fft_forward(length.max(1)) }
    }

    /// The lines of the spectrum, from 0 Hz on; `values` is overwritten and must have the plan's length.
    pub fn of(&self, values: &mut [f64]) -> Vec<Complex64> {
        let mut lines = self.plan.make_output_vec();
        match self.plan.process(values, &mut lines) {
            Ok(()) => lines,
            Err(_) => vec![Complex64::ZERO; lines.len()],
        }
    }
}

/// Share of a record at its end in which noise is looked for: a hit's force is over, its response has mostly died away.
const TAIL: usize = 4;
/// Fewest samples of a tail.
const FEWEST: usize = 32;

/// Standard deviation of a signal's white noise, from the median line of its last quarter: what still rings there is a few lines among many, and
/// the median does not see them.
pub(crate) fn noise(values: &[f64]) -> f64 {
    let length = (values.len() / TAIL).max(FEWEST.min(values.len()));
    let tail = &values[values.len() - length..];
    let mean = tail.iter().sum::<f64>() / length as f64;
    let hann = |i: usize| (std::f64::consts::PI * (i as f64 + 0.5) / length as f64).sin().powi(2);
    let mut windowed: Vec<f64> = tail.iter().enumerate().map(|(i, v)| (v - mean) * hann(i)).collect();
    let power: f64 = (0..length).map(|i| hann(i).powi(2)).sum();
    let lines = Transform::new(length).of(&mut windowed);
    let inner = lines.get(2..lines.len() - 1).unwrap_or_default();
    let mut squares: Vec<f64> = inner.iter().map(|line| line.norm_sqr()).collect();
    if squares.is_empty() || power == 0.0 {
        return 0.0;
    }
    squares.sort_by(f64::total_cmp);
    // The median of an exponential distribution is ln 2 of its mean.
    (squares[squares.len() / 2] / std::f64::consts::LN_2 / power).sqrt()
}

/// A length not shorter than `length` of factors 2, 3 and 5 alone, if one lies within `most`.
pub(crate) fn smooth_length(length: usize, most: usize) -> usize {
    let smooth = |mut n: usize| {
        for factor in [2, 3, 5] {
            while n.is_multiple_of(factor) {
                n /= factor;
            }
        }
        n == 1
    };
    (length.max(8)..=most).find(|n| smooth(*n)).unwrap_or(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_met_beside_what_still_rings() {
        let mut seed = 1u64;
        let mut uniform = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let std = (1.0f64 / 12.0).sqrt();
        let values: Vec<f64> = (0..8192).map(|i| uniform() + 30.0 * (0.2 * f64::from(i)).sin()).collect();
        assert!((noise(&values) / std - 1.0).abs() < 0.1, "{}", noise(&values));
        assert_eq!(noise(&[0.0; 100]), 0.0);
        assert!(noise(&[1.0, 2.0]).is_finite());
    }

    #[test]
    fn smooth_lengths_are_not_shorter_than_asked_and_within_what_there_is() {
        assert_eq!((smooth_length(1021, 2000), smooth_length(1021, 1022)), (1024, 1022));
    }
}
