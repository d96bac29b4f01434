//! The map of a mismatch: every site fitted, what each leaves unexplained, and the δ(ω) it would have to have.

use super::descent::{Descent, Start};
use super::followed::{Followed, followed};
use super::recorded::{Recorded, telling};
use super::sites::sites;
use super::subject::{Stand, State, Subject};
use super::yielded::Yielded;
use super::{LineEstimate, Location, Site};
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
/// Lines on which sites and laws find their way.
const FEW_LINES: usize = 72;
/// Sites that leave more than this, times the best and besides, with softened weights are left there.
const PROMISING: (f64, f64) = (300.0, 1000.0);
/// What those leave with softened weights comes after all that the others leave without.
const HOPELESS: f64 = 1e6;
/// Sites that leave up to this many times what the best leaves on those lines are fitted on all lines.
const RIVAL: f64 = 1.5;
/// Steps on all lines, for a site and for one that a law has led elsewhere.
const STEPS: usize = 4;
/// Best sites whose δ and laws are told, and what they may leave, as a multiple of what the best leaves.
const TOLD: usize = 3;
const ALTERNATIVE: f64 = 1.2;
/// Gain in χ² for which a free scalar sets out again from where a law has led.
const ELSEWHERE: f64 = 1.0;
/// 1 − γ·bᵀZ⁻¹b, and the compliance of what is in series, must be known to this share of themselves for δ to be told.
const KNOWN: f64 = 1.0 / 3.0;

/// What each site leaves unexplained of a mismatch, the best first by χ² and what it asks of the tolerances; empty with fewer than two FRFs, which over-determine nothing.
///
/// Every site sets out from the quantities as `base` has them and as `refitted` bent them, and goes on from the better end. Of a body the
/// abscissa is sought too. The way is found on six dozen lines, half of them the peaks; sites that come near the best are then fitted on all
/// lines, of the others only what they leave there is told. δ and laws are those of the best three. A recording of more than two thousand
/// lines is thinned: every k-th line, and as many of those with the largest signal against noise.
pub fn locate(base: &Hypothesis, refitted: &Fit, observation: &Observation) -> Vec<Location> {
    if observation.pairs().len() < 2 {
        return Vec::new();
    }
    let thinned = telling(observation, MOST_LINES);
    let observation = thinned.as_ref().unwrap_or(observation);
    let Ok(fixture) = base.to_fixture() else { return Vec::new() };
    let fewer = telling(observation, FEW_LINES);
    let (few, whole) = (Recorded::of(fewer.as_ref().unwrap_or(observation)), Recorded::of(observation));
    let [few, whole] = [&few, &whole].map(|recorded| Subject { recorded, moves: true, law: None });
    let starts: Vec<Start> = [base, &refitted.hypothesis].iter().filter_map(|h| few.start(h)).collect();
    let approached: Vec<(f64, Descent)> =
        sites(&fixture, observation).par_iter().filter_map(|sites| few.approached(&starts, sites)).collect();
    let best = least(approached.iter().map(|(left, _)| *left));
    let mut reached: Vec<(f64, State)> = approached
        .into_par_iter()
        .filter_map(|(left, descent)| match left < PROMISING.0 * best + PROMISING.1 {
            true => descent.ended(),
            false => Some((HOPELESS * left, descent.state)),
        })
        .collect();
    reached.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut seen: Vec<Site> = Vec::new();
    reached.retain(|(_, state)| {
        let known = seen.iter().any(|site| site.is_like(&state.stand.site));
        seen.push(state.stand.site.clone());
        !known
    });
    let best = least(reached.iter().map(|(left, _)| *left));
    let ended = |(left, on_few): (f64, State)| {
        let state = whole.state(&on_few.stand, &whole.recorded.weights)?;
        let state = if left < RIVAL * best { whole.descended(state, STEPS)?.1 } else { state };
        Some((whole.objective(&state, &whole.recorded.weights), on_few, state))
    };
    let mut ended: Vec<(f64, State, State)> = reached.into_par_iter().filter_map(ended).collect();
    ended.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = least(ended.iter().map(|(left, ..)| *left));
    let mut all: Vec<Location> = ended
        .into_par_iter()
        .enumerate()
        .filter_map(|(rank, (left, on_few, state))| {
            let told = rank < TOLD && left < ALTERNATIVE * best;
            if told {
                told_location(&few, &whole, on_few, state, base)
            } else {
                Some(location(&whole, &state))
            }
        })
        .collect();
    all.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    all
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

/// The measured δ(ω) of effect `index` of a repaired fit: one free scalar a line at its place, beside the other effects as they were
/// fitted, tolerances yielding from where the fit left them. `None` for an effect that does not act through one site, and with fewer
/// than two FRFs.
pub fn measure(repaired: &Fit, index: usize, observation: &Observation) -> Option<Location> {
    if observation.pairs().len() < 2 {
        return None;
    }
    let thinned = telling(observation, MOST_LINES);
    let observation = thinned.as_ref().unwrap_or(observation);
    let effect = repaired.hypothesis.effects().into_iter().nth(index)?;
    let without = repaired.hypothesis.without(index);
    let site = Site::of(&without.to_fixture().ok()?, &effect)?;
    let fewer = telling(observation, FEW_LINES);
    let (few, whole) = (Recorded::of(fewer.as_ref().unwrap_or(observation)), Recorded::of(observation));
    let [few, whole] = [&few, &whole].map(|recorded| Subject { recorded, moves: false, law: None });
    let stand = Stand::free(&without, &site);
    let (_, on_few) = few.descended(few.state(&stand, &few.recorded.weights)?, STEPS)?;
    let (_, state) = whole.descended(whole.state(&on_few.stand, &whole.recorded.weights)?, STEPS)?;
    told_location(&few, &whole, on_few, state, &without)
}

/// What a fitted site comes to, with its δ and its laws. A law may lead to tolerances that suit the free scalars better, too: a false minimum
/// left, from which they then go on.
fn told_location(
    few: &Subject,
    whole: &Subject,
    on_few: State,
    state: State,
    base: &Hypothesis,
) -> Option<Location> {
    let laws = followed(few, whole, &few.yielded(on_few, false)?, base);
    let weights = &whole.recorded.weights;
    let mut state = state;
    for law in &laws {
        let stand = Stand { parameters: Vec::new(), ..law.state.stand.clone() };
        let Some(other) = whole.state(&stand, weights) else { continue };
        if whole.objective(&other, weights) + ELSEWHERE < whole.objective(&state, weights) {
            state = whole.descended(other, STEPS)?.1;
        }
    }
    let lowest = whole.objective(&state, weights);
    let mut location = location(whole, &state);
    let yielded = whole.yielded(state, true)?;
    let delta = deltas(&yielded, whole);
    let indices: Vec<usize> = delta.iter().map(|(line, _)| *line).collect();
    let told = |law: &Followed| whole.told(law, lowest, &indices);
    location.laws = laws.iter().filter_map(told).collect();
    location.masked -= delta.len();
    location.delta = delta.into_iter().map(|(_, estimate)| estimate).collect();
    Some(location)
}

/// What a fitted site leaves, by band and FRF.
fn location(subject: &Subject, state: &State) -> Location {
    let recorded = subject.recorded;
    let observation = recorded.observation;
    let (n, frfs) = (recorded.lines(), recorded.frfs());
    let hz = observation.lines().hz();
    let mut lines = vec![(0.0, 0usize); n];
    let mut by_frf = vec![(0.0, 0usize); frfs];
    for (line, of_line) in lines.iter_mut().enumerate() {
        for (k, place) in recorded.places(line).enumerate().filter(|(_, p)| recorded.weights[*p] > 0.0) {
            let chi2 =
                recorded.weights[place] * (recorded.measured[place] - state.modelled[place]).norm_sqr();
            by_frf[k].0 += chi2;
            by_frf[k].1 += 2;
            of_line.0 += chi2;
        }
        of_line.1 = freedoms(recorded, state, line);
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
    Location {
        site: state.stand.site.clone(),
        chi2_per_dof,
        departures: state.stand.penalty(),
        degrees,
        p_value: if degrees == 0 {
            1.0
        } else {
            upper_tail(excess(chi2_per_dof, degrees, observation.noise_uncertainty()))
        },
        bands: (0..bands).map(band).collect(),
        frfs: observation
            .pairs()
            .iter()
            .zip(by_frf)
            .map(|(pair, (chi2, values))| (pair.clone(), chi2 / values.max(1) as f64))
            .collect(),
        delta: Vec::new(),
        masked: n,
        laws: Vec::new(),
    }
}

/// Degrees of freedom of a line: real values less the scalar, where it is felt. Values of FRFs that stand alone on a line determine nothing.
fn freedoms(recorded: &Recorded, state: &State, line: usize) -> usize {
    let valid = recorded.places(line).filter(|p| recorded.weights[*p] > 0.0);
    let felt = valid.clone().any(|p| state.slopes[p] != Complex64::ZERO);
    2 * valid.count().saturating_sub(usize::from(felt))
}

/// δ on the lines where the scalar is over-determined and can be inverted, with their indices.
fn deltas(yielded: &Yielded, subject: &Subject) -> Vec<(usize, LineEstimate)> {
    let n = yielded.order;
    let covariance = covariance(&yielded.information, n);
    let hz = subject.recorded.observation.lines().hz();
    let mut all = Vec::with_capacity(hz.len());
    let mut spread = vec![Complex64::ZERO; n];
    for line in 0..hz.len() {
        let weight = yielded.weights[line];
        if weight.is_nan() || weight <= 0.0 || freedoms(subject.recorded, &yielded.state, line) == 0 {
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
        if matches!(yielded.state.stand.site, Site::Series { .. }) {
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
