//! What a fit finds: the joints with their tests and covariance, the fixture's quantities.

use super::admissible::{boundary, by_chance, not_negative, refitted};
use super::law::{Dynamics, Form};
use super::laws::Spread;
use super::length::length_between;
use super::likelihood::{ELEMENTS, NamedCoordinate};
use super::problem::{Fitted, Problem};
use super::uncertainty::{tolerance_inflation, total, units};
use super::{
    FittedFrfs, FittedQuantity, Followed, JointFit, JointLikelihood, JointTests, LawFit, SeveralError,
    UnmovedQuantity,
};
use jointscope_inference::{Covariance, NormalEquations};
use jointscope_linalg::Cholesky;
use jointscope_tolerances::Tolerance;
use std::sync::Arc;

/// What a model that does not explain the FRFs does to their noise.
pub(super) struct Inflated {
    /// χ² and priors per degree of freedom.
    pub chi2_per_dof: f64,
    /// What the noise's variance is multiplied by.
    pub by: f64,
    pub weights: Vec<f64>,
}

impl Inflated {
    pub(super) fn of(problem: &Problem, first: &Fitted) -> Self {
        let by = problem.inflation(&first.point);
        let weights = problem.test.weights.iter().map(|weight| weight / by).collect();
        Inflated { chi2_per_dof: problem.per_degree(&first.point), by, weights }
    }

    /// The optimum under these weights, from that without.
    pub(super) fn refitted(&self, problem: &Problem, first: Fitted) -> Option<Fitted> {
        if self.by <= 1.0 {
            return Some(first);
        }
        let mut fitted = problem.fit(first.point.coordinates, Some(first.others))?;
        fitted.refresh(problem)?;
        Some(fitted)
    }
}

/// A finished fit of joints by the laws that they follow, and what else is known of it.
pub(super) struct Outcome<'a> {
    pub problem: &'a Problem<'a>,
    pub unmoved: &'a [Tolerance],
    pub inflated: &'a Inflated,
    /// By joint.
    pub laws: Vec<Vec<LawFit>>,
}

/// The joints of a fit, in the order that they were looked for.
pub(super) struct Found {
    pub joints: Vec<JointFit>,
    /// Place of a joint and of one of its six numbers, for each row of the covariance.
    pub elements: Vec<(usize, &'static str)>,
    pub covariance: Vec<Vec<f64>>,
    /// What of it comes from a model that does not explain the FRFs.
    pub model_covariance: Vec<Vec<f64>>,
    /// What the FRFs alone tell of all of them.
    pub likelihood: Option<JointLikelihood>,
}

/// A number of a joint.
#[derive(Clone, Copy)]
struct Slot {
    joint: usize,
    /// Its place among the joint's six.
    place: usize,
    coordinate: usize,
    /// SI units for one unit of the coordinate.
    unit: f64,
}

/// The covariance of the first coordinates, those after them being exact.
fn with_the_fixture_exact(equations: &NormalEquations, own: usize) -> Option<Covariance> {
    let mut bare = NormalEquations::zero(own);
    for (row, whole) in bare.information.chunks_mut(own).zip(equations.information.chunks(equations.order)) {
        row.copy_from_slice(&whole[..own]);
    }
    bare.covariance()
}

impl Slot {
    /// The number by its name, with that of its joint before it where there are several.
    fn named(&self, joint: Option<&str>) -> NamedCoordinate {
        let element = ELEMENTS[self.place];
        let name = joint.map_or(element.to_owned(), |joint| numbered(joint, element));
        NamedCoordinate { name, coordinate: self.coordinate, unit: self.unit }
    }
}

/// Name of a number of one of several joints.
pub(super) fn numbered(joint: &str, element: &str) -> String {
    format!("{joint}/{element}")
}

/// The optimum with every c free, of which the tests are.
struct Free<'a> {
    fitted: &'a Fitted,
    equations: NormalEquations,
    covariance: Covariance,
    /// Of the joints' own coordinates, the fixture's quantities being exact.
    noise: Covariance,
    tolerance_inflation: f64,
}

/// The optimum that is stated, and how uncertain its numbers are.
struct Stated<'a> {
    at: &'a Fitted,
    quantities: Vec<FittedQuantity>,
    frfs: Arc<FittedFrfs>,
    /// Of all coordinates, with what the model's error adds.
    total: Covariance,
    /// What the model's error adds.
    model: Option<Covariance>,
    /// The first joint's, kg, with its deviation.
    mass: Option<(f64, f64)>,
    /// By how much the laws compared differ, by joint.
    spreads: Vec<Spread>,
    slots: Vec<Slot>,
}

impl Stated<'_> {
    /// Covariance of two numbers, with what the laws compared add.
    fn covariance(&self, a: &Slot, b: &Slot) -> f64 {
        let of_laws =
            if a.joint == b.joint { self.spreads[a.joint].covariance[a.place][b.place] } else { 0.0 };
        in_si(&self.total, a, b) + of_laws
    }

    /// What of it the model's error adds.
    fn of_model(&self, a: &Slot, b: &Slot) -> f64 {
        self.model.as_ref().map_or(0.0, |model| in_si(model, a, b))
    }

    /// Covariances of the six numbers of one joint.
    fn six(&self, of: &dyn Fn(&Slot, &Slot) -> f64, joint: usize) -> [[f64; 6]; 6] {
        let mut six = [[0.0; 6]; 6];
        let own = || self.slots.iter().filter(|slot| slot.joint == joint);
        own().for_each(|a| own().for_each(|b| six[a.place][b.place] = of(a, b)));
        six
    }

    /// Covariances of the numbers of all joints.
    fn matrix(&self, of: &dyn Fn(&Slot, &Slot) -> f64) -> Vec<Vec<f64>> {
        self.slots.iter().map(|a| self.slots.iter().map(|b| of(a, b)).collect()).collect()
    }
}

fn in_si(of: &Covariance, a: &Slot, b: &Slot) -> f64 {
    of.at(a.coordinate, b.coordinate) * a.unit * b.unit
}

/// A law with the probability that it has among those compared; 1 where none were.
fn as_compared(mut stated: LawFit, laws: &[LawFit]) -> LawFit {
    let is_same = |fit: &&LawFit| fit.kind == stated.kind && fit.mass.is_some() == stated.mass.is_some();
    stated.probability = match laws.is_empty() {
        true => 1.0,
        false => laws.iter().find(is_same).map_or(0.0, |fit| fit.probability),
    };
    stated
}

impl Outcome<'_> {
    /// From the optimum with every c free. `asymmetry` tells by how much χ² falls where k and the damping
    /// matrix of a joint may be unsymmetric, variances counting so many times.
    pub(super) fn of(
        self,
        free: &Fitted,
        asymmetry: &dyn Fn(usize, f64) -> Option<f64>,
    ) -> Result<Found, SeveralError> {
        let setup = self.problem.test.setup;
        let free = self.free(free)?;
        let (held, passive) = self.held(free.fitted)?;
        let stated = self.stated(held.as_ref(), &free)?;
        let joint = |(place, passive): (usize, bool)| {
            let reciprocity = asymmetry(place, free.tolerance_inflation);
            JointFit { is_on_the_boundary: !passive, ..self.joint(place, &free, &stated, reciprocity) }
        };
        let name = |joint: usize| setup.fixture.joints()[setup.joints[joint]].name.as_str();
        let named = stated.slots.iter().map(|slot| slot.named(Some(name(slot.joint))));
        Ok(Found {
            joints: passive.into_iter().enumerate().map(joint).collect(),
            elements: stated.slots.iter().map(|slot| (slot.joint, ELEMENTS[slot.place])).collect(),
            covariance: stated.matrix(&|a, b| stated.covariance(a, b)),
            model_covariance: stated.matrix(&|a, b| stated.of_model(a, b)),
            likelihood: self.likelihood(named, &free),
        })
    }

    /// What is known at the optimum with every c free.
    fn free<'a>(&self, fitted: &'a Fitted) -> Result<Free<'a>, SeveralError> {
        let (problem, equations) = (self.problem, fitted.equations(self.problem));
        let undetermined = || self.undetermined(&equations);
        let covariance = equations.covariance().ok_or_else(undetermined)?;
        let noise = with_the_fixture_exact(&equations, problem.own()).ok_or_else(undetermined)?;
        let tolerance_inflation =
            tolerance_inflation(&problem.parameters, problem.own(), &fitted.point.coordinates, &covariance);
        Ok(Free { fitted, equations, covariance, noise, tolerance_inflation })
    }

    /// The numbers that are stated: those with every c held that would give out energy, if there is such a c.
    fn stated<'a>(&self, held: Option<&'a Fitted>, free: &Free<'a>) -> Result<Stated<'a>, SeveralError> {
        let problem = self.problem;
        let at = held.unwrap_or(free.fitted);
        // Deviations are those of free elements, on the boundary too.
        let posterior = match held {
            Some(held) => {
                let equations = held.equations(problem);
                equations.covariance().ok_or_else(|| self.undetermined(&equations))?
            }
            None => free.covariance.clone(),
        };
        let model = if self.inflated.by > 1.0 { at.jackknifed(problem) } else { None };
        let total = total(&posterior, free.tolerance_inflation, model.as_ref());
        let mass = problem
            .mass
            .map(|scale| (problem.mass_at(&at.point.coordinates), scale * total.std(problem.of_laws())));
        let spread = |(laws, law): (&Vec<LawFit>, &Dynamics)| {
            let none = Spread { covariance: [[0.0; 6]; 6], mass: 0.0 };
            Spread::of(laws, law.kind, mass.is_some()).unwrap_or(none)
        };
        let spreads = self.laws.iter().zip(&problem.laws).map(spread).collect();
        let recorded = problem.test.setup.recorded;
        let (measured, modelled) = (recorded.frfs.clone(), at.point.predicted.clone());
        Ok(Stated {
            at,
            quantities: self.quantities(&at.point.coordinates, &total),
            frfs: Arc::new(FittedFrfs { measured, modelled }),
            total,
            model,
            mass,
            spreads,
            slots: self.slots(),
        })
    }

    /// A joint by its place among those that are looked for; `asymmetry` is by how much χ² falls where its k
    /// and damping matrix may be unsymmetric.
    fn joint(&self, place: usize, free: &Free, stated: &Stated, asymmetry: Option<f64>) -> JointFit {
        let (problem, setup) = (self.problem, self.problem.test.setup);
        let (first, law) = problem.places().nth(place).unwrap_or((0, &problem.laws[0]));
        let coordinates = &stated.at.point.coordinates;
        let own = &coordinates[first..first + law.count()];
        let [k, d, _] = law.matrices(own);
        let lowest = |form: Form, first: usize| {
            let (covariance, noise) = (&free.covariance, &free.noise);
            not_negative(
                form,
                &free.fitted.point.coordinates,
                first,
                (covariance, noise, free.tolerance_inflation),
            )
        };
        let (laws, spread) = (&self.laws[place], &stated.spreads[place]);
        let mass = stated.mass.filter(|_| place == 0);
        let slots = stated.slots.iter().filter(|slot| slot.joint == place);
        JointFit {
            stiffness: k,
            damping: d.scale(1.0 / law.middle),
            covariance: stated.six(&|a, b| stated.covariance(a, b), place),
            model_covariance: stated.six(&|a, b| stated.of_model(a, b), place),
            law_covariance: spread.covariance,
            length: length_between(
                (setup.fixture, &setup.fixture.joints()[setup.joints[place]]),
                (problem.test.quantities, coordinates),
                (problem.own(), first, law),
                &stated.total,
            ),
            chi2_per_dof: self.inflated.chi2_per_dof,
            inflation: self.inflated.by,
            tolerance_inflation: free.tolerance_inflation,
            is_on_the_boundary: false,
            quantities: stated.quantities.clone(),
            unmoved: self.unmoved.iter().map(|own| UnmovedQuantity::of(own, setup.fixture)).collect(),
            tests: JointTests {
                reciprocity: asymmetry.map(|gain| by_chance(law, gain)),
                definite: lowest(law.stiffness, first),
                passive: lowest(law.damping, first + law.stiffness.count()),
            },
            admissible: None,
            laws: laws.clone(),
            follows: Followed {
                law: law.kind,
                fit: as_compared(LawFit::of(law, own, stated.at.point.objective, mass.map(|of| of.0)), laws),
                omega: law.middle,
                shape: law.shape_with_std(own, |own| stated.total.std(first + own)),
            },
            frfs: setup.recorded.pairs.clone(),
            lines: setup.recorded.s.len(),
            fitted: Arc::clone(&stated.frfs),
            mass: mass.map(|(mass, std)| (mass, std.hypot(spread.mass.sqrt()))),
            scalar: law.stiffness == Form::Scalar,
            likelihood: self.likelihood(slots.map(|slot| slot.named(None)), free),
        }
    }

    fn slots(&self) -> Vec<Slot> {
        let of_joint = |(joint, (first, law)): (usize, (usize, &Dynamics))| {
            let units = units(law);
            let own = law.slots().iter().enumerate();
            own.map(move |(index, &place)| Slot {
                joint,
                place,
                coordinate: first + index,
                unit: units[place],
            })
            .collect::<Vec<_>>()
        };
        self.problem.places().enumerate().flat_map(of_joint).collect()
    }

    /// The optimum with every c that would give out energy held to v vᵀ, in free coordinates, if there is
    /// such a c, and which joints are passive without.
    fn held(&self, free: &Fitted) -> Result<(Option<Fitted>, Vec<bool>), SeveralError> {
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
            let on_the_boundary = |law: &Dynamics| Dynamics { damping: boundary(law.damping), ..*law };
            let held =
                |(law, passive): (&Dynamics, &bool)| if *passive { *law } else { on_the_boundary(law) };
            let laws = problem.laws.iter().zip(&passive).map(held).collect();
            let (other, fitted) = refitted(problem, free, laws).ok_or(SeveralError::NoStart)?;
            at = other.converted(&fitted.point.coordinates, &problem.laws);
        }
        if passive.iter().all(|passive| *passive) {
            return Ok((None, passive));
        }
        let point = problem.point(at, None).ok_or(SeveralError::NoStart)?;
        let others = problem.other_columns(&point).ok_or(SeveralError::NoStart)?;
        Ok((Some(Fitted { point, others }), passive))
    }

    fn quantities(&self, at: &[f64], total: &Covariance) -> Vec<FittedQuantity> {
        let (own, test) = (self.problem.own(), &self.problem.test);
        let of = |(index, tolerance): (usize, &Tolerance)| {
            FittedQuantity::of(tolerance, test.setup.fixture, at[own + index], total.std(own + index))
        };
        test.quantities.iter().enumerate().map(of).collect()
    }

    /// What the FRFs alone tell of these numbers and of the quantities, other joints, a mass and the rest of
    /// the laws integrated out.
    fn likelihood(
        &self,
        numbers: impl Iterator<Item = NamedCoordinate>,
        free: &Free,
    ) -> Option<JointLikelihood> {
        let (numbers, at): (Vec<NamedCoordinate>, _) = (numbers.collect(), &free.fitted.point.coordinates);
        JointLikelihood::of(&numbers, self.problem.own(), at, &free.equations, &self.problem.parameters)
    }

    /// Which joints the FRFs leave undetermined, the others being given; all, if none by itself.
    fn undetermined(&self, equations: &NormalEquations) -> SeveralError {
        let (n, setup) = (equations.order, self.problem.test.setup);
        let places: Vec<(usize, usize)> =
            self.problem.places().map(|(first, law)| (first, first + law.count())).collect();
        let name = |joint: usize| setup.fixture.joints()[setup.joints[joint]].name.clone();
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
