//! Several joints at once from all FRFs, the fixture's quantities moving within their tolerances.
//!
//! The relation between the FRFs across one joint and that joint needs two sides that it alone connects. A fit needs none: every joint acts on its own d, whatever
//! else connects its ends ([`free`]). So joints of a chain are found together, each without being told of the others, and those of a loop at all. Two joints between the
//! same two rigid bodies act on one relative motion, of which only the sum of both can be told: they are refused by name.
//!
//! k, c and the quantities have one posterior: what is not known of a block moves the joints on both of its sides, and their covariance says so. Losses are the joints'
//! own, as for one joint; modal ratios of the whole, which mix joints, are read as each joint's own c.

mod free;
mod laws;
mod outcome;
mod problem;

pub use outcome::{FoundJoint, JointsCovariance, JointsFit, SeveralError};

use super::law::{Dynamics, Form, LawKind};
use super::problem::{Columns, needed};
use super::quantities::{Uncertain, uncertain};
use super::recorded::Recorded;
use super::{
    DOUBTFUL, JointFitOptions, LOOKS, NEGLIGIBLE, SHARES_AS_NOISE, START_LOSS, coordinates, units_of,
};
use crate::sides::check_instruments;
use free::{MOST_JOINTS, connected};
use jointscope_fixture::{BodyKind, Fixture, Joint};
use jointscope_frf::RigidMotionError;
use jointscope_frf::noise::with_variances;
use jointscope_inference::{LeastSquares, NormalEquations, Parameter, Transform};
use jointscope_linalg::RealMatrix2;
use jointscope_spectra::FrfSet;
use outcome::Outcome;
use problem::{Point, Problem, Test};

/// Fits the joints named, or all of the fixture's, to every FRF whose channels the fixture has. Joints that are not named move within their tolerances.
///
/// Variances are estimated from coherence and averages where the set has them, from its scatter elsewhere; those that it carries already are kept.
///
/// It starts from the fixture's own joints; where χ² per degree of freedom stays above 1.3, stages follow in which 100, 30, 6 and 1 % of the signal count as noise, from
/// the fixture's joints, from half and from twice their stiffness.
///
/// # Errors
/// See [`SeveralError`].
pub fn fit_joints(
    fixture: &Fixture,
    frfs: &FrfSet,
    names: Option<&[String]>,
    options: JointFitOptions,
) -> Result<JointsFit, SeveralError> {
    check_instruments(fixture)?;
    let joints = chosen(fixture, names)?;
    let scalar = scalars(fixture, &joints)?;
    refuse_parallel(fixture, &joints)?;
    let known = match frfs.variance(0) {
        Some(_) => None,
        None => Some(with_variances(frfs).map_err(RigidMotionError::from)?.0),
    };
    let recorded = Recorded::of(known.as_ref().unwrap_or(frfs), fixture, options.band)
        .ok_or(SeveralError::NothingRecorded)?;
    let middle = recorded.s.iter().map(|s| s.im).sum::<f64>() / recorded.s.len() as f64;
    let nominal: Vec<RealMatrix2> = joints
        .iter()
        .map(|&joint| {
            let joint = &fixture.joints()[joint];
            jointscope_lumped::nominal_stiffness(&joint.law, fixture.joint_length(joint))
        })
        .collect();
    let law = |(k, &scalar): (&RealMatrix2, &bool)| {
        Dynamics::new(LawKind::Viscous, units_of(*k, scalar), middle, scalar)
    };
    let laws: Vec<Dynamics> = nominal.iter().zip(&scalar).map(law).collect();
    let quantities = uncertain(fixture, &joints, options.exact);
    let start = |share: f64| -> Vec<f64> {
        let own = laws.iter().zip(&nominal);
        own.flat_map(|(law, k)| coordinates(law, k.scale(share), k.scale(share * START_LOSS))).collect()
    };
    let fitter = Fitter { recorded: &recorded, fixture, joints: &joints };
    let (quantities, unmoved) = fitter.that_matter(&laws, &start(1.0), quantities)?;
    let weights = &recorded.weights;
    let test = fitter.test(&quantities, weights);
    let problem = Problem::viscous(&test, laws.clone());
    let mut first = fitter.first(&problem, &start)?;
    first.refresh(&problem)?;
    let chi2_per_dof = fitter.per_degree(&problem, &first.point);
    let inflation = fitter.inflation(&problem, &first.point);
    let laws = match options.laws {
        true => laws::compared(&fitter, (&problem, &first), &quantities),
        false => vec![Vec::new(); joints.len()],
    };
    let inflated_weights: Vec<f64> = weights.iter().map(|weight| weight / inflation).collect();
    let inflated = fitter.test(&quantities, &inflated_weights);
    let problem = Problem::viscous(&inflated, problem.laws.clone());
    if inflation > 1.0 {
        let (point, others) =
            problem.fit(first.point.coordinates, Some(first.others)).ok_or(SeveralError::NoStart)?;
        first = Fitted { point, others };
        first.refresh(&problem)?;
    }
    Outcome {
        fitter: &fitter,
        problem: &problem,
        quantities: &quantities,
        unmoved,
        chi2_per_dof,
        inflation,
        laws,
    }
    .of(first)
}

/// The joints that are looked for.
fn chosen(fixture: &Fixture, names: Option<&[String]>) -> Result<Vec<usize>, SeveralError> {
    let all = || fixture.joints().iter().map(|joint| joint.name.clone()).collect::<Vec<_>>();
    let joints: Vec<usize> = match names {
        None => (0..fixture.joints().len()).collect(),
        Some(names) => {
            let place = |name: &String| {
                let found = fixture.joints().iter().position(|joint| joint.name == *name);
                found.ok_or_else(|| SeveralError::NoSuchJoint { name: name.clone(), names: all() })
            };
            names.iter().map(place).collect::<Result<_, _>>()?
        }
    };
    match joints.len() {
        0 => Err(SeveralError::NoJoint),
        1..=MOST_JOINTS => Ok(joints),
        _ => Err(SeveralError::TooMany { most: MOST_JOINTS, names: all() }),
    }
}

fn bodies(fixture: &Fixture, joint: &Joint) -> [usize; 2] {
    [joint.from, joint.to].map(|point| fixture.points()[point].body)
}

/// Whether each joint's bodies do not rotate.
fn scalars(fixture: &Fixture, joints: &[usize]) -> Result<Vec<bool>, SeveralError> {
    let rotates = |body: usize| match &fixture.bodies()[body].kind {
        BodyKind::Rigid(rigid) => rigid.rotates,
        BodyKind::Beam(_) => true,
    };
    let scalar = |&joint: &usize| {
        let joint = &fixture.joints()[joint];
        match bodies(fixture, joint).map(rotates) {
            [true, true] => Ok(false),
            [false, false] => Ok(true),
            _ => Err(SeveralError::Mixed { joint: joint.name.clone() }),
        }
    };
    joints.iter().map(scalar).collect()
}

/// Joints between the same two rigid pieces: without the joints that are looked for, bodies that cannot move against each other but as two rigid bodies.
fn refuse_parallel(fixture: &Fixture, joints: &[usize]) -> Result<(), SeveralError> {
    let is_rigid = |body: usize| matches!(fixture.bodies()[body].kind, BodyKind::Rigid(_));
    for (place, &a) in joints.iter().enumerate() {
        for &b in &joints[..place] {
            let [here, there] = [a, b].map(|joint| {
                let mut bodies = bodies(fixture, &fixture.joints()[joint]);
                bodies.sort_unstable();
                bodies
            });
            if here == there && here.into_iter().all(is_rigid) {
                return Err(SeveralError::Parallel {
                    joints: [b, a].map(|joint| fixture.joints()[joint].name.clone()),
                    bodies: here.map(|body| fixture.bodies()[body].name.clone()),
                });
            }
        }
    }
    Ok(())
}

/// Whether a joint's ends hold together without it.
fn is_in_a_loop(fixture: &Fixture, joint: usize) -> bool {
    let pieces = connected(&fixture.without_joints(&[joint]));
    let [a, b] = bodies(fixture, &fixture.joints()[joint]);
    pieces[a] == pieces[b]
}

/// What all fits of one recording share.
struct Fitter<'a> {
    recorded: &'a Recorded,
    fixture: &'a Fixture,
    joints: &'a [usize],
}

/// A finished fit.
struct Fitted {
    point: Point,
    others: Columns,
}

impl Fitted {
    /// Takes the derivatives by the quantities at the optimum, and goes on where they promise more.
    fn refresh(&mut self, problem: &Problem) -> Result<(), SeveralError> {
        for look in 0.. {
            self.others = problem.other_columns(&self.point).ok_or(SeveralError::NoStart)?;
            let promised = problem.promised(&self.point, &self.equations(problem));
            if look == LOOKS || promised < needed(problem.test.recorded, self.point.objective) {
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

/// Mean square departure of the quantities, in standard deviations, above which another start is tried.
const PLAUSIBLE: f64 = 4.0;
/// Stiffness of the starts as shares of the fixture's.
const SHARES: [f64; 3] = [1.0, 0.5, 2.0];

impl Fitter<'_> {
    fn test<'b>(&'b self, quantities: &'b [Uncertain], weights: &'b [f64]) -> Test<'b> {
        let Fitter { recorded, fixture, joints } = self;
        Test { recorded, fixture, joints, quantities, weights }
    }

    /// The quantities that the FRFs depend on, and the others.
    fn that_matter(
        &self,
        laws: &[Dynamics],
        start: &[f64],
        quantities: Vec<Uncertain>,
    ) -> Result<(Vec<Uncertain>, Vec<Uncertain>), SeveralError> {
        let weights = &self.recorded.weights;
        let test = self.test(&quantities, weights);
        let problem = Problem::viscous(&test, laws.to_vec());
        let columns = problem.point(problem.whole(start)).and_then(|point| problem.other_columns(&point));
        let matter: Vec<bool> = columns
            .ok_or(SeveralError::NoStart)?
            .iter()
            .map(|column| self.recorded.size(column) > NEGLIGIBLE)
            .collect();
        let (matter, others): (Vec<_>, Vec<_>) =
            quantities.into_iter().zip(matter).partition(|(_, matters)| *matters);
        let bare = |all: Vec<(Uncertain, bool)>| all.into_iter().map(|(quantity, _)| quantity).collect();
        Ok((bare(matter), bare(others)))
    }

    /// The lowest optimum of viscous joints.
    fn first(&self, problem: &Problem, start: &dyn Fn(f64) -> Vec<f64>) -> Result<Fitted, SeveralError> {
        let mut best: Option<Fitted> = None;
        let attempts = std::iter::once((1.0, false)).chain(SHARES.map(|share| (share, true)));
        for (share, from_afar) in attempts {
            let start = problem.whole(&start(share));
            let found = match from_afar {
                true => self.searched(problem, start),
                false => problem.fit(start, None),
            };
            let Some((point, others)) = found else { continue };
            if best.as_ref().is_none_or(|best| point.objective < best.point.objective) {
                best = Some(Fitted { point, others });
            }
            if best.as_ref().is_some_and(|best| self.is_plausible(problem, &best.point)) {
                break;
            }
        }
        best.filter(|best| best.point.objective.is_finite()).ok_or(SeveralError::NoStart)
    }

    /// Whether noise explains the FRFs with a fixture that is about what is stated: where neither noise nor tolerances bind, a fit may end far from both.
    fn is_plausible(&self, problem: &Problem, point: &Point) -> bool {
        let own = problem.own();
        let known = problem.parameters[own..].iter().zip(&point.coordinates[own..]);
        let known = known.filter(|(parameter, _)| parameter.precision > 0.0);
        let (squares, count) = known
            .fold((0.0, 0.0), |(sum, count), (parameter, at)| (sum + parameter.penalty(*at), count + 1.0));
        self.per_degree(problem, point) < DOUBTFUL && squares <= PLAUSIBLE * f64::max(count, 1.0)
    }

    /// A fit by stages in which less and less of the signal counts as noise, so that sharp resonances do not decide where it goes.
    fn searched(&self, problem: &Problem, start: Vec<f64>) -> Option<(Point, Columns)> {
        let mut at = start;
        for share in SHARES_AS_NOISE {
            let weights = self.recorded.weights_with(share);
            let test = self.test(problem.test.quantities, &weights);
            at = Problem::viscous(&test, problem.laws.clone()).fit(at, None)?.0.coordinates;
        }
        problem.fit(at, None)
    }

    fn per_degree(&self, problem: &Problem, point: &Point) -> f64 {
        self.recorded.per_degree(point.objective, problem.own(), &problem.parameters)
    }

    /// What the noise is multiplied by so that it explains what is left, correlated from line to line as that is.
    fn inflation(&self, problem: &Problem, point: &Point) -> f64 {
        self.recorded.inflation(self.per_degree(problem, point), &point.predicted)
    }
}

impl<'a> Problem<'a> {
    /// Joints of which nothing is known beforehand.
    fn viscous(test: &'a Test<'a>, laws: Vec<Dynamics>) -> Self {
        let own = Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 });
        let count = laws.iter().map(Dynamics::count).sum();
        let quantities = test.quantities.iter().map(|quantity| quantity.parameter);
        let parameters = std::iter::repeat_n(own, count).chain(quantities).collect();
        Problem { test, laws, parameters }
    }

    /// The laws' coordinates with the fixture as stated.
    fn whole(&self, own: &[f64]) -> Vec<f64> {
        let mut all = own.to_vec();
        all.resize(self.parameters.len(), 0.0);
        all
    }

    /// The same point in laws whose matrices have other forms.
    fn converted(&self, at: &Point, laws: &[Dynamics]) -> Vec<f64> {
        let own = self.places().zip(laws).flat_map(|((first, law), other)| {
            let [k, d, _] = law.matrices(&at.coordinates[first..first + law.count()]);
            coordinates(other, k, d)
        });
        own.chain(at.coordinates[self.own()..].iter().copied()).collect()
    }
}

/// The limit of what is passive.
fn boundary(law: &Dynamics) -> Dynamics {
    Dynamics { damping: if law.damping == Form::Scalar { Form::Zero } else { Form::RankOne }, ..*law }
}
