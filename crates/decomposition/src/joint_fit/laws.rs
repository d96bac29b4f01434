//! Laws of a joint's stiffness and damping over frequency, compared by their evidence.

use super::law::{Dynamics, Form, LawKind};
use super::problem::{Point, Problem};
use super::quantities::Uncertain;
use super::{Fitted, Fitter};
use jointscope_fixture::BodyKind;
use jointscope_inference::{Parameter, Transform, laplace_evidence};
use jointscope_linalg::RealMatrix2;
use num_complex::Complex64;

/// A law as fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct LawFit {
    /// Which.
    pub kind: LawKind,
    /// The joint's mass, kg, uniform over its length; nothing for a massless one.
    pub mass: Option<f64>,
    /// Probability among the laws compared.
    pub probability: f64,
    /// χ² and priors, in units of the noise as inflated.
    pub objective: f64,
    /// K: N/m, N/rad, N·m/rad.
    pub stiffness: RealMatrix2,
    /// C, H, or D of the law; zero of a law without damping.
    pub damping: RealMatrix2,
    /// K₁ per rad/s, of the law that has it.
    pub change: Option<RealMatrix2>,
    /// τ (s) or α, of the laws that have one.
    pub shape: Option<f64>,
    law: Dynamics,
    coordinates: Vec<f64>,
}

impl LawFit {
    /// Its name in result files.
    pub fn name(&self) -> String {
        let with_mass = if self.mass.is_some() { "_with_mass" } else { "" };
        format!("{}{with_mass}", self.kind.name())
    }

    /// K(ω) and C(ω) of the dynamic stiffness K + sC on d at s = δ + iω, without the mass.
    pub fn stiffness_and_damping(&self, s: Complex64) -> (RealMatrix2, RealMatrix2) {
        let dynamic = self.law.placed(&self.coordinates).stiffness(s);
        let damping = dynamic.im().scale(1.0 / s.im);
        (dynamic.re() - damping.scale(s.re), damping)
    }
}

/// Standard deviation beforehand of an element of K, in units of the diagonal of a joint nearby.
const STIFFNESS: f64 = 2.0;
/// Of a loss factor in the middle of the band, and of the change of stiffness up to there as a share.
const LOSS: f64 = 0.1;
/// Of ln(ωτ) in the middle of the band.
const TIME: f64 = 1.5;
/// Of the exponent about ½: that of a uniform distribution.
const EXPONENT: f64 = 0.29;
/// The exponent stays this far from 0 and 1, where a springpot is a spring or a dashpot.
const FROM_LIMITS: f64 = 0.02;
/// Standard deviation beforehand of the joint's mass as a share of the lighter side's.
const MASS: f64 = 0.02;
/// Variance of what nothing is known of, the same for every law.
const UNKNOWN: f64 = 1e4;

/// Most steps of a law's fit: one that needs more is far from the FRFs.
const STEPS: usize = 25;

/// A law at its optimum.
struct Candidate {
    fit: LawFit,
    /// Logarithm of its marginal likelihood.
    evidence: f64,
    /// What it leaves, as an inflation of the noise.
    inflation: f64,
}

/// All laws with and without mass, the most probable first. `first` is the viscous one at its optimum.
pub(super) fn compared(fitter: &Fitter, viscous: &Problem, first: &Fitted, quantities: &[Uncertain]) -> Vec<LawFit> {
    let all = candidates(fitter, viscous, first, quantities, viscous.test.weights);
    // Noise is inflated by what the best law leaves.
    let best = all.iter().min_by(|a, b| a.fit.objective.total_cmp(&b.fit.objective));
    let inflation = best.map_or(1.0, |best| best.inflation);
    if inflation == 1.0 {
        return ranked(all);
    }
    let weights: Vec<f64> = viscous.test.weights.iter().map(|weight| weight / inflation).collect();
    ranked(candidates(fitter, viscous, first, quantities, &weights))
}

fn ranked(mut all: Vec<Candidate>) -> Vec<LawFit> {
    let most = all.iter().map(|candidate| candidate.evidence).fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = all.iter().map(|candidate| (candidate.evidence - most).exp()).sum();
    for candidate in &mut all {
        candidate.fit.probability = (candidate.evidence - most).exp() / total;
    }
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    all.into_iter().map(|candidate| candidate.fit).collect()
}

fn candidates(
    fitter: &Fitter,
    viscous: &Problem,
    first: &Fitted,
    quantities: &[Uncertain],
    weights: &[f64],
) -> Vec<Candidate> {
    let test = fitter.test(quantities, weights);
    let scale = MASS * lighter_side(fitter);
    let laws = LawKind::ALL.into_iter().flat_map(|kind| [None, Some(scale)].map(|mass| (kind, mass)));
    let fitted = laws.filter_map(|(kind, mass)| {
        let law = Dynamics::new(kind, viscous.law.unit, viscous.law.middle, fitter.scalar);
        let problem = Problem { test: &test, law, parameters: parameters(&law, mass, quantities), mass };
        let starts: &[f64] = match kind {
            LawKind::StandardLinearSolid => &[-1.0, 1.0],
            LawKind::Fractional => &[-0.2, 0.2],
            _ => &[0.0],
        };
        let fits = starts.iter().filter_map(|&shape| {
            let nearby = if mass.is_none() { Some(first.others.clone()) } else { None };
            problem.fit_within(start(&law, mass, viscous, &first.point, shape), nearby, STEPS)
        });
        let (point, others) = fits.reduce(|a, b| if b.0.objective < a.0.objective { b } else { a })?;
        candidate(fitter, &problem, &point, &others)
    });
    fitted.collect()
}

fn lighter_side(fitter: &Fitter) -> f64 {
    let mass = |alpha: bool| -> f64 {
        let bodies = fitter.sides.side(alpha).bodies().iter();
        let own = bodies.map(|body| match &body.kind {
            BodyKind::Rigid(rigid) => rigid.mass.value,
            BodyKind::Beam(beam) => beam.mass_per_length.value * (beam.to.value - beam.from.value),
        });
        own.sum()
    };
    mass(true).min(mass(false))
}

fn parameters(law: &Dynamics, mass: Option<f64>, quantities: &[Uncertain]) -> Vec<Parameter> {
    let own = |std: f64| {
        Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 }).with_precision(1.0 / (std * std))
    };
    let mut all = vec![own(STIFFNESS); law.stiffness.count()];
    all.extend(std::iter::repeat_n(own(LOSS), law.damping.count() + law.change.count()));
    if law.shapes() > 0 {
        all.push(match law.kind {
            LawKind::Fractional => own(EXPONENT).between(FROM_LIMITS - 0.5, 0.5 - FROM_LIMITS),
            _ => own(TIME),
        });
    }
    all.extend(mass.map(|_| own(1.0).between(0.0, f64::INFINITY)));
    all.extend(quantities.iter().map(|quantity| quantity.parameter));
    all
}

/// Where a law starts: at the viscous joint, with the same losses in the middle of the band.
fn start(law: &Dynamics, mass: Option<f64>, viscous: &Problem, at: &Point, shape: f64) -> Vec<f64> {
    let own = viscous.law.count();
    let elements = law.stiffness.count();
    let (k, d) = at.coordinates[..own].split_at(elements);
    let stiffening = law.stiffening(shape);
    let mut all: Vec<f64> = k.iter().zip(d).map(|(k, d)| k - stiffening * d).collect();
    if law.damping != Form::Zero {
        all.extend_from_slice(d);
    }
    all.extend(std::iter::repeat_n(0.0, law.change.count()));
    all.extend(std::iter::repeat_n(shape, law.shapes()));
    all.extend(mass.map(|_| 0.05));
    all.extend_from_slice(&at.coordinates[own..]);
    all
}

fn candidate(
    fitter: &Fitter,
    problem: &Problem,
    point: &Point,
    others: &[Vec<Complex64>],
) -> Option<Candidate> {
    let information = problem.equations_of(point, others, problem.test.weights).information;
    let variance = |parameter: &Parameter| if parameter.precision > 0.0 { 1.0 / parameter.precision } else { UNKNOWN };
    let variances: Vec<f64> = problem.parameters.iter().map(variance).collect();
    let evidence = laplace_evidence(point.objective, &information, &variances)?;
    let own = &point.coordinates[..problem.law.count()];
    let [k, d, l] = problem.law.matrices(own);
    let fit = LawFit {
        kind: problem.law.kind,
        mass: problem.mass.map(|_| problem.mass_at(&point.coordinates)),
        probability: 0.0,
        objective: point.objective,
        stiffness: k,
        damping: d.scale(problem.law.own_damping(own)),
        change: (problem.law.change != Form::Zero).then(|| l.scale(1.0 / problem.law.middle)),
        shape: problem.law.shape(own),
        law: problem.law,
        coordinates: own.to_vec(),
    };
    Some(Candidate { fit, evidence, inflation: fitter.inflation(problem, point) })
}
