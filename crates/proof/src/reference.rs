//! The best fit about the truth, by the laboratory's own model: the objective that names are judged by, and the
//! Cramér–Rao bound of the hidden parameters.

use crate::objective::{Tolerance, objective, values};
use jointscope_diagnosis::Observation;
use jointscope_fixture::{Fixture, ParameterRange};
use jointscope_linalg::solve_positive_definite;
use jointscope_rig::{Instrument, frfs};
use num_complex::Complex64;

/// The best fit in the truth's neighbourhood.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// χ² and squared departures there.
    pub objective: f64,
    /// The same at the truth itself.
    pub at_truth: f64,
    /// Cramér–Rao bound of each hidden effect's parameters, one standard deviation; `None` where the recording does not determine one.
    pub bounds: Vec<Vec<Option<f64>>>,
}

/// Step of central differences, in standard deviations or hundredths of a parameter.
const DIFFERENCE: f64 = 2e-3;
/// Steps towards the optimum at the most; derivatives are made anew while they gain.
const STEPS: usize = 12;
/// Gain in the objective below which nothing is left to gain.
const CONVERGED: f64 = 1e-2;

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
    /// Fits from `truth` (the fixture with its true quantities and hidden effects) under the tolerances of `believed`.
    ///
    /// `None` where the truth has no finite FRFs.
    pub fn of(believed: &Fixture, truth: &Fixture, observation: &Observation) -> Option<Self> {
        let near =
            Neighbourhood { observation, tolerances: Tolerance::all(believed), coordinates: Vec::new() }
                .with_coordinates(truth);
        let mut place = near.place(truth.clone())?;
        let at_truth = place.objective;
        let mut jacobian = near.jacobian(&place);
        let mut fresh = true;
        for _ in 0..STEPS {
            let gain = match near.step(&place, &jacobian) {
                Some(next) => {
                    let gain = place.objective - next.objective;
                    place = next;
                    gain
                }
                None => 0.0,
            };
            if gain < CONVERGED {
                if fresh {
                    break;
                }
                jacobian = near.jacobian(&place);
                fresh = true;
            } else {
                fresh = false;
            }
        }
        let bounds = near.bounds(&place, &jacobian, truth);
        Some(Reference { objective: place.objective, at_truth, bounds })
    }
}

impl Neighbourhood<'_> {
    fn with_coordinates(mut self, truth: &Fixture) -> Self {
        self.coordinates = (0..self.tolerances.len()).map(Coordinate::Quantity).collect();
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
                self.coordinates.push(Coordinate::Parameter { effect, parameter, scale, least });
            }
        }
        self
    }

    fn place(&self, fixture: Fixture) -> Option<Place> {
        let observation = self.observation;
        let set = frfs(&fixture, observation.pairs(), observation.lines(), Instrument::AsDescribed).ok()?;
        let predicted = set.all_values().to_vec();
        let values = values(&fixture);
        let objective = objective(observation, &predicted, &self.tolerances, &values);
        objective.is_finite().then_some(Place { fixture, values, predicted, objective })
    }

    /// `from` with its coordinates moved by `steps`, in units of each.
    fn moved(&self, from: &Place, steps: &[f64]) -> Option<Fixture> {
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
        fixture.with_physics(physics).ok()
    }

    /// Derivatives of the FRFs by coordinate, central differences; zeros where it cannot be moved.
    fn jacobian(&self, place: &Place) -> Vec<Vec<Complex64>> {
        let count = self.coordinates.len();
        let at = |m: usize, step: f64| {
            let mut steps = vec![0.0; count];
            steps[m] = step;
            self.moved(place, &steps).and_then(|fixture| self.place(fixture))
        };
        (0..count)
            .map(|m| match (at(m, DIFFERENCE), at(m, -DIFFERENCE)) {
                (Some(up), Some(down)) => {
                    let both = up.predicted.iter().zip(&down.predicted);
                    both.map(|(u, d)| (u - d) / (2.0 * DIFFERENCE)).collect()
                }
                _ => vec![Complex64::ZERO; place.predicted.len()],
            })
            .collect()
    }

    fn prior(&self, m: usize) -> f64 {
        match self.coordinates[m] {
            Coordinate::Quantity(which) => f64::from(self.tolerances[which].is_known()),
            Coordinate::Parameter { .. } => 0.0,
        }
    }

    fn departure(&self, m: usize, values: &[f64]) -> f64 {
        match self.coordinates[m] {
            Coordinate::Quantity(which) => self.tolerances[which].departure(values),
            Coordinate::Parameter { .. } => 0.0,
        }
    }

    /// JᵀWJ and the priors on its diagonal, row-major. A coordinate without effect gets a stiff one.
    fn information(&self, jacobian: &[Vec<Complex64>]) -> Vec<f64> {
        let n = jacobian.len();
        let weights = self.observation.weights();
        let mut matrix = vec![0.0; n * n];
        for m in 0..n {
            for k in 0..=m {
                let products = jacobian[m].iter().zip(&jacobian[k]).zip(weights);
                let sum: f64 = products.map(|((a, b), w)| w * (a.re * b.re + a.im * b.im)).sum();
                matrix[m * n + k] = sum;
                matrix[k * n + m] = sum;
            }
        }
        for m in 0..n {
            matrix[m * n + m] += self.prior(m);
            if matrix[m * n + m] == 0.0 {
                matrix[m * n + m] = 1.0;
            }
        }
        matrix
    }

    /// The first damped step that lowers the objective.
    fn step(&self, place: &Place, jacobian: &[Vec<Complex64>]) -> Option<Place> {
        let n = jacobian.len();
        let matrix = self.information(jacobian);
        let residual: Vec<Complex64> =
            self.observation.values().iter().zip(&place.predicted).map(|(m, p)| m - p).collect();
        let right: Vec<f64> = (0..n)
            .map(|m| {
                let terms = jacobian[m].iter().zip(&residual).zip(self.observation.weights());
                let pull: f64 = terms.map(|((j, r), w)| w * (j.re * r.re + j.im * r.im)).sum();
                pull - self.prior(m) * self.departure(m, &place.values)
            })
            .collect();
        [0.0, 1e-3, 1e-1, 10.0].into_iter().find_map(|damping| {
            let mut damped = matrix.clone();
            (0..n).for_each(|m| damped[m * n + m] *= 1.0 + damping);
            let mut steps = right.clone();
            if !solve_positive_definite(&mut damped, &mut steps) {
                return None;
            }
            let next = self.moved(place, &steps).and_then(|fixture| self.place(fixture))?;
            (next.objective < place.objective).then_some(next)
        })
    }

    /// One standard deviation of every hidden parameter by the inverse of the information.
    fn bounds(&self, place: &Place, jacobian: &[Vec<Complex64>], truth: &Fixture) -> Vec<Vec<Option<f64>>> {
        let n = jacobian.len();
        let matrix = self.information(jacobian);
        let parameters = |effect: &jointscope_fixture::Effect| vec![None; effect.parameters.len()];
        let mut bounds: Vec<Vec<Option<f64>>> = truth.physics().iter().map(parameters).collect();
        for (m, coordinate) in self.coordinates.iter().enumerate() {
            let Coordinate::Parameter { effect, parameter, scale, least } = *coordinate else { continue };
            let still = jacobian[m].iter().all(|derivative| *derivative == Complex64::ZERO);
            let at_its_end = place.fixture.physics()[effect].value(parameter) <= least;
            let mut copy = matrix.clone();
            let mut column = vec![0.0; n];
            column[m] = 1.0;
            if !still && !at_its_end && solve_positive_definite(&mut copy, &mut column) && column[m] > 0.0 {
                bounds[effect][parameter] = Some(column[m].sqrt() * scale);
            }
        }
        bounds
    }
}
