//! Laws of several joints over frequency.
//!
//! Trying all combinations would take 6ᵐ fits of m joints. All begin with the one law that is most probable
//! for all of them: joints of one structure are mostly made alike, and of those that are, the first to get its
//! law would take the blame for the others. Then in each round every joint is fitted with every law, the others
//! keeping theirs, and the one change that gains most evidence is made, once a joint.

use super::super::law::{Dynamics, LawKind, coordinates};
use super::super::laws::{Candidate, LawFit, least_inflation, nearest, probable};
use super::super::problem::{Course, Fitted, Problem, Test};
use crate::settings::laws::NEAR_LOG_EVIDENCE;
use crate::settings::several::{FEW_STEPS, LIMIT, MOST_STEPS, NEAREST};
use jointscope_inference::Limit;

/// Laws of all joints at their optimum.
pub(super) struct State {
    laws: Vec<Dynamics>,
    fitted: Fitted,
}

impl State {
    /// The joints by these laws, of whose matrices nothing is known beforehand, at their optimum; nothing
    /// where all are viscous or the FRFs leave them undetermined.
    pub(super) fn fitted(self, test: Test<'_>) -> Option<(Problem<'_>, Fitted)> {
        if self.laws.iter().all(|law| law.kind == LawKind::Viscous) {
            return None;
        }
        let problem = Problem::open(test, self.laws, None);
        let mut fitted = problem.fit(self.fitted.point.coordinates, Some(self.fitted.others))?;
        fitted.refresh(&problem)?;
        fitted.equations(&problem).covariance()?;
        Some((problem, fitted))
    }
}

/// Every joint's laws, the most probable first, the other joints following their most probable law, and the
/// laws that all follow; without the joints' masses.
pub(super) fn compared(viscous: &Problem, first: &Fitted) -> (Vec<Vec<LawFit>>, State) {
    let test = viscous.test;
    let mut current = alike(viscous, first);
    let mut may_change = vec![true; viscous.laws.len()];
    loop {
        let joints = 0..may_change.len();
        let mut all: Vec<Vec<(Candidate, State)>> =
            joints.map(|joint| of_every_kind(test, &current, Some(joint))).collect();
        match best_change(&all, &current, &may_change) {
            // One change a joint: laws that take turns are as good as each other.
            Some((joint, place)) => {
                may_change[joint] = false;
                current = all.swap_remove(joint).swap_remove(place).1;
            }
            None => {
                let bare = |all: Vec<(Candidate, State)>| {
                    probable(all.into_iter().map(|(candidate, _)| candidate).collect()).0
                };
                return (all.into_iter().map(bare).collect(), current);
            }
        }
    }
}

/// All joints with the one law that is most probable for all of them.
fn alike(viscous: &Problem, first: &Fitted) -> State {
    let point = first.point.with(first.point.coordinates.clone());
    let fitted = Fitted { point, others: first.others.clone() };
    let as_fitted = State { laws: viscous.laws.clone(), fitted };
    let all = of_every_kind(viscous.test, &as_fitted, None);
    let inflation = least_inflation(all.iter().map(|(candidate, _)| candidate));
    let probable = all.into_iter().max_by(|a, b| a.0.inflated(inflation).total_cmp(&b.0.inflated(inflation)));
    probable.map_or(as_fitted, |(_, state)| state)
}

/// The joint whose change of law gains most evidence, and the place of that law among its candidates.
fn best_change(
    all: &[Vec<(Candidate, State)>],
    current: &State,
    may_change: &[bool],
) -> Option<(usize, usize)> {
    let inflation = least_inflation(all.iter().flatten().map(|(candidate, _)| candidate));
    let stays = |joint: usize, candidate: &Candidate| candidate.fit.kind == current.laws[joint].kind;
    let gain = |joint: usize, candidate: &Candidate| {
        let own = all[joint].iter().find(|(own, _)| stays(joint, own));
        own.map_or(f64::NEG_INFINITY, |(own, _)| candidate.inflated(inflation) - own.inflated(inflation))
    };
    let joints = all.iter().enumerate().filter(|(joint, _)| may_change[*joint]);
    let changes = joints.flat_map(|(joint, all)| {
        let others = all.iter().enumerate().filter(move |(_, (candidate, _))| !stays(joint, candidate));
        others.map(move |(place, (candidate, _))| (joint, place, gain(joint, candidate)))
    });
    let best = changes.filter(|(.., gain)| *gain > 0.0).max_by(|a, b| a.2.total_cmp(&b.2))?;
    Some((best.0, best.1))
}

/// Shapes that a law is tried from.
fn shapes(kind: LawKind) -> &'static [f64] {
    match kind {
        LawKind::StandardLinearSolid => &[-1.0, 1.0],
        LawKind::Fractional => &[-0.3, 0.3],
        _ => &[0.0],
    }
}

fn lower(a: (Candidate, State), b: (Candidate, State)) -> (Candidate, State) {
    if b.0.fit.objective < a.0.fit.objective { b } else { a }
}

/// One joint (all without one) with every law, the others keeping theirs.
fn of_every_kind(test: Test, current: &State, joint: Option<usize>) -> Vec<(Candidate, State)> {
    let own = current.laws[joint.unwrap_or(0)].kind;
    let mut all: Vec<(Candidate, State)> = Vec::new();
    for kind in std::iter::once(own).chain(LawKind::ALL.into_iter().filter(|kind| *kind != own)) {
        let shapes = if kind == own { &[0.0] } else { shapes(kind) };
        let limit = nearest(all.iter().map(|(candidate, _)| candidate)).map(|nearest| Limit {
            objective: nearest.fit.objective,
            reach: 2.0 * NEAR_LOG_EVIDENCE * nearest.inflation,
            ..LIMIT
        });
        let fits = shapes.iter().filter_map(|shape| candidate(test, current, joint, (kind, *shape), limit));
        all.extend(fits.reduce(lower));
    }
    converged(test, joint, all)
}

/// The same laws, those nearest to the FRFs gone on with until they have converged by derivatives taken there:
/// evidence is of optima.
fn converged(test: Test, joint: Option<usize>, mut all: Vec<(Candidate, State)>) -> Vec<(Candidate, State)> {
    all.sort_by(|a, b| a.0.fit.objective.total_cmp(&b.0.fit.objective));
    let least = all.first().map_or(0.0, |(nearest, _)| nearest.fit.objective);
    for (rank, (candidate, State { laws, fitted })) in all.iter_mut().enumerate() {
        if rank < NEAREST || candidate.fit.objective - least < 2.0 * NEAR_LOG_EVIDENCE {
            let problem = Problem::lawful(test, laws.clone(), None);
            let again = fitted.refresh(&problem).and_then(|()| of_all(&problem, fitted, joint));
            again.into_iter().for_each(|again| *candidate = again);
        }
    }
    all
}

/// A joint (all without one) with a law at its optimum next to the current one: in the middle of the band it
/// begins with the stiffness and damping that it has there.
fn candidate(
    test: Test,
    current: &State,
    joint: Option<usize>,
    (kind, shape): (LawKind, f64),
    limit: Option<Limit>,
) -> Option<(Candidate, State)> {
    let mut laws = current.laws.clone();
    let mut rest = current.fitted.point.coordinates.as_slice();
    let mut start = Vec::with_capacity(rest.len());
    for (place, law) in laws.iter_mut().enumerate() {
        let own = *law;
        let (here, after) = rest.split_at(own.count());
        rest = after;
        if kind == own.kind || joint.is_some_and(|joint| joint != place) {
            start.extend_from_slice(here);
            continue;
        }
        *law = own.of_kind(kind);
        let [k, d, _] = own.matrices(here);
        let mut matrices = coordinates(law, k, d);
        matrices.resize(law.count() - law.shapes(), 0.0);
        matrices.resize(law.count(), shape);
        start.extend(matrices);
    }
    start.extend_from_slice(rest);
    let problem = Problem::lawful(test, laws, None);
    let steps = if kind == LawKind::Constant { FEW_STEPS } else { MOST_STEPS };
    let course = Course { steps, limit, ..Course::default() };
    let fitted =
        problem.fit_from(problem.point(start, None)?, Some(current.fitted.others.clone()), course)?;
    Some((of_all(&problem, &fitted, joint)?, State { laws: problem.laws, fitted }))
}

/// What a joint's law comes to at an optimum; of all alike that of the first.
fn of_all(problem: &Problem, fitted: &Fitted, joint: Option<usize>) -> Option<Candidate> {
    Candidate::of(problem, fitted, joint.unwrap_or(0))
}
