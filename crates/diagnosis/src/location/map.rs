//! The map of a mismatch: every site fitted, what each leaves unexplained, and the δ(ω) it would have to
//! have.

use super::descent::{Descent, Start};
use super::fitted_law::{FittedLaw, fitted_laws};
use super::free_scalars::FreeScalars;
use super::problem::{Iterate, Parameters, Problem};
use super::recorded::{Recorded, most_informative};
use super::sites::sites;
use super::{BandMisfit, LineEstimate, Location, Site};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::observation::excess;
use crate::settings::Settings;
use crate::{Hypothesis, Observation, Watch};
use jointscope_inference::{each, each_used_up, normal_above};
use jointscope_linalg::Cholesky;
use num_complex::Complex64;

/// What each site leaves unexplained of a mismatch, the best first by χ² and what it asks of the tolerances;
/// empty with fewer than two FRFs, which over-determine nothing.
///
/// Every site sets out from the quantities as `base` has them and as `refitted` bent them, and goes on from
/// the better end. Of a body the abscissa is sought too. The way is found on six dozen lines, half of them
/// the peaks; sites that come near the best are then fitted on all lines, of the others only what they leave
/// there is stated. δ and laws are those of the best three. A recording of more than two thousand lines is
/// thinned: every k-th line, and as many of those with the largest signal against noise.
pub fn locate(base: &Hypothesis, refitted: &Fit, observation: &Observation) -> Vec<Location> {
    located(Fitter { observation, settings: &Settings::default(), watch: Watch::default() }, base, refitted)
}

/// As [`locate`], with the settings of a search.
pub(crate) fn located(fitter: Fitter, base: &Hypothesis, refitted: &Fit) -> Vec<Location> {
    let Fitter { observation, settings, .. } = fitter;
    let settings = &settings.location;
    if observation.pairs().len() < 2 {
        return Vec::new();
    }
    let thinned = most_informative(observation, settings.most_lines);
    let observation = thinned.as_ref().unwrap_or(observation);
    let Ok(fixture) = base.to_fixture() else { return Vec::new() };
    let fewer = most_informative(observation, settings.few_lines);
    let (few, whole) = (
        Recorded::of(fitter.on(fewer.as_ref().unwrap_or(observation))),
        Recorded::of(fitter.on(observation)),
    );
    let [few, whole] = [&few, &whole].map(|recorded| Problem { recorded, moves: true, law: None });
    let starts: Vec<Start> = [base, &refitted.hypothesis].iter().filter_map(|h| few.start(h)).collect();
    let sites = sites(&fixture, observation);
    let approached: Vec<(f64, Descent)> =
        each(&sites, |sites| few.approached(&starts, sites)).into_iter().flatten().collect();
    let (promising, besides) = settings.promising;
    let best = least(approached.iter().map(|(left, _)| *left));
    let reached = each_used_up(approached, |(left, descent)| match left < promising * best + besides {
        true => descent.ended(),
        false => Some((settings.hopeless * left, descent.state)),
    });
    let mut reached: Vec<(f64, Iterate)> = reached.into_iter().flatten().collect();
    reached.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut seen: Vec<Site> = Vec::new();
    reached.retain(|(_, state)| {
        let known = seen.iter().any(|site| site.is_like(&state.parameters.site));
        seen.push(state.parameters.site.clone());
        !known
    });
    let best = least(reached.iter().map(|(left, _)| *left));
    let ended = |(left, on_few): (f64, Iterate)| {
        let state = whole.state(&on_few.parameters, &whole.recorded.weights)?;
        let state =
            if left < settings.rival * best { whole.descended(state, settings.steps.1)?.1 } else { state };
        Some((whole.objective(&state, &whole.recorded.weights), on_few, state))
    };
    let mut ended: Vec<(f64, Iterate, Iterate)> =
        each_used_up(reached, ended).into_iter().flatten().collect();
    ended.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = least(ended.iter().map(|(left, ..)| *left));
    let (count, multiple) = settings.stated;
    let ranked = ended.into_iter().enumerate().collect();
    let all = each_used_up(ranked, |(rank, (left, on_few, state))| {
        let stated = rank < count && left < multiple * best;
        if stated {
            stated_location(&few, &whole, on_few, state, base)
        } else {
            Some(location(&whole, &state))
        }
    });
    let mut all: Vec<Location> = all.into_iter().flatten().collect();
    all.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    all
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

/// The measured δ(ω) of effect `index` of a repaired fit: one free scalar a line at its place, beside the
/// other effects as they were fitted, tolerances yielding from where the fit left them. `None` for an effect
/// that does not act through one site, and with fewer than two FRFs.
pub fn measure(repaired: &Fit, index: usize, observation: &Observation) -> Option<Location> {
    measured(Fitter { observation, settings: &Settings::default(), watch: Watch::default() }, repaired, index)
}

/// As [`measure`], with the settings of a search.
pub(crate) fn measured(fitter: Fitter, repaired: &Fit, index: usize) -> Option<Location> {
    let Fitter { observation, settings, .. } = fitter;
    let settings = &settings.location;
    if observation.pairs().len() < 2 {
        return None;
    }
    let thinned = most_informative(observation, settings.most_lines);
    let observation = thinned.as_ref().unwrap_or(observation);
    let effect = repaired.hypothesis.effects().into_iter().nth(index)?;
    let without = repaired.hypothesis.without(index);
    let site = Site::of(&without.to_fixture().ok()?, &effect)?;
    let fewer = most_informative(observation, settings.few_lines);
    let (few, whole) = (
        Recorded::of(fitter.on(fewer.as_ref().unwrap_or(observation))),
        Recorded::of(fitter.on(observation)),
    );
    let [few, whole] = [&few, &whole].map(|recorded| Problem { recorded, moves: false, law: None });
    let parameters = Parameters::free(&without, &site);
    let (_, on_few) = few.descended(few.state(&parameters, &few.recorded.weights)?, settings.steps.1)?;
    let (_, state) =
        whole.descended(whole.state(&on_few.parameters, &whole.recorded.weights)?, settings.steps.1)?;
    stated_location(&few, &whole, on_few, state, &without)
}

/// What a fitted site comes to, with its δ and its laws. A law may lead to tolerances that suit the free
/// scalars better, too: a false minimum left, from which they then go on.
fn stated_location(
    few: &Problem,
    whole: &Problem,
    on_few: Iterate,
    state: Iterate,
    base: &Hypothesis,
) -> Option<Location> {
    let laws = fitted_laws(few, whole, &few.free_scalars(on_few, false)?, base);
    let settings = &whole.settings().location;
    let weights = &whole.recorded.weights;
    let mut state = state;
    for law in &laws {
        let parameters = Parameters { of_law: Vec::new(), ..law.state.parameters.clone() };
        let Some(other) = whole.state(&parameters, weights) else { continue };
        if whole.objective(&other, weights) + settings.elsewhere < whole.objective(&state, weights) {
            state = whole.descended(other, settings.steps.1)?.1;
        }
    }
    let lowest = whole.objective(&state, weights);
    let mut location = location(whole, &state);
    let free_scalars = whole.free_scalars(state, true)?;
    let delta = deltas(&free_scalars, whole);
    let indices: Vec<usize> = delta.iter().map(|(line, _)| *line).collect();
    let stated = |law: &FittedLaw| whole.stated(law, lowest, &indices);
    location.laws = laws.iter().filter_map(stated).collect();
    location.masked -= delta.len();
    location.delta = delta.into_iter().map(|(_, estimate)| estimate).collect();
    Some(location)
}

/// What a fitted site leaves, by band and FRF.
fn location(problem: &Problem, state: &Iterate) -> Location {
    let recorded = problem.recorded;
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
        of_line.1 = degrees_of_freedom(recorded, state, line);
    }
    let total = |range: std::ops::Range<usize>| {
        lines[range].iter().fold((0.0, 0), |sum, line| (sum.0 + line.0, sum.1 + line.1))
    };
    let (chi2, degrees) = total(0..n);
    let chi2_per_dof = chi2 / degrees.max(1) as f64;
    let bands = problem.settings().location.bands.min(n);
    let band = |b: usize| {
        let (from, to) = (b * n / bands, (b + 1) * n / bands);
        let (chi2, degrees) = total(from..to);
        let chi2_per_dof = Some(chi2 / degrees.max(1) as f64);
        BandMisfit { from: hz[from], to: hz[to - 1], chi2_per_dof }
    };
    Location {
        site: state.parameters.site.clone(),
        chi2_per_dof,
        departures: state.parameters.squared_departures(),
        degrees,
        p_value: if degrees == 0 {
            1.0
        } else {
            normal_above(excess(chi2_per_dof, degrees, observation.noise_uncertainty()))
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

/// Degrees of freedom of a line: real values less the scalar, where it is felt. Values of FRFs that
/// parameters alone on a line determine nothing.
fn degrees_of_freedom(recorded: &Recorded, state: &Iterate, line: usize) -> usize {
    let valid = recorded.places(line).filter(|p| recorded.weights[*p] > 0.0);
    let felt = valid.clone().any(|p| state.slopes[p] != Complex64::ZERO);
    2 * valid.count().saturating_sub(usize::from(felt))
}

/// δ on the lines where the scalar is over-determined and can be inverted, with their indices.
fn deltas(free_scalars: &FreeScalars, problem: &Problem) -> Vec<(usize, LineEstimate)> {
    let known = problem.settings().location.known;
    let n = free_scalars.order;
    let covariance =
        Cholesky::of(n, &free_scalars.information).map_or(vec![0.0; n * n], |factor| factor.inverse());
    let hz = problem.recorded.observation.lines().hz();
    let mut all = Vec::with_capacity(hz.len());
    let mut spread = vec![Complex64::ZERO; n];
    for line in 0..hz.len() {
        let weight = free_scalars.weights[line];
        if weight.is_nan()
            || weight <= 0.0
            || degrees_of_freedom(problem.recorded, &free_scalars.state, line) == 0
        {
            continue;
        }
        let sensitivities = &free_scalars.sensitivities[line * n..(line + 1) * n];
        for (sum, row) in spread.iter_mut().zip(covariance.chunks_exact(n.max(1))) {
            *sum = row.iter().zip(sensitivities).map(|(c, s)| s * *c).sum();
        }
        // Noise has one variance in the real and the imaginary part; of the tolerances' share their mean is
        // stated.
        let tolerances: f64 =
            spread.iter().zip(sensitivities).map(|(a, s)| (a.conj() * s).re).sum::<f64>().max(0.0);
        let deviation = (1.0 / weight + 0.5 * tolerances).sqrt();
        let (z, inversion) = (free_scalars.state.scalars[line], free_scalars.state.inversions[line]);
        let lower = 1.0 - inversion.feedback * z;
        if inversion.feedback.norm() * deviation > known * lower.norm() {
            continue;
        }
        let (mut value, mut std) = (inversion.delta(z), deviation / lower.norm_sqr());
        if matches!(free_scalars.state.parameters.site, Site::Series { .. }) {
            if std > known * value.norm() {
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
