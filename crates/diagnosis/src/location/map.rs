//! The map of a mismatch: every site fitted, what each leaves unexplained, and the δ(ω) it would have to have.

use super::law_fit::{FittedLaw, Measured};
use super::laws::laws_of;
use super::sites::sites;
use super::yielding::{COARSE_LINES, State, Subject, Yielded};
use super::{LawFit, LineEstimate, Location, Site};
use crate::diagnosis::upper_tail;
use crate::evidence::excess;
use crate::fit::Fit;
use crate::{Hypothesis, Observation};
use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;
use rayon::prelude::*;

/// Bands in which a site's misfit is told.
const BANDS: usize = 12;
/// A recording with more lines than this is thinned for the map.
const MOST_LINES: usize = 2000;
/// Sites whose χ² is within this factor of the best get their uncertainties stated with care.
const RIVAL: f64 = 1.5;
/// Shares by which the scalars are softened while laws are fitted again about the tolerances of the closest.
const SOFTENED: [f64; 7] = [0.1, 0.03, 0.01, 0.0, 0.0, 0.0, 0.0];
/// Relative change of what the closest law leaves that ends them.
const SETTLED: f64 = 1e-3;
/// 1 − γ·bᵀZ⁻¹b, and the compliance of what is in series, must be known to this share of themselves for δ to be told.
const KNOWN: f64 = 1.0 / 3.0;

/// What each site leaves unexplained of a mismatch, the best first; empty with fewer than two FRFs, which over-determine nothing.
///
/// Every site sets out from the quantities as `base` has them and as `refitted` bent them, and goes on from the better end. Of a body the
/// abscissa is sought too. A recording of more than two thousand lines is thinned: every k-th line, and as many of those with the largest
/// signal against noise, which are the peaks.
pub fn locate(base: &Hypothesis, refitted: &Fit, observation: &Observation) -> Vec<Location> {
    if observation.pairs().len() < 2 {
        return Vec::new();
    }
    let thinned = thinned(observation);
    let observation = thinned.as_ref().unwrap_or(observation);
    let Ok(fixture) = base.to_fixture() else { return Vec::new() };
    let starts = [base, &refitted.hypothesis];
    let coarse = observation.thinned(COARSE_LINES);
    let states: Vec<(f64, State)> = sites(&fixture, observation)
        .par_iter()
        .filter_map(|sites| {
            let subject = Subject { observation, site: sites.first()?, moves: true };
            let state = subject.reached(&starts, sites, &coarse)?;
            Some((subject.plain_objective(&state), state))
        })
        .collect();
    let best = states.iter().map(|(objective, _)| *objective).fold(f64::INFINITY, f64::min);
    let mut all: Vec<Location> = states
        .into_par_iter()
        .filter_map(|(objective, state)| {
            let site = state.site.clone();
            let subject = Subject { observation, site: &site, moves: true };
            location(&subject, state, objective < RIVAL * best)
        })
        .collect();
    all.sort_by(|a, b| a.chi2_per_dof.total_cmp(&b.chi2_per_dof));
    all
}

/// The measured δ(ω) of effect `index` of a repaired fit: one free scalar a line at its place, beside the other effects as they were
/// fitted, tolerances yielding from where the fit left them. `None` for an effect that does not act through one site, and with fewer
/// than two FRFs.
pub fn measure(repaired: &Fit, index: usize, observation: &Observation) -> Option<Location> {
    if observation.pairs().len() < 2 {
        return None;
    }
    let thinned = thinned(observation);
    let observation = thinned.as_ref().unwrap_or(observation);
    let effect = repaired.hypothesis.effects().into_iter().nth(index)?;
    let without = repaired.hypothesis.without(index);
    let site = Site::of(&without.to_fixture().ok()?, &effect)?;
    let subject = Subject { observation, site: &site, moves: false };
    location(&subject, subject.approached(&without)?, true)
}

/// Fewer lines, where there are too many.
fn thinned(observation: &Observation) -> Option<Observation> {
    let n = observation.lines().len();
    if n <= MOST_LINES {
        return None;
    }
    let signal = |line: usize| -> f64 {
        let places = (0..observation.pairs().len()).map(|k| k * n + line);
        places.map(|at| observation.weights()[at] * observation.values()[at].norm_sqr()).sum()
    };
    let signals: Vec<f64> = (0..n).map(signal).collect();
    let mut sorted = signals.clone();
    sorted.sort_by(f64::total_cmp);
    let loud = sorted[n - MOST_LINES / 2];
    let every = n.div_ceil(MOST_LINES / 2);
    let hz = observation.lines().hz();
    let kept = |frequency: f64| {
        let line = hz.partition_point(|f| *f < frequency).min(n - 1);
        line % every == 0 || signals[line] >= loud
    };
    observation.reduced(kept, |_| true)
}

/// What a fitted site comes to; `carefully` where its uncertainties and laws will be looked at.
fn location(subject: &Subject, state: State, carefully: bool) -> Option<Location> {
    let observation = subject.observation;
    let yielded = &subject.finished(state, carefully)?;
    let (n, frfs) = (observation.lines().len(), observation.pairs().len());
    let hz = observation.lines().hz();
    // χ² and degrees of freedom of every line; values of FRFs that stand alone on a line determine nothing.
    let mut lines = vec![(0.0, 0usize); n];
    let mut by_frf = vec![(0.0, 0usize); frfs];
    for line in 0..n {
        let weight = |k: usize| observation.weights()[k * n + line];
        let valid = (0..frfs).filter(|&k| weight(k) > 0.0).count();
        for k in (0..frfs).filter(|&k| weight(k) > 0.0) {
            let residual = observation.values()[k * n + line] - yielded.state.modelled[line * frfs + k];
            let chi2 = weight(k) * residual.norm_sqr();
            by_frf[k].0 += chi2;
            by_frf[k].1 += 2;
            lines[line].0 += chi2;
        }
        lines[line].1 = 2 * valid.saturating_sub(usize::from(yielded.weights[line] > 0.0));
    }
    let total = |range: std::ops::Range<usize>| {
        lines[range].iter().fold((0.0, 0), |sum, line| (sum.0 + line.0, sum.1 + line.1))
    };
    let (chi2, degrees) = total(0..n);
    let chi2_per_dof = chi2 / degrees.max(1) as f64;
    let bands = BANDS.min(n);
    let band = |b: usize| {
        let (from, to) = (b * n / bands, (b + 1) * n / bands);
        let (chi2, degrees) = total(from..to);
        (hz[from], hz[to - 1], chi2 / degrees.max(1) as f64)
    };
    let told = deltas(yielded, &lines, hz);
    let indices: Vec<usize> = told.iter().map(|(line, _)| *line).collect();
    let laws = laws(subject, yielded, carefully, &indices);
    Some(Location {
        site: yielded.state.site.clone(),
        chi2_per_dof,
        degrees,
        p_value: if degrees == 0 { 1.0 } else { upper_tail(excess(chi2_per_dof, degrees)) },
        bands: (0..bands).map(band).collect(),
        frfs: observation
            .pairs()
            .iter()
            .zip(by_frf)
            .map(|(pair, (chi2, values))| (pair.clone(), chi2 / values.max(1) as f64))
            .collect(),
        masked: n - told.len(),
        delta: told.into_iter().map(|(_, estimate)| estimate).collect(),
        laws,
    })
}

/// The laws of a site, the closest first. The tolerances that the closest one asks for may be far from those that suit free scalars, and near a
/// resonance no straight line leads there: softly at first, all are fitted again and again from where it went. Derivatives are
/// taken at its own scalars, for those of single lines carry noise, which would let the tolerances seem better known than they are.
fn laws(subject: &Subject, yielded: &Yielded, carefully: bool, told: &[usize]) -> Vec<LawFit> {
    let fitted = |yielded: &Yielded, raised: f64, softness: f64| {
        let measured = Measured::new(yielded, subject.observation.lines().omegas(), raised, softness);
        let laws = laws_of(&yielded.state.site).iter();
        let mut fits: Vec<FittedLaw> = laws.filter_map(|law| measured.fitted(law, told)).collect();
        fits.sort_by(|a, b| a.told.chi2_per_dof.total_cmp(&b.told.chi2_per_dof));
        fits
    };
    let lowest = subject.plain_objective(&yielded.state);
    let first = if carefully { SOFTENED[0] } else { 0.0 };
    let mut fits = fitted(yielded, 0.0, first);
    let mut at = yielded.state.clone();
    let rounds = if carefully { &SOFTENED[1..] } else { &SOFTENED[..0] };
    for softness in rounds {
        let Some(closest) = fits.first() else { break };
        let Some(next) = subject.departed(&at, &closest.departures) else { break };
        let lines = subject.observation.lines().omegas().zip(&next.inversions);
        let scalars = lines.map(|(omega, inversion)| closest.scalar(omega, inversion)).collect();
        let Some(about) = subject.finished_about(next, scalars) else { break };
        let again = fitted(&about, subject.plain_objective(&about.state) - lowest, *softness);
        let before = closest.told.chi2_per_dof;
        let settled = again.first().is_some_and(|a| (a.told.chi2_per_dof - before).abs() < SETTLED * before);
        (fits, at) = (again, about.state);
        if *softness == 0.0 && settled {
            break;
        }
    }
    fits.into_iter().map(|fit| fit.told).collect()
}

/// δ on the lines where the scalar is over-determined and can be inverted, with their indices.
fn deltas(yielded: &Yielded, lines: &[(f64, usize)], hz: &[f64]) -> Vec<(usize, LineEstimate)> {
    let n = yielded.order;
    let covariance = covariance(&yielded.information, n);
    let mut all = Vec::with_capacity(lines.len());
    let mut spread = vec![Complex64::ZERO; n];
    for (line, (_, degrees)) in lines.iter().enumerate() {
        let weight = yielded.weights[line];
        if weight.is_nan() || weight <= 0.0 || *degrees == 0 {
            continue;
        }
        let sensitivities = &yielded.sensitivities[line * n..(line + 1) * n];
        for (sum, row) in spread.iter_mut().zip(covariance.chunks_exact(n.max(1))) {
            *sum = row.iter().zip(sensitivities).map(|(c, s)| s * *c).sum();
        }
        // Noise has one variance in the real and the imaginary part; of the tolerances' share their mean is told.
        let tolerances: f64 =
            spread.iter().zip(sensitivities).map(|(a, s)| (a.conj() * s).re).sum::<f64>().max(0.0);
        let deviation = (1.0 / weight + 0.5 * tolerances).sqrt();
        let (z, inversion) = (yielded.state.scalars[line], yielded.state.inversions[line]);
        let lower = 1.0 - inversion.feedback * z;
        if inversion.feedback.norm() * deviation > KNOWN * lower.norm() {
            continue;
        }
        let (mut value, mut std) = (inversion.delta(z), deviation / lower.norm_sqr());
        if matches!(yielded.state.site, Site::Series { .. }) {
            if std > KNOWN * value.norm() {
                continue;
            }
            (value, std) = (value.inv(), std / value.norm_sqr());
        }
        if value.is_finite() && std.is_finite() {
            all.push((line, LineEstimate { frequency: hz[line], value, std }));
        }
    }
    all
}

/// Inverse of a positive definite matrix; zeros where it has none.
fn covariance(information: &[f64], n: usize) -> Vec<f64> {
    let mut inverse = vec![0.0; n * n];
    for a in 0..n {
        let (mut copy, mut column) = (information.to_vec(), vec![0.0; n]);
        column[a] = 1.0;
        if !solve_positive_definite(&mut copy, &mut column) {
            return vec![0.0; n * n];
        }
        (0..n).for_each(|b| inverse[b * n + a] = column[b]);
    }
    inverse
}
