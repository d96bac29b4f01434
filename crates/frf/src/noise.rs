//! Variances of FRFs: from coherence and averages where they were recorded, from the FRFs themselves where not.
//!
//! With n averages the variance of one complex value is (1 − γ²)/((n − 1) γ²)·|H|², but as an estimate line by line
//! it has so few degrees of freedom that weights taken from it are worthless. The physics behind it is smooth:
//! response noise is a floor in the accelerance, force noise is a share of |H|². [`with_variances`] therefore
//! fits var = S + N·|H|² with S and N slowly varying over the lines.

use crate::local_rational::LocalRationalFit;
use jointscope_spectra::{FrfForm, FrfSet, SpectraError, median};
use num_complex::Complex64;
use serde::Serialize;

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

/// Averages that a recording may have.
const AVERAGES: (f64, f64) = (1.5, 1000.0);

/// The number of averages with which a coherence states the noise that the `scatter` over the lines shows; `None` where they do not go together.
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

/// Half-width of the window, in lines, within which the noise is taken as constant.
const WINDOW: usize = 25;
/// The least of it where levels are followed from line to line.
const SHORTEST: usize = 4;
/// Fewest usable lines from which a scatter can be estimated.
const FEWEST: usize = 8;
/// Power of the force, relative to the strongest line's, that counts as none.
const NO_FORCE: f64 = 1e-12;
/// Smallest relative noise that is believed: quantisation and calibration are never better.
pub(crate) const FLOOR: f64 = 1e-5;

/// The set with its own variances, or where it has none with those of [`with_variances`]; and where these came from, nothing for its own.
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

/// Degrees of freedom from which a local level of variances is told: to an eighth.
const TOLD: f64 = 150.0;
/// Steps in which such a level is found.
const STEPS: usize = 6;

/// Variances E|ε|² of one FRF from its coherence and number of averages, smoothed over the lines.
///
/// A file says nothing of the force, whose power falls by decades within few lines before a soft tip's first zero, and the variances rise by as much. So what the lines
/// show against a noise that varies slowly is followed over no more of them than tell a level: with n averages each has 2(n − 1) degrees of freedom.
pub(crate) fn from_coherence(values: &[Complex64], coherence: &[f64], averages: u32) -> Vec<f64> {
    let raw = of_lines(values, coherence, averages);
    let slow = smoothed(values, &raw, coherence, &[], 1.0);
    let ratios: Vec<f64> = raw.iter().zip(&slow).map(|(raw, slow)| raw / slow).collect();
    let degrees = 2.0 * f64::from(averages.max(2) - 1);
    let reach = ((TOLD / degrees / 2.0).ceil() as usize).clamp(SHORTEST, WINDOW);
    let level = |line: usize| {
        let usable = around(line, reach, raw.len()).filter(|&i| coherence[i] > 0.0);
        let near: Vec<(f64, f64)> = usable.map(|i| (i as f64 - line as f64, ratios[i])).collect();
        // What a level from ν degrees of freedom divides is too large in the mean by ν/(ν − 2).
        let all = degrees * near.len() as f64;
        local_level(&near).map_or(1.0, |level| level * all / (all - 2.0).max(1.0))
    };
    let floor = |value: &Complex64| (FLOOR * FLOOR * value.norm_sqr()).max(f64::MIN_POSITIVE);
    let lines = values.iter().zip(&slow).enumerate();
    lines.map(|(line, (value, slow))| (slow * level(line)).max(floor(value))).collect()
}

/// The level at zero of variances at distances from there, their logarithm along a straight line: the most likely one for spreads in proportion to the level. `None` of too
/// few, or where they are all nothing.
fn local_level(near: &[(f64, f64)]) -> Option<f64> {
    let count = near.len() as f64;
    let mean = near.iter().map(|(_, ratio)| ratio).sum::<f64>() / count;
    if near.len() < FEWEST || mean <= 0.0 {
        return None;
    }
    let (first, second) =
        near.iter().fold((0.0, 0.0), |(first, second), (at, _)| (first + at, second + at * at));
    let determinant = count * second - first * first;
    let (mut level, mut slope) = (mean.ln(), 0.0);
    for _ in 0..STEPS {
        let (mut b0, mut b1) = (0.0, 0.0);
        for (at, ratio) in near {
            let excess = ratio / (level + slope * at).exp() - 1.0;
            (b0, b1) = (b0 + excess, b1 + excess * at);
        }
        // A step no farther than by half: single lines far above the rest would throw it off.
        let step = ((b0 * second - b1 * first) / determinant, (b1 * count - b0 * first) / determinant);
        let reach = near.iter().map(|(at, _)| (step.0 + step.1 * at).abs()).fold(0.0, f64::max);
        let share = (0.5 / reach.max(f64::MIN_POSITIVE)).min(1.0);
        (level, slope) = (level + share * step.0, slope + share * step.1);
    }
    Some(level.exp())
}

/// Variance E|ε|² of one value by line as coherence and averages state it, (1 − γ²)/((n − 1)γ²)·|H|²: right in the mean over many lines,
/// with too few degrees of freedom to weigh a single one by.
pub fn of_lines(values: &[Complex64], coherence: &[f64], averages: u32) -> Vec<f64> {
    let degrees = f64::from(averages.max(2) - 1);
    let of_line = |(value, gamma2): (&Complex64, &f64)| {
        let gamma2 = gamma2.clamp(1e-6, 1.0);
        (1.0 - gamma2) / (degrees * gamma2) * value.norm_sqr()
    };
    values.iter().zip(coherence).map(of_line).collect()
}

/// Smooths variances of single lines over the lines: the noise of the channels varies slowly, and what it makes of an FRF rises wherever
/// the power of the `force`, in any unit, dips. An empty `force` is one that is the same on all lines; lines without coherence are skipped.
///
/// `alike` is the number of neighbouring lines that tell as much about the noise as one line whose noise is its own: 1 without a window, more under
/// one or with zero padding. The mean is over that many times more lines: a variance from few independent values is too small as often as too large,
/// and what it divides is too large in the mean.
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
    let usable: Vec<bool> = coherence.iter().map(|&g| g > 0.0).collect();
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

/// Lines on each side from which the course of an FRF through a line is taken.
pub(crate) const NEIGHBOURS: usize = 5;
/// |H|² below this share of the largest counts as nothing.
const NOTHING: f64 = 1e-30;
/// A line whose own noise is followed to more than this share tells nothing about it.
pub(crate) const FOLLOWED: f64 = 0.8;
/// Squared errors beyond this many times their expected size are peaks that the local function missed, not noise.
const CLIPPED: f64 = 8.0;

/// Variances E|ε|² of one FRF from what is left of its values at `hz` by a rational function through their neighbours: one mode and a
/// smooth rest. Medians over a window keep out what is neither, two modes at once.
pub fn from_scatter(hz: &[f64], values: &[Complex64]) -> Vec<f64> {
    let n = values.len();
    let size: Vec<f64> = values.iter().map(|v| v.norm_sqr()).collect();
    let largest = size.iter().copied().fold(0.0, f64::max);
    if n < FEWEST.max(2 * NEIGHBOURS + 1) {
        return vec![(0.01f64.powi(2) * largest).max(f64::MIN_POSITIVE); n];
    }
    let mut fit = LocalRationalFit::new();
    let local = |line: usize| {
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

fn around(line: usize, reach: usize, n: usize) -> std::ops::Range<usize> {
    line.saturating_sub(reach)..(line + reach + 1).min(n)
}

/// Fits raw variances as S + N·|H|² within a sliding window: both non-negative, weighted by the fit itself, as the
/// spread of a variance is proportional to it, and clipped at so many times the fit.
fn smooth(
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
        let weight = 1.0 / (fit[i] * fit[i]).max(f64::MIN_POSITIVE);
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

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_samples::Noise;

    fn resonance(line: usize) -> Complex64 {
        let x = line as f64 / 400.0;
        let square = |v: f64| v * v;
        -square(x) / (Complex64::new(square(0.37) - square(x), 2.0 * 0.01 * 0.37 * x))
    }

    /// Hits of one FRF: H1 and coherence of `n` averages with response noise `floor` and force noise `share`.
    fn measure(random: &mut Noise, truth: Complex64, n: u32, floor: f64, share: f64) -> (Complex64, f64) {
        let (mut xx, mut yy, mut xy) = (0.0, 0.0, Complex64::ZERO);
        for _ in 0..n {
            let x = Complex64::ONE + random.complex(share);
            let y = truth + random.complex(floor);
            xx += x.norm_sqr();
            yy += y.norm_sqr();
            xy += y * x.conj();
        }
        (xy / xx, xy.norm_sqr() / (xx * yy))
    }

    #[test]
    fn smoothed_variances_of_few_averages_normalise_the_errors_to_one() {
        for averages in [5, 8, 20] {
            let mut random = Noise::from_state(averages as u64);
            let (mut chi2, mut count) = (0.0, 0.0);
            for _ in 0..20 {
                let lines: Vec<(Complex64, f64)> =
                    (1..401).map(|l| measure(&mut random, resonance(l), averages, 1e-2, 1e-5)).collect();
                let values: Vec<Complex64> = lines.iter().map(|l| l.0).collect();
                let coherence: Vec<f64> = lines.iter().map(|l| l.1).collect();
                let variance = from_coherence(&values, &coherence, averages);
                for (i, v) in variance.iter().enumerate() {
                    chi2 += (values[i] - resonance(i + 1)).norm_sqr() / v;
                    count += 1.0;
                }
            }
            let ratio = chi2 / count;
            assert!((0.93..1.07).contains(&ratio), "{averages} averages: chi2 per degree of freedom {ratio}");
        }
    }

    #[test]
    fn without_coherence_the_scatter_of_the_lines_gives_the_floor() {
        let mut random = Noise::from_state(7);
        let (mut chi2, mut count) = (0.0, 0.0);
        for _ in 0..20 {
            let values: Vec<Complex64> = (1..401).map(|l| resonance(l) + random.complex(1e-4)).collect();
            for (i, v) in from_scatter(&hz(400), &values).iter().enumerate() {
                chi2 += (values[i] - resonance(i + 1)).norm_sqr() / v;
                count += 1.0;
            }
        }
        let ratio: f64 = chi2 / count;
        assert!((0.8..1.2).contains(&ratio), "{ratio}");
    }

    fn hz(count: usize) -> Vec<f64> {
        (1..=count).map(|l| l as f64).collect()
    }

    /// A peak whose half-width is a third of a line's distance, noise a share of |H|.
    #[test]
    fn without_coherence_noise_that_grows_with_a_sharp_peak_is_seen_on_the_peak_too() {
        let sharp = |line: usize| {
            let x = line as f64;
            -x * x / Complex64::new(130.3 * 130.3 - x * x, 2.0 * 0.3 * x)
                - 0.7 * x * x / Complex64::new(341.6 * 341.6 - x * x, 0.5 * x)
        };
        let mut random = Noise::from_state(11);
        let (mut all, mut peak) = ((0.0, 0.0), (0.0, 0.0));
        for _ in 0..40 {
            let values: Vec<Complex64> =
                (1..401).map(|l| sharp(l) * (1.0 + random.complex(1e-4)) + random.complex(1e-6)).collect();
            for (i, v) in from_scatter(&hz(400), &values).iter().enumerate() {
                let chi2 = (values[i] - sharp(i + 1)).norm_sqr() / v;
                let near = (i as f64 + 1.0 - 130.3).abs() < 4.0;
                let sum = if near { &mut peak } else { &mut all };
                *sum = (sum.0 + chi2, sum.1 + 1.0);
            }
        }
        let ratios = [all.0 / all.1, peak.0 / peak.1];
        assert!(ratios.iter().all(|r| (0.8f64..1.3).contains(r)), "away from and on the peak: {ratios:?}");
    }

    #[test]
    fn a_noiseless_frf_keeps_a_positive_variance() {
        let values: Vec<Complex64> = (1..100).map(resonance).collect();
        assert!(from_coherence(&values, &vec![1.0; 99], 5).iter().all(|v| *v > 0.0 && v.is_finite()));
        assert!(from_scatter(&hz(values.len()), &values).iter().all(|v| *v > 0.0 && v.is_finite()));
        assert!(from_scatter(&hz(3), &values[..3]).iter().all(|v| *v > 0.0));
    }

    /// A soft tip's blow, a half sine whose spectrum has its first zero within the band, as share of its force at 0 Hz.
    fn soft(line: usize) -> f64 {
        let a = 1.5 * line as f64 / 250.0;
        ((std::f64::consts::PI * a).cos() / (1.0 - 4.0 * a * a)).abs().max(0.03)
    }

    #[test]
    fn where_the_force_dies_away_within_the_band_errors_are_normalised_to_one_all_the_same() {
        for averages in [5, 10] {
            let mut random = Noise::from_state(40 + u64::from(averages));
            // χ² and number of lines, where the blow is strong and where it is weak.
            let mut sums = [(0.0, 0.0); 2];
            for _ in 0..40 {
                let blow = |l: usize, random: &mut Noise| {
                    let share = soft(l);
                    measure(random, resonance(l), averages, 1e-4 / (share * share), 1e-9)
                };
                let lines: Vec<(Complex64, f64)> = (1..401).map(|l| blow(l, &mut random)).collect();
                let (values, coherence): (Vec<Complex64>, Vec<f64>) = lines.into_iter().unzip();
                for (i, v) in from_coherence(&values, &coherence, averages).iter().enumerate() {
                    let sum = &mut sums[usize::from(soft(i + 1) < 0.1)];
                    sum.0 += (values[i] - resonance(i + 1)).norm_sqr() / v;
                    sum.1 += 1.0;
                }
            }
            for (chi2, count) in sums {
                let ratio: f64 = chi2 / count;
                assert!(
                    (0.93..1.07).contains(&ratio),
                    "{averages} averages: chi2 per degree of freedom {ratio}"
                );
            }
        }
    }
}
