//! Whether physics allows the joint found: reciprocal, never giving out energy, at rest without load.

use super::law::{Dynamics, Form};
use super::problem::{Point, Problem};
use super::{EXPLAINED, Fitted, Fitter, coordinates};
use crate::DecompositionError;
use jointscope_inference::{Covariance, Parameter, Transform};
use jointscope_linalg::RealMatrix2;
use serde::Serialize;
use std::f64::consts::SQRT_2;

/// Probabilities of FRFs that speak at least as much against a property, if the joint has it. Nothing where it cannot be tested.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JointTests {
    /// k12 = k21 and c12 = c21: by how much χ² falls where they may differ, against χ² of two degrees of freedom.
    pub reciprocity: Option<f64>,
    /// The smallest eigenvalue of k is not negative (one-sided); of k in units of its diagonal, since N/m and N·m/rad do not compare.
    pub definite: Option<f64>,
    /// The smallest eigenvalue of c is not negative (one-sided), in the same units.
    pub passive: Option<f64>,
}

impl JointTests {
    /// Probability below which a test fails.
    pub const FAILED: f64 = 0.05;

    /// Names of the tests that fail.
    pub fn failed(&self) -> Vec<&'static str> {
        let all = [("reciprocity", self.reciprocity), ("definite", self.definite), ("passive", self.passive)];
        all.into_iter().filter(|(_, p)| p.is_some_and(|p| p < Self::FAILED)).map(|(name, _)| name).collect()
    }
}

/// The most probable joint among those that physics allows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Admissible {
    /// K, symmetric and positive semidefinite.
    pub stiffness: [[f64; 2]; 2],
    /// C, symmetric and positive semidefinite.
    pub damping: [[f64; 2]; 2],
    /// By how much χ² and priors exceed those of the joint without constraint.
    pub costs: f64,
}

/// Tests of the free optimum, and the nearest admissible joint where one fails. Variances count `strain` times; `asymmetry` is by how much χ² falls where
/// k and c are free of symmetry.
pub(super) fn examined(
    problem: &Problem,
    free: &Fitted,
    covariance: &Covariance,
    (strain, asymmetry): (f64, Option<f64>),
) -> (JointTests, Option<Admissible>) {
    let at = &free.point.coordinates;
    let count = problem.law.stiffness.count();
    let lowest = |first: usize| not_negative(problem.law.stiffness, at, first, (covariance, strain));
    let tests = JointTests {
        reciprocity: asymmetry.map(|gain| (-0.5 * gain).exp()),
        definite: lowest(0),
        passive: lowest(count),
    };
    let failed = tests.failed();
    let admissible =
        if failed.is_empty() { None } else { nearest(problem, free, &failed, asymmetry.unwrap_or(0.0)) };
    (tests, admissible)
}

/// P(a smallest eigenvalue as low as that of the symmetric or scalar matrix whose coordinates begin at `first` | zero). Variances count `strain` times.
pub(super) fn not_negative(
    form: Form,
    at: &[f64],
    first: usize,
    (covariance, strain): (&Covariance, f64),
) -> Option<f64> {
    if form == Form::Scalar {
        return below_zero(at[first], (strain * covariance.at(first, first)).sqrt());
    }
    let [a, b, d] = [0, 1, 2].map(|e| at[first + e]);
    let (half, mean) = (0.5 * (a - d), 0.5 * (a + d));
    let lambda = mean - half.hypot(b);
    // v of the smallest eigenvalue; dλ = vᵀ dM v.
    let angle = 0.5 * b.atan2(half);
    let (v, w) = (-angle.sin(), angle.cos());
    let by = [v * v, 2.0 * v * w, w * w];
    let mut variance = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            variance += by[i] * by[j] * covariance.at(first + i, first + j);
        }
    }
    below_zero(lambda, (strain * variance).sqrt())
}

/// P(an estimate this low | zero).
fn below_zero(value: f64, std: f64) -> Option<f64> {
    (std > 0.0).then(|| 0.5 * statrs::function::erf::erfc(-value / (std * SQRT_2)))
}

/// Gain by freedom of symmetry from which it is asked whether the symmetric optimum is one: one time in twenty by chance.
const LARGE_GAIN: f64 = 5.99;
/// Decrease by which a symmetric optimum is another than the one before.
const ANOTHER: f64 = 0.1;
/// Times that it is asked.
const ROUNDS: usize = 4;

/// What is known of a joint whose k and c are free of symmetry.
pub(super) enum Freed {
    /// By how much it lowers χ² to first order, in the units of [`asymmetry`]: too little for its optimum to be sought.
    Promised(f64),
    /// Its optimum.
    Fitted(Point),
    /// Nothing yet.
    Unknown,
}

/// The symmetric optimum, sought again from the free one for as long as that leads to another, lower one, and what is known of the free one: freedom goes round what
/// keeps a symmetric fit on its way.
pub(super) fn settled(
    fitter: &Fitter,
    problem: &Problem,
    mut at: Fitted,
) -> Result<(Fitted, Freed), DecompositionError> {
    at.refresh(problem)?;
    for _ in 0..ROUNDS {
        if let Some(gain) = promised(fitter, problem, &at) {
            return Ok((at, Freed::Promised(gain)));
        }
        let Some(free) = reciprocity(problem, &at) else { break };
        if at.point.objective - free.objective < LARGE_GAIN {
            return Ok((at, Freed::Fitted(free)));
        }
        let law = problem.law.free();
        let [k, d, _] = law.matrices(&free.coordinates[..law.count()]);
        let mut start = coordinates(&problem.law, k, d);
        start.extend_from_slice(&free.coordinates[law.count()..]);
        let before = at.point.objective;
        match problem.fit(start, None) {
            Some((point, others)) if point.objective < before => at = Fitted { point, others },
            _ => return Ok((at, Freed::Fitted(free))),
        }
        at.refresh(problem)?;
        if at.point.objective > before - ANOTHER {
            return Ok((at, Freed::Fitted(free)));
        }
    }
    Ok((at, Freed::Unknown))
}

/// The gain by freedom of symmetry to first order, in the units of [`asymmetry`], where the FRFs are explained and it is too small for the optimum to be sought.
fn promised(fitter: &Fitter, problem: &Problem, at: &Fitted) -> Option<f64> {
    if problem.law.stiffness != Form::Symmetric || fitter.per_degree(problem, &at.point) > EXPLAINED {
        return None;
    }
    let law = problem.law.free();
    let free = Problem { law, parameters: free_parameters(problem, &law), ..*problem };
    let start = freed(problem, &law, &at.point);
    let there = at.point.with(start);
    let equations = free.equations_of(&there, &at.others, free.test.weights);
    let step = equations.step(0.0)?;
    let gain: f64 = step.iter().zip(&equations.right).map(|(step, right)| step * right).sum();
    if gain >= LARGE_GAIN {
        return None;
    }
    let rest = at.point.coordinates.iter().skip(problem.own()).zip(step.iter().skip(free.own()));
    let mut moved = vec![0.0; free.own()];
    moved.extend(rest.map(|(at, step)| at + step));
    Some(
        gain.max(0.0)
            / super::uncertainty::strain(&free.parameters, free.own(), &moved, &equations.covariance()?),
    )
}

/// The coordinates of a point in a law with other forms of its matrices.
fn freed(problem: &Problem, law: &Dynamics, at: &Point) -> Vec<f64> {
    let own = problem.law.count();
    let [k, d, _] = problem.law.matrices(&at.coordinates[..own]);
    let mut start = coordinates(law, k, d);
    start.extend_from_slice(&at.coordinates[own..]);
    start
}

/// The optimum with k and c free of symmetry.
fn reciprocity(problem: &Problem, free: &Fitted) -> Option<Point> {
    if problem.law.stiffness != Form::Symmetric {
        return None;
    }
    let law = problem.law.free();
    Some(refitted(problem, free, law)?.0)
}

/// By how much χ² and priors fall where k and c may be unsymmetric, in units of what such a joint leaves of the FRFs and of the tolerances: what asymmetry
/// explains is not taken for noise.
pub(super) fn asymmetry(fitter: &Fitter, problem: &Problem, symmetric: &Fitted, known: Freed) -> Option<f64> {
    let known = match known {
        Freed::Unknown => promised(fitter, problem, symmetric).map_or(Freed::Unknown, Freed::Promised),
        known => known,
    };
    let point = match known {
        Freed::Promised(gain) => return Some(gain),
        Freed::Fitted(point) => point,
        Freed::Unknown => reciprocity(problem, symmetric)?,
    };
    let law = problem.law.free();
    let free = Problem { law, parameters: free_parameters(problem, &law), ..*problem };
    let inflation = fitter.inflation(&free, &point);
    let others = free.other_columns(&point)?;
    let at = Fitted { point, others };
    let covariance = at.equations(&free).covariance()?;
    let scale = inflation
        * super::uncertainty::strain(&free.parameters, free.own(), &at.point.coordinates, &covariance);
    Some((symmetric.point.objective - at.point.objective).max(0.0) / scale)
}

/// The parameters of a problem with another form of the law's matrices.
fn free_parameters(problem: &Problem, law: &Dynamics) -> Vec<Parameter> {
    let linear = Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 });
    let rest = problem.parameters[problem.law.count()..].iter().copied();
    std::iter::repeat_n(linear, law.count()).chain(rest).collect()
}

/// The problem with another form of the law's matrices, from the optimum of the first.
fn refitted(problem: &Problem, free: &Fitted, law: Dynamics) -> Option<(Point, Dynamics)> {
    let start = freed(problem, &law, &free.point);
    let other =
        Problem { test: problem.test, law, parameters: free_parameters(problem, &law), mass: problem.mass };
    let (point, _) = other.fit(start, Some(free.others.clone()))?;
    Some((point, law))
}

/// The optimum with c = v vᵀ (zero for bodies that do not rotate), and its law.
pub(super) fn on_the_boundary_of_c(problem: &Problem, free: &Fitted) -> Option<(Point, Dynamics)> {
    refitted(problem, free, Dynamics { damping: boundary(problem.law.damping), ..problem.law })
}

fn boundary(form: Form) -> Form {
    if form == Form::Scalar { Form::Zero } else { Form::RankOne }
}

fn nearest(problem: &Problem, free: &Fitted, failed: &[&str], gain: f64) -> Option<Admissible> {
    let mut law = problem.law;
    if failed.contains(&"definite") {
        law.stiffness = boundary(law.stiffness);
    }
    if failed.contains(&"passive") {
        law.damping = boundary(law.damping);
    }
    let matrices = |law: &Dynamics, point: &Point| -> [RealMatrix2; 3] {
        law.matrices(&point.coordinates[..law.count()])
    };
    let ([k, d, _], objective) = if law == problem.law {
        (matrices(&law, &free.point), free.point.objective)
    } else {
        let (point, law) = refitted(problem, free, law)?;
        (matrices(&law, &point), point.objective)
    };
    let costs = objective - free.point.objective + gain;
    Some(Admissible { stiffness: k.0, damping: d.scale(1.0 / law.middle).0, costs })
}
