//! The joint from all FRFs at once, the fixture's quantities moving within their tolerances.
//!
//! [`maximum_likelihood`](crate::maximum_likelihood) fits k and c to the FRFs across the joint with the fixture taken as exact; what its tolerances do is added afterwards.
//! But the other FRFs weigh the blocks, so to say: a mass that is 0.2 % off shifts every resonance. Here the maximum of the posterior is
//! sought over k, c and every uncertain quantity of the fixture, each with its own standard deviation as prior, from all FRFs whose channels the fixture
//! has; the fixture's quantities are then integrated out of the covariance. Each side is modelled as for the decomposition: with its own supports, masses and
//! mass-proportional damping, all other losses being the joint's.

mod admissible;
mod found;
mod law;
mod laws;
mod likelihood;
mod problem;
mod quantities;
mod recorded;
mod several;
mod uncertainty;
mod uncoupled;

pub use admissible::{Admissible, JointTests};
pub use found::{FittedLength, FittedQuantity, JointFit, UnmovedQuantity};
pub use law::LawKind;
pub use laws::LawFit;
pub use likelihood::JointLikelihood;
pub use several::{FoundJoint, JointsCovariance, JointsFit, SeveralError, fit_joints};

use crate::{DecompositionError, LikelihoodFit, Sides};
use admissible::Freed;
use jointscope_averaging::Band;
use jointscope_inference::{LeastSquares, NormalEquations, Parameter, Transform};
use jointscope_linalg::{Matrix2, RealMatrix2};
use jointscope_spectra::FrfSet;
use law::{Dynamics, Form};
use problem::{Columns, Point, Problem, Test};
use quantities::Uncertain;
use recorded::Recorded;
use uncertainty::{length_between, strain, total};

/// What a fit of the joint is asked for.
#[derive(Debug, Clone, Copy, Default)]
pub struct JointFitOptions {
    /// Lines fitted; all without.
    pub band: Option<Band>,
    /// Take the fixture's bare numbers as exact.
    pub exact: bool,
    /// Whether laws over frequency are compared.
    pub laws: bool,
}

/// χ² per degree of freedom up to which noise and tolerances count as explaining the FRFs: variances from few averages are themselves known to a few per cent.
const EXPLAINED: f64 = 1.2;
/// χ² per degree of freedom above which another start is tried.
const DOUBTFUL: f64 = 1.3;
/// Probability of the laws with mass from which the joint is said to have one.
const HEAVY: f64 = 0.95;
/// Shares of the signal that count as noise in the stages of a fit from afar.
const SHARES_AS_NOISE: [f64; 4] = [1.0, 0.3, 0.06, 0.01];
/// Damping of a start without any, as a loss factor.
const START_LOSS: f64 = 3e-3;

/// Fits the joint that `sides` were taken apart at to every FRF whose channels the fixture has.
///
/// It starts from the fit to the FRFs across the joint, if there is one, and from the fixture's own joint, `nominal`.
///
/// # Errors
/// No FRF that can be used, no start with finite FRFs, or FRFs that leave an element undetermined.
pub fn fit_joint(
    frfs: &FrfSet,
    sides: &Sides,
    scalar: bool,
    near: Option<&LikelihoodFit>,
    nominal: RealMatrix2,
    options: JointFitOptions,
) -> Result<JointFit, DecompositionError> {
    let recorded = Recorded::of(frfs, sides.fixture(), options.band).ok_or(DecompositionError::NoFit(
        "no FRF has both of its channels in the fixture and a value in the band",
    ))?;
    let start = near.map_or(nominal, |fit| fit.stiffness);
    let unit = units_of(start, scalar);
    let middle = recorded.s.iter().map(|s| s.im).sum::<f64>() / recorded.s.len() as f64;
    let law = Dynamics::new(LawKind::Viscous, unit, middle, scalar);
    let quantities = quantities::uncertain(sides.fixture(), &[sides.joint_index()], options.exact);
    let starts = [
        near.map(|fit| (fit.stiffness, fit.damping.scale(middle))),
        Some((nominal, nominal.scale(START_LOSS))),
    ];
    let starts: Vec<Vec<f64>> = starts.into_iter().flatten().map(|(k, d)| coordinates(&law, k, d)).collect();
    let fitter = Fitter { recorded: &recorded, sides, scalar };
    let (quantities, others, columns) = fitter.that_matter(law, &starts, quantities)?;
    let mut fit = fitter.fit(law, (&starts, columns), &quantities, options.laws)?;
    fit.unmoved = others.iter().map(|uncertain| uncertain.unmoved(sides.fixture())).collect();
    Ok(fit)
}

/// √(k_ii k_jj), in which the elements of a joint near to K are of order one.
fn units_of(k: RealMatrix2, scalar: bool) -> RealMatrix2 {
    let root = |i: usize| k.at(i, i).abs().max(f64::MIN_POSITIVE).sqrt();
    let unit = |i: usize, j: usize| if scalar && i + j > 0 { 1.0 } else { root(i) * root(j) };
    Matrix2::new(unit(0, 0), unit(0, 1), unit(1, 0), unit(1, 1))
}

/// Coordinates of K and of an imaginary stiffness D.
fn coordinates(law: &Dynamics, k: RealMatrix2, d: RealMatrix2) -> Vec<f64> {
    let of = |form: Form, m: RealMatrix2| {
        let e = |i: usize, j: usize| m.at(i, j) / law.unit.at(i, j);
        match form {
            Form::Scalar => vec![e(0, 0)],
            Form::Symmetric => vec![e(0, 0), 0.5 * (e(0, 1) + e(1, 0)), e(1, 1)],
            Form::Free => vec![e(0, 0), e(0, 1), e(1, 1), e(1, 0)],
            Form::RankOne => rank_one(e(0, 0), 0.5 * (e(0, 1) + e(1, 0)), e(1, 1)),
            Form::Zero => Vec::new(),
        }
    };
    [of(law.stiffness, k), of(law.damping, d)].concat()
}

/// v of the nearest v vᵀ to [[a, b], [b, d]].
fn rank_one(a: f64, b: f64, d: f64) -> Vec<f64> {
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let largest = (mean + half.hypot(b)).max(0.0).sqrt();
    let angle = 0.5 * b.atan2(half);
    vec![largest * angle.cos(), largest * angle.sin()]
}

/// What all fits of one recording share.
struct Fitter<'a> {
    recorded: &'a Recorded,
    sides: &'a Sides,
    scalar: bool,
}

/// A finished fit.
struct Fitted {
    point: Point,
    others: Columns,
}

/// Times that an optimum is gone on from with derivatives taken there.
const LOOKS: usize = 3;

impl Fitted {
    /// Takes the derivatives by the quantities at the optimum, which those of the fit were taken near, and goes on where they promise more.
    fn refresh(&mut self, problem: &Problem) -> Result<(), DecompositionError> {
        for look in 0.. {
            self.others = problem.other_columns(&self.point).ok_or(UNDETERMINED)?;
            let promised = problem.promised(&self.point, &self.equations(problem));
            if look == LOOKS || promised < problem::needed(problem.test.recorded, self.point.objective) {
                break;
            }
            match problem.fit(self.point.coordinates.clone(), Some(self.others.clone())) {
                Some((point, _)) if point.objective < self.point.objective => self.point = point,
                _ => break,
            }
        }
        Ok(())
    }

    fn equations(&self, problem: &Problem) -> NormalEquations {
        problem.equations_of(&self.point, &self.others, problem.test.weights)
    }
}

const NO_START: DecompositionError = DecompositionError::NoFit("no start gives finite FRFs");
const UNDETERMINED: DecompositionError =
    DecompositionError::NoFit("the FRFs leave an element of k or c undetermined");

impl<'a> Fitter<'a> {
    fn test<'b>(&'b self, quantities: &'b [Uncertain], weights: &'b [f64]) -> Test<'b> {
        Test {
            recorded: self.recorded,
            fixture: self.sides.fixture(),
            joint: &self.sides.joint().name,
            quantities,
            weights,
        }
    }

    /// The quantities that the FRFs depend on, the others, and the derivatives by the first ones at the first start, if they were taken there.
    #[allow(clippy::type_complexity)]
    fn that_matter(
        &self,
        law: Dynamics,
        starts: &[Vec<f64>],
        quantities: Vec<Uncertain>,
    ) -> Result<(Vec<Uncertain>, Vec<Uncertain>, Option<Columns>), DecompositionError> {
        let weights = &self.recorded.weights;
        let test = self.test(&quantities, weights);
        let problem = Problem::viscous(&test, law, None);
        let columns = |start: &Vec<f64>| problem.other_columns(&problem.point(problem.whole(start), None)?);
        let (place, columns) = starts
            .iter()
            .enumerate()
            .find_map(|(place, start)| Some((place, columns(start)?)))
            .ok_or(NO_START)?;
        let all = quantities.into_iter().zip(columns);
        let (matter, others): (Vec<_>, Vec<_>) =
            all.partition(|(_, column)| self.recorded.size(column) > NEGLIGIBLE);
        let (matter, columns): (Vec<_>, Vec<_>) = matter.into_iter().unzip();
        let others = others.into_iter().map(|(quantity, _)| quantity).collect();
        Ok((matter, others, (place == 0).then_some(columns)))
    }

    fn fit(
        &self,
        law: Dynamics,
        (starts, mut nearby): (&[Vec<f64>], Option<Columns>),
        quantities: &[Uncertain],
        with_laws: bool,
    ) -> Result<JointFit, DecompositionError> {
        let test = self.test(quantities, &self.recorded.weights);
        let problem = Problem::viscous(&test, law, None);
        let mut best: Option<Fitted> = None;
        for start in starts {
            let Some((point, others)) = problem.fit(problem.whole(start), nearby.take()) else { continue };
            if best.as_ref().is_none_or(|best| point.objective < best.point.objective) {
                best = Some(Fitted { point, others });
            }
            if best.as_ref().is_some_and(|best| self.per_degree(&problem, &best.point) < DOUBTFUL) {
                break;
            }
        }
        if best.as_ref().is_none_or(|best| self.per_degree(&problem, &best.point) > DOUBTFUL) {
            // The last start is the nominal joint.
            let afar = starts.last().and_then(|start| self.searched(&problem, problem.whole(start)));
            best = afar
                .into_iter()
                .chain(best)
                .reduce(|a, b| if b.point.objective < a.point.objective { b } else { a });
        }
        let first = best.filter(|best| best.point.objective.is_finite()).ok_or(NO_START)?;
        let (first, free) = admissible::settled(self, &problem, first)?;
        let chi2_per_dof = self.per_degree(&problem, &first.point);
        let mass = Some(laws::mass_scale(self));
        let with_mass = Problem::viscous(&test, law, mass);
        // Where a joint without mass explains the FRFs, one with mass is next to it.
        let heavy = match with_laws && chi2_per_dof > EXPLAINED {
            true => self.with_mass(&with_mass, &first, starts.last()),
            false => None,
        };
        let laws = match with_laws {
            true => laws::compared(
                self,
                (&problem, &first),
                heavy.as_ref().map(|heavy| (&with_mass, heavy)),
                quantities,
            ),
            false => Vec::new(),
        };
        // A joint whose mass the FRFs show is not taken for a softer one.
        let is_heavy =
            laws.iter().filter(|fit| fit.mass.is_some()).map(|fit| fit.probability).sum::<f64>() > HEAVY;
        let heavy = match (is_heavy, heavy) {
            (true, None) => self.with_mass(&with_mass, &first, None),
            (true, found) => found,
            (false, _) => None,
        };
        let (problem, first, free) = match heavy {
            Some(mut heavy) => {
                heavy.refresh(&with_mass)?;
                (with_mass, heavy, Freed::Unknown)
            }
            None => (problem, first, free),
        };
        let mass = problem.mass;
        let chi2_per_dof = self.per_degree(&problem, &first.point);
        let inflation = self.inflation(&problem, &first.point);
        let asymmetry = admissible::asymmetry(self, &problem, &first, free);
        let weights: Vec<f64> = self.recorded.weights.iter().map(|weight| weight / inflation).collect();
        let inflated = self.test(quantities, &weights);
        let problem = Problem::viscous(&inflated, law, mass);
        let fitted = if inflation > 1.0 {
            let (point, others) = problem.fit(first.point.coordinates, Some(first.others)).ok_or(NO_START)?;
            let mut fitted = Fitted { point, others };
            fitted.refresh(&problem)?;
            fitted
        } else {
            first
        };
        let mut result = self.result(&problem, &fitted, quantities, asymmetry)?;
        if let Some(spread) = laws::Spread::of(&laws, result.mass.is_some()) {
            result.law_covariance = spread.covariance;
            for (row, more) in result.covariance.iter_mut().zip(spread.covariance) {
                row.iter_mut().zip(more).for_each(|(entry, more)| *entry += more);
            }
            result.mass = result.mass.map(|(mass, std)| (mass, std.hypot(spread.mass.sqrt())));
        }
        (result.chi2_per_dof, result.inflation, result.laws) = (chi2_per_dof, inflation, laws);
        Ok(result)
    }

    /// A fit by stages in which less and less of the signal counts as noise, so that sharp resonances do not decide where it goes.
    fn searched(&self, problem: &Problem, start: Vec<f64>) -> Option<Fitted> {
        let mut at = start;
        for share in SHARES_AS_NOISE {
            let weights = self.recorded.weights_with(share);
            let test = self.test(problem.test.quantities, &weights);
            at = Problem::viscous(&test, problem.law, problem.mass).fit(at, None)?.0.coordinates;
        }
        let (point, others) = problem.fit(at, None)?;
        Some(Fitted { point, others })
    }

    /// The fit of a joint with mass from that without and, if wanted, from afar: a mass left out bends the blocks, and on the way back lie other optima.
    fn with_mass(&self, problem: &Problem, light: &Fitted, afar: Option<&Vec<f64>>) -> Option<Fitted> {
        let mut start = light.point.coordinates.clone();
        start.insert(problem.law.count(), laws::FIRST_MASS);
        let near = problem.fit(start, None).map(|(point, others)| Fitted { point, others });
        let afar = afar.and_then(|start| {
            let mut start = problem.whole(start);
            start[problem.law.count()] = laws::FIRST_MASS;
            self.searched(problem, start)
        });
        near.into_iter().chain(afar).reduce(|a, b| if b.point.objective < a.point.objective { b } else { a })
    }

    /// The joint, tests and covariance at an optimum whose c is free.
    fn result(
        &self,
        problem: &Problem,
        free: &Fitted,
        quantities: &[Uncertain],
        asymmetry: Option<f64>,
    ) -> Result<JointFit, DecompositionError> {
        let law = &problem.law;
        let equations = free.equations(problem);
        let covariance = equations.covariance().ok_or(UNDETERMINED)?;
        let strain = strain(&problem.parameters, problem.own(), &free.point.coordinates, &covariance);
        let (tests, admissible) = admissible::examined(problem, free, &covariance, (strain, asymmetry));
        let [_, d, _] = law.matrices(&free.point.coordinates[..law.count()]);
        let is_passive = d.at(0, 0) >= 0.0 && (self.scalar || (d.at(1, 1) >= 0.0 && d.determinant() >= 0.0));
        let held = if is_passive { None } else { admissible::on_the_boundary_of_c(problem, free) };
        let moved = match &held {
            Some((point, law)) => {
                let [k, d, _] = law.matrices(&point.coordinates[..law.count()]);
                let rest = &point.coordinates[law.count()..];
                let mut at = coordinates(&problem.law, k, d);
                at.extend_from_slice(rest);
                let mut fitted =
                    Fitted { point: problem.point(at, None).ok_or(NO_START)?, others: Columns::new() };
                fitted.refresh(problem)?;
                Some(fitted)
            }
            None => None,
        };
        let fitted = moved.as_ref().unwrap_or(free);
        let at = &fitted.point;
        let [k, d, _] = law.matrices(&at.coordinates[..law.count()]);
        // Deviations are those of free elements, on the boundary too.
        let covariance = match held {
            Some(_) => fitted.equations(problem).covariance().ok_or(UNDETERMINED)?,
            None => covariance,
        };
        let inflated =
            self.recorded.weights.first().zip(problem.test.weights.first()).is_some_and(|(a, b)| a != b);
        let model = if inflated { self.jackknifed(problem, fitted) } else { None };
        let total = total(&covariance, strain, model.as_ref());
        let model_covariance = model.map_or([[0.0; 6]; 6], |model| self.in_si(law, &model));
        let own = problem.own();
        let length = length_between(
            (self.sides.fixture(), self.sides.joint()),
            (quantities, &at.coordinates),
            (own, 0, law),
            &total,
        );
        let moved = quantities.iter().enumerate().map(|(index, uncertain)| {
            uncertain.fitted(self.sides.fixture(), at.coordinates[own + index], total.std(own + index))
        });
        let kept = (0..law.count()).chain(own..problem.parameters.len()).collect();
        let likelihood =
            JointLikelihood::of(law, (&free.point.coordinates, kept), &equations, &problem.parameters);
        Ok(JointFit {
            stiffness: k,
            damping: d.scale(1.0 / law.middle),
            covariance: self.in_si(law, &total),
            model_covariance,
            law_covariance: [[0.0; 6]; 6],
            length,
            chi2_per_dof: 0.0,
            inflation: 1.0,
            strain,
            is_on_the_boundary: held.is_some(),
            quantities: moved.collect(),
            unmoved: Vec::new(),
            tests,
            admissible,
            laws: Vec::new(),
            frfs: self.recorded.pairs.clone(),
            lines: self.recorded.s.len(),
            mass: problem
                .mass
                .map(|scale| (problem.mass_at(&at.coordinates), scale * total.std(problem.law.count()))),
            scalar: self.scalar,
            likelihood,
        })
    }
}

/// Weighted squared change by one standard deviation of a quantity below which the FRFs do not depend on it.
const NEGLIGIBLE: f64 = 1e-9;

impl<'a> Problem<'a> {
    /// A viscous joint of which nothing is known beforehand, with mass if there is a scale for it (kg).
    fn viscous(test: &'a Test<'a>, law: Dynamics, mass: Option<f64>) -> Self {
        let own = Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 });
        let quantities = test.quantities.iter().map(|quantity| quantity.parameter);
        let parameters = std::iter::repeat_n(own, law.count()).chain(mass.map(|_| laws::mass_parameter()));
        Problem { test, law, parameters: parameters.chain(quantities).collect(), mass }
    }

    /// The law's coordinates with the fixture as stated.
    fn whole(&self, own: &[f64]) -> Vec<f64> {
        let mut all = own.to_vec();
        all.resize(self.parameters.len(), 0.0);
        all
    }
}
