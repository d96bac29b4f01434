//! A fit under way: Gauss and Newton's steps, damped, from derivatives that are made anew as seldom as possible.

use crate::fit::{Fit, Linearisation};
use crate::{Hypothesis, Observation};
use num_complex::Complex64;

/// Iterations with softened weights, each share, and in the end.
pub(crate) const ITERATIONS: (usize, usize) = (12, 60);
/// Decrease of the objective below which a fit has converged.
const CONVERGED: f64 = 0.01;
/// The same as a share of what a poor fit leaves beyond the degrees of freedom.
const NEGLIGIBLE: f64 = 1e-5;
/// The same of a softened fit, as a share of its objective, and of one that many others are compared with: they only have to find the way.
const SOFTLY: f64 = 0.01;
const AMONG_MANY: f64 = 0.03;
/// Steps made from old derivatives that gain less than this share of the first one's call for new ones.
const SLOW: f64 = 0.15;
/// Damping, relative to each coordinate's own curvature, to begin with, and next to none.
const DAMPING: f64 = 1e-8;
const UNDAMPED: f64 = 1e-13;
/// Damping beyond which no step is a gain.
const GIVEN_UP: f64 = 1e7;
/// Times the decrease of convergence that an undamped step must promise to be tried, and how often it is.
const VALLEY: f64 = 3.0;
const VALLEYS: usize = 3;
/// A fit is given up where this many times what its derivatives promise would not bring it below the limit.
pub(crate) const PROMISE: f64 = 3.0;
/// Derivatives that a fit with a limit may take without being asked for its pace; how many more such gains it may then be away, and what is
/// never too far: small effects are found along flat valleys, a little at a time.
const UNHURRIED: usize = 2;
const PACES: f64 = 5.0;
const IN_REACH: f64 = 60.0;

/// A fit under way.
pub(crate) struct State {
    pub hypothesis: Hypothesis,
    pub predicted: Vec<Complex64>,
    /// Derivatives made here or on the way.
    pub linear: Option<Linearisation>,
    /// The relative decrease with which a softened stage is content.
    content: f64,
}

impl State {
    pub fn at(hypothesis: Hypothesis, observation: &Observation) -> Option<Self> {
        let predicted = hypothesis.predict(observation).ok()?;
        Some(State { hypothesis, predicted, linear: None, content: SOFTLY })
    }

    pub fn objective(&self, observation: &Observation, weights: &[f64]) -> f64 {
        let values = observation.values().iter().zip(&self.predicted).zip(weights);
        values.map(|((m, p), w)| w * (m - p).norm_sqr()).sum::<f64>() + self.hypothesis.penalty()
    }

    /// A fit only has to find its way until it is nearly there; at the end a derivative's error, times what noise leaves, would lead astray along
    /// directions that the FRFs hardly determine.
    fn linearised(&self, observation: &Observation, nearly_there: bool) -> Linearisation {
        match nearly_there {
            true => Linearisation::of(&self.hypothesis, observation),
            false => Linearisation::forward(&self.hypothesis, &self.predicted, observation),
        }
    }

    pub fn improve(&mut self, observation: &Observation, epsilon: f64, iterations: usize, limit: f64) {
        let mut damping = DAMPING;
        // Derivatives cost far more than a prediction, and change little from step to step: they are made anew
        // only when steps made from old ones gain little.
        let mut fresh = self.linear.is_none();
        // Of a quantity and an effect that do almost the same, exact derivatives alone tell what the one gains over the other.
        let in_reach = |objective: f64| epsilon == 0.0 && limit.is_finite() && objective - limit <= IN_REACH;
        let mut nearly_there = in_reach(self.objective(observation, observation.weights()));
        let mut linear = self.linear.take().unwrap_or_else(|| self.linearised(observation, nearly_there));
        let mut hoped_for = 0.0;
        let mut valleys = 0;
        let mut pace = Pace::default();
        for _ in 0..iterations {
            // Weights are frozen within an iteration, so that a step is judged by what it was made for.
            let weights = observation.softened_weights(&self.predicted, epsilon);
            let before = self.objective(observation, &weights);
            let (matrix, right) =
                linear.normal(&self.hypothesis, &weights, &observation.residual(&self.predicted));
            let promised = if fresh { self.promised(&matrix, &right) } else { 0.0 };
            if fresh && (before - PROMISE * promised > limit || pace.is_too_slow(before, limit)) {
                break;
            }
            let patience = if fresh { GIVEN_UP } else { damping * 10.0 };
            let stepped = self.step(observation, &weights, &matrix, &right, before, &mut damping, patience);
            let gain = stepped.as_ref().map_or(0.0, |(_, after)| before - after);
            if let Some((next, _)) = stepped {
                (self.hypothesis, self.predicted) = (next.hypothesis, next.predicted);
            }
            // Far from explaining anything, a fit is compared with others whose objectives are far away.
            let excess = (before - observation.degrees() as f64).max(0.0);
            let converged =
                if epsilon == 0.0 { CONVERGED.max(NEGLIGIBLE * excess) } else { self.content * before };
            if gain < converged && fresh {
                // Along a flat valley a damped step gains little of what there is.
                let valley =
                    promised > VALLEY * converged && gain > 0.0 && valleys < VALLEYS && epsilon == 0.0;
                if valley {
                    valleys += 1;
                    damping = UNDAMPED;
                } else if nearly_there || epsilon > 0.0 {
                    break;
                }
                nearly_there = epsilon == 0.0;
                linear = self.linearised(observation, nearly_there);
                continue;
            }
            let slow = gain < hoped_for || gain < converged;
            hoped_for = if fresh { (SLOW * gain).max(converged) } else { hoped_for };
            if slow {
                nearly_there |= in_reach(before - gain);
                linear = self.linearised(observation, nearly_there);
                hoped_for = 0.0;
            }
            fresh = slow;
        }
        self.linear = Some(linear);
    }

    /// What a whole step gains if the FRFs follow their derivatives.
    fn promised(&self, matrix: &[f64], right: &[f64]) -> f64 {
        let step = self.hypothesis.bounded_step(matrix, right).unwrap_or_default();
        step.iter().zip(right).map(|(step, right)| step * right).sum::<f64>().abs()
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
                    *damping = (*damping * 0.1).max(UNDAMPED);
                    return Some((next, after));
                }
            }
            *damping *= 10.0;
            if *damping > given_up {
                return None;
            }
        }
    }

    pub fn into_fit(self, observation: &Observation) -> Fit {
        let chi2 = observation.chi2(&self.predicted);
        let objective = chi2 + self.hypothesis.penalty();
        Fit { hypothesis: self.hypothesis, predicted: self.predicted, chi2, objective }
    }
}

/// A coarse fit under way, to be compared with others after each of its stages.
pub(crate) struct Softening(State);

impl Softening {
    /// Before the first stage; `None` where the start predicts no finite FRFs.
    pub fn begin(start: Hypothesis, thinned: &Observation) -> Option<Self> {
        State::at(start, thinned).map(|state| Softening(State { content: AMONG_MANY, ..state }))
    }

    /// One stage, with a share of [`COARSE`]: the softened objective that it comes to.
    pub fn stage(&mut self, thinned: &Observation, share: f64) -> f64 {
        self.0.improve(thinned, share, ITERATIONS.0, f64::INFINITY);
        self.0.objective(thinned, &thinned.softened_weights(&self.0.predicted, share))
    }

    /// Where it stands.
    pub fn hypothesis(self) -> Hypothesis {
        self.0.hypothesis
    }
}

/// How fast a fit with a limit comes nearer to it, from one set of derivatives to the next.
#[derive(Default)]
struct Pace {
    seen: usize,
    last: f64,
}

impl Pace {
    /// Whether a fit whose objective is now `objective` would, at what the last derivatives gained, need many more to come below `limit`.
    fn is_too_slow(&mut self, objective: f64, limit: f64) -> bool {
        let gained = self.last - objective;
        self.last = objective;
        self.seen += 1;
        self.seen > UNHURRIED && objective - limit > IN_REACH.max(PACES * gained)
    }
}
