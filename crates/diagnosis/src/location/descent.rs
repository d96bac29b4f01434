//! The way to a site's best: softened weights on few lines first, then the recording as it is.

use super::Site;
use super::subject::{Modelled, Stand, State, Subject};
use super::tangent::{Normal, Tangent};
use crate::Hypothesis;
use jointscope_linalg::solve_positive_definite;

/// Shares by which weights are softened on the way from afar: up to which every start is followed, up to which every site; steps for each.
const SOFTENED: [f64; 3] = [0.3, 0.1, 0.02];
const COMPARED: usize = 1;
const PRUNED: usize = 2;
const STEPS: usize = 3;
/// Starts that leave more than this many times what the best leaves are not followed.
const BESIDE: f64 = 3.0;
/// Share of the objective, and gain, below which a fit has converged: on the way, and at its end.
pub(super) const NEAR: Converged = Converged { share: 0.03, gain: 1.0, trusting: true };
pub(super) const THERE: Converged = Converged { share: 3e-4, gain: 0.1, trusting: false };
/// Steps made from old derivatives that gain less than this share of the one before call for new ones.
const SLOW: f64 = 0.2;
/// Damping to begin with, and beyond which no step is a gain.
const DAMPING: f64 = 1e-6;
const GIVEN_UP: f64 = 1e3;

/// When a descent stops.
#[derive(Debug, Clone, Copy)]
pub(super) struct Converged {
    share: f64,
    gain: f64,
    /// Whether old derivatives are believed when they say so.
    trusting: bool,
}

/// A hypothesis from which all sites set out.
pub(super) struct Start {
    hypothesis: Hypothesis,
    centre: Modelled,
    surroundings: Vec<Modelled>,
}

/// A state on its way, with derivatives that were right somewhere behind it.
pub(super) struct Descent<'a> {
    subject: &'a Subject<'a>,
    pub state: State,
    tangent: Option<Tangent>,
    damping: f64,
}

impl<'a> Descent<'a> {
    pub fn from(subject: &'a Subject<'a>, state: State) -> Self {
        Descent { subject, state, tangent: None, damping: DAMPING }
    }

    fn amid(subject: &'a Subject<'a>, state: State, surroundings: &[Modelled]) -> Option<Self> {
        let tangent = Some(subject.tangent_amid(&state, surroundings)?);
        Some(Descent { tangent, ..Descent::from(subject, state) })
    }

    /// Makes up to `steps` steps down with the given weights; `None` where the state has no derivatives.
    pub fn descend(&mut self, weights: &[f64], steps: usize, goal: Converged) -> Option<f64> {
        // Free scalars are those of other weights.
        self.state = self.subject.state(&self.state.stand, weights)?;
        let mut lowest = self.subject.objective(&self.state, weights);
        let (mut worn, mut last) = (self.tangent.is_none(), f64::INFINITY);
        for _ in 0..steps {
            let fresh = worn;
            if fresh {
                self.tangent = Some(self.subject.tangent(&self.state, false)?);
                last = f64::INFINITY;
            }
            let normal = self.subject.normal(&self.state, self.tangent.as_ref()?, weights);
            let next = self.step(&normal, weights, lowest, fresh);
            let gain = next.as_ref().map_or(0.0, |(_, after)| lowest - after);
            let stuck = next.is_none();
            if let Some(next) = next {
                (self.state, lowest) = next;
            }
            let converged = gain < goal.gain.max(goal.share * lowest);
            if converged && (fresh || (goal.trusting && !stuck)) {
                break;
            }
            worn = converged || gain < SLOW * last;
            last = gain;
        }
        Some(lowest)
    }

    /// Goes down with weights softened by one share after another; with what is left of the last.
    pub fn soften(&mut self, shares: &[f64]) -> Option<f64> {
        let mut left = f64::INFINITY;
        for share in shares {
            let weights = self.subject.recorded.softened(*share, &self.state.modelled);
            left = self.descend(&weights, STEPS, NEAR)?;
        }
        Some(left)
    }

    /// The rest of the way, to the end of the softening and beyond; with what is left.
    pub fn ended(mut self) -> Option<(f64, State)> {
        self.soften(&SOFTENED[PRUNED..])?;
        let left = self.descend(&self.subject.recorded.weights, STEPS, NEAR)?;
        Some((left, self.state))
    }

    /// The first damped step that lowers the objective. Old derivatives get one attempt.
    fn step(&mut self, normal: &Normal, weights: &[f64], before: f64, fresh: bool) -> Option<(State, f64)> {
        loop {
            if let Some(step) = damped(normal, self.damping) {
                let stand = self.subject.moved(&self.state.stand, &step);
                if let Some(next) = self.subject.state(&stand, weights) {
                    let after = self.subject.objective(&next, weights);
                    if after < before {
                        self.damping = (self.damping * 0.1).max(1e-9);
                        return Some((next, after));
                    }
                }
            }
            if !fresh {
                return None;
            }
            self.damping = if self.damping < 1e-3 { 1e-3 } else { self.damping * 10.0 };
            if self.damping > GIVEN_UP {
                self.damping = DAMPING;
                return None;
            }
        }
    }
}

fn damped(normal: &Normal, damping: f64) -> Option<Vec<f64>> {
    let n = normal.right.len();
    let (mut matrix, mut step) = (normal.matrix.clone(), normal.right.clone());
    (0..n).for_each(|a| matrix[a * n + a] *= 1.0 + damping);
    solve_positive_definite(&mut matrix, &mut step).then_some(step)
}

impl Subject<'_> {
    /// What all sites have in common at a hypothesis.
    pub fn start(&self, hypothesis: &Hypothesis) -> Option<Start> {
        let centre = self.model(hypothesis)?;
        Some(Start { hypothesis: hypothesis.clone(), centre, surroundings: self.surroundings(hypothesis)? })
    }

    /// Fits from each of several starts with softened weights, of each from the most promising of `sites`, and some way on from the best
    /// of their ends; with what is left, still softened.
    pub fn approached(&self, starts: &[Start], sites: &[Site]) -> Option<(f64, Descent<'_>)> {
        let weights = self.recorded.softened(SOFTENED[0], &self.recorded.measured);
        let states: Vec<(f64, &Start, State)> = starts
            .iter()
            .filter_map(|start| {
                self.promising(start, sites, &weights).map(|(left, state)| (left, start, state))
            })
            .collect();
        let best = states.iter().map(|(left, ..)| *left).fold(f64::INFINITY, f64::min);
        let near = states.into_iter().filter(|(left, ..)| *left <= BESIDE * best);
        let ends = near.filter_map(|(_, start, state)| {
            let mut descent = Descent::amid(self, state, &start.surroundings)?;
            let left = descent.soften(&SOFTENED[..COMPARED])?;
            Some((left, descent))
        });
        let (_, mut descent) = ends.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let left = descent.soften(&SOFTENED[COMPARED..PRUNED])?;
        Some((left, descent))
    }

    /// The way down without softening.
    pub fn descended(&self, state: State, steps: usize) -> Option<(f64, State)> {
        let mut descent = Descent::from(self, state);
        let left = descent.descend(&self.recorded.weights, steps, THERE)?;
        Some((left, descent.state))
    }

    /// Of several sites the one that leaves least with weights softened about what was measured, nothing yielding.
    fn promising(&self, start: &Start, sites: &[Site], weights: &[f64]) -> Option<(f64, State)> {
        let left = |site| {
            let state = self.state_on(&start.centre, &Stand::free(&start.hypothesis, site), weights)?;
            Some((self.objective(&state, weights), state))
        };
        sites.iter().filter_map(left).min_by(|a, b| a.0.total_cmp(&b.0))
    }
}
