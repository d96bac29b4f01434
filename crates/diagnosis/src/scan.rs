//! A hypothesis about which effects are tried with its quantities linearised, or held where they are.

use crate::candidate::Candidate;
use crate::fitter::Fitter;
use crate::{Hypothesis, Linearisation};
use jointscope_fixture::Effect;
use jointscope_inference::{dot, each, whitened};
use jointscope_linalg::Cholesky;
use num_complex::Complex64;
use std::borrow::Cow;

/// A base about which effects are tried with the tolerances linearised, or held where they are.
pub(crate) struct Scan<'a> {
    fitter: Fitter<'a>,
    base: Hypothesis,
    pub linear: Linearisation,
    /// √w·derivative by coordinate.
    columns: Vec<Vec<f64>>,
    weights: Cow<'a, [f64]>,
    /// Of the tolerances' information, which all that is tried shares; `None` where a combination of them is
    /// not determined.
    factor: Option<Cholesky>,
    predicted: Vec<Complex64>,
    /// What the base leaves, √w·residual, and what the tolerances make of it.
    residual: Vec<f64>,
    step: Vec<f64>,
}

impl<'a> Scan<'a> {
    /// About `base` with noise `inflation`, its quantities `yielding` or held.
    pub(crate) fn about(
        fitter: Fitter<'a>,
        base: Hypothesis,
        inflation: f64,
        yielding: bool,
    ) -> Option<Self> {
        let observation = fitter.observation;
        let predicted = base.predict(observation).ok()?;
        let weights = observation.inflated_weights(&predicted, inflation);
        let linear = if yielding { fitter.linearised(&base) } else { Linearisation::default() };
        let residual = observation.residual(&predicted);
        let equations = linear.equations(&base, &weights, &residual);
        let columns = linear.derivatives.iter().map(|d| whitened(d, &weights)).collect();
        let step = equations.step(0.0).unwrap_or_else(|| vec![0.0; equations.order]);
        let residual = whitened(&residual, &weights);
        Some(Scan {
            fitter,
            base,
            linear,
            columns,
            weights,
            factor: Cholesky::of(equations.order, &equations.information),
            predicted,
            residual,
            step,
        })
    }

    /// Quantities whose deviation changes the FRFs by less than inflated noise can tell.
    pub(crate) fn insensitive(&self) -> Vec<usize> {
        let least = self.fitter.settings.ranking.insensitive;
        let is_below = |m: &usize| dot(&self.columns[*m], &self.columns[*m]) < least * self.base.prior(*m);
        (0..self.base.tolerances().len()).filter(is_below).collect()
    }

    /// What the base leaves.
    pub(crate) fn objective(&self) -> f64 {
        dot(&self.residual, &self.residual) + self.base.squared_departures()
    }

    /// What direction `index` of a candidate gains at its best size, to first order with the tolerances
    /// yielding, and the effect of that size.
    pub(crate) fn first_order(&self, candidate: &Candidate, index: usize) -> (f64, Option<Effect>) {
        let nothing = (0.0, None);
        let Some(small) = candidate.scaled(index, 1.0) else { return nothing };
        let Ok(moved) = self.base.with(small).predict(self.fitter.observation) else { return nothing };
        let change: Vec<Complex64> = moved.iter().zip(&self.predicted).map(|(m, p)| m - p).collect();
        let change = whitened(&change, &self.weights);
        let shared: Vec<f64> = self.columns.iter().map(|column| dot(column, &change)).collect();
        let Some(factor) = &self.factor else { return nothing };
        // bᵀ A⁻¹ b = |L⁻¹ b|²
        let mut absorbed = shared.clone();
        factor.solve_lower_in_place(&mut absorbed);
        let own = dot(&change, &change);
        let left = own - dot(&absorbed, &absorbed);
        // What the tolerances can imitate to nine digits is not to be told from them.
        if left <= 1e-9 * own {
            return nothing;
        }
        let slope = dot(&change, &self.residual) - dot(&shared, &self.step);
        (slope * slope / left, candidate.scaled(index, slope / left))
    }

    /// The score of each (candidate, start).
    pub(crate) fn scores(&self, starts: &[(usize, usize)], candidates: &[Candidate]) -> Vec<f64> {
        each(starts, |&(c, s)| self.score(candidates[c].effect(s)))
    }

    /// The objective with `effect` added and everything else at its linear best.
    fn score(&self, effect: Effect) -> f64 {
        let Ok(predicted) = self.base.with(effect).predict(self.fitter.observation) else {
            return f64::INFINITY;
        };
        let residual = whitened(&self.fitter.observation.residual(&predicted), &self.weights);
        let misfit = dot(&residual, &residual);
        let pull = |m: usize| self.base.prior(m) * self.base.coordinates[m];
        let Some(factor) = &self.factor else { return misfit };
        let mut right: Vec<f64> =
            self.columns.iter().enumerate().map(|(m, column)| dot(column, &residual) - pull(m)).collect();
        factor.solve_lower_in_place(&mut right);
        misfit + self.base.squared_departures() - dot(&right, &right)
    }
}
