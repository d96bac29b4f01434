//! A site's laws fitted to the FRFs themselves, tolerances yielding.

use super::descent::{Descent, NEAR, THERE};
use super::guess::{Guess, Measured};
use super::laws::{Law, laws_of};
use super::subject::{Stand, State, Subject};
use super::yielded::Yielded;
use super::{LawFit, LawParameter, Site};
use crate::Hypothesis;
use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;

/// Laws followed to the end, and how many times what the closest guess leaves the others may leave.
const FOLLOWED: usize = 3;
const RIVAL: f64 = 20.0;
/// On fewer lines: what the closest law leaves times this is worth another look on all of them.
const CLOSE: f64 = 1.5;
/// What each parameter must gain in χ² for a law to be called closer.
const PRICE: f64 = 3.0;
/// Share of their size that counts as noise of the scalars while laws are guessed.
const SOFT: f64 = 0.1;
/// Shares by which weights are softened while a law is followed; steps for each, and for the last ones without any.
const SOFTENED: [f64; 3] = [0.1, 0.03, 0.01];
const STEPS: usize = 3;
const LAST_STEPS: usize = 6;
/// Relative step of the parameters' differences.
const DIFFERENCE: f64 = 1e-5;

/// A law at its best.
pub(super) struct Followed {
    law: Law,
    pub state: State,
    /// χ² and priors.
    pub objective: f64,
}

impl Followed {
    fn cost(&self) -> f64 {
        self.objective + PRICE * self.state.stand.parameters.len() as f64
    }
}

/// The laws that come closest to a site's free scalars, the closest first: guessed and followed on `few` lines, ended on all lines of
/// `whole`. `base` is where the tolerances may set out from besides where the free scalars have led them.
pub(super) fn followed(
    few: &Subject,
    whole: &Subject,
    yielded: &Yielded,
    base: &Hypothesis,
) -> Vec<Followed> {
    let measured = Measured::new(yielded, &few.recorded.omegas, SOFT);
    let laws = laws_of(&yielded.state.stand.site).iter();
    let price = |guess: &Guess| guess.left + PRICE * guess.parameters.len() as f64;
    let mut guesses: Vec<(&Law, Guess)> =
        laws.filter_map(|law| measured.guess(law).map(|guess| (law, guess))).collect();
    guesses.sort_by(|a, b| price(&a.1).total_cmp(&price(&b.1)));
    guesses.truncate(FOLLOWED);
    let least = guesses.first().map_or(0.0, |(_, guess)| price(guess).max(few.recorded.lines() as f64));
    let on_few = guesses
        .iter()
        .filter(|(_, guess)| price(guess) < RIVAL * least)
        .filter_map(|(law, guess)| few.law_from(law, guess, &yielded.state.stand, base));
    let mut on_few: Vec<Followed> = on_few.collect();
    on_few.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    let least = on_few.first().map_or(0.0, Followed::cost);
    let close = on_few.into_iter().filter(|fit| fit.cost() < CLOSE * least);
    let mut all: Vec<Followed> = close.filter_map(|fit| whole.ended(fit)).collect();
    all.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    all
}

impl Subject<'_> {
    fn law_from(&self, law: &Law, guess: &Guess, free: &Stand, base: &Hypothesis) -> Option<Followed> {
        let bound = Subject { law: Some(*law), ..*self };
        let obeying = |stand: Stand| Stand { parameters: guess.parameters.clone(), ..stand };
        let from_base = Stand { hypothesis: free.hypothesis.with_tolerances_of(base), ..free.clone() };
        let departed = bound.moved(free, &guess.departures);
        let weights = bound.recorded.softened(SOFTENED[0], &bound.recorded.measured);
        let states = [departed, free.clone(), from_base].map(|s| bound.state(&obeying(s), &weights));
        let left = |state: State| (bound.objective(&state, &weights), state);
        let (_, state) = states.into_iter().flatten().map(left).min_by(|a, b| a.0.total_cmp(&b.0))?;
        let mut descent = Descent::from(&bound, state);
        descent.soften(&SOFTENED)?;
        let objective = descent.descend(&bound.recorded.weights, STEPS, NEAR)?;
        Some(Followed { law: *law, state: descent.state, objective })
    }

    fn ended(&self, fit: Followed) -> Option<Followed> {
        let bound = Subject { law: Some(fit.law), ..*self };
        let mut descent = Descent::from(&bound, fit.state);
        let objective = descent.descend(&bound.recorded.weights, LAST_STEPS, THERE)?;
        Some(Followed { state: descent.state, objective, ..fit })
    }

    /// The law as it is told, on the lines `told`, where free scalars leave `lowest`; `None` where its parameters are not determined.
    pub fn told(&self, fit: &Followed, lowest: f64, told: &[usize]) -> Option<LawFit> {
        let bound = Subject { law: Some(fit.law), ..*self };
        let tangent = bound.tangent(&fit.state, true)?;
        let normal = bound.normal(&fit.state, &tangent, &bound.recorded.weights);
        let parameters = parameters(&fit.law, &fit.state, &normal.matrix, tangent.order)?;
        let lines = self.recorded.lines();
        let valid = |line: &usize| {
            let size = |p: usize| self.recorded.weights[p] * fit.state.slopes[p].norm_sqr();
            self.recorded.places(*line).map(size).sum::<f64>() > 0.0
        };
        let degrees = (2 * (0..lines).filter(valid).count()).checked_sub(parameters.len())?;
        let in_series = matches!(fit.state.stand.site, Site::Series { .. });
        let value = |&line: &usize| -> Complex64 {
            let component = fit.state.inversions[line].delta(fit.state.scalars[line]);
            if in_series { component.inv() } else { component }
        };
        (degrees > 0).then(|| LawFit {
            name: fit.law.name,
            formula: fit.law.formula,
            chi2_per_dof: (fit.objective - lowest).max(0.0) / degrees as f64,
            parameters,
            degrees,
            values: told.iter().map(value).collect(),
        })
    }
}

/// The parameters as they are told, with standard deviations, tolerances included.
fn parameters(law: &Law, state: &State, information: &[f64], order: usize) -> Option<Vec<LawParameter>> {
    let own = &state.stand.parameters;
    let p = own.len();
    let first = order.checked_sub(p)?;
    let mut covariance = vec![0.0; p * p];
    for a in 0..p {
        let (mut copy, mut column) = (information.to_vec(), vec![0.0; order]);
        column[first + a] = 1.0;
        if !solve_positive_definite(&mut copy, &mut column) {
            return None;
        }
        (0..p).for_each(|b| covariance[a * p + b] = column[first + b]);
    }
    let values = (law.told)(own);
    let mut slopes = vec![0.0; p * p];
    for a in 0..p {
        let step = DIFFERENCE * own[a].abs().max(1e-12);
        let moved = |sign: f64| {
            let mut parameters = own.clone();
            parameters[a] += sign * step;
            (law.told)(&parameters)
        };
        let (up, down) = (moved(1.0), moved(-1.0));
        (0..p).for_each(|told| slopes[told * p + a] = (up[told] - down[told]) / (2.0 * step));
    }
    let tell = |(index, (name, unit)): (usize, &(&'static str, &'static str))| {
        let row = &slopes[index * p..(index + 1) * p];
        let variance: f64 = (0..p * p).map(|i| row[i / p] * covariance[i] * row[i % p]).sum();
        let std = variance.max(0.0).sqrt();
        std.is_finite().then_some(LawParameter { name, unit, value: values[index], std })
    };
    law.parameters.iter().enumerate().map(tell).collect()
}
