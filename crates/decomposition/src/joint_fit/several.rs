//! Several joints at once from all FRFs, the fixture's quantities moving within their tolerances.
//!
//! The relation between the FRFs across one joint and that joint needs two sides that it alone connects. A
//! fit needs none: every joint acts on its own d, whatever else connects its ends. So joints of a chain are
//! found together, each without being told of the others, and those of a loop at all. Two joints between the
//! same two rigid bodies act on one relative motion, of which only the sum of both can be told: they are
//! refused by name.
//!
//! k, c and the quantities have one posterior: what is not known of a block moves the joints on both of its
//! sides, and their covariance says so. Losses are the joints' own, as for one joint; modal ratios of the
//! whole, which mix joints, are read as each joint's own c.

mod found;
mod laws;
mod starts;

use crate::settings::starts::{ASTRAY, DOUBTFUL_FIT, PLAUSIBLE_DEPARTURE, START_LOSS};
pub use found::{FoundJoint, JointsCovariance, JointsFit, SeveralError};

use super::admissible::first_order_asymmetry;
use super::law::{Dynamics, LawKind, coordinates};
use super::outcome::{Inflated, Outcome, numbered};
use super::problem::{Fitted, Point, Problem, Test, lower};
use super::quantities::uncertain;
use super::recorded::Recorded;
use super::setup::Setup;
use super::uncoupled::MOST_JOINTS;
use super::{JointFit, JointFitOptions, that_matter, units_of};
use crate::JointEnds;
use crate::sides::{check_instruments, with_effects_of};
use jointscope_fixture::{BodyKind, Fixture, Joint, Place};
use jointscope_frf::{KnownNoise, RigidMotionError};
use jointscope_linalg::RealMatrix2;
use jointscope_spectra::FrfSet;

/// Fits the joints named, or all of the fixture's, to every FRF whose channels the fixture has. Joints that
/// are not named move within their tolerances.
///
/// Variances are estimated from coherence and averages where the set has them, from its scatter elsewhere;
/// those that it carries already are kept.
///
/// It starts from the fixture's own joints where none of 0.4 to 2.5 times their stiffness, each joint by itself,
/// is nearer to the FRFs; else, and where χ² per degree of freedom stays above 1.3, stages follow in which 100,
/// 30, 6 and 1 % of the signal count as noise, from the three nearest.
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
    let known = KnownNoise::of(frfs, options.band.map(|band| (band.from, band.to)))
        .map_err(RigidMotionError::from)?;
    let recorded = Recorded::of(&known.frfs, fixture, options.band).ok_or(SeveralError::NothingRecorded)?;
    let middle = recorded.middle();
    let nominal: Vec<RealMatrix2> = joints.iter().map(|&joint| nominal_stiffness(fixture, joint)).collect();
    let law = |(k, &scalar): (&RealMatrix2, &bool)| {
        Dynamics::new(LawKind::Viscous, units_of(*k, scalar), middle, scalar)
    };
    let laws: Vec<Dynamics> = nominal.iter().zip(&scalar).map(law).collect();
    let quantities = uncertain(fixture, &joints, options.exact);
    let start = |shares: &[f64]| -> Vec<f64> {
        let own = laws.iter().zip(&nominal).zip(shares);
        own.flat_map(|((law, k), share)| coordinates(law, k.scale(*share), k.scale(share * START_LOSS)))
            .collect()
    };
    let as_stated = start(&vec![1.0; joints.len()]);
    let pieces = connected(&with_effects_of(fixture, without(fixture, &joints)));
    let setup = Setup { recorded: &recorded, fixture, joints: &joints, pieces: &pieces };
    let (quantities, unmoved, _) =
        that_matter(setup, laws.clone(), &[as_stated], quantities).ok_or(SeveralError::NoStart)?;
    let test = Test { setup, quantities: &quantities, weights: &recorded.weights };
    let viscous = Problem::open(test, laws.clone(), None);
    let mut first = lowest(&viscous, &start).ok_or(SeveralError::NoStart)?;
    first.refresh(&viscous).ok_or(SeveralError::NoStart)?;
    if first.point.objective > ASTRAY * recorded.size(&recorded.values) {
        return Err(SeveralError::Astray);
    }
    let (laws, followed) = match options.laws {
        true => {
            let (laws, followed) = laws::compared(&viscous, &first);
            (laws, followed.fitted(test))
        }
        false => (vec![Vec::new(); joints.len()], None),
    };
    let (problem, first) = followed.unwrap_or((viscous, first));
    let inflated = Inflated::of(&problem, &first);
    let problem = problem.weighted(&inflated.weights);
    let free = inflated.refitted(&problem, first).ok_or(SeveralError::NoStart)?;
    let outcome = Outcome { problem: &problem, unmoved: &unmoved, inflated: &inflated, laws };
    let found = outcome.of(&free, &|joint, inflation| {
        first_order_asymmetry(&problem, &free, joint).map(|gain| gain / inflation)
    })?;
    let fits = joints.iter().zip(found.joints);
    let joints: Vec<FoundJoint> = fits.map(|(&joint, fit)| FoundJoint::of(fixture, joint, fit)).collect();
    let name = |(joint, element): &(usize, &str)| numbered(&joints[*joint].name, element);
    Ok(JointsFit {
        merged: known.merged_from.map(|recorded| (recorded, known.frfs.lines().len())),
        elements: found.elements.iter().map(name).collect(),
        joints,
        covariance: found.covariance,
        model_covariance: found.model_covariance,
        likelihood: found.likelihood,
    })
}

impl FoundJoint {
    fn of(fixture: &Fixture, place: usize, fit: JointFit) -> Self {
        let joint = &fixture.joints()[place];
        FoundJoint {
            name: joint.name.clone(),
            ends: JointEnds::of(fixture, joint),
            is_in_a_loop: is_in_a_loop(fixture, place),
            nominal: nominal_stiffness(fixture, place),
            fit,
        }
    }
}

fn nominal_stiffness(fixture: &Fixture, joint: usize) -> RealMatrix2 {
    let joint = &fixture.joints()[joint];
    jointscope_lumped::nominal_stiffness(&joint.law, fixture.joint_length(joint))
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
    let rotates = |body: usize| fixture.bodies()[body].kind.rotates();
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

/// Joints between the same two rigid pieces: without the joints that are looked for, bodies that cannot move
/// against each other but as two rigid bodies.
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

/// The fixture without some of its joints, and without effects.
fn without(fixture: &Fixture, joints: &[usize]) -> Fixture {
    fixture.part(|_| true, joints)
}

/// Whether a joint's ends hold together without it.
fn is_in_a_loop(fixture: &Fixture, joint: usize) -> bool {
    let pieces = connected(&without(fixture, &[joint]));
    let [a, b] = bodies(fixture, &fixture.joints()[joint]);
    pieces[a] == pieces[b]
}

/// Which piece of the fixture each body is in, numbered from 0: joints and springs from body to body hold
/// pieces together.
fn connected(fixture: &Fixture) -> Vec<usize> {
    let joints =
        fixture.joints().iter().map(|joint| [joint.from, joint.to].map(|p| fixture.points()[p].body));
    let place = |name: &str| fixture.bodies().iter().position(|body| body.name == name);
    let springs = fixture.physics().iter().filter_map(|effect| match &effect.place {
        Place::Between(one, other) => Some([place(one)?, place(other)?]),
        _ => None,
    });
    let mut pieces: Vec<usize> = (0..fixture.bodies().len()).collect();
    for [a, b] in joints.chain(springs) {
        let [a, b] = [pieces[a], pieces[b]];
        pieces.iter_mut().filter(|piece| **piece == b).for_each(|piece| *piece = a);
    }
    let mut numbers: Vec<usize> = pieces.clone();
    numbers.sort_unstable();
    numbers.dedup();
    pieces.iter().map(|piece| numbers.partition_point(|number| number < piece)).collect()
}

/// The lowest optimum of viscous joints: from the fixture's own, if nothing of the grid is nearer, else and
/// where that does not explain the FRFs, by stages from the nearest of the grid.
fn lowest(problem: &Problem, start: &(dyn Fn(&[f64]) -> Vec<f64> + Sync)) -> Option<Fitted> {
    let starts = starts::starts(problem, start);
    let nearest = starts.first().filter(|shares| shares.iter().all(|share| *share == 1.0));
    let attempts = nearest.map(|shares| (shares, false)).into_iter();
    let mut best: Option<Fitted> = None;
    for (shares, from_afar) in attempts.chain(starts.iter().map(|shares| (shares, true))) {
        let start = problem.whole(&start(shares));
        let found = if from_afar { problem.searched(start) } else { problem.fit(start, None) };
        best = best.into_iter().chain(found).reduce(lower);
        if best.as_ref().is_some_and(|best| is_plausible(problem, &best.point)) {
            break;
        }
    }
    best.filter(|best| best.point.objective.is_finite())
}

/// Whether noise explains the FRFs with a fixture that is about what is stated: where neither noise nor
/// tolerances bind, a fit may end far from both.
fn is_plausible(problem: &Problem, point: &Point) -> bool {
    let own = problem.own();
    let known = problem.parameters[own..].iter().zip(&point.coordinates[own..]);
    let known = known.filter(|(parameter, _)| parameter.precision > 0.0);
    let (squares, count) = known.fold((0.0, 0.0), |(sum, count), (parameter, at)| {
        (sum + parameter.squared_departure(*at), count + 1.0)
    });
    problem.per_degree(point) < DOUBTFUL_FIT && squares <= PLAUSIBLE_DEPARTURE * f64::max(count, 1.0)
}
