//! The joint from all FRFs at once, the fixture's quantities moving within their tolerances.
//!
//! [`maximum_likelihood`](crate::maximum_likelihood) fits k and c to the FRFs across the joint with the
//! fixture taken as exact; what its tolerances do is added afterwards. But the other FRFs weigh the blocks,
//! so to say: a mass that is 0.2 % off shifts every resonance. Here the maximum of the posterior is sought
//! over k, c and every uncertain quantity of the fixture, each with its own standard deviation as prior, from
//! all FRFs whose channels the fixture has; the fixture's quantities are then integrated out of the
//! covariance. Each side is modelled as for the decomposition: with its own supports, masses and
//! mass-proportional damping, all other losses being the joint's.

mod admissible;
mod coupled;
mod evidence;
mod found;
mod law;
mod laws;
mod length;
mod likelihood;
mod outcome;
mod priors;
mod problem;
mod quantities;
mod recorded;
mod setup;
mod several;
mod smallest_eigenvalue;
mod uncertainty;
mod uncoupled;

pub use admissible::{Admissible, JointTests};
pub use found::{FittedFrfs, FittedQuantity, Followed, JointFit, UnmovedQuantity};
pub use law::LawKind;
pub use laws::LawFit;
pub use length::FittedLength;
pub use likelihood::JointLikelihood;
pub use several::{FoundJoint, JointsCovariance, JointsFit, SeveralError, fit_joints};

use crate::settings::laws::FIRST_MASS;
use crate::settings::noise::EXPLAINED;
use crate::settings::starts::{ASTRAY, DOUBTFUL_FIT, NO_DEPENDENCE, START_LOSS};
use crate::{DecompositionError, IdlePoints, LikelihoodFit, Sides};
use admissible::Freed;
use jointscope_averaging::Band;
use jointscope_linalg::{Matrix2, RealMatrix2};
use jointscope_spectra::FrfSet;
use jointscope_tolerances::Tolerance;
use law::{Dynamics, coordinates};
use outcome::{Inflated, Outcome};
use problem::{Columns, Fitted, Problem, Test, lower};
use recorded::Recorded;
use setup::Setup;

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

/// Fits the joint that `sides` were taken apart at to every FRF whose channels the fixture has.
///
/// It starts from the fit to the FRFs across the joint, if there is one, and from the fixture's own joint,
/// `nominal`.
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
    let middle = recorded.middle();
    let law = Dynamics::new(LawKind::Viscous, unit, middle, scalar);
    let starts = [
        near.map(|fit| (fit.stiffness, fit.damping.scale(middle))),
        Some((nominal, nominal.scale(START_LOSS))),
    ];
    let starts: Vec<Vec<f64>> = starts.into_iter().flatten().map(|(k, d)| coordinates(&law, k, d)).collect();
    let pieces: Vec<usize> =
        (0..sides.fixture().bodies().len()).map(|body| usize::from(!sides.is_on_alpha(body))).collect();
    let joints = [sides.joint_index()];
    let setup = Setup { recorded: &recorded, fixture: sides.fixture(), joints: &joints, pieces: &pieces };
    let quantities = quantities::uncertain(sides.fixture(), &joints, options.exact);
    let (quantities, unmoved, nearby) = that_matter(setup, vec![law], &starts, quantities).ok_or(NO_START)?;
    let test = Test { setup, quantities: &quantities, weights: &recorded.weights };
    let problem = Problem::open(test, vec![law], None);
    let first = lowest(&problem, &starts, nearby).ok_or(NO_START)?;
    let (first, free) = admissible::settled(&problem, first).ok_or(UNDETERMINED)?;
    let mass = laws::mass_scale(sides);
    let with_mass = Problem::open(test, vec![law], Some(mass));
    // Where a joint without mass explains the FRFs, one with mass is next to it.
    let heavy = match options.laws && problem.per_degree(&first.point) > EXPLAINED {
        true => heavy(&with_mass, &first, starts.last()),
        false => None,
    };
    let (laws, at) = match options.laws {
        true => laws::compared((&problem, &first), heavy.as_ref().map(|heavy| (&with_mass, heavy)), mass),
        false => (Vec::new(), Vec::new()),
    };
    let followed = laws.first().and_then(|best| {
        let problem = Problem::open(test, vec![law.of_kind(best.kind)], best.mass.map(|_| mass));
        by_its_law(problem, at, heavy)
    });
    let (problem, first, free) = followed.unwrap_or((problem, first, free));
    if first.point.objective > ASTRAY * recorded.size(&recorded.values) {
        return Err(NOWHERE_NEAR);
    }
    let asymmetry = admissible::asymmetry(&problem, &first, free);
    let inflated = Inflated::of(&problem, &first);
    let problem = problem.weighted(&inflated.weights);
    let stated = (problem.laws[0].kind, problem.mass.is_some());
    let laws: Vec<LawFit> = laws.into_iter().map(|fit| fit.beside(stated, inflated.by)).collect();
    let free = inflated.refitted(&problem, first).ok_or(NO_START)?;
    let outcome = Outcome { problem: &problem, unmoved: &unmoved, inflated: &inflated, laws: vec![laws] };
    let found = outcome.of(&free, &|_, _| asymmetry).map_err(|error| match error {
        SeveralError::Undetermined { .. } => UNDETERMINED,
        _ => NO_START,
    })?;
    let mut fit = found.joints.into_iter().next().ok_or(NO_START)?;
    fit.admissible = admissible::nearest(&problem, &free, &fit.tests.failed(), asymmetry.unwrap_or(0.0));
    Ok(fit)
}

/// √(k_ii k_jj), in which the elements of a joint near to K are of order one.
fn units_of(k: RealMatrix2, scalar: bool) -> RealMatrix2 {
    let root = |i: usize| k.at(i, i).abs().max(f64::MIN_POSITIVE).sqrt();
    let unit = |i: usize, j: usize| if scalar && i + j > 0 { 1.0 } else { root(i) * root(j) };
    Matrix2::new(unit(0, 0), unit(0, 1), unit(1, 0), unit(1, 1))
}

const NO_START: DecompositionError = DecompositionError::NoFit("no start gives finite FRFs");
const NOWHERE_NEAR: DecompositionError =
    DecompositionError::NoFit("no joint between these blocks comes near the FRFs from where it was sought");
const UNDETERMINED: DecompositionError =
    DecompositionError::NoFit("the FRFs leave an element of k or c undetermined");

/// The quantities that the FRFs depend on, the others, and the derivatives by the first ones at the first
/// start, if they were taken there.
///
/// `None` where no start gives finite FRFs.
#[allow(clippy::type_complexity)]
fn that_matter(
    setup: Setup,
    laws: Vec<Dynamics>,
    starts: &[Vec<f64>],
    quantities: Vec<Tolerance>,
) -> Option<(Vec<Tolerance>, Vec<Tolerance>, Option<Columns>)> {
    let recorded = setup.recorded;
    let idle = IdlePoints::of(setup.fixture, &recorded.pairs);
    let (idle, quantities): (Vec<_>, Vec<_>) =
        quantities.into_iter().partition(|tolerance| idle.have(tolerance.quantity.owner));
    let test = Test { setup, quantities: &quantities, weights: &recorded.weights };
    let problem = Problem::open(test, laws, None);
    let columns = |start: &Vec<f64>| problem.other_columns(&problem.point(problem.whole(start), None)?);
    let (place, columns) =
        starts.iter().enumerate().find_map(|(place, start)| Some((place, columns(start)?)))?;
    let all = quantities.into_iter().zip(columns);
    let (matter, others): (Vec<_>, Vec<_>) =
        all.partition(|(_, column)| recorded.size(column) > NO_DEPENDENCE);
    let (matter, columns): (Vec<_>, Vec<_>) = matter.into_iter().unzip();
    let others = others.into_iter().map(|(quantity, _)| quantity);
    let mut others: Vec<Tolerance> = others.chain(idle).collect();
    others.sort_by_key(|tolerance| tolerance.index);
    Some((matter, others, (place == 0).then_some(columns)))
}

/// The fit by the most probable law, from where laws were compared; `None` for the viscous law without mass,
/// of which the first fit is. Under a law that the FRFs refute, what it leaves would be taken for what
/// physics forbids.
fn by_its_law<'a>(
    problem: Problem<'a>,
    at: Vec<f64>,
    heavy: Option<Fitted>,
) -> Option<(Problem<'a>, Fitted, Freed)> {
    let is_viscous = problem.laws[0].kind == LawKind::Viscous;
    if is_viscous && problem.mass.is_none() {
        return None;
    }
    let known = heavy.filter(|_| is_viscous);
    let fitted = problem.fit(at, None).into_iter().chain(known).reduce(lower)?.or_from_afar(&problem)?;
    let (fitted, free) = admissible::settled(&problem, fitted)?;
    fitted.equations(&problem).covariance()?;
    Some((problem, fitted, free))
}

/// The lowest optimum of a viscous joint without mass; the last start is the nominal joint.
fn lowest(problem: &Problem, starts: &[Vec<f64>], mut nearby: Option<Columns>) -> Option<Fitted> {
    let mut best: Option<Fitted> = None;
    let is_doubtful = |best: &Option<Fitted>| {
        best.as_ref().is_none_or(|best| problem.per_degree(&best.point) > DOUBTFUL_FIT)
    };
    for start in starts {
        let found = problem.fit(problem.whole(start), nearby.take());
        best = best.into_iter().chain(found).reduce(lower);
        if !is_doubtful(&best) {
            break;
        }
    }
    if is_doubtful(&best) {
        let afar = starts.last().and_then(|start| problem.searched(problem.whole(start)));
        best = afar.into_iter().chain(best).reduce(lower);
    }
    best.filter(|best| best.point.objective.is_finite())
}

/// The fit of a joint with mass from that without and, if wanted, from afar: a mass left out bends the
/// blocks, and on the way back lie other optima.
fn heavy(problem: &Problem, light: &Fitted, afar: Option<&Vec<f64>>) -> Option<Fitted> {
    let mut start = light.point.coordinates.clone();
    start.insert(problem.of_laws(), FIRST_MASS);
    let near = problem.fit(start, None);
    let afar = afar.and_then(|start| {
        let mut start = problem.whole(start);
        start[problem.of_laws()] = FIRST_MASS;
        problem.searched(start)
    });
    near.into_iter().chain(afar).reduce(lower)
}
