//! Laws of several joints over frequency.
//!
//! Trying all combinations would take 6ᵐ fits of m joints. All joints begin with K + sC; in each round every
//! joint is fitted with every law, the others keeping theirs, and the one change that gains most evidence is
//! made. A joint that takes the blame for another's law is so overtaken by the other.

use super::super::law::{Dynamics, LawKind, coordinates};
use super::super::laws::{Candidate, LawFit, probable};
use super::super::problem::{Columns, Fitted, Problem, Test};
use crate::settings::several::{FEW_STEPS, MOST_STEPS};

/// Laws of all joints at their optimum.
pub(super) struct State {
    laws: Vec<Dynamics>,
    coordinates: Vec<f64>,
    others: Columns,
}

impl State {
    /// The joints by these laws, of whose matrices nothing is known beforehand, at their optimum; nothing
    /// where all are viscous or the FRFs leave them undetermined.
    pub(super) fn fitted(self, test: Test<'_>) -> Option<(Problem<'_>, Fitted)> {
        if self.laws.iter().all(|law| law.kind == LawKind::Viscous) {
            return None;
        }
        let problem = Problem::open(test, self.laws, None);
        let mut fitted = problem.fit(self.coordinates, Some(self.others))?;
        fitted.refresh(&problem)?;
        fitted.equations(&problem).covariance()?;
        Some((problem, fitted))
    }
}

/// Every joint's laws, the most probable first, the other joints following their most probable law, and the
/// laws that all follow; without the joints' masses.
pub(super) fn compared(viscous: &Problem, first: &Fitted) -> (Vec<Vec<LawFit>>, State) {
    let joints = viscous.laws.len();
    let mut current = State {
        laws: viscous.laws.clone(),
        coordinates: first.point.coordinates.clone(),
        others: first.others.clone(),
    };
    loop {
        let all: Vec<Vec<(Candidate, State)>> =
            (0..joints).map(|joint| candidates(viscous.test, &current, joint)).collect();
        // Noise is inflated by what the best combination leaves.
        let lowest = all.iter().flatten().min_by(|a, b| a.0.fit.objective.total_cmp(&b.0.fit.objective));
        let inflation = lowest.map_or(1.0, |(best, _)| best.inflation);
        let evidence = |candidate: &Candidate| {
            candidate.evidence + 0.5 * candidate.fit.objective * (1.0 - 1.0 / inflation)
        };
        let stays = |joint: usize, candidate: &Candidate| candidate.fit.kind == current.laws[joint].kind;
        let gain = |joint: usize, candidate: &Candidate| {
            let own = all[joint].iter().find(|(own, _)| stays(joint, own));
            own.map_or(f64::NEG_INFINITY, |(own, _)| evidence(candidate) - evidence(own))
        };
        let changes = all.iter().enumerate().flat_map(|(joint, all)| {
            let others = all.iter().enumerate().filter(move |(_, (candidate, _))| !stays(joint, candidate));
            others.map(move |(place, (candidate, _))| (joint, place, gain(joint, candidate)))
        });
        let best = changes.filter(|(.., gain)| *gain > 0.0).max_by(|a, b| a.2.total_cmp(&b.2));
        let changed = current.laws.iter().zip(&viscous.laws).filter(|(a, b)| a.kind != b.kind).count();
        match best {
            // No more changes than joints: laws that take turns are as good as each other.
            Some((joint, place, _)) if changed < joints && current.laws[joint].kind == LawKind::Viscous => {
                if let Some((_, state)) =
                    all.into_iter().nth(joint).and_then(|all| all.into_iter().nth(place))
                {
                    current = state;
                }
            }
            _ => {
                let bare = |all: Vec<(Candidate, State)>| {
                    probable(all.into_iter().map(|(candidate, _)| candidate).collect()).0
                };
                return (all.into_iter().map(bare).collect(), current);
            }
        }
    }
}

/// One joint with every law, the others keeping theirs.
fn candidates(test: Test, current: &State, joint: usize) -> Vec<(Candidate, State)> {
    let of_kind = |kind: LawKind| {
        let shapes: &[f64] = match kind {
            _ if kind == current.laws[joint].kind => &[0.0],
            LawKind::StandardLinearSolid => &[-1.0, 1.0],
            LawKind::Fractional => &[-0.3, 0.3],
            _ => &[0.0],
        };
        let fits = shapes.iter().filter_map(|shape| candidate(test, current, joint, (kind, *shape)));
        fits.reduce(|a, b| if b.0.fit.objective < a.0.fit.objective { b } else { a })
    };
    LawKind::ALL.into_iter().filter_map(of_kind).collect()
}

/// A joint with a law at its optimum next to the current one: in the middle of the band it begins with the
/// stiffness and damping that it has there.
fn candidate(
    test: Test,
    current: &State,
    joint: usize,
    (kind, shape): (LawKind, f64),
) -> Option<(Candidate, State)> {
    let mut laws = current.laws.clone();
    let own = &current.laws[joint];
    laws[joint] = own.of_kind(kind);
    let first: usize = current.laws[..joint].iter().map(Dynamics::count).sum();
    let (before, rest) = current.coordinates.split_at(first);
    let (here, after) = rest.split_at(own.count());
    let mut start = before.to_vec();
    if kind == own.kind {
        start.extend_from_slice(here);
    } else {
        let [k, d, _] = own.matrices(here);
        let mut matrices = coordinates(&laws[joint], k, d);
        matrices.resize(laws[joint].count() - laws[joint].shapes(), 0.0);
        matrices.resize(laws[joint].count(), shape);
        start.extend(matrices);
    }
    start.extend_from_slice(after);
    let problem = Problem::lawful(test, laws, None);
    let steps = if kind == LawKind::Constant { FEW_STEPS } else { MOST_STEPS };
    let fitted = problem.fit_within(start, Some(current.others.clone()), steps)?;
    let candidate = Candidate::of(&problem, &fitted, joint)?;
    let Fitted { point, others } = fitted;
    Some((candidate, State { laws: problem.laws, coordinates: point.coordinates, others }))
}
