use crate::catalogue::scaled;
use crate::normal::products;
use crate::under_way::{ITERATIONS, State};
use crate::{Hypothesis, Observation};
use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;
use rayon::prelude::*;

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

/// Step of differences in units of a coordinate: small against a resonance's width, large against rounding.
const DIFFERENCE: f64 = 2e-4;
/// Relative change of an FRF that a difference may make at any line, and the least of the step above: where two coordinates do the same, such
/// as a modulus and a factor on it, it is their derivatives' agreement to many digits that leaves the matter to what is known beforehand.
const GENTLE: (f64, f64) = (1e-3, 1e-3);
/// Shares by which a fit is softened on its way, when it starts far from its goal: on thinned lines, then on all.
pub(crate) const COARSE: [f64; 4] = [1.0, 0.3, 0.1, 0.03];
const FINE: [f64; 1] = [0.01];
/// Lines of a coarse fit.
pub(crate) const COARSE_LINES: usize = 100;
/// Correlation of neighbouring residuals that chance hardly makes.
const CORRELATED: f64 = 0.15;
/// χ² per degree of freedom above which a refit looks elsewhere too, and how many of those starts it follows to the end.
const MUCH: f64 = 1.3;
const STARTS: usize = 3;
/// Shares of its size by which an effect fades.
const FADING: [f64; 4] = [0.75, 0.5, 0.25, 0.1];

impl Linearisation {
    /// As [`Linearisation::of`], by steps so small that every digit counts which rounding leaves: for uncertainties.
    fn exact(at: &Hypothesis, observation: &Observation) -> Self {
        Linearisation::rigid().differences(at, observation, |m| at.small_step(m, observation))
    }

    /// Central differences about `at`; one-sided ones where a coordinate lies on its bound, such as a dashpot of zero. A coordinate that cannot be
    /// moved gets zeros.
    pub fn of(at: &Hypothesis, observation: &Observation) -> Self {
        Linearisation::rigid().extended(at, observation)
    }

    /// These derivatives for the first coordinates of `at`, and central differences for the rest.
    pub(crate) fn extended(self, at: &Hypothesis, observation: &Observation) -> Self {
        self.differences(at, observation, |_| DIFFERENCE)
    }

    fn differences(
        mut self,
        at: &Hypothesis,
        observation: &Observation,
        steps: impl Fn(usize) -> f64,
    ) -> Self {
        for m in self.derivatives.len()..at.coordinates.len() {
            let step = steps(m);
            let moved = |m: usize, sign: f64| at.predict_moved(m, sign * step, None, observation);
            let slope = |up: Vec<Complex64>, down: Vec<Complex64>, width: f64| {
                up.iter().zip(&down).map(|(u, d)| (u - d) / width).collect()
            };
            let derivative = match (moved(m, 1.0), moved(m, -1.0)) {
                (Ok(up), Ok(down)) => Some(slope(up, down, 2.0 * step)),
                (Ok(up), Err(_)) => moved(m, 0.0).ok().map(|here| slope(up, here, step)),
                (Err(_), Ok(down)) => moved(m, 0.0).ok().map(|here| slope(here, down, step)),
                (Err(_), Err(_)) => None,
            };
            self.derivatives.push(derivative.unwrap_or(vec![Complex64::ZERO; observation.values().len()]));
        }
        self
    }

    /// Forward differences from `predicted`, which `at` predicts: half the price, right to a thousandth, which is enough to find
    /// the way but not to state an uncertainty.
    pub(crate) fn forward(at: &Hypothesis, predicted: &[Complex64], observation: &Observation) -> Self {
        let derivatives = (0..at.coordinates.len()).map(|m| {
            if at.is_held(m) {
                return vec![Complex64::ZERO; predicted.len()];
            }
            let step = at.inward(m, DIFFERENCE);
            match at.predict_moved(m, step, Some(predicted), observation) {
                Ok(moved) => moved.iter().zip(predicted).map(|(u, p)| (u - p) / step).collect(),
                Err(_) => vec![Complex64::ZERO; predicted.len()],
            }
        });
        Linearisation { derivatives: derivatives.collect() }
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
        let free: Vec<usize> = (0..n).filter(|&m| !at.is_held(m)).collect();
        let columns: Vec<&[Complex64]> =
            free.iter().map(|&m| self.derivatives[m].as_slice()).chain([residual]).collect();
        let all = products(&columns, weights);
        let width = columns.len();
        let mut matrix = vec![0.0; n * n];
        let mut right = vec![0.0; n];
        (0..n).for_each(|m| matrix[m * n + m] = if at.is_held(m) { 1.0 } else { at.prior(m) });
        for (i, &m) in free.iter().enumerate() {
            right[m] = all[free.len() * width + i] - at.prior(m) * at.coordinates[m];
            free.iter().enumerate().for_each(|(j, &k)| matrix[m * n + k] += all[i * width + j]);
        }
        (matrix, right)
    }
}

impl Hypothesis {
    /// A step of coordinate `m` for central differences whose error is far below a thousandth.
    fn small_step(&self, m: usize, observation: &Observation) -> f64 {
        let predicted = [0.0, DIFFERENCE].map(|step| self.predict_moved(m, step, None, observation));
        let [Ok(here), Ok(there)] = predicted else { return DIFFERENCE };
        let change = |(a, b): (&Complex64, &Complex64)| (a - b).norm() / a.norm().max(b.norm());
        let most = here.iter().zip(&there).map(change).filter(|c| c.is_finite()).fold(0.0, f64::max);
        DIFFERENCE * (GENTLE.0 / most).clamp(GENTLE.1, 1.0)
    }
}

impl Fit {
    /// Fits from the hypothesis as it stands; `far` softens the weights first, for starts far from the goal.
    ///
    /// `None` where the start itself predicts no finite FRFs.
    pub fn of(start: &Hypothesis, observation: &Observation, far: bool) -> Option<Self> {
        if !far {
            return Fit::refined(start, observation, f64::INFINITY);
        }
        let coarse = Fit::coarse(start, &observation.thinned(COARSE_LINES))?;
        Fit::from_coarse(&coarse.hypothesis, observation, f64::INFINITY)
    }

    /// The softened beginning of a far fit, on thinned lines: good enough to compare hypotheses by. Its objective is the softened one.
    pub(crate) fn coarse(start: &Hypothesis, thinned: &Observation) -> Option<Self> {
        Fit::softened(start, thinned, &COARSE)
    }

    /// The last softened stage, on all lines; its objective is the softened one.
    pub(crate) fn middle(start: &Hypothesis, observation: &Observation) -> Option<Self> {
        Fit::softened(start, observation, &FINE)
    }

    fn softened(start: &Hypothesis, observation: &Observation, stages: &[f64]) -> Option<Self> {
        let mut state = State::at(start.clone(), observation)?;
        for &epsilon in stages {
            state.improve(observation, epsilon, ITERATIONS.0, f64::INFINITY);
        }
        let last = stages.last().copied().unwrap_or_default();
        let objective = state.objective(observation, &observation.softened_weights(&state.predicted, last));
        Some(Fit { objective, ..state.into_fit(observation) })
    }

    /// The best of fits from the hypothesis as it stands, far and near, and, where those leave much, of far fits from about it: one
    /// deviation up and down each quantity that is known to no better than a tenth, whose peaks may lie anywhere between others.
    pub(crate) fn searched(start: &Hypothesis, observation: &Observation) -> Option<Self> {
        let near = [Fit::of(start, observation, true), Fit::of(start, observation, false)];
        let best = |a: Fit, b: Fit| if b.objective < a.objective { b } else { a };
        let first = near.into_iter().flatten().reduce(best)?;
        if first.chi2_per_dof(observation) < MUCH {
            return Some(first);
        }
        let thinned = observation.thinned(COARSE_LINES);
        let wide = (0..start.tolerances().len()).filter(|&m| start.tolerances()[m].is_wide());
        let starts: Vec<Hypothesis> =
            wide.flat_map(|m| [-1.0, 1.0].map(|sign| start.moved(m, sign))).collect();
        let mut fits: Vec<Fit> = starts.par_iter().filter_map(|s| Fit::coarse(s, &thinned)).collect();
        fits.sort_by(|a, b| a.objective.total_cmp(&b.objective));
        fits.truncate(STARTS);
        let fits: Vec<Option<Fit>> =
            fits.par_iter().map(|f| Fit::from_coarse(&f.hypothesis, observation, f64::INFINITY)).collect();
        fits.into_iter().flatten().chain([first]).reduce(best)
    }

    /// The fit without effect `index` that is reached by making the effect smaller step by step, so that the quantities can take over
    /// what they are able to imitate.
    ///
    /// `None` as well where a part of the effect is already missed by more than `limit`.
    pub(crate) fn faded(
        full: &Hypothesis,
        index: usize,
        observation: &Observation,
        limit: f64,
    ) -> Option<Self> {
        let effect = &full.effects()[index];
        let without = full.without(index);
        let mut at = without.clone();
        for share in FADING {
            let smaller = scaled(effect, share).and_then(|effect| without.beside(effect));
            let Some(smaller) = smaller.map(|h| h.with_coordinates_of(&at)) else { break };
            let Some(fit) = Fit::refined(&smaller, observation, limit) else { break };
            if fit.objective > limit {
                return None;
            }
            at = fit.hypothesis;
        }
        Fit::refined(&without.with_coordinates_of(&at), observation, f64::INFINITY)
    }

    /// The rest of a far fit, on all lines; see [`Fit::refined`] for `limit`.
    pub(crate) fn from_coarse(start: &Hypothesis, observation: &Observation, limit: f64) -> Option<Self> {
        let mut state = State::at(start.clone(), observation)?;
        for epsilon in FINE {
            state.improve(observation, epsilon, ITERATIONS.0, f64::INFINITY);
        }
        state.improve(observation, 0.0, ITERATIONS.1, limit);
        Some(state.into_fit(observation))
    }

    /// Fits from nearby, and gives up early where the objective will hardly come below `limit`.
    pub(crate) fn refined(start: &Hypothesis, observation: &Observation, limit: f64) -> Option<Self> {
        Fit::refined_with(start, None, observation, limit)
    }

    /// As [`Fit::refined`], with derivatives of the first coordinates known from nearby.
    pub(crate) fn refined_with(
        start: &Hypothesis,
        nearby: Option<&Linearisation>,
        observation: &Observation,
        limit: f64,
    ) -> Option<Self> {
        let mut state = State::at(start.clone(), observation)?;
        state.linear = nearby.map(|linear| linear.clone().extended(start, observation));
        state.improve(observation, 0.0, ITERATIONS.1, limit);
        Some(state.into_fit(observation))
    }

    /// χ² over the real values that count less the effects' free parameters.
    pub fn chi2_per_dof(&self, observation: &Observation) -> f64 {
        self.chi2 / (observation.degrees().saturating_sub(self.hypothesis.effect_parameters())).max(1) as f64
    }

    /// What a gain in χ² has to be divided by to count as one of independent values of known noise: χ² per degree of freedom where it is above
    /// one, and (1 + ρ)/(1 − ρ) where residuals of neighbouring lines are correlated by ρ.
    pub(crate) fn scale(&self, observation: &Observation) -> f64 {
        let correlation = observation.residual_correlation(&self.predicted);
        let alike = match correlation > CORRELATED {
            true => (1.0 + correlation.min(0.9)) / (1.0 - correlation.min(0.9)),
            false => 1.0,
        };
        self.chi2_per_dof(observation).max(1.0) * alike
    }

    /// Covariance of the coordinates, row-major; `None` where the FRFs leave a combination free.
    pub fn covariance(&self, observation: &Observation) -> Option<Vec<f64>> {
        let linear = Linearisation::exact(&self.hypothesis, observation);
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
