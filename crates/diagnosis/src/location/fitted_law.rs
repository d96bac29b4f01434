//! A site's laws fitted to the FRFs themselves, tolerances yielding.

use super::descent::Descent;
use super::free_scalars::FreeScalars;
use super::guess::{Guess, Measured};
use super::laws::{Law, laws_of};
use super::problem::{Iterate, Parameters, Problem};
use super::{LawFit, LawParameter, Site};
use crate::Hypothesis;
use crate::settings::location::differences::PARAMETER_STEP;
use jointscope_inference::Covariance;
use num_complex::Complex64;

/// A law at its best.
pub(super) struct FittedLaw {
    law: Law,
    pub state: Iterate,
    /// χ² and priors.
    pub objective: f64,
}

impl FittedLaw {
    fn cost(&self, penalty: f64) -> f64 {
        self.objective + penalty * self.state.parameters.of_law.len() as f64
    }
}

/// The laws that come closest to a site's free scalars, the closest first: guessed and fitted on `few` lines,
/// ended on all lines of `whole`. `base` is where the tolerances may set out from besides where the free
/// scalars have led them.
pub(super) fn fitted_laws(
    few: &Problem,
    whole: &Problem,
    free_scalars: &FreeScalars,
    base: &Hypothesis,
) -> Vec<FittedLaw> {
    let settings = &few.settings().location.law;
    let measured = Measured::new(free_scalars, &few.recorded.omegas, settings);
    let laws = laws_of(&free_scalars.state.parameters.site).iter();
    let cost_of = |guess: &Guess| guess.left + settings.penalty * guess.parameters.len() as f64;
    let mut guesses: Vec<(&Law, Guess)> =
        laws.filter_map(|law| measured.guess(law).map(|guess| (law, guess))).collect();
    guesses.sort_by(|a, b| cost_of(&a.1).total_cmp(&cost_of(&b.1)));
    guesses.truncate(settings.fitted.0);
    let least = guesses.first().map_or(0.0, |(_, guess)| cost_of(guess).max(few.recorded.lines() as f64));
    let on_few = guesses
        .iter()
        .filter(|(_, guess)| cost_of(guess) < settings.fitted.1 * least)
        .filter_map(|(law, guess)| few.law_from(law, guess, &free_scalars.state.parameters, base));
    let mut on_few: Vec<FittedLaw> = on_few.collect();
    let cost = |fit: &FittedLaw| fit.cost(settings.penalty);
    on_few.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    let least = on_few.first().map_or(0.0, cost);
    let close = on_few.into_iter().filter(|fit| cost(fit) < settings.close * least);
    let mut all: Vec<FittedLaw> = close.filter_map(|fit| whole.ended(fit)).collect();
    all.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    all
}

impl Problem<'_> {
    fn law_from(&self, law: &Law, guess: &Guess, free: &Parameters, base: &Hypothesis) -> Option<FittedLaw> {
        let settings = &self.settings().location.law;
        let bound = Problem { law: Some(*law), ..*self };
        let obeying = |parameters: Parameters| Parameters { of_law: guess.parameters.clone(), ..parameters };
        let from_base = Parameters { hypothesis: free.hypothesis.with_tolerances_of(base), ..free.clone() };
        let departed = bound.moved(free, &guess.departures);
        let weights = bound.recorded.inflated(settings.inflation[0], &bound.recorded.measured);
        let states = [departed, free.clone(), from_base].map(|s| bound.state(&obeying(s), &weights));
        let left = |state: Iterate| (bound.objective(&state, &weights), state);
        let (_, state) = states.into_iter().flatten().map(left).min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (_, descent) = Descent::from(&bound, state).through(&settings.inflation)?;
        let (objective, descent) = descent.descend(&bound.recorded.weights, settings.steps.0, true)?;
        Some(FittedLaw { law: *law, state: descent.state, objective })
    }

    fn ended(&self, fit: FittedLaw) -> Option<FittedLaw> {
        let bound = Problem { law: Some(fit.law), ..*self };
        let (objective, state) = bound.descended(fit.state, self.settings().location.law.steps.1)?;
        Some(FittedLaw { law: fit.law, state, objective })
    }

    /// The law as it is stated, on the lines `stated`, where free scalars leave `lowest`; `None` where its
    /// parameters are not determined.
    pub(super) fn stated(&self, fit: &FittedLaw, lowest: f64, stated: &[usize]) -> Option<LawFit> {
        let bound = Problem { law: Some(fit.law), ..*self };
        let tangent = bound.tangent(&fit.state, true)?;
        let normal = bound.normal(&fit.state, &tangent, &bound.recorded.weights);
        let parameters = parameters(&fit.law, &fit.state, &normal.covariance()?)?;
        let lines = self.recorded.lines();
        let valid = |line: &usize| {
            let size = |p: usize| self.recorded.weights[p] * fit.state.slopes[p].norm_sqr();
            self.recorded.places(*line).map(size).sum::<f64>() > 0.0
        };
        let degrees = (2 * (0..lines).filter(valid).count()).checked_sub(parameters.len())?;
        let in_series = matches!(fit.state.parameters.site, Site::Series { .. });
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
            values: stated.iter().map(value).collect(),
        })
    }
}

/// The parameters as they are stated, with standard deviations, tolerances included.
fn parameters(law: &Law, state: &Iterate, covariance: &Covariance) -> Option<Vec<LawParameter>> {
    let own = &state.parameters.of_law;
    let p = own.len();
    let first = covariance.order().checked_sub(p)?;
    let values = (law.stated)(own);
    let mut slopes = vec![0.0; p * p];
    for a in 0..p {
        let step = PARAMETER_STEP * own[a].abs().max(1e-12);
        let moved = |sign: f64| {
            let mut parameters = own.clone();
            parameters[a] += sign * step;
            (law.stated)(&parameters)
        };
        let (up, down) = (moved(1.0), moved(-1.0));
        (0..p).for_each(|stated| slopes[stated * p + a] = (up[stated] - down[stated]) / (2.0 * step));
    }
    let tell = |(index, (name, unit)): (usize, &(&'static str, &'static str))| {
        let row = &slopes[index * p..(index + 1) * p];
        let variance: f64 =
            (0..p * p).map(|i| row[i / p] * covariance.at(first + i / p, first + i % p) * row[i % p]).sum();
        let std = variance.max(0.0).sqrt();
        std.is_finite().then_some(LawParameter { name, unit, value: values[index], std })
    };
    law.parameters.iter().enumerate().map(tell).collect()
}
