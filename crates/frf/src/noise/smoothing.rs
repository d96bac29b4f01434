//! Variances of single lines smoothed over the lines: a floor and a share of |H|², both slowly varying.

use num_complex::Complex64;

/// Half-width of the window, in lines, within which the noise is taken as constant.
pub(super) const WINDOW: usize = 25;
/// Fewest usable lines from which a scatter can be estimated.
pub(super) const FEWEST: usize = 8;
/// Power of the force, relative to the strongest line's, that counts as none.
const NO_FORCE: f64 = 1e-12;
/// |H|² below this share of the largest counts as nothing.
pub(super) const NOTHING: f64 = 1e-30;
/// Times its expectation that a variance of two hits or more comes to on one line of twenty thousand.
const MOST_OVER_FIT: f64 = 10.0;
/// Smallest relative noise that is believed: quantisation and calibration are never better.
pub(crate) const FLOOR: f64 = 1e-5;

/// Smooths variances of single lines over the lines: the noise of the channels varies slowly, and what it
/// makes of an FRF rises wherever the power of the `force`, in any unit, dips. An empty `force` is one that
/// is the same on all lines; lines without coherence or of exactly zero are skipped.
///
/// `alike` is the number of neighbouring lines that tell as much about the noise as one line whose noise is
/// its own: 1 without a window, more under one or with zero padding. The mean is over that many times more
/// lines: a variance from few independent values is too small as often as too large, and what it divides is
/// too large in the mean.
pub fn smoothed(
    values: &[Complex64],
    of_lines: &[f64],
    coherence: &[f64],
    force: &[f64],
    alike: f64,
) -> Vec<f64> {
    let reach = (WINDOW as f64 * alike.clamp(1.0, of_lines.len().max(1) as f64)).round() as usize;
    let strongest = force.iter().copied().fold(0.0, f64::max);
    // A line without force has no FRF, whatever its neighbours say.
    let power = |line: usize| match force.get(line) {
        Some(power) if strongest > 0.0 => (power / strongest).max(NO_FORCE),
        _ => 1.0,
    };
    let raw: Vec<f64> = of_lines.iter().enumerate().map(|(line, variance)| variance * power(line)).collect();
    let usable: Vec<bool> = (0..values.len()).map(|line| is_measured(values, coherence, line)).collect();
    let mean = |line: usize| {
        let (mut sum, mut count) = (0.0, 0.0f64);
        for i in around(line, reach, raw.len()).filter(|&i| usable[i]) {
            sum += raw[i];
            count += 1.0;
        }
        sum / count.max(1.0)
    };
    let begun = (0..raw.len()).map(mean).collect();
    let size: Vec<f64> = values.iter().map(|v| v.norm_sqr()).collect();
    let smoothed = smooth(&size, &raw, &usable, begun, 3, f64::INFINITY, reach);
    smoothed.iter().enumerate().map(|(line, variance)| variance / power(line)).collect()
}

/// As [`FrfSet::is_measured`](jointscope_spectra::FrfSet::is_measured), of one FRF's values.
pub(super) fn is_measured(values: &[Complex64], coherence: &[f64], line: usize) -> bool {
    coherence[line] > 0.0 && values[line] != Complex64::ZERO
}

/// Lines about one, on each side up to `reach`.
pub(super) fn around(line: usize, reach: usize, n: usize) -> std::ops::Range<usize> {
    line.saturating_sub(reach)..(line + reach + 1).min(n)
}

/// Fits raw variances as S + N·|H|² within a sliding window: both non-negative, weighted by the fit itself,
/// as the spread of a variance is proportional to it, and clipped at so many times the fit.
pub(super) fn smooth(
    size: &[f64],
    raw: &[f64],
    usable: &[bool],
    begun: Vec<f64>,
    passes: usize,
    clipped: f64,
    reach: usize,
) -> Vec<f64> {
    let n = size.len();
    let mut fit: Vec<f64> = begun;
    for _ in 0..passes {
        let raw: Vec<f64> = raw.iter().zip(&fit).map(|(raw, fit)| raw.min(clipped * fit)).collect();
        fit = (0..n)
            .map(|line| fit_window(around(line, reach, n), &raw, size, &fit, usable, size[line]))
            .collect();
    }
    // A value of exactly nothing comes from a dead channel: it is known no better than the loudest one.
    let largest = size.iter().copied().fold(0.0, f64::max);
    let known = |s: f64| if s < NOTHING * largest { largest } else { s };
    let floor = |s: f64| (FLOOR * FLOOR * known(s)).max(f64::MIN_POSITIVE);
    fit.iter().zip(size).map(|(v, s)| v.max(floor(*s))).collect()
}

fn fit_window(
    range: std::ops::Range<usize>,
    raw: &[f64],
    size: &[f64],
    fit: &[f64],
    usable: &[bool],
    here: f64,
) -> f64 {
    let [mut a11, mut a12, mut a22, mut b1, mut b2] = [0.0; 5];
    for i in range.filter(|&i| usable[i]) {
        // Far below what a line shows no variance lies: a first fit that follows a resonance may claim so of
        // the quiet lines beside it, which would then count above all others.
        let expected = fit[i].max(raw[i] / MOST_OVER_FIT);
        let weight = 1.0 / (expected * expected).max(f64::MIN_POSITIVE);
        a11 += weight;
        a12 += weight * size[i];
        a22 += weight * size[i] * size[i];
        b1 += weight * raw[i];
        b2 += weight * raw[i] * size[i];
    }
    if a11 == 0.0 {
        return 0.0;
    }
    let determinant = a11 * a22 - a12 * a12;
    if determinant > 1e-9 * a11 * a22 {
        let floor = (b1 * a22 - b2 * a12) / determinant;
        let share = (a11 * b2 - a12 * b1) / determinant;
        if floor >= 0.0 && share >= 0.0 {
            return floor + share * here;
        }
        if floor < 0.0 {
            return b2 / a22 * here;
        }
    }
    b1 / a11
}
