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
mod uncertainty;
mod uncoupled;

pub use admissible::{Admissible, JointTests};
pub use found::{FittedLength, FittedQuantity, JointFit, UnmovedQuantity};
pub use law::LawKind;
pub use laws::LawFit;
pub use likelihood::JointLikelihood;

use crate::{DecompositionError, LikelihoodFit, Sides};
use jointscope_averaging::Band;
use jointscope_inference::{Parameter, Transform, inflated_weight};
use jointscope_linalg::{Matrix2, RealMatrix2};
use jointscope_spectra::FrfSet;
use law::{Dynamics, Form};
use num_complex::Complex64;
use problem::{Columns, Point, Problem, Test};
use quantities::Uncertain;
use recorded::Recorded;
use uncertainty::{strain, total};

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
    let recorded = Recorded::of(frfs, sides, options.band).ok_or(DecompositionError::NoFit(
        "no FRF has both of its channels in the fixture and a value in the band",
    ))?;
    let start = near.map_or(nominal, |fit| fit.stiffness);
    let root = |i: usize| start.at(i, i).abs().max(f64::MIN_POSITIVE).sqrt();
    let unit = |i: usize, j: usize| if scalar && i + j > 0 { 1.0 } else { root(i) * root(j) };
    let unit = Matrix2::new(unit(0, 0), unit(0, 1), unit(1, 0), unit(1, 1));
    let middle = recorded.s.iter().map(|s| s.im).sum::<f64>() / recorded.s.len() as f64;
    let law = Dynamics::new(LawKind::Viscous, unit, middle, scalar);
    let quantities = quantities::uncertain(sides, options.exact);
    let starts = [
        near.map(|fit| (fit.stiffness, fit.damping.scale(middle))),
        Some((nominal, nominal.scale(START_LOSS))),
    ];
    let starts: Vec<Vec<f64>> = starts.into_iter().flatten().map(|(k, d)| coordinates(&law, k, d)).collect();
    let fitter = Fitter { recorded: &recorded, sides, scalar };
    let (quantities, others) = fitter.that_matter(law, &starts, quantities)?;
    let mut fit = fitter.fit(law, &starts, &quantities, options.laws)?;
    let unmoved = others.into_iter().map(|uncertain| UnmovedQuantity {
        body: uncertain.body(sides.fixture()),
        path: uncertain.quantity.path,
        stated: uncertain.quantity.value,
        std: uncertain.quantity.std,
    });
    fit.unmoved = unmoved.collect();
    Ok(fit)
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

    /// The quantities that the FRFs depend on, and the others.
    fn that_matter(
        &self,
        law: Dynamics,
        starts: &[Vec<f64>],
        quantities: Vec<Uncertain>,
    ) -> Result<(Vec<Uncertain>, Vec<Uncertain>), DecompositionError> {
        let weights = &self.recorded.weights;
        let test = self.test(&quantities, weights);
        let problem = Problem::viscous(&test, law, None);
        let matter = starts.iter().find_map(|start| {
            let columns = problem.other_columns(&problem.point(problem.whole(start), None)?)?;
            let size = |column: &Vec<Complex64>| -> f64 {
                column.iter().zip(weights).map(|(value, weight)| weight * value.norm_sqr()).sum()
            };
            Some(columns.iter().map(|column| size(column) > NEGLIGIBLE).collect::<Vec<bool>>())
        });
        let matter = matter.ok_or(NO_START)?;
        let (matter, others): (Vec<_>, Vec<_>) =
            quantities.into_iter().zip(matter).partition(|(_, matters)| *matters);
        let bare = |all: Vec<(Uncertain, bool)>| all.into_iter().map(|(quantity, _)| quantity).collect();
        Ok((bare(matter), bare(others)))
    }

    fn fit(
        &self,
        law: Dynamics,
        starts: &[Vec<f64>],
        quantities: &[Uncertain],
        with_laws: bool,
    ) -> Result<JointFit, DecompositionError> {
        let test = self.test(quantities, &self.recorded.weights);
        let problem = Problem::viscous(&test, law, None);
        let mut best: Option<Fitted> = None;
        for start in starts {
            let Some((point, others)) = problem.fit(problem.whole(start), None) else { continue };
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
        let (first, free) = admissible::settled(&problem, first);
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
            Some(heavy) => (with_mass, heavy, None),
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
            let (point, others) = problem.fit(first.point.coordinates, None).ok_or(NO_START)?;
            Fitted { point, others }
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
            let values = self.recorded.values.iter().zip(&self.recorded.weights);
            let weights: Vec<f64> =
                values.map(|(value, weight)| inflated_weight(*weight, value.norm_sqr(), share)).collect();
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
        let covariance = self.covariance_at(problem, &free.point)?;
        let strain = strain(problem, &free.point, &covariance);
        let (tests, admissible) = admissible::examined(problem, free, &covariance, (strain, asymmetry));
        let [_, d, _] = law.matrices(&free.point.coordinates[..law.count()]);
        let is_passive = d.at(0, 0) >= 0.0 && (self.scalar || (d.at(1, 1) >= 0.0 && d.determinant() >= 0.0));
        let held = if is_passive { None } else { admissible::on_the_boundary_of_c(problem, free) };
        let (k, d, at) = match &held {
            Some((point, law)) => {
                let [k, d, _] = law.matrices(&point.coordinates[..law.count()]);
                let rest = &point.coordinates[law.count()..];
                let mut at = coordinates(&problem.law, k, d);
                at.extend_from_slice(rest);
                (k, d, problem.point(at, None).ok_or(NO_START)?)
            }
            None => {
                let [k, d, _] = law.matrices(&free.point.coordinates[..law.count()]);
                (k, d, problem.point(free.point.coordinates.clone(), None).ok_or(NO_START)?)
            }
        };
        // Deviations are those of free elements, on the boundary too.
        let covariance = if held.is_some() { self.covariance_at(problem, &at)? } else { covariance };
        let inflated =
            self.recorded.weights.first().zip(problem.test.weights.first()).is_some_and(|(a, b)| a != b);
        let model = if inflated { self.jackknifed(problem, &at) } else { None };
        let total = total(&covariance, strain, model.as_ref());
        let model_covariance = model.map_or([[0.0; 6]; 6], |model| self.in_si(law, &model));
        let own = problem.own();
        let length = self.length(problem, &at, &total);
        let quantities = quantities.iter().enumerate().map(|(index, uncertain)| {
            let transform = uncertain.parameter.transform;
            let coordinate = at.coordinates[own + index];
            let fitted = transform.value(coordinate).unwrap_or(uncertain.quantity.value);
            FittedQuantity {
                path: uncertain.quantity.path.clone(),
                body: uncertain.body(self.sides.fixture()),
                stated: uncertain.quantity.value,
                std: uncertain.quantity.std,
                fitted,
                fitted_std: transform.slope(fitted).abs() * total.std(own + index),
                deviations: coordinate,
            }
        });
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
            quantities: quantities.collect(),
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
            likelihood: self.likelihood(problem, &free.point),
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
