//! Maximum of likelihood and prior by Levenberg's and Marquardt's method.

use super::misfit::{Jacobian, View, sum_of_squares};
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
    /// JᵀJ of the data, row-major.
    information: Vec<f64>,
}

/// Gain of a step below which a fit has converged: absolute, and relative to the objective.
const CONVERGED: (f64, f64) = (0.1, 2e-5);
/// Steps at the most with derivatives that were taken once: near the maximum they serve for several.
const STEPS: usize = 5;
/// Share of the gain of the first step that a further one must bring for the derivatives to go on serving.
const FADING: f64 = 0.05;

impl Fit {
    /// From `start`, derivatives being taken `renewals` times at the most; `None` where the start has no finite motion.
    pub fn of(view: &View, start: &Parameters, renewals: usize) -> Option<Self> {
        Self::sloped(view, view, start, renewals)
    }

    /// The same, with derivatives of a view of the same records that steps more coarsely: they need not be as exact as what they lead to.
    pub fn sloped(view: &View, slopes: &View, start: &Parameters, renewals: usize) -> Option<Self> {
        let own = std::ptr::eq(view, slopes);
        let mut parameters = start.clone();
        let mut residuals = view.residuals(&parameters)?;
        let mut objective = sum_of_squares(&residuals) + parameters.penalty();
        let mut damping = 1e-3;
        let mut information = Vec::new();
        for _ in 0..renewals.max(1) {
            let jacobian = match own {
                true => view.jacobian(&parameters, &residuals)?,
                false => slopes.jacobian(&parameters, &slopes.residuals(&parameters)?)?,
            };
            let mut gains = Vec::new();
            let mut failures = 0;
            while gains.len() < STEPS && failures < 6 {
                let right = jacobian.descent(&residuals);
                let tried = step(&parameters, &jacobian, right, damping).and_then(|step| {
                    let next = parameters.stepped(&step);
                    let residuals = view.residuals(&next)?;
                    let value = sum_of_squares(&residuals) + next.penalty();
                    (value < objective).then_some((next, residuals, value))
                });
                let Some((next, new_residuals, value)) = tried else {
                    if !gains.is_empty() {
                        break;
                    }
                    failures += 1;
                    damping = (damping * 10.0).min(1e12);
                    continue;
                };
                let gain = objective - value;
                (parameters, residuals, objective) = (next, new_residuals, value);
                damping = (damping * 0.1).max(1e-9);
                gains.push(gain);
                if gain < FADING * gains[0] || gain < tolerance(objective) {
                    break;
                }
            }
            information = jacobian.matrix;
            if gains.iter().sum::<f64>() < tolerance(objective) {
                break;
            }
        }
        Some(Fit { chi2: objective - parameters.penalty(), objective, parameters, information })
    }

    /// These parameters as they are, with what a view tells of them.
    pub fn at(view: &View, slopes: &View, parameters: &Parameters) -> Option<Self> {
        let chi2 = view.chi2(parameters)?;
        let information = slopes.jacobian(parameters, &slopes.residuals(parameters)?)?.matrix;
        let parameters = parameters.clone();
        Some(Fit { chi2, objective: chi2 + parameters.penalty(), parameters, information })
    }

    /// Covariance of the coordinates, row-major: inverse of the information of data and prior, the data's noise being `scale` times what was
    /// assumed. What neither data nor priors determine has an infinite variance.
    pub fn covariance(&self, scale: f64) -> Vec<f64> {
        let n = self.parameters.coordinates.len();
        let mut information: Vec<f64> = self.information.iter().map(|e| e / scale).collect();
        (0..n).for_each(|i| information[i * n + i] += self.parameters.prior(i));
        inverse(&information, n).unwrap_or_else(|| vec![f64::INFINITY; n * n])
    }
}

fn tolerance(objective: f64) -> f64 {
    CONVERGED.0 + CONVERGED.1 * objective
}

fn step(parameters: &Parameters, jacobian: &Jacobian, mut right: Vec<f64>, damping: f64) -> Option<Vec<f64>> {
    let n = parameters.coordinates.len();
    let mut matrix = jacobian.matrix.clone();
    for i in 0..n {
        let prior = parameters.prior(i);
        right[i] -= prior * parameters.coordinates[i];
        // A coordinate that nothing determines must not spoil the others.
        matrix[i * n + i] = (matrix[i * n + i] + prior) * (1.0 + damping) + 1e-12;
    }
    solve_positive_definite(&mut matrix, &mut right)
        .then_some(right)
        .filter(|step| step.iter().all(|s| s.is_finite()))
}
