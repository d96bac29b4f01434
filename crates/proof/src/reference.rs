//! The best fit about the truth, by the laboratory's own model: the objective that names are judged by, and
//! the Cramér–Rao bound of the hidden parameters.

use crate::objective::{Tolerance, objective, values};
use jointscope_diagnosis::Observation;
use jointscope_fixture::{Fixture, ParameterRange};
use jointscope_inference::{
    Convergence, DerivativePrecision, Descent, LeastSquares, NormalEquations, Settings, StepDamping, descend,
};
use jointscope_rig::{Instrument, frfs};
use num_complex::Complex64;

/// The best fit in the truth's neighbourhood.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// χ² and squared departures there.
    pub objective: f64,
    /// The same at the truth itself.
    pub at_truth: f64,
    /// Cramér–Rao bound of each hidden effect's parameters, one standard deviation; `None` where the
    /// recording does not determine one.
    pub bounds: Vec<Vec<Option<f64>>>,
}

/// Step of central differences, in standard deviations or hundredths of a parameter.
const DIFFERENCE: f64 = 2e-3;

/// The start is a few standard deviations from the optimum: undamped steps, derivatives anew only when they
/// gain nothing any more, and little to gain is left.
const SETTINGS: Settings = Settings {
    steps: 12,
    derivatives: usize::MAX,
    damping: StepDamping { initial: 0.0, decrease: 0.0, least: 0.0, raised: 1e-3, most: 10.0 },
    convergence: Convergence { gain: 1e-2, share: 0.0, floor: 0.0 },
    reuse: Some(0.0),
    fresh: false,
    trust_old: false,
    exact_at_end: false,
    limit: None,
    valleys: 0,
    curved_valley: 0.0,
};

/// A coordinate that moves.
enum Coordinate {
    Quantity(usize),
    Parameter { effect: usize, parameter: usize, scale: f64, least: f64 },
}

struct Neighbourhood<'a> {
    observation: &'a Observation,
    tolerances: Vec<Tolerance>,
    coordinates: Vec<Coordinate>,
}

/// A fixture near the truth with what it predicts.
#[derive(Clone)]
struct Place {
    fixture: Fixture,
    values: Vec<f64>,
    predicted: Vec<Complex64>,
    objective: f64,
}

impl Reference {
    /// Fits from `truth` (the fixture with its true quantities and hidden effects) under the tolerances of
    /// `believed`.
    ///
    /// `None` where the truth has no finite FRFs.
    pub fn of(believed: &Fixture, truth: &Fixture, observation: &Observation) -> Option<Self> {
        let near = Neighbourhood::about(truth, Tolerance::all(believed), observation);
        let start = near.place(truth.clone())?;
        let at_truth = start.objective;
        let Descent { point, derivatives, .. } = descend(&near, start, None, &SETTINGS)?;
        let bounds = near.bounds(&point, &derivatives, truth);
        Some(Reference { objective: point.objective, at_truth, bounds })
    }
}

impl LeastSquares for Neighbourhood<'_> {
    type Point = Place;
    type Weights = ();
    type Derivatives = Vec<Vec<Complex64>>;
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Place) {}

    fn objective(&self, place: &Place, _: &()) -> f64 {
        place.objective
    }

    /// Central differences by coordinate; zeros where it cannot be moved.
    fn derivatives(&self, place: &Place, _: DerivativePrecision) -> Option<Vec<Vec<Complex64>>> {
        let count = self.coordinates.len();
        let at = |m: usize, step: f64| {
            let mut steps = vec![0.0; count];
            steps[m] = step;
            self.moved(place, &steps)
        };
        let column = |m: usize| match (at(m, DIFFERENCE), at(m, -DIFFERENCE)) {
            (Some(up), Some(down)) => {
                let both = up.predicted.iter().zip(&down.predicted);
                both.map(|(u, d)| (u - d) / (2.0 * DIFFERENCE)).collect()
            }
            _ => vec![Complex64::ZERO; place.predicted.len()],
        };
        Some((0..count).map(column).collect())
    }

    fn equations(&self, place: &Place, columns: &Vec<Vec<Complex64>>, _: &()) -> NormalEquations {
        let (measured, weights) = (self.observation.values(), self.observation.weights());
        let residual: Vec<Complex64> = measured.iter().zip(&place.predicted).map(|(m, p)| m - p).collect();
        let priors = |m: usize| match self.coordinates[m] {
            Coordinate::Quantity(which) => {
                let tolerance = &self.tolerances[which];
                (f64::from(tolerance.is_known()), tolerance.departure(&place.values))
            }
            Coordinate::Parameter { .. } => (0.0, 0.0),
        };
        let held = |m: usize| is_still(&columns[m]) && priors(m).0 == 0.0;
        NormalEquations::of_columns(columns, &residual, weights, held, priors)
    }

    fn stepped(&self, place: &Place, equations: &NormalEquations, damping: f64) -> Option<Place> {
        self.moved(place, &equations.step(damping)?)
    }
}

/// Whether a coordinate does nothing to the FRFs.
fn is_still(column: &[Complex64]) -> bool {
    column.iter().all(|derivative| *derivative == Complex64::ZERO)
}

impl<'a> Neighbourhood<'a> {
    /// All tolerances move, and the parameters of the effects that are not exactly zero.
    fn about(truth: &Fixture, tolerances: Vec<Tolerance>, observation: &'a Observation) -> Self {
        let mut coordinates: Vec<Coordinate> = (0..tolerances.len()).map(Coordinate::Quantity).collect();
        for (effect, hidden) in truth.physics().iter().enumerate() {
            for (parameter, spec) in hidden.kind.spec().parameters.iter().enumerate() {
                let value = hidden.value(parameter).abs();
                let scale = match spec.name {
                    "x" => 1e-3,
                    _ if value > 0.0 => 0.01 * value,
                    _ => continue,
                };
                let least = match spec.range {
                    ParameterRange::Positive => 1e-6 * value,
                    ParameterRange::NonNegative => 0.0,
                    ParameterRange::Any | ParameterRange::NonZero => f64::NEG_INFINITY,
                };
                coordinates.push(Coordinate::Parameter { effect, parameter, scale, least });
            }
        }
        Neighbourhood { observation, tolerances, coordinates }
    }

    fn place(&self, fixture: Fixture) -> Option<Place> {
        let observation = self.observation;
        let set = frfs(&fixture, observation.pairs(), observation.lines(), Instrument::AsDescribed).ok()?;
        let predicted = set.all_values().to_vec();
        let values = values(&fixture);
        let objective = objective(observation, &predicted, &self.tolerances, &values);
        objective.is_finite().then_some(Place { fixture, values, predicted, objective })
    }

    /// `from` with its coordinates moved by `steps`, in units of each; `None` where that is no fixture, or
    /// predicts nothing.
    fn moved(&self, from: &Place, steps: &[f64]) -> Option<Place> {
        let mut fixture = from.fixture.clone();
        let mut physics = fixture.physics().to_vec();
        {
            let mut quantities = fixture.quantities_mut();
            for (coordinate, step) in self.coordinates.iter().zip(steps) {
                match *coordinate {
                    Coordinate::Quantity(which) => {
                        let tolerance = &self.tolerances[which];
                        quantities[tolerance.index].quantity.value += step * tolerance.step(&from.values);
                    }
                    Coordinate::Parameter { effect, parameter, scale, least } => {
                        let value = &mut physics[effect].parameters[parameter].value;
                        *value = (*value + step * scale).max(least);
                    }
                }
            }
        }
        self.place(fixture.with_physics(physics).ok()?)
    }

    /// One standard deviation of every hidden parameter by the inverse of the information.
    fn bounds(&self, place: &Place, columns: &Vec<Vec<Complex64>>, truth: &Fixture) -> Vec<Vec<Option<f64>>> {
        let mut bounds: Vec<Vec<Option<f64>>> =
            truth.physics().iter().map(|effect| vec![None; effect.parameters.len()]).collect();
        let Some(covariance) = self.equations(place, columns, &()).covariance() else { return bounds };
        for (m, coordinate) in self.coordinates.iter().enumerate() {
            let Coordinate::Parameter { effect, parameter, scale, least } = *coordinate else { continue };
            let at_its_end = place.fixture.physics()[effect].value(parameter) <= least;
            if !is_still(&columns[m]) && !at_its_end && covariance.at(m, m) > 0.0 {
                bounds[effect][parameter] = Some(covariance.at(m, m).sqrt() * scale);
            }
        }
        bounds
    }
}
