//! Variances by what a local rational function leaves of each line.

use super::smoothing::{FEWEST, NOTHING, WINDOW, around, smooth};
use crate::local_rational::LocalRationalFit;
use jointscope_spectra::median;
use num_complex::Complex64;

/// Lines on each side from which the course of an FRF through a line is taken.
pub(crate) const NEIGHBOURS: usize = 5;
/// A line whose own noise is followed to more than this share tells nothing about it.
pub(crate) const FOLLOWED: f64 = 0.8;
/// Squared errors beyond this many times their expected size are peaks that the local function missed, not
/// noise.
const CLIPPED: f64 = 8.0;

/// Variances E|ε|² of one FRF from what is left of its values at `hz` by a rational function through their
/// neighbours: one mode and a smooth rest. Medians over a window keep out what is neither, two modes at once.
/// Values of exactly zero were not measured and tell nothing of it.
pub fn from_scatter(hz: &[f64], values: &[Complex64]) -> Vec<f64> {
    let n = values.len();
    let size: Vec<f64> = values.iter().map(|v| v.norm_sqr()).collect();
    let largest = size.iter().copied().fold(0.0, f64::max);
    if n < FEWEST.max(2 * NEIGHBOURS + 1) {
        return vec![(0.01f64.powi(2) * largest).max(f64::MIN_POSITIVE); n];
    }
    let mut fit = LocalRationalFit::new();
    let local = |line: usize| {
        if size[line] == 0.0 {
            return None;
        }
        let local = fit.about(hz, values, line, NEIGHBOURS)?;
        (local.leverage < FOLLOWED).then(|| local.residual.norm_sqr() / (1.0 - local.leverage))
    };
    let raw: Vec<Option<f64>> = (0..n).map(local).collect();
    let usable: Vec<bool> = raw.iter().map(Option::is_some).collect();
    let raw: Vec<f64> = raw.into_iter().map(Option::unwrap_or_default).collect();
    // The square of a complex normal is exponential: its median is ln 2 of its mean.
    let mut window = Vec::with_capacity(2 * WINDOW + 1);
    let mut mean_by_median = |line: usize, value: &dyn Fn(usize) -> f64| {
        window.clear();
        window.extend(around(line, WINDOW, n).filter(|&i| usable[i]).map(value));
        median(&mut window).map_or(0.0, |median| median / std::f64::consts::LN_2)
    };
    let share = |i: usize| raw[i] / size[i].max(NOTHING * largest).max(f64::MIN_POSITIVE);
    // An upper bound to begin with: the floor that the median shows, and the share that it shows.
    let begun = (0..n)
        .map(|line| mean_by_median(line, &|i| raw[i]) + mean_by_median(line, &share) * size[line])
        .collect();
    smooth(&size, &raw, &usable, begun, 5, CLIPPED, WINDOW)
}
