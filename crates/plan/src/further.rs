//! Names weighed by one more test, of the structure in another state: with a known mass, on another support.
//!
//! The two tests have the structure's quantities and the name's parameters in common. What the first one
//! tells of them, near its fit a normal distribution with its full covariance, is what is known beforehand
//! when the second is fitted; so nothing counts twice.

use crate::PlanError;
use crate::candidates;
use crate::expected_noise::ExpectedNoise;
use crate::names::{Name, NameNow, Names, Remaining, carried};
use crate::plan::PlanOptions;
use crate::planned_test::PlannedTest;
use jointscope_diagnosis::{Hypothesis, Linearisation, Observation, with_idle_points_exact};
use jointscope_fixture::Fixture;
use jointscope_inference::{DerivativePrecision, LeastSquares, NormalEquations, Settings, descend, each};
use jointscope_spectra::FrfPair;
use jointscope_wording::effect_name;
use num_complex::Complex64;

/// The names that a diagnosis has left, with the probabilities that `further`, the FRFs of the structure as
/// the fixture beside them describes it, leaves them together with the present ones; the most probable first.
///
/// # Errors
/// See [`PlanError`].
pub fn weighed_by(
    fixture: &Fixture,
    remaining: &Remaining,
    further: (&Fixture, &Observation),
    options: &PlanOptions,
) -> Result<Vec<NameNow>, PlanError> {
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
    let (state, observation) = (known(further.0), further.1);
    let cost = |name: &Name| {
        let hypothesis = name.hypothesis.in_fixture(&state, options.exact);
        let information = carried(&name.information, &name.hypothesis, &hypothesis);
        let problem = Problem { centre: hypothesis.coordinates().to_vec(), information, observation };
        let cost =
            problem.least(hypothesis).ok_or_else(|| PlanError::NotComparable(effect_name(&name.effect)))?;
        Ok(name.cost + cost / names.inflation)
    };
    let costs: Vec<f64> = each(&names.names, cost).into_iter().collect::<Result<_, PlanError>>()?;
    let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
    let weight = |cost: &f64| (-0.5 * (cost - least)).exp();
    let total = costs.iter().map(weight).sum::<f64>() + names.unlisted;
    let mut all: Vec<NameNow> = names
        .names
        .iter()
        .zip(&costs)
        .map(|(name, cost)| NameNow { effect: name.effect.clone(), probability: weight(cost) / total })
        .collect();
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    Ok(all)
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
    /// χ² and what the first test says against the coordinates, at the best of them.
    fn least(&self, start: Hypothesis) -> Option<f64> {
        let predicted = start.predict(self.observation).ok()?;
        let start = At { hypothesis: start, predicted };
        Some(descend(self, start, None, &Settings::default())?.objective)
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
