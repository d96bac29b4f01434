//! Resonances that move from one FRF to the next, as those of a structure do that warms up between hits.
//!
//! FRFs of one response share their poles whatever the structure is: a hammer brings no mass, and gains,
//! delays and misplaced points move none. (FRFs of different responses do not where an accelerometer roves.)
//! What the resonances differ by among them, beyond their noise, is drift: no model that stays the same in
//! time can follow it.

use crate::local_rational::LocalRationalFit;
use jointscope_spectra::{FrfForm, FrfSet};
use num_complex::Complex64;

/// FRFs of one response from which a drift can be told.
const FEWEST: usize = 3;
/// A resonance's summed |H|² stands out of its neighbourhood's median by this factor, and a value's by this
/// one of its variance.
const STANDS_OUT: f64 = 25.0;
/// Lines on each side of a resonance, at least and as a share of all.
const NEIGHBOURHOOD: (usize, f64) = (8, 0.0025);
/// Lines on each side of a peak that its function is fitted to: half-widths, and limits.
const HALF_WIDTHS: f64 = 3.0;
const LIMITS: (usize, usize) = (5, 60);
/// A resonance is told where its place is known to this share of its half-width.
const KNOWN: f64 = 0.3;
/// A resonance is resolved where its half-width is this many lines, and has moved where it did so by this
/// share of the half-width: less is the local function's own error.
const RESOLVED: f64 = 0.5;
const MOVED: f64 = 0.05;
/// Standard deviations by which the differences must exceed their noise.
const BEYOND_NOISE: f64 = 5.0;

/// How far resonances differ among FRFs of one response.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// Frequency (Hz), relative standard deviation among the FRFs, and relative half-width (damping ratio) of
    /// each resonance, ascending.
    pub resonances: Vec<(f64, f64, f64)>,
}

impl Drift {
    /// The drift of accelerances; `None` where no three of them share a response, or their resonances agree
    /// within their noise.
    pub fn of(frfs: &FrfSet) -> Option<Self> {
        let frfs = frfs.to_form(FrfForm::Accelerance).ok()?;
        let pairs = frfs.pairs();
        let mut resonances = Vec::new();
        let mut drifts = false;
        for first in 0..pairs.len() {
            let group: Vec<usize> =
                (0..pairs.len()).filter(|&i| pairs[i].response == pairs[first].response).collect();
            if group[0] != first || group.len() < FEWEST {
                continue;
            }
            for line in peaks(&frfs, &group) {
                if let Some((resonance, certain)) = differences(&frfs, &group, line) {
                    resonances.push(resonance);
                    drifts |= certain;
                }
            }
        }
        resonances.sort_by(|a, b| a.0.total_cmp(&b.0));
        drifts.then_some(Drift { resonances })
    }

    /// The relative standard deviation of the resonance nearest to `hz`.
    pub fn at(&self, hz: f64) -> f64 {
        let nearest = self.resonances.iter().min_by(|a, b| (a.0 - hz).abs().total_cmp(&(b.0 - hz).abs()));
        nearest.map_or(0.0, |r| r.1)
    }

    /// The place in [`Drift::resonances`] of the one nearest to `hz`.
    pub fn nearest(&self, hz: f64) -> usize {
        let distance = |i: &usize| (self.resonances[*i].0 - hz).abs();
        (0..self.resonances.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    }

    /// |change of the FRF|² when its resonances move by one standard deviation, at each of the lines `wanted`
    /// of an accelerance.
    pub fn squared_change(&self, hz: &[f64], values: &[Complex64], wanted: &[usize]) -> Vec<f64> {
        let mut fit = LocalRationalFit::new();
        let change = |&line: &usize| {
            let distance = self.at(hz[line]) * hz[line];
            fit.about(hz, values, line, LIMITS.0)
                .map_or(0.0, |f| 0.25 * (f.at(distance) - f.at(-distance)).norm_sqr())
        };
        wanted.iter().map(change).collect()
    }
}

fn neighbourhood(lines: usize) -> usize {
    NEIGHBOURHOOD.0.max((lines as f64 * NEIGHBOURHOOD.1) as usize)
}

/// Lines on which the FRFs, taken together, have a resonance that stands well out of its neighbourhood.
pub fn resonant_lines(frfs: &FrfSet) -> Vec<usize> {
    peaks(frfs, &(0..frfs.pairs().len()).collect::<Vec<_>>())
}

/// Lines at which the summed |H|² of some FRFs peaks.
fn peaks(frfs: &FrfSet, group: &[usize]) -> Vec<usize> {
    let n = frfs.lines().len();
    let level: Vec<f64> =
        (0..n).map(|line| group.iter().map(|&i| frfs.values(i)[line].norm_sqr()).sum()).collect();
    let reach = neighbourhood(n);
    let is_peak = |&line: &usize| {
        let near = line.saturating_sub(reach)..(line + reach + 1).min(n);
        if line < LIMITS.0 || line + LIMITS.0 >= n || near.clone().any(|i| level[i] > level[line]) {
            return false;
        }
        let mut sorted = level[near].to_vec();
        sorted.sort_by(f64::total_cmp);
        level[line] > STANDS_OUT * sorted[sorted.len() / 2]
    };
    (0..n).filter(is_peak).collect()
}

/// Mean frequency, relative deviation and relative half-width of the resonance about `line`, and whether its
/// FRFs differ for certain.
fn differences(frfs: &FrfSet, group: &[usize], line: usize) -> Option<((f64, f64, f64), bool)> {
    let hz = frfs.lines().hz();
    let reach = neighbourhood(hz.len());
    let near = line.saturating_sub(reach)..(line + reach + 1).min(hz.len());
    let mut fit = LocalRationalFit::new();
    let (mut places, mut variances, mut widths) = (Vec::new(), Vec::new(), Vec::new());
    for &index in group {
        let values = frfs.values(index);
        let top = near.clone().max_by(|a, b| values[*a].norm_sqr().total_cmp(&values[*b].norm_sqr()))?;
        let step = (hz[(top + 1).min(hz.len() - 1)] - hz[top.saturating_sub(1)]) / 2.0;
        let Some(rough) = fit.about(hz, values, top, LIMITS.0) else { continue };
        let lines = (HALF_WIDTHS * rough.resonance().1 / step).ceil();
        let half = (lines.max(0.0) as usize).clamp(LIMITS.0, LIMITS.1);
        let Some(local) = fit.about(hz, values, top, half) else { continue };
        let (distance, width, variance) = local.resonance();
        let clear = values[top].norm_sqr() > STANDS_OUT * local.variance;
        let known =
            variance.sqrt() < KNOWN * width && distance.abs() < width + step && width > RESOLVED * step;
        if clear && known {
            places.push(hz[top] + distance);
            variances.push(variance);
            widths.push(width);
        }
    }
    let count = places.len() as f64;
    if places.len() < FEWEST {
        return None;
    }
    let mean = places.iter().sum::<f64>() / count;
    let chi2: f64 = places.iter().zip(&variances).map(|(f, v)| (f - mean).powi(2) / v).sum();
    let scatter = places.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let noise = variances.iter().sum::<f64>() / count;
    widths.sort_by(f64::total_cmp);
    let deviation = (scatter - noise).max(0.0).sqrt() / mean;
    let half_width = widths[widths.len() / 2] / mean;
    let certain =
        deviation > MOVED * half_width && chi2 > count - 1.0 + BEYOND_NOISE * (2.0 * (count - 1.0)).sqrt();
    Some(((mean, deviation, half_width), certain))
}
