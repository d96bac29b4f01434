//! The fit of a place: weights with inflated noise on few lines first, then the recording as it is.

use super::Site;
use super::problem::{Iterate, Modelled, Parameters, Problem};
use super::tangent::Tangent;
use crate::Hypothesis;
use jointscope_inference::{
    Convergence, DerivativePrecision, LeastSquares, NormalEquations, Settings, descend,
};

/// A place fitted with given weights.
struct Weighted<'a> {
    problem: &'a Problem<'a>,
    weights: &'a [f64],
}

impl LeastSquares for Weighted<'_> {
    type Point = Iterate;
    type Weights = ();
    type Derivatives = Tangent;
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Iterate) {}

    fn objective(&self, at: &Iterate, _: &()) -> f64 {
        self.problem.objective(at, self.weights)
    }

    fn derivatives(&self, at: &Iterate, _: DerivativePrecision) -> Option<Tangent> {
        self.problem.tangent(at, false)
    }

    fn equations(&self, at: &Iterate, tangent: &Tangent, _: &()) -> NormalEquations {
        self.problem.normal(at, tangent, self.weights)
    }

    fn stepped(&self, at: &Iterate, equations: &NormalEquations, damping: f64) -> Option<Iterate> {
        let moved = self.problem.moved(&at.parameters, &equations.step(damping)?);
        self.problem.state(&moved, self.weights)
    }
}

/// A hypothesis from which all sites set out.
pub(super) struct Start {
    hypothesis: Hypothesis,
    centre: Modelled,
    surroundings: Vec<Modelled>,
}

/// A fit of a place under way, with derivatives that were taken somewhere behind it.
pub(super) struct Descent<'a> {
    problem: &'a Problem<'a>,
    pub state: Iterate,
    tangent: Option<Tangent>,
}

impl<'a> Descent<'a> {
    pub(super) fn from(problem: &'a Problem<'a>, state: Iterate) -> Self {
        Descent { problem, state, tangent: None }
    }

    /// Up to `steps` steps with the given weights: what is left, and where. `None` where there are no
    /// derivatives. `on_the_way` to other weights old derivatives are believed when they say that it has
    /// converged.
    pub(super) fn descend(self, weights: &[f64], steps: usize, on_the_way: bool) -> Option<(f64, Self)> {
        let settings = &self.problem.settings().location;
        // Free scalars are those of other weights.
        let state = self.problem.state(&self.state.parameters, weights)?;
        let convergence: Convergence = if on_the_way { settings.near } else { settings.end };
        let settings = Settings {
            steps,
            damping: settings.damping,
            convergence,
            trust_old: on_the_way,
            ..Settings::default()
        };
        let end = descend(&Weighted { problem: self.problem, weights }, state, self.tangent, &settings)?;
        Some((end.objective, Descent { state: end.point, tangent: Some(end.derivatives), ..self }))
    }

    /// Goes on by stages with inflated noise; with what is left of the last.
    pub(super) fn through(self, inflations: &[f64]) -> Option<(f64, Self)> {
        let mut reached = (f64::INFINITY, self);
        for inflation in inflations {
            let weights = reached.1.problem.recorded.inflated(*inflation, &reached.1.state.modelled);
            let steps = reached.1.problem.settings().location.steps.0;
            reached = reached.1.descend(&weights, steps, true)?;
        }
        Some(reached)
    }

    /// The last stages, with and without inflated noise; with what is left.
    pub(super) fn ended(self) -> Option<(f64, Iterate)> {
        let problem = self.problem;
        let settings = &problem.settings().location;
        let (_, descent) = self.through(&settings.inflation[settings.dropped_after..])?;
        let (left, descent) = descent.descend(&problem.recorded.weights, settings.steps.0, true)?;
        Some((left, descent.state))
    }
}

impl Problem<'_> {
    /// What all sites have in common at a hypothesis.
    pub(super) fn start(&self, hypothesis: &Hypothesis) -> Option<Start> {
        let centre = self.model(hypothesis)?;
        Some(Start { hypothesis: hypothesis.clone(), centre, surroundings: self.surroundings(hypothesis)? })
    }

    /// Fits from each of several starts with inflated noise, of each from the most promising of `sites`, and
    /// some way on from the best of their ends; with what is left, noise still inflated.
    pub(super) fn approached(&self, starts: &[Start], sites: &[Site]) -> Option<(f64, Descent<'_>)> {
        let settings = &self.settings().location;
        let weights = self.recorded.inflated(settings.inflation[0], &self.recorded.measured);
        let states: Vec<(f64, &Start, Iterate)> = starts
            .iter()
            .filter_map(|start| {
                self.promising(start, sites, &weights).map(|(left, state)| (left, start, state))
            })
            .collect();
        let best = states.iter().map(|(left, ..)| *left).fold(f64::INFINITY, f64::min);
        let near = states.into_iter().filter(|(left, ..)| *left <= settings.followed * best);
        let ends = near.filter_map(|(_, start, state)| {
            let tangent = Some(self.tangent_amid(&state, &start.surroundings)?);
            Descent { tangent, ..Descent::from(self, state) }
                .through(&settings.inflation[..settings.compared])
        });
        let (_, descent) = ends.min_by(|a, b| a.0.total_cmp(&b.0))?;
        descent.through(&settings.inflation[settings.compared..settings.dropped_after])
    }

    /// The fit without inflated noise.
    pub(super) fn descended(&self, state: Iterate, steps: usize) -> Option<(f64, Iterate)> {
        let (left, descent) = Descent::from(self, state).descend(&self.recorded.weights, steps, false)?;
        Some((left, descent.state))
    }

    /// Of several sites the one that leaves least with noise inflated by what was measured, nothing yielding.
    fn promising(&self, start: &Start, sites: &[Site], weights: &[f64]) -> Option<(f64, Iterate)> {
        let left = |site| {
            let state = self.state_on(&start.centre, &Parameters::free(&start.hypothesis, site), weights)?;
            Some((self.objective(&state, weights), state))
        };
        sites.iter().filter_map(left).min_by(|a, b| a.0.total_cmp(&b.0))
    }
}
