//! Laws of a joint's stiffness and damping over frequency, compared by their evidence.

use super::evidence::Fit;
use super::law::{Dynamics, Form, LawKind};
use super::likelihood::{JointLikelihood, named_coordinates};
use super::problem::{Fitted, Problem, Test};
use crate::Sides;
use crate::settings::laws::{
    CERTAIN, FEW_STEPS, HOPELESS, KEPT_PROBABILITY, MASS_GAIN, MOST_STEPS, NEAR_LOG_EVIDENCE,
};
use crate::settings::priors::{MASS, UNKNOWN_VARIANCE};
use jointscope_inference::Parameter;
use jointscope_linalg::{ComplexMatrix2, RealMatrix2};
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
    /// χ² and priors.
    pub objective: f64,
    /// K: N/m, N/rad, N·m/rad.
    pub stiffness: RealMatrix2,
    /// C, H, or D of the law; zero of a law without damping.
    pub damping: RealMatrix2,
    /// K₁ per rad/s, of the law that has it.
    pub change: Option<RealMatrix2>,
    /// τ (s) or α, of the laws that have one.
    pub shape: Option<f64>,
    /// Standard deviation of it, where the FRFs determine the law.
    pub shape_std: Option<f64>,
    /// What the FRFs tell of its K and C in the middle of the band, of a law that the joint's numbers are not
    /// of: for a comparison with joints that follow it. Nothing of improbable laws.
    pub likelihood: Option<JointLikelihood>,
    law: Dynamics,
    coordinates: Vec<f64>,
}

impl LawFit {
    /// Whether it is said to hold, rather than to be the most probable of the laws compared.
    pub fn is_certain(&self) -> bool {
        self.probability >= CERTAIN
    }

    /// The same as one of the laws beside that of the joint's numbers, `stated`, with noise whose variance
    /// counts `inflation` times.
    pub(super) fn beside(mut self, stated: (LawKind, bool), inflation: f64) -> Self {
        let is_stated = (self.kind, self.mass.is_some()) == stated;
        self.likelihood =
            self.likelihood.filter(|_| !is_stated).map(|likelihood| likelihood.inflated(inflation));
        self.shape_std = self.shape_std.map(|std| std * inflation.sqrt());
        self
    }

    /// A law at these coordinates of its own.
    pub(super) fn of(law: &Dynamics, own: &[f64], objective: f64, mass: Option<f64>) -> Self {
        let [k, d, l] = law.matrices(own);
        LawFit {
            kind: law.kind,
            mass,
            probability: 0.0,
            objective,
            stiffness: k - d.scale(law.stiffening(own)) - l,
            damping: d.scale(law.own_damping(own)),
            change: (law.change != Form::Zero).then(|| l.scale(1.0 / law.middle)),
            shape: law.shape(own),
            shape_std: None,
            likelihood: None,
            law: *law,
            coordinates: own.to_vec(),
        }
    }

    /// Its name in result files.
    pub fn name(&self) -> String {
        let with_mass = if self.mass.is_some() { "_with_mass" } else { "" };
        format!("{}{with_mass}", self.kind.name())
    }

    /// K(ω) and C(ω) in the middle of the band, where laws are compared.
    pub fn in_the_middle(&self) -> (RealMatrix2, RealMatrix2) {
        self.stiffness_and_damping(Complex64::new(0.0, self.law.middle))
    }

    /// The dynamic stiffness on d at s = δ + iω, without the mass.
    pub(crate) fn dynamic_stiffness(&self, s: Complex64) -> ComplexMatrix2 {
        self.law.placed(&self.coordinates).stiffness(&[s])
    }

    /// K(ω) and C(ω) of the dynamic stiffness K + sC on d at s = δ + iω, without the mass.
    fn stiffness_and_damping(&self, s: Complex64) -> (RealMatrix2, RealMatrix2) {
        let dynamic = self.dynamic_stiffness(s);
        let damping = dynamic.im().scale(1.0 / s.im);
        (dynamic.re() - damping.scale(s.re), damping)
    }
}

/// By how much the laws compared, each as often as it is probable, are off the one that the headline follows
/// in the middle of the band.
pub(super) struct Spread {
    /// Mean products of the differences in (k11, k12, k22, c11, c12, c22).
    pub covariance: [[f64; 6]; 6],
    /// Mean square of the difference in mass, that of a law without one being zero, kg².
    pub mass: f64,
}

impl Spread {
    /// `kind`, `heavy`: the law that the headline follows and whether with mass. Nothing where it is not
    /// among the laws.
    pub(super) fn of(laws: &[LawFit], kind: LawKind, heavy: bool) -> Option<Self> {
        let stated = laws.iter().find(|fit| fit.kind == kind && fit.mass.is_some() == heavy)?;
        let six = |fit: &LawFit| {
            let (k, c) = fit.in_the_middle();
            [k.at(0, 0), k.at(0, 1), k.at(1, 1), c.at(0, 0), c.at(0, 1), c.at(1, 1)]
        };
        let reference = six(stated);
        let mut spread = Spread { covariance: [[0.0; 6]; 6], mass: 0.0 };
        for fit in laws {
            let own = six(fit);
            let by: [f64; 6] = std::array::from_fn(|e| own[e] - reference[e]);
            for (row, a) in spread.covariance.iter_mut().zip(by) {
                row.iter_mut().zip(by).for_each(|(entry, b)| *entry += fit.probability * a * b);
            }
            spread.mass += fit.probability * (fit.mass.unwrap_or(0.0) - stated.mass.unwrap_or(0.0)).powi(2);
        }
        Some(spread)
    }
}

/// A law at its optimum.
pub(super) struct Candidate {
    pub fit: LawFit,
    /// Logarithm of its marginal likelihood.
    pub evidence: f64,
    /// What it leaves, as an inflation of the noise.
    pub inflation: f64,
    /// Coordinates of the whole fit there.
    pub at: Vec<f64>,
}

/// All laws of one joint with and without mass (in units of `scale`), the most probable first. `viscous` is
/// that law at its optimum, `heavy` the same with mass where that is known. After them the coordinates of the
/// first.
pub(super) fn compared(
    viscous: (&Problem, &Fitted),
    heavy: Option<(&Problem, &Fitted)>,
    scale: f64,
) -> (Vec<LawFit>, Vec<f64>) {
    probable(candidates(viscous, heavy, scale))
}

/// Laws by their evidence, the most probable first, and the coordinates of that one.
pub(super) fn probable(mut all: Vec<Candidate>) -> (Vec<LawFit>, Vec<f64>) {
    let inflation = least_inflation(all.iter());
    for candidate in &mut all {
        candidate.evidence = candidate.inflated(inflation);
    }
    ranked(all)
}

/// The law nearest to the FRFs.
pub(super) fn nearest<'a>(all: impl Iterator<Item = &'a Candidate>) -> Option<&'a Candidate> {
    all.min_by(|a, b| a.fit.objective.total_cmp(&b.fit.objective))
}

/// What the noise of all is inflated by: what the nearest law leaves.
pub(super) fn least_inflation<'a>(all: impl Iterator<Item = &'a Candidate>) -> f64 {
    nearest(all).map_or(1.0, |nearest| nearest.inflation)
}

fn ranked(mut all: Vec<Candidate>) -> (Vec<LawFit>, Vec<f64>) {
    let most = all.iter().map(|candidate| candidate.evidence).fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = all.iter().map(|candidate| (candidate.evidence - most).exp()).sum();
    for candidate in &mut all {
        candidate.fit.probability = (candidate.evidence - most).exp() / total;
        if candidate.fit.probability < KEPT_PROBABILITY {
            candidate.fit.likelihood = None;
        }
    }
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    let first = all.first().map_or_else(Vec::new, |first| first.at.clone());
    (all.into_iter().map(|candidate| candidate.fit).collect(), first)
}

fn candidates(
    (viscous, first): (&Problem, &Fitted),
    known: Option<(&Problem, &Fitted)>,
    scale: f64,
) -> Vec<Candidate> {
    let light = without_mass(viscous, first);
    let heavy = with_mass(viscous.test, known, scale, &light);
    light.into_iter().chain(heavy).collect()
}

fn most_evidence<'a>(all: impl Iterator<Item = &'a Candidate>) -> f64 {
    all.map(|candidate| candidate.evidence).fold(f64::NEG_INFINITY, f64::max)
}

/// Every law of a joint without mass, the most probable first; those that are far from the nearest are fitted
/// in few steps.
fn without_mass(viscous: &Problem, first: &Fitted) -> Vec<Candidate> {
    let own = viscous.laws[0];
    let starts: Vec<(Dynamics, Vec<f64>, f64)> = LawKind::ALL
        .into_iter()
        .map(|kind| own.of_kind(kind))
        .filter_map(|law| nearest_start(viscous, first, &law).map(|(start, misfit)| (law, start, misfit)))
        .collect();
    let least = starts.iter().map(|(.., misfit)| *misfit).fold(f64::INFINITY, f64::min);
    let mut all: Vec<(Candidate, Fitted)> = Vec::new();
    for (law, mut start, misfit) in starts {
        let problem = Problem::lawful(viscous.test, vec![law], None);
        start.extend_from_slice(&first.point.coordinates[own.count()..]);
        let hopeless = misfit - least > HOPELESS || law.kind == LawKind::Constant;
        let steps = if hopeless { FEW_STEPS } else { MOST_STEPS };
        let Some(fitted) = problem.fit_within(start, Some(first.others.clone()), steps) else { continue };
        let candidate = Candidate::of(&problem, &fitted, 0);
        all.extend(candidate.map(|candidate| (candidate, fitted)));
    }
    let nearest = most_evidence(all.iter().map(|(candidate, _)| candidate));
    let closely = |(candidate, fitted): (Candidate, Fitted)| {
        if nearest - candidate.evidence > NEAR_LOG_EVIDENCE {
            return candidate;
        }
        let problem = Problem::lawful(viscous.test, vec![candidate.fit.law], None);
        Candidate::converged(&problem, fitted).unwrap_or(candidate)
    };
    let mut all: Vec<Candidate> = all.into_iter().map(closely).collect();
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    all
}

/// The laws of a joint with mass, from those without.
fn with_mass(
    test: Test,
    known: Option<(&Problem, &Fitted)>,
    scale: f64,
    light: &[Candidate],
) -> Vec<Candidate> {
    let with_mass = |light: &Candidate| {
        let law = light.fit.law;
        let problem = Problem::lawful(test, vec![law], Some(scale));
        let start = match known {
            Some((heavy, optimum)) => {
                let (mut start, _) = nearest_start(heavy, optimum, &law)?;
                start.extend_from_slice(&optimum.point.coordinates[heavy.of_laws()..]);
                start
            }
            None => {
                // A joint without mass is one of those with it: from there no fit ends farther from the FRFs.
                let mut start = light.at.clone();
                start.insert(law.count(), 0.0);
                start
            }
        };
        let fitted = problem.fit_within(start, None, MOST_STEPS)?;
        let candidate = Candidate::converged(&problem, fitted)?;
        let gain = light.fit.objective - candidate.fit.objective;
        Some((candidate, gain))
    };
    let nearest = most_evidence(light.iter());
    // Where a law explains the FRFs without mass, one that is far from it does not with mass. Where none does,
    // the nearest may have bent the blocks instead, and another law with mass be the one.
    let is_explained = light.iter().any(|light| light.inflation <= 1.0);
    let (mut heavy, mut most): (Vec<Candidate>, f64) = (Vec::new(), 0.0);
    for light in light {
        // Where mass gains nothing for the laws nearest to the FRFs, it does not for the others.
        if is_explained && nearest - light.evidence > NEAR_LOG_EVIDENCE && most < MASS_GAIN {
            break;
        }
        if let Some((candidate, gain)) = with_mass(light) {
            heavy.push(candidate);
            most = most.max(gain);
        }
    }
    heavy
}

/// The start of a law from which the viscous joint is imitated best, and what χ² it promises, up to what all
/// laws have in common.
fn nearest_start(viscous: &Problem, first: &Fitted, law: &Dynamics) -> Option<(Vec<f64>, f64)> {
    let shapes: &[f64] = match law.kind {
        LawKind::StandardLinearSolid => &[-2.0, -1.0, 0.0, 1.0, 2.0],
        LawKind::Fractional => &[-0.4, -0.2, 0.0, 0.2, 0.4],
        _ => &[0.0],
    };
    let starts = shapes.iter().filter_map(|&shape| viscous.imitated(&first.point, law, shape));
    starts.reduce(|a, b| if b.1 < a.1 { b } else { a })
}

/// Mass of the joint between these sides for one unit of its coordinate, kg.
pub(super) fn mass_scale(sides: &Sides) -> f64 {
    let mass = |alpha: bool| -> f64 { sides.side(alpha).bodies().iter().map(|body| body.kind.mass()).sum() };
    MASS * mass(true).min(mass(false))
}

/// Prior variances, those of quantities of which nothing is known being large.
fn variances(parameters: &[Parameter]) -> Vec<f64> {
    let variance = |parameter: &Parameter| {
        if parameter.precision > 0.0 { 1.0 / parameter.precision } else { UNKNOWN_VARIANCE }
    };
    parameters.iter().map(variance).collect()
}

impl Candidate {
    /// Its evidence with noise whose variance counts `inflation` times.
    pub(super) fn inflated(&self, inflation: f64) -> f64 {
        self.evidence + 0.5 * self.fit.objective * (1.0 - 1.0 / inflation)
    }

    /// The law of the one joint, its fit gone on with until it has converged by derivatives taken there:
    /// evidence is of optima, and one that is missed by ten in χ² decides between laws.
    fn converged(problem: &Problem, fitted: Fitted) -> Option<Self> {
        Candidate::of(problem, &fitted.or_from_afar(problem)?, 0)
    }

    /// A joint's law at the optimum of all; `None` where that is not determined.
    pub(super) fn of(problem: &Problem, at: &Fitted, joint: usize) -> Option<Self> {
        let (first, law) = problem.places().nth(joint)?;
        let equations = at.equations(problem);
        let fit = Fit {
            objective: at.point.objective,
            at: &at.point.coordinates,
            equations: &equations,
            parameters: &problem.parameters,
        };
        let place_of_mass = problem.mass.map(|_| problem.of_laws());
        let evidence = fit.evidence((first, law), place_of_mass, &variances(&problem.parameters))?;
        let own = &at.point.coordinates[first..first + law.count()];
        let mass = problem.mass.map(|_| problem.mass_at(&at.point.coordinates));
        let mut fit = LawFit::of(law, own, at.point.objective, mass);
        if let Some(covariance) = equations.covariance().filter(|_| law.shapes() > 0) {
            fit.shape_std = law.shape_with_std(own, |own| covariance.std(first + own)).map(|(_, std)| std);
        }
        if problem.laws.len() == 1 {
            let (numbers, at) = (named_coordinates(law), &at.point.coordinates);
            fit.likelihood =
                JointLikelihood::of(&numbers, problem.own(), at, &equations, &problem.parameters);
        }
        let whole = at.point.coordinates.clone();
        Some(Candidate { fit, evidence, inflation: problem.inflation(&at.point), at: whole })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_of_laws_is_their_difference_as_often_as_they_are_probable() {
        let unit = RealMatrix2::new(1.0, 1.0, 1.0, 1.0);
        let fit = |kind: LawKind, probability: f64, k: f64, mass: f64| {
            let law = Dynamics::new(kind, unit, 100.0, false);
            let mut coordinates = vec![0.0; law.count()];
            coordinates[0] = k;
            let zero = RealMatrix2::zero();
            let (stiffness, damping, change, shape) = (zero, zero, None, None);
            let mass = Some(mass);
            LawFit {
                kind,
                mass,
                probability,
                objective: 0.0,
                stiffness,
                damping,
                change,
                shape,
                shape_std: None,
                likelihood: None,
                law,
                coordinates,
            }
        };
        let laws = [fit(LawKind::Structural, 0.75, 1.2, 0.08), fit(LawKind::Viscous, 0.25, 1.0, 0.07)];
        let spread = Spread::of(&laws, LawKind::Viscous, true).unwrap();
        assert!((spread.covariance[0][0] - 0.75 * 0.04).abs() < 1e-12);
        assert_eq!(spread.covariance[2][2], 0.0);
        assert!((spread.mass - 0.75 * 1e-4).abs() < 1e-12);
        let about_the_first = Spread::of(&laws, LawKind::Structural, true).unwrap();
        assert!((about_the_first.covariance[0][0] - 0.25 * 0.04).abs() < 1e-12);
        assert!(Spread::of(&laws, LawKind::Viscous, false).is_none());
    }
}
