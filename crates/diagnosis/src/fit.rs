use crate::{Hypothesis, Observation};
use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;

/// A hypothesis at its best, and how good that is.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The hypothesis at the optimum.
    pub hypothesis: Hypothesis,
    /// What it predicts, FRF after FRF.
    pub predicted: Vec<Complex64>,
    /// χ² of the FRFs.
    pub chi2: f64,
    /// χ² and the squared departures of the fixture's quantities: what was minimised.
    pub objective: f64,
}

/// A linearisation of a hypothesis: what its coordinates do to the FRFs.
#[derive(Debug, Clone)]
pub struct Linearisation {
    /// Derivatives by coordinate, each FRF after FRF.
    pub derivatives: Vec<Vec<Complex64>>,
}

/// Step of central differences in units of a coordinate: small against a resonance's width, large against rounding.
const DIFFERENCE: f64 = 2e-4;
/// Shares by which a fit is softened on its way, when it starts far from its goal.
const CONTINUATION: [f64; 4] = [0.3, 0.1, 0.03, 0.01];
/// Iterations with softened weights, each share, and in the end.
const ITERATIONS: (usize, usize) = (12, 60);
/// Decrease of the objective below which a fit has converged.
const CONVERGED: f64 = 1e-3;
/// Steps made from old derivatives that gain less than this share of the first one's call for new ones.
const SLOW: f64 = 0.15;
/// Damping beyond which no step is a gain.
const GIVEN_UP: f64 = 1e7;

impl Linearisation {
    /// Central differences about `at`. A coordinate that cannot be moved gets zeros.
    pub fn of(at: &Hypothesis, observation: &Observation) -> Self {
        let derivatives = (0..at.coordinates.len())
            .map(|m| {
                let moved = |sign: f64| {
                    let mut other = at.clone();
                    other.coordinates[m] += sign * DIFFERENCE;
                    other.predict(observation)
                };
                match (moved(1.0), moved(-1.0)) {
                    (Ok(up), Ok(down)) => {
                        up.iter().zip(&down).map(|(u, d)| (u - d) / (2.0 * DIFFERENCE)).collect()
                    }
                    _ => vec![Complex64::ZERO; observation.values().len()],
                }
            })
            .collect();
        Linearisation { derivatives }
    }

    /// Nothing that could yield.
    pub(crate) fn rigid() -> Self {
        Linearisation { derivatives: Vec::new() }
    }

    /// JᵀWJ with the prior on its diagonal (row-major, whole), and JᵀWr less the prior's pull.
    pub(crate) fn normal(
        &self,
        at: &Hypothesis,
        weights: &[f64],
        residual: &[Complex64],
    ) -> (Vec<f64>, Vec<f64>) {
        let n = self.derivatives.len();
        let mut matrix = vec![0.0; n * n];
        let mut right = vec![0.0; n];
        let mut weighted = vec![Complex64::ZERO; weights.len()];
        for (m, derivative) in self.derivatives.iter().enumerate() {
            weighted.iter_mut().zip(derivative).zip(weights).for_each(|((w, d), weight)| *w = d * *weight);
            right[m] = dot(&weighted, residual) - at.prior(m) * at.coordinates[m];
            for (k, other) in self.derivatives.iter().enumerate().take(m + 1) {
                let value = dot(&weighted, other) + if k == m { at.prior(m) } else { 0.0 };
                matrix[m * n + k] = value;
                matrix[k * n + m] = value;
            }
        }
        (matrix, right)
    }
}

/// Re Σ aᵢ* bᵢ.
fn dot(a: &[Complex64], b: &[Complex64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x.re * y.re + x.im * y.im).sum()
}

impl Fit {
    /// Fits from the hypothesis as it stands; `far` softens the weights first, for starts far from the goal.
    ///
    /// `None` where the start itself predicts no finite FRFs.
    pub fn of(start: &Hypothesis, observation: &Observation, far: bool) -> Option<Self> {
        let mut state = State::at(start.clone(), observation)?;
        if far {
            for epsilon in CONTINUATION {
                state.improve(observation, epsilon, ITERATIONS.0);
            }
        }
        state.improve(observation, 0.0, ITERATIONS.1);
        Some(state.into_fit(observation))
    }

    /// Number of values that count.
    pub fn chi2_per_dof(&self, observation: &Observation) -> f64 {
        self.chi2 / (observation.degrees().saturating_sub(self.hypothesis.effect_parameters())).max(1) as f64
    }

    /// Covariance of the coordinates, row-major; `None` where the FRFs leave a combination free.
    pub fn covariance(&self, observation: &Observation) -> Option<Vec<f64>> {
        let linear = Linearisation::of(&self.hypothesis, observation);
        let residual = vec![Complex64::ZERO; observation.values().len()];
        let (matrix, _) = linear.normal(&self.hypothesis, observation.weights(), &residual);
        let n = self.hypothesis.coordinates.len();
        let mut covariance = vec![0.0; n * n];
        for m in 0..n {
            let mut copy = matrix.clone();
            let mut column = vec![0.0; n];
            column[m] = 1.0;
            if !solve_positive_definite(&mut copy, &mut column) {
                return None;
            }
            (0..n).for_each(|k| covariance[k * n + m] = column[k]);
        }
        Some(covariance)
    }
}

/// A fit under way.
struct State {
    hypothesis: Hypothesis,
    predicted: Vec<Complex64>,
}

impl State {
    fn at(hypothesis: Hypothesis, observation: &Observation) -> Option<Self> {
        let predicted = hypothesis.predict(observation).ok()?;
        Some(State { hypothesis, predicted })
    }

    fn residual(&self, observation: &Observation) -> Vec<Complex64> {
        observation.values().iter().zip(&self.predicted).map(|(m, p)| m - p).collect()
    }

    fn objective(&self, observation: &Observation, weights: &[f64]) -> f64 {
        let misfit: f64 = self.residual(observation).iter().zip(weights).map(|(r, w)| w * r.norm_sqr()).sum();
        misfit + self.hypothesis.penalty()
    }

    fn improve(&mut self, observation: &Observation, epsilon: f64, iterations: usize) {
        let mut damping = 1e-6;
        // Derivatives cost far more than a prediction, and change little from step to step: they are made anew
        // only when steps made from old ones gain little.
        let mut linear = Linearisation::of(&self.hypothesis, observation);
        let mut fresh = true;
        let mut hoped_for = 0.0;
        for _ in 0..iterations {
            // Weights are frozen within an iteration, so that a step is judged by what it was made for.
            let weights: Vec<f64> = self
                .predicted
                .iter()
                .enumerate()
                .map(|(index, modelled)| observation.softened(index, *modelled, epsilon))
                .collect();
            let before = self.objective(observation, &weights);
            let (matrix, right) = linear.normal(&self.hypothesis, &weights, &self.residual(observation));
            let patience = if fresh { GIVEN_UP } else { damping * 10.0 };
            let stepped = self.step(observation, &weights, &matrix, &right, before, &mut damping, patience);
            let gain = stepped.as_ref().map_or(0.0, |(_, after)| before - after);
            if let Some((next, _)) = stepped {
                *self = next;
            }
            let converged = if epsilon == 0.0 { CONVERGED } else { 0.01 * before };
            if gain < converged && fresh {
                return;
            }
            let slow = gain < hoped_for || gain < converged;
            hoped_for = if fresh { (SLOW * gain).max(converged) } else { hoped_for };
            if slow {
                linear = Linearisation::of(&self.hypothesis, observation);
            }
            fresh = slow;
            if fresh {
                hoped_for = 0.0;
            }
        }
    }

    /// The first damped step that lowers the objective.
    #[allow(clippy::too_many_arguments)]
    fn step(
        &self,
        observation: &Observation,
        weights: &[f64],
        matrix: &[f64],
        right: &[f64],
        before: f64,
        damping: &mut f64,
        given_up: f64,
    ) -> Option<(State, f64)> {
        let n = right.len();
        let largest = (0..n).map(|m| matrix[m * n + m]).fold(0.0, f64::max);
        loop {
            let mut damped = matrix.to_vec();
            for m in 0..n {
                damped[m * n + m] += *damping * matrix[m * n + m].max(1e-14 * largest);
            }
            let next =
                self.hypothesis.bounded_step(&damped, right).map(|step| self.hypothesis.stepped(&step));
            if let Some(next) = next.and_then(|next| State::at(next, observation)) {
                let after = next.objective(observation, weights);
                if after < before {
                    *damping = (*damping * 0.1).max(1e-12);
                    return Some((next, after));
                }
            }
            *damping *= 10.0;
            if *damping > given_up {
                return None;
            }
        }
    }

    fn into_fit(self, observation: &Observation) -> Fit {
        let chi2 = observation.chi2(&self.predicted);
        let objective = chi2 + self.hypothesis.penalty();
        Fit { hypothesis: self.hypothesis, predicted: self.predicted, chi2, objective }
    }
}
