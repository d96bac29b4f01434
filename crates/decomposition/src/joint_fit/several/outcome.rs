//! What a fit of several joints finds.

use super::super::law::{Dynamics, Form};
use super::super::likelihood::ELEMENTS;
use super::super::quantities::Uncertain;
use super::super::uncertainty::{jackknifed_by, length_between, strain, total, units};
use super::super::{
    FittedQuantity, JointFit, JointLikelihood, JointTests, LawFit, UnmovedQuantity, admissible, laws,
};
use super::{Fitted, Fitter, Point, Problem, boundary, is_in_a_loop};
use crate::{JointEnds, SidesError};
use jointscope_frf::RigidMotionError;
use jointscope_inference::{Covariance, NormalEquations};
use jointscope_linalg::{Cholesky, RealMatrix2};
use serde::Serialize;

/// Several joints from all FRFs.
#[derive(Debug, Clone, PartialEq)]
pub struct JointsFit {
    /// One a joint, in the order that they were asked for or stand in the fixture.
    pub joints: Vec<FoundJoint>,
    /// Names of the numbers that [`covariance`](Self::covariance) is of: `J1/k11` and so on, one joint's after the other's.
    pub elements: Vec<String>,
    /// Posterior covariance of the numbers of all joints, SI, the fixture's quantities integrated out; with what the model's error and the laws compared add.
    pub covariance: Vec<Vec<f64>>,
}

/// One of several joints.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundJoint {
    /// Its name in the fixture.
    pub name: String,
    /// Where its K and C act.
    pub ends: JointEnds,
    /// Whether its ends hold together without it, so that it has no two sides and eq (7) does not apply.
    pub is_in_a_loop: bool,
    /// The fixture's stiffness of it.
    pub nominal: RealMatrix2,
    /// What was found; quantities, FRFs and χ² are those of the fit as a whole. The p-value of reciprocity is of first order; no nearest admissible joint is sought.
    pub fit: JointFit,
}

/// Why several joints cannot be found at once.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SeveralError {
    /// An effect of the measuring chain that cannot be taken out of FRFs.
    #[error(transparent)]
    Instrument(#[from] SidesError),
    /// The fixture has no joint at all.
    #[error("the fixture has no joint to find; state those that are looked for under `joints`")]
    NoJoint,
    /// There is no such joint.
    #[error("the fixture has no joint `{name}`; choose among {} with --joint", names.join(", "))]
    NoSuchJoint {
        /// The name asked for.
        name: String,
        /// The joints there are.
        names: Vec<String>,
    },
    /// More joints than are found at once.
    #[error("the fixture has {} joints ({}) and at most {most} are found at once: choose one with --joint", names.len(), names.join(", "))]
    TooMany {
        /// Most joints.
        most: usize,
        /// The joints there are.
        names: Vec<String>,
    },
    /// A joint between a body that rotates and one that does not.
    #[error(
        "joint `{joint}` connects a body that rotates and one that does not; it has no stiffness on d = u_to − R·u_from"
    )]
    Mixed {
        /// The joint.
        joint: String,
    },
    /// Two joints between the same two rigid bodies.
    #[error(
        "joints `{}` and `{}` connect the same two rigid bodies `{}` and `{}`: FRFs tell only the sum of both; choose the one that is looked for with --joint, the other is then taken as the fixture states it, within its tolerances",
        joints[0], joints[1], bodies[0], bodies[1]
    )]
    Parallel {
        /// Their names.
        joints: [String; 2],
        /// The bodies that both connect.
        bodies: [String; 2],
    },
    /// The FRFs' noise cannot be estimated.
    #[error(transparent)]
    Noise(#[from] RigidMotionError),
    /// No FRF can be used.
    #[error("no FRF has both of its channels in the fixture and a value in the band")]
    NothingRecorded,
    /// No start leads anywhere.
    #[error("no start of the fit gives finite FRFs")]
    NoStart,
    /// The FRFs do not determine all numbers.
    #[error(
        "the FRFs leave an element of k or c of joint {} undetermined: measure FRFs across it with two points on each of its bodies, or choose the joints to be found with --joint",
        joints.join(", ")
    )]
    Undetermined {
        /// Names of the joints that this is true of.
        joints: Vec<String>,
    },
}

/// A finished fit of free viscous joints, and what else is known of it.
pub(super) struct Outcome<'a> {
    pub fitter: &'a Fitter<'a>,
    pub problem: &'a Problem<'a>,
    pub quantities: &'a [Uncertain],
    pub unmoved: Vec<Uncertain>,
    pub chi2_per_dof: f64,
    pub inflation: f64,
    pub laws: Vec<Vec<LawFit>>,
}

impl Outcome<'_> {
    pub fn of(self, free: Fitted) -> Result<JointsFit, SeveralError> {
        let Outcome { fitter, problem, .. } = &self;
        let equations = free.equations(problem);
        let covariance = equations.covariance().ok_or_else(|| self.undetermined(&equations))?;
        let strain = strain(&problem.parameters, problem.own(), &free.point.coordinates, &covariance);
        let tests: Vec<JointTests> =
            (0..problem.laws.len()).map(|joint| self.tests(joint, &free, &covariance, strain)).collect();
        let likelihoods: Vec<Option<JointLikelihood>> =
            (0..problem.laws.len()).map(|joint| self.likelihood(joint, &free.point, &equations)).collect();
        let (held, passive) = self.held(free)?;
        // Deviations are those of free elements, on the boundary too.
        let equations = held.equations(problem);
        let covariance = equations.covariance().ok_or_else(|| self.undetermined(&equations))?;
        let model = match self.inflation > 1.0 {
            true => jackknifed_by(
                fitter.recorded.s.len(),
                problem.test.weights,
                &held.point.coordinates,
                |weights| problem.equations_of(&held.point, &held.others, weights).step(0.0),
            ),
            false => None,
        };
        let total = total(&covariance, strain, model.as_ref());
        let slots = self.slots();
        let mut all: Vec<Vec<f64>> = slots
            .iter()
            .map(|(_, _, a, by_a)| {
                slots.iter().map(|(_, _, b, by_b)| total.at(*a, *b) * by_a * by_b).collect()
            })
            .collect();
        let spreads: Vec<[[f64; 6]; 6]> = self
            .laws
            .iter()
            .map(|laws| laws::Spread::of(laws, false).map_or([[0.0; 6]; 6], |spread| spread.covariance))
            .collect();
        for (row, (joint, slot, ..)) in all.iter_mut().zip(&slots) {
            for (entry, (other, across, ..)) in row.iter_mut().zip(&slots) {
                if joint == other {
                    *entry += spreads[*joint][*slot][*across];
                }
            }
        }
        let six = |of: &dyn Fn(usize, usize) -> f64, wanted: usize| {
            let mut six = [[0.0; 6]; 6];
            for (a, (joint, m, ..)) in slots.iter().enumerate().filter(|(_, (joint, ..))| *joint == wanted) {
                for (b, (_, n, ..)) in slots.iter().enumerate().filter(|(_, (other, ..))| other == joint) {
                    six[*m][*n] = of(a, b);
                }
            }
            six
        };
        let of_model = |a: usize, b: usize| {
            let ((_, _, m, by_m), (_, _, n, by_n)) = (slots[a], slots[b]);
            model.as_ref().map_or(0.0, |model| model.at(m, n) * by_m * by_n)
        };
        let quantities = self.quantities(&held.point, &total);
        let unmoved: Vec<UnmovedQuantity> =
            self.unmoved.iter().map(|own| own.unmoved(fitter.fixture)).collect();
        let found = problem.places().zip(tests).zip(likelihoods).zip(&self.laws).enumerate();
        let joints = found.map(|(place, ((((first, law), tests), likelihood), laws))| {
            let joint = &fitter.fixture.joints()[fitter.joints[place]];
            let [k, d, _] = law.matrices(&held.point.coordinates[first..first + law.count()]);
            FoundJoint {
                name: joint.name.clone(),
                ends: JointEnds::of(fitter.fixture, joint),
                is_in_a_loop: is_in_a_loop(fitter.fixture, fitter.joints[place]),
                nominal: jointscope_lumped::nominal_stiffness(&joint.law, fitter.fixture.joint_length(joint)),
                fit: JointFit {
                    stiffness: k,
                    damping: d.scale(1.0 / law.middle),
                    covariance: six(&|a, b| all[a][b], place),
                    model_covariance: six(&of_model, place),
                    law_covariance: spreads[place],
                    length: length_between(
                        (fitter.fixture, joint),
                        (self.quantities, &held.point.coordinates),
                        (problem.own(), first, law),
                        &total,
                    ),
                    chi2_per_dof: self.chi2_per_dof,
                    inflation: self.inflation,
                    strain,
                    is_on_the_boundary: !passive[place],
                    quantities: quantities.clone(),
                    unmoved: unmoved.clone(),
                    tests,
                    admissible: None,
                    laws: laws.clone(),
                    frfs: fitter.recorded.pairs.clone(),
                    lines: fitter.recorded.s.len(),
                    mass: None,
                    scalar: law.stiffness == Form::Scalar,
                    likelihood,
                },
            }
        });
        let joints: Vec<FoundJoint> = joints.collect();
        let name = |(joint, slot, ..): &(usize, usize, usize, f64)| {
            format!("{}/{}", joints[*joint].name, ELEMENTS[*slot])
        };
        Ok(JointsFit { elements: slots.iter().map(name).collect(), joints, covariance: all })
    }

    /// Of each number: its joint, its place among the joint's six, its coordinate, and SI units for one unit of that.
    fn slots(&self) -> Vec<(usize, usize, usize, f64)> {
        let of_joint = |(joint, (first, law)): (usize, (usize, &Dynamics))| {
            let units = units(law);
            own_slots(law)
                .iter()
                .enumerate()
                .map(move |(place, &slot)| (joint, slot, first + place, units[slot]))
                .collect::<Vec<_>>()
        };
        self.problem.places().enumerate().flat_map(of_joint).collect()
    }

    fn tests(&self, joint: usize, free: &Fitted, covariance: &Covariance, strain: f64) -> JointTests {
        let at = &free.point.coordinates;
        let Some((first, law)) = self.problem.places().nth(joint) else {
            return JointTests { reciprocity: None, definite: None, passive: None };
        };
        let lowest = |first: usize| admissible::not_negative(law.stiffness, at, first, (covariance, strain));
        JointTests {
            reciprocity: self.asymmetry(joint, free).map(|gain| (-0.5 * gain / strain).exp()),
            definite: lowest(first),
            passive: lowest(first + law.stiffness.count()),
        }
    }

    /// By how much χ² falls, to first order, where k and c of a joint may be unsymmetric.
    fn asymmetry(&self, joint: usize, free: &Fitted) -> Option<f64> {
        let problem = self.problem;
        if problem.laws[joint].stiffness != Form::Symmetric {
            return None;
        }
        let mut laws = problem.laws.clone();
        laws[joint] = laws[joint].free();
        let start = problem.converted(&free.point, &laws);
        let unsymmetric = Problem::viscous(problem.test, laws);
        let at = Problem::relabelled(&free.point, start);
        let equations = unsymmetric.equations_of(&at, &free.others, problem.test.weights);
        let step = equations.step(0.0)?;
        Some(step.iter().zip(&equations.right).map(|(step, right)| step * right).sum::<f64>().max(0.0))
    }

    /// The optimum with every c that would give out energy held to v vᵀ, in free coordinates, and which joints are passive without.
    fn held(&self, free: Fitted) -> Result<(Fitted, Vec<bool>), SeveralError> {
        let problem = self.problem;
        let mut passive = vec![true; problem.laws.len()];
        let mut at = free.point.coordinates.clone();
        loop {
            let mut changed = false;
            for (joint, (first, law)) in problem.places().enumerate() {
                let [_, d, _] = law.matrices(&at[first..first + law.count()]);
                let scalar = law.stiffness == Form::Scalar;
                let ok = d.at(0, 0) >= 0.0 && (scalar || (d.at(1, 1) >= 0.0 && d.determinant() >= 0.0));
                // A c that is held is passive up to rounding.
                if passive[joint] && !ok {
                    (passive[joint], changed) = (false, true);
                }
            }
            if !changed {
                break;
            }
            let laws: Vec<Dynamics> = problem
                .laws
                .iter()
                .zip(&passive)
                .map(|(law, passive)| if *passive { *law } else { boundary(law) })
                .collect();
            let start = problem.converted(&free.point, &laws);
            let other = Problem::viscous(problem.test, laws);
            let (point, _) = other.fit(start, Some(free.others.clone())).ok_or(SeveralError::NoStart)?;
            at = other.converted(&point, &problem.laws);
        }
        if passive.iter().all(|passive| *passive) {
            return Ok((free, passive));
        }
        let point = problem.point(at).ok_or(SeveralError::NoStart)?;
        let others = problem.other_columns(&point).ok_or(SeveralError::NoStart)?;
        Ok((Fitted { point, others }, passive))
    }

    fn quantities(&self, at: &Point, total: &Covariance) -> Vec<FittedQuantity> {
        let own = self.problem.own();
        let of = |(index, uncertain): (usize, &Uncertain)| {
            uncertain.fitted(self.fitter.fixture, at.coordinates[own + index], total.std(own + index))
        };
        self.quantities.iter().enumerate().map(of).collect()
    }

    /// What the FRFs alone tell of one joint and of the quantities, the other joints integrated out.
    fn likelihood(&self, joint: usize, free: &Point, equations: &NormalEquations) -> Option<JointLikelihood> {
        let problem = self.problem;
        let (first, law) = problem.places().nth(joint)?;
        let kept = (first..first + law.count()).chain(problem.own()..problem.parameters.len()).collect();
        JointLikelihood::of(law, (&free.coordinates, kept), equations, &problem.parameters)
    }

    /// Which joints the FRFs leave undetermined, the others being given; all, if none by itself.
    fn undetermined(&self, equations: &NormalEquations) -> SeveralError {
        let n = equations.order;
        let places: Vec<(usize, usize)> =
            self.problem.places().map(|(first, law)| (first, first + law.count())).collect();
        let name = |joint: usize| self.fitter.fixture.joints()[self.fitter.joints[joint]].name.clone();
        let is_open = |&joint: &usize| {
            let mut information = equations.information.clone();
            for (_, (from, to)) in places.iter().enumerate().filter(|(other, _)| *other != joint) {
                for m in *from..*to {
                    let own = information[m * n + m];
                    information[m * n + m] += 1e9 * if own > 0.0 { own } else { 1.0 };
                }
            }
            Cholesky::of(n, &information).is_none()
        };
        let open: Vec<String> = (0..places.len()).filter(is_open).map(name).collect();
        let joints = if open.is_empty() { (0..places.len()).map(name).collect() } else { open };
        SeveralError::Undetermined { joints }
    }
}

/// Which of k11, k12, k22, c11, c12, c22 a viscous law has.
fn own_slots(law: &Dynamics) -> &'static [usize] {
    if law.stiffness == Form::Scalar { &[0, 3] } else { &[0, 1, 2, 3, 4, 5] }
}

/// The covariance of all joints, by the names of its rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointsCovariance<'a> {
    /// Names of rows and columns.
    pub elements: &'a [String],
    /// SI.
    pub matrix: &'a [Vec<f64>],
}

impl JointsFit {
    /// The covariance of all joints with the names of its rows.
    pub fn covariance_of_all(&self) -> JointsCovariance<'_> {
        JointsCovariance { elements: &self.elements, matrix: &self.covariance }
    }
}
