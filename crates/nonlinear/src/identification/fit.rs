//! Maximum of likelihood and prior by Levenberg's and Marquardt's method.

use super::misfit::{Normal, View};
use super::parameters::Parameters;
use jointscope_linalg::{inverse, solve_positive_definite};

/// Parameters at which likelihood and prior are largest.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub parameters: Parameters,
    /// χ² of the data.
    pub chi2: f64,
    /// χ² and priors.
    pub objective: f64,
    normal: Normal,
}

/// Gain of an iteration below which a fit has converged, relative to χ².
const CONVERGED: f64 = 1e-5;

impl Fit {
    /// From `start`, with so many iterations at the most; `None` where the start has no finite motion.
    pub fn of(view: &View, start: &Parameters, iterations: usize) -> Option<Self> {
        let mut parameters = start.clone();
        let mut normal = view.normal(&parameters)?;
        let mut objective = normal.chi2 + parameters.penalty();
        let mut damping = 1e-3;
        for _ in 0..iterations {
            let mut better = None;
            for _ in 0..6 {
                if let Some(step) = step(&parameters, &normal, damping) {
                    let next = parameters.stepped(&step);
                    let value = view.chi2(&next).map(|chi2| chi2 + next.penalty());
                    if let Some(value) = value.filter(|value| *value < objective) {
                        better = Some((next, value));
                        break;
                    }
                }
                damping *= 8.0;
                if damping > 1e8 {
                    break;
                }
            }
            let Some((next, value)) = better else { break };
            let gain = objective - value;
            damping = (damping * 0.1).max(1e-9);
            parameters = next;
            objective = value;
            normal = view.normal(&parameters)?;
            if gain < 0.05 + CONVERGED * objective {
                break;
            }
        }
        Some(Fit { chi2: normal.chi2, objective, parameters, normal })
    }

    /// Covariance of the coordinates, row-major: inverse of the information of data and prior, widened by `scale`. What neither data nor priors
    /// determine has an infinite variance.
    pub fn covariance(&self, scale: f64) -> Vec<f64> {
        let n = self.parameters.coordinates.len();
        let mut information = self.normal.matrix.clone();
        for i in 0..n {
            information[i * n + i] = information[i * n + i] / scale + self.parameters.prior(i);
            for j in (0..n).filter(|j| *j != i) {
                information[i * n + j] /= scale;
            }
        }
        inverse(&information, n).unwrap_or_else(|| vec![f64::INFINITY; n * n])
    }
}

fn step(parameters: &Parameters, normal: &Normal, damping: f64) -> Option<Vec<f64>> {
    let n = parameters.coordinates.len();
    let mut matrix = normal.matrix.clone();
    let mut right = normal.right.clone();
    for i in 0..n {
        let prior = parameters.prior(i);
        right[i] -= prior * parameters.coordinates[i];
        // A coordinate that nothing determines must not spoil the others.
        matrix[i * n + i] = (matrix[i * n + i] + prior) * (1.0 + damping) + 1e-12;
    }
    solve_positive_definite(&mut matrix, &mut right).then_some(right).filter(|step| step.iter().all(|s| s.is_finite()))
}
