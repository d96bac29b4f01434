//! Whether physics allows the joint found: reciprocal, never giving out energy, at rest without load.

use super::law::{Dynamics, Form};
use super::problem::{Fitted, Point, Problem};
use super::smallest_eigenvalue::as_low_if_zero;
use super::uncertainty::tolerance_inflation;
use crate::settings::noise::EXPLAINED;
use crate::settings::symmetry::{ANOTHER_OPTIMUM, LARGE_GAIN, MOST_ROUNDS};
use jointscope_inference::{Covariance, NormalEquations, SIGNIFICANT, chi_squared_above, normal_below};
use serde::Serialize;

/// Probabilities of FRFs that speak at least as much against a property, if the joint has it. Nothing where
/// it cannot be tested.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JointTests {
    /// k12 = k21, and the same of the damping matrix of the law that the joint follows: by how much χ² falls
    /// where they may differ, against χ² of two degrees of freedom (of one for a law without damping).
    pub reciprocity: Option<f64>,
    /// The smallest eigenvalue of k in the middle of the band is not negative: probability of one this low
    /// where the nearest k on the edge is true; of k in units of its diagonal, since N/m and N·m/rad do not
    /// compare.
    pub definite: Option<f64>,
    /// The smallest eigenvalue of the law's damping matrix is not negative, in the same way and units;
    /// nothing for a law without damping.
    pub passive: Option<f64>,
}

impl JointTests {
    /// Whether a test of this probability fails.
    pub fn fails(p: f64) -> bool {
        p < SIGNIFICANT
    }

    /// Names of the tests that fail.
    pub fn failed(&self) -> Vec<&'static str> {
        let all = [("reciprocity", self.reciprocity), ("definite", self.definite), ("passive", self.passive)];
        all.into_iter().filter(|(_, p)| p.is_some_and(Self::fails)).map(|(name, _)| name).collect()
    }
}

/// The most probable joint among those that physics allows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Admissible {
    /// K, symmetric and positive semidefinite.
    pub stiffness: [[f64; 2]; 2],
    /// C in the middle of the band, symmetric and positive semidefinite.
    pub damping: [[f64; 2]; 2],
    /// By how much χ² and priors exceed those of the joint without constraint.
    pub costs: f64,
}

/// P(a smallest eigenvalue as low as that of the symmetric or scalar matrix whose coordinates begin at
/// `first` | zero). `noise` is the covariance with the fixture exact; variances count `inflation` times.
pub(super) fn not_negative(
    form: Form,
    at: &[f64],
    first: usize,
    (covariance, noise, inflation): (&Covariance, &Covariance, f64),
) -> Option<f64> {
    if form == Form::Zero {
        return None;
    }
    if form == Form::Scalar {
        return below_zero(at[first], (inflation * covariance.at(first, first)).sqrt());
    }
    let place = |e: usize| first + e;
    let own = |of: &Covariance| {
        std::array::from_fn(|i| std::array::from_fn(|j| inflation * of.at(place(i), place(j))))
    };
    as_low_if_zero([0, 1, 2].map(|e| at[place(e)]), own(covariance), own(noise))
}

/// P(at least this gain in χ² | a joint of this law that is reciprocal).
pub(super) fn by_chance(law: &Dynamics, gain: f64) -> f64 {
    chi_squared_above(gain.max(0.0), law.asymmetries() as f64)
}

/// P(an estimate this low | zero).
fn below_zero(value: f64, std: f64) -> Option<f64> {
    (std > 0.0).then(|| normal_below(value / std))
}

/// What is known of a joint whose k and c are free of symmetry.
pub(super) enum Freed {
    /// By how much it lowers χ² to first order, in the units of [`asymmetry`]: too little for its optimum to
    /// be sought.
    Promised(f64),
    /// Its optimum.
    Fitted(Point),
    /// Nothing yet.
    Unknown,
}

/// The symmetric optimum of one joint, sought again from the free one for as long as that leads to another,
/// lower one, and what is known of the free one: freedom goes round what keeps a symmetric fit on its way.
///
/// `None` where an optimum has no derivatives.
pub(super) fn settled(problem: &Problem, mut at: Fitted) -> Option<(Fitted, Freed)> {
    at.refresh(problem)?;
    for _ in 0..MOST_ROUNDS {
        if let Some(gain) = promised(problem, &at) {
            return Some((at, Freed::Promised(gain)));
        }
        let Some(free) = reciprocity(problem, &at) else { break };
        if at.point.objective - free.objective < LARGE_GAIN {
            return Some((at, Freed::Fitted(free)));
        }
        let start = asymmetric(problem, 0).converted(&free.coordinates, &problem.laws);
        let before = at.point.objective;
        match problem.fit(start, None) {
            Some(next) if next.point.objective < before => at = next,
            _ => return Some((at, Freed::Fitted(free))),
        }
        at.refresh(problem)?;
        if at.point.objective > before - ANOTHER_OPTIMUM {
            return Some((at, Freed::Fitted(free)));
        }
    }
    Some((at, Freed::Unknown))
}

/// The problem with k and the damping matrix of a joint free of symmetry, the rest of its law as it is.
fn asymmetric<'a>(problem: &Problem<'a>, joint: usize) -> Problem<'a> {
    let mut laws = problem.laws.clone();
    laws[joint] = laws[joint].free();
    problem.with_forms(laws)
}

/// The problem with k and c of a joint free of symmetry, its equations at a symmetric optimum, the step that
/// they ask for, and by how much χ² falls, to first order; `None` for bodies that do not rotate.
fn freed<'a>(
    problem: &Problem<'a>,
    at: &Fitted,
    joint: usize,
) -> Option<(Problem<'a>, NormalEquations, Vec<f64>, f64)> {
    if problem.laws[joint].stiffness != Form::Symmetric {
        return None;
    }
    let free = asymmetric(problem, joint);
    let there = at.point.with(problem.converted(&at.point.coordinates, &free.laws));
    let equations = free.equations_of(&there, &at.others, free.test.weights);
    let step = equations.step(0.0)?;
    let gain: f64 = step.iter().zip(&equations.right).map(|(step, right)| step * right).sum();
    Some((free, equations, step, gain))
}

/// By how much χ² falls, to first order, where k and c of a joint may be unsymmetric.
pub(super) fn first_order_asymmetry(problem: &Problem, at: &Fitted, joint: usize) -> Option<f64> {
    freed(problem, at, joint).map(|(.., gain)| gain.max(0.0))
}

/// The gain by freedom of symmetry to first order, in the units of [`asymmetry`], where the FRFs are
/// explained and it is too small for the optimum to be sought.
fn promised(problem: &Problem, at: &Fitted) -> Option<f64> {
    if problem.per_degree(&at.point) > EXPLAINED {
        return None;
    }
    let (free, equations, step, gain) = freed(problem, at, 0)?;
    if gain >= LARGE_GAIN {
        return None;
    }
    let rest = at.point.coordinates.iter().skip(problem.own()).zip(step.iter().skip(free.own()));
    let mut moved = vec![0.0; free.own()];
    moved.extend(rest.map(|(at, step)| at + step));
    Some(gain.max(0.0) / tolerance_inflation(&free.parameters, free.own(), &moved, &equations.covariance()?))
}

/// The optimum with k and c free of symmetry.
fn reciprocity(problem: &Problem, symmetric: &Fitted) -> Option<Point> {
    if problem.laws[0].stiffness != Form::Symmetric {
        return None;
    }
    refitted(problem, symmetric, vec![problem.laws[0].free()]).map(|(_, free)| free.point)
}

/// By how much χ² and priors fall where k and c of one joint may be unsymmetric, in units of what such a
/// joint leaves of the FRFs and of the tolerances: what asymmetry explains is not taken for noise.
pub(super) fn asymmetry(problem: &Problem, symmetric: &Fitted, known: Freed) -> Option<f64> {
    let known = match known {
        Freed::Unknown => promised(problem, symmetric).map_or(Freed::Unknown, Freed::Promised),
        known => known,
    };
    let point = match known {
        Freed::Promised(gain) => return Some(gain),
        Freed::Fitted(point) => point,
        Freed::Unknown => reciprocity(problem, symmetric)?,
    };
    let free = asymmetric(problem, 0);
    let inflation = free.inflation(&point);
    let others = free.other_columns(&point)?;
    let at = Fitted { point, others };
    let covariance = at.equations(&free).covariance()?;
    let scale =
        inflation * tolerance_inflation(&free.parameters, free.own(), &at.point.coordinates, &covariance);
    Some((symmetric.point.objective - at.point.objective).max(0.0) / scale)
}

/// The problem with other forms of the laws' matrices, fitted from the optimum of the first.
pub(super) fn refitted<'a>(
    problem: &Problem<'a>,
    free: &Fitted,
    laws: Vec<Dynamics>,
) -> Option<(Problem<'a>, Fitted)> {
    let start = problem.converted(&free.point.coordinates, &laws);
    let other = problem.with_forms(laws);
    let fitted = other.fit(start, Some(free.others.clone()))?;
    Some((other, fitted))
}

/// The limit of what is positive semidefinite: v vᵀ, zero for bodies that do not rotate.
pub(super) fn boundary(form: Form) -> Form {
    if form == Form::Scalar { Form::Zero } else { Form::RankOne }
}

/// The nearest joint that passes the tests that `failed`; `gain` is by how much χ² falls where k and c are
/// free of symmetry.
pub(super) fn nearest(problem: &Problem, free: &Fitted, failed: &[&str], gain: f64) -> Option<Admissible> {
    if failed.is_empty() {
        return None;
    }
    let mut law = problem.laws[0];
    if failed.contains(&"definite") {
        law.stiffness = boundary(law.stiffness);
    }
    if failed.contains(&"passive") {
        law.damping = boundary(law.damping);
    }
    let refitted = if law == problem.laws[0] { None } else { Some(refitted(problem, free, vec![law])?.1) };
    let point = &refitted.as_ref().unwrap_or(free).point;
    let [k, d, _] = law.matrices(&point.coordinates[..law.count()]);
    let costs = point.objective - free.point.objective + gain;
    Some(Admissible { stiffness: k.0, damping: d.scale(1.0 / law.middle).0, costs })
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn a_single_element_is_as_likely_not_negative_as_its_distance_from_zero_says() {
        let covariance = Covariance::new(2, vec![9.0, 0.0, 0.0, 4.0]);
        let p = not_negative(Form::Scalar, &[5.0, -1.96 * 4.0], 1, (&covariance, &covariance, 4.0)).unwrap();
        assert!((p - 0.025).abs() < 1e-4, "{p}");
        let exact = Covariance::new(1, vec![0.0]);
        assert_eq!(not_negative(Form::Scalar, &[1.0], 0, (&exact, &exact, 1.0)), None);
    }

    #[test]
    fn a_test_fails_below_five_per_cent_and_not_at_it() {
        let tests =
            |p: [Option<f64>; 3]| JointTests { reciprocity: p[0], definite: p[1], passive: p[2] }.failed();
        assert_eq!(tests([Some(0.049), Some(0.0), Some(0.01)]), ["reciprocity", "definite", "passive"]);
        assert!(tests([Some(0.05), None, Some(0.9)]).is_empty());
    }

    #[test]
    fn what_gives_out_energy_is_sought_on_the_boundary_of_what_does_not() {
        assert_eq!((boundary(Form::Scalar), boundary(Form::Symmetric)), (Form::Zero, Form::RankOne));
    }
}
