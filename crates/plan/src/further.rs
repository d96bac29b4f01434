//! Names weighed by one more test, of the structure in another state: with a known mass, on another support.
//!
//! The two tests have the structure's quantities and the name's parameters in common, and modal damping ratios
//! not: those are of an assembly as it was tested. What the first one tells of what they share, near its fit a
//! normal distribution with its full covariance, is what is known beforehand when the second is fitted; so
//! nothing counts twice. What no name meets in the second test is none of these names' doing: it counts as
//! noise, makes physics that none covers likelier, and is told.

use crate::PlanError;
use crate::candidates;
use crate::expected_noise::ExpectedNoise;
use crate::model_error::ModelErrorNoise;
use crate::names::{Name, Names, Remaining, WeighedName, carried};
use crate::plan::PlanOptions;
use crate::planned_test::PlannedTest;
use crate::says;
use crate::settings::further::MISFIT;
use crate::settings::outcome::SURE;
use jointscope_diagnosis::{Hypothesis, Linearisation, MOST_UNLISTED, Observation, with_idle_points_exact};
use jointscope_fixture::Fixture;
use jointscope_inference::{
    DerivativePrecision, LeastSquares, NormalEquations, Settings, descend, each, variance_inflation,
};
use jointscope_spectra::FrfPair;
use jointscope_wording::effect_name;
use num_complex::Complex64;
use serde::Serialize;

/// The names that a diagnosis has left, weighed by a further test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Weighed {
    /// The answer in one sentence.
    pub says: String,
    /// The names, the most probable first. They sum to less than one: the rest is something not listed.
    pub names: Vec<WeighedName>,
    /// χ² per degree of freedom that the best name leaves of the further test.
    pub chi2_per_dof: f64,
    /// Whether the best name meets it down to its noise.
    pub is_met: bool,
    /// What a reader should know besides, one plain sentence each.
    pub remarks: Vec<String>,
    /// FRFs of the further test.
    pub recorded: Vec<FrfPair>,
}

impl Weighed {
    /// Whether one name is sure by both tests.
    pub fn is_settled(&self) -> bool {
        self.names.first().is_some_and(|first| first.probability >= SURE)
    }
}

/// Weighs the names that a diagnosis has left by `further`, the FRFs of the structure as the fixture beside
/// them describes it, together with the present ones.
///
/// # Errors
/// See [`PlanError`].
pub fn weighed_by(
    fixture: &Fixture,
    remaining: &Remaining,
    further: (&Fixture, &Observation),
    options: &PlanOptions,
) -> Result<Weighed, PlanError> {
    let observation = &remaining.observation;
    let points = candidates::points(fixture, &options.points, observation.pairs())?;
    let here = points.iter().map(|point| FrfPair::transverse(point, point));
    let channels: Vec<FrfPair> =
        here.chain(observation.pairs().iter().chain(further.1.pairs()).cloned()).collect();
    let known = |fixture: &Fixture| with_idle_points_exact(fixture.clone(), &channels);
    let base = known(fixture);
    let names = Names::fitted(remaining, observation, &base, options.exact)?;
    let test = PlannedTest {
        fixture: base,
        exact: options.exact,
        lines: observation.lines().clone(),
        noise: ExpectedNoise::of(observation),
        inflation: names.inflation,
        model_error: None,
    };
    let names = names.with_information(&test, observation)?;
    let state = known(further.0);
    let in_state = |name: &Name| name.hypothesis.in_state(&state, options.exact);
    let with_model_error = remaining.model_error.and_then(|error| {
        let model = in_state(&names.names[0]);
        ModelErrorNoise::of(&error, &model, further.1).with_model_error(&model, further.1)
    });
    let observation = with_model_error.as_ref().unwrap_or(further.1);
    let fitted = |name: &Name| {
        let start = in_state(name);
        let information = carried(&name.information, &name.hypothesis, &start);
        let problem = Problem { centre: start.coordinates().to_vec(), information, observation };
        problem.least(start).ok_or_else(|| PlanError::NotComparable(effect_name(&name.effect)))
    };
    let fits: Vec<(At, f64)> = each(&names.names, fitted).into_iter().collect::<Result<_, PlanError>>()?;
    Ok(weighed(&names, &fits, observation))
}

/// Names by what each leaves of the further test, at what the first knows of it.
fn weighed(names: &Names, fits: &[(At, f64)], observation: &Observation) -> Weighed {
    let residual = |at: &At| {
        let degrees = observation.degrees().max(1) as f64;
        (observation.chi2(&at.predicted) / degrees, observation.residual_correlation(&at.predicted))
    };
    let costs = |inflation: f64| -> Vec<f64> {
        let of = |(name, (_, least)): (&Name, &(At, f64))| name.cost + least / inflation;
        names.names.iter().zip(fits).map(of).collect()
    };
    let least = |costs: &[f64]| (0..costs.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b])).unwrap_or(0);
    let (chi2_per_dof, correlation) = residual(&fits[least(&costs(names.inflation))].0);
    let costs = costs(names.inflation.max(variance_inflation(chi2_per_dof, correlation)));
    let lowest = costs[least(&costs)];
    let weight = |cost: &f64| (-0.5 * (cost - lowest)).exp();
    let misfit = observation.excess(chi2_per_dof);
    let is_met = misfit <= MISFIT;
    let unlisted = match is_met {
        true => names.unlisted,
        false => names.unlisted.max((names.unlisted.ln() + 0.5 * misfit * misfit).min(MOST_UNLISTED).exp()),
    };
    let total = costs.iter().map(weight).sum::<f64>() + unlisted;
    let name = |(name, cost): (&Name, &f64)| WeighedName {
        effect: name.effect.clone(),
        probability: weight(cost) / total,
        before: name.probability,
    };
    let mut all: Vec<WeighedName> = names.names.iter().zip(&costs).map(name).collect();
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    Weighed {
        says: says::weighed(&all, chi2_per_dof, is_met),
        remarks: names.added.then(says::added_names).into_iter().collect(),
        names: all,
        chi2_per_dof,
        is_met,
        recorded: observation.pairs().to_vec(),
    }
}

/// A test whose coordinates are known beforehand with a full covariance.
struct Problem<'a> {
    centre: Vec<f64>,
    information: Vec<f64>,
    observation: &'a Observation,
}

/// Coordinates with what they predict.
struct At {
    hypothesis: Hypothesis,
    predicted: Vec<Complex64>,
}

impl Problem<'_> {
    /// The best coordinates, and χ² there with what the first test says against them.
    fn least(&self, start: Hypothesis) -> Option<(At, f64)> {
        let predicted = start.predict(self.observation).ok()?;
        let start = At { hypothesis: start, predicted };
        let end = descend(self, start, None, &Settings::default())?;
        Some((end.point, end.objective))
    }

    fn departure(&self, at: &At) -> Vec<f64> {
        at.hypothesis.coordinates().iter().zip(&self.centre).map(|(at, centre)| at - centre).collect()
    }

    fn prior_gradient(&self, departure: &[f64]) -> Vec<f64> {
        let rows = self.information.chunks_exact(departure.len().max(1));
        rows.map(|row| row.iter().zip(departure).map(|(entry, departure)| entry * departure).sum()).collect()
    }
}

impl LeastSquares for Problem<'_> {
    type Point = At;
    type Weights = ();
    type Derivatives = Linearisation;
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &At) {}

    fn objective(&self, at: &At, (): &()) -> f64 {
        let departure = self.departure(at);
        let known: f64 = self
            .prior_gradient(&departure)
            .iter()
            .zip(&departure)
            .map(|(gradient, departure)| gradient * departure)
            .sum();
        self.observation.chi2(&at.predicted) + known
    }

    fn derivatives(&self, at: &At, _: DerivativePrecision) -> Option<Linearisation> {
        Some(Linearisation::of(&at.hypothesis, self.observation))
    }

    fn equations(&self, at: &At, linear: &Linearisation, (): &()) -> NormalEquations {
        let residual: Vec<Complex64> = self
            .observation
            .values()
            .iter()
            .zip(&at.predicted)
            .map(|(measured, own)| measured - own)
            .collect();
        let weights = self.observation.weights();
        let mut equations =
            NormalEquations::of_columns(&linear.derivatives, &residual, weights, |_| false, |_| (0.0, 0.0));
        equations.information.iter_mut().zip(&self.information).for_each(|(own, known)| *own += known);
        let gradient = self.prior_gradient(&self.departure(at));
        equations.right.iter_mut().zip(&gradient).for_each(|(own, gradient)| *own -= gradient);
        equations
    }

    fn stepped(&self, at: &At, equations: &NormalEquations, damping: f64) -> Option<At> {
        let parameters = at.hypothesis.parameters();
        let step = equations.bounded_step(damping, at.hypothesis.coordinates(), parameters)?;
        let hypothesis = at.hypothesis.stepped(&step);
        let predicted = hypothesis.predict(self.observation).ok()?;
        Some(At { hypothesis, predicted })
    }
}
