//! The fit itself: the coordinates of every joint's law, perhaps the first joint's mass, and the fixture's
//! uncertain quantities.

use super::law::{Dynamics, Placed, coordinates};
use super::priors::{mass_parameter, open_parameters, own_parameters};
use super::setup::Setup;
use super::uncertainty::jackknifed_by;
use super::uncoupled::Uncoupled;
use crate::settings::differences::QUANTITY_STEP;
use crate::settings::fit::{
    CONVERGED, CONVERGED_SHARE, CREEPS, CURVED_VALLEY, MOST_RESUMPTIONS, MOST_STEPS, REUSE, SIGNAL_AS_NOISE,
};
use jointscope_inference::{
    Convergence, Covariance, DerivativePrecision, LeastSquares, Limit, NormalEquations, Parameter, Settings,
    StepDamping, descend,
};
use jointscope_tolerances::{Tolerance, moved};
use num_complex::Complex64;
use std::sync::Arc;

/// What joints are fitted to, whatever their laws.
#[derive(Clone, Copy)]
pub(super) struct Test<'a> {
    pub setup: Setup<'a>,
    pub quantities: &'a [Tolerance],
    /// 2/σ², divided by what the model's error inflates the noise by.
    pub weights: &'a [f64],
}

/// Laws to be fitted to a test, one a joint.
pub(super) struct Problem<'a> {
    pub test: Test<'a>,
    pub laws: Vec<Dynamics>,
    /// Coordinates: those of the laws, the first joint's mass if it has one, the fixture's quantities.
    pub parameters: Vec<Parameter>,
    /// kg for one unit of the mass's coordinate.
    pub mass: Option<f64>,
}

/// Where a fit stands.
pub(super) struct Point {
    pub coordinates: Vec<f64>,
    uncoupled: Arc<Uncoupled>,
    pub predicted: Vec<Complex64>,
    pub objective: f64,
}

impl Point {
    /// The same joints and fixture in the coordinates of other laws.
    pub(super) fn with(&self, coordinates: Vec<f64>) -> Self {
        let (uncoupled, predicted) = (Arc::clone(&self.uncoupled), self.predicted.clone());
        Point { coordinates, uncoupled, predicted, objective: self.objective }
    }
}

/// What the mass and the quantities do to each value, in their order.
pub(super) type Columns = Vec<Vec<Complex64>>;

/// How far a fit goes.
pub(super) struct Course {
    pub steps: usize,
    /// Whether derivatives that it is given were taken at its start.
    pub fresh: bool,
    /// What it has to come near, else it is given up.
    pub limit: Option<Limit>,
}

impl Default for Course {
    fn default() -> Self {
        Course { steps: MOST_STEPS, fresh: false, limit: None }
    }
}

/// A finished fit.
pub(super) struct Fitted {
    pub point: Point,
    pub others: Columns,
}

impl Fitted {
    /// Takes the derivatives by the quantities at the optimum, which those of the fit were taken near, and
    /// goes on where they promise more.
    ///
    /// `None` where there are none.
    pub(super) fn refresh(&mut self, problem: &Problem) -> Option<()> {
        for look in 0.. {
            self.others = problem.other_columns(&self.point)?;
            let promised = problem.promised(&self.point, &self.equations(problem));
            if look == MOST_RESUMPTIONS || promised < problem.needed(self.point.objective) {
                break;
            }
            let here = self.point.with(self.point.coordinates.clone());
            let course = Course { fresh: true, ..Course::default() };
            match problem.fit_from(here, Some(self.others.clone()), course) {
                Some(next) if next.point.objective < self.point.objective => self.point = next.point,
                _ => break,
            }
        }
        Some(())
    }

    pub(super) fn equations(&self, problem: &Problem) -> NormalEquations {
        problem.equations_of(&self.point, &self.others, problem.test.weights)
    }

    /// This fit or a lower one, sought once more from the fixture as stated by stages, where this one creeps:
    /// a law that was refuted has bent the quantities, and from there a valley leads to the optimum which
    /// steps follow by tenths.
    pub(super) fn or_from_afar(mut self, problem: &Problem) -> Option<Self> {
        self.refresh(problem)?;
        if problem.promised(&self.point, &self.equations(problem)) < CREEPS {
            return Some(self);
        }
        let mut start = self.point.coordinates.clone();
        start[problem.own()..].fill(0.0);
        let afar = problem.searched(start).and_then(|mut afar| afar.refresh(problem).map(|()| afar));
        Some(afar.into_iter().fold(self, lower))
    }

    /// How far the coordinates move when each of eight blocks of lines is left out, to first order.
    pub(super) fn jackknifed(&self, problem: &Problem) -> Option<Covariance> {
        let lines = problem.test.setup.recorded.s.len();
        jackknifed_by(lines, problem.test.weights, &self.point.coordinates, |weights| {
            problem.equations_of(&self.point, &self.others, weights).step(0.0)
        })
    }
}

/// The fit that came lower.
pub(super) fn lower(a: Fitted, b: Fitted) -> Fitted {
    if b.point.objective < a.point.objective { b } else { a }
}

impl<'a> Problem<'a> {
    /// Joints of whose stiffness and losses nothing is known beforehand, with a mass of the first if there is
    /// a scale for it (kg).
    pub(super) fn open(test: Test<'a>, laws: Vec<Dynamics>, mass: Option<f64>) -> Self {
        let own = laws.iter().flat_map(open_parameters).collect();
        Problem::of(test, laws, mass, own)
    }

    /// Joints of any laws, with what is known beforehand of their stiffness and losses.
    pub(super) fn lawful(test: Test<'a>, laws: Vec<Dynamics>, mass: Option<f64>) -> Self {
        let own = laws.iter().flat_map(own_parameters).collect();
        Problem::of(test, laws, mass, own)
    }

    fn of(test: Test<'a>, laws: Vec<Dynamics>, mass: Option<f64>, mut parameters: Vec<Parameter>) -> Self {
        parameters.extend(mass.map(|_| mass_parameter()));
        parameters.extend(test.quantities.iter().map(|quantity| quantity.parameter));
        Problem { test, laws, parameters, mass }
    }

    /// The same with the joints' matrices in other forms.
    pub(super) fn with_forms(&self, laws: Vec<Dynamics>) -> Self {
        Problem::open(self.test, laws, self.mass)
    }

    /// The same for values of these weights.
    pub(super) fn weighted<'b>(&self, weights: &'b [f64]) -> Problem<'b>
    where
        'a: 'b,
    {
        let test = Test { weights, ..self.test };
        Problem { test, laws: self.laws.clone(), parameters: self.parameters.clone(), mass: self.mass }
    }

    /// Number of coordinates of the laws.
    pub(super) fn of_laws(&self) -> usize {
        self.laws.iter().map(Dynamics::count).sum()
    }

    /// Number of coordinates before those of the fixture's quantities.
    pub(super) fn own(&self) -> usize {
        self.of_laws() + usize::from(self.mass.is_some())
    }

    /// Each joint's law with the place of its first coordinate.
    pub(super) fn places(&self) -> impl Iterator<Item = (usize, &Dynamics)> {
        self.laws.iter().scan(0, |next, law| {
            let first = *next;
            *next += law.count();
            Some((first, law))
        })
    }

    /// The first joint's mass at these coordinates, kg.
    pub(super) fn mass_at(&self, coordinates: &[f64]) -> f64 {
        self.mass.map_or(0.0, |scale| scale * coordinates[self.of_laws()])
    }

    /// The laws' coordinates with the fixture as stated.
    pub(super) fn whole(&self, own: &[f64]) -> Vec<f64> {
        let mut all = own.to_vec();
        all.resize(self.parameters.len(), 0.0);
        all
    }

    /// Coordinates of the same joints and fixture where K and the damping matrix of the same laws have other
    /// forms.
    pub(super) fn converted(&self, at: &[f64], laws: &[Dynamics]) -> Vec<f64> {
        let own = self.places().zip(laws).flat_map(|((first, law), other)| {
            let own = &at[first..first + law.count()];
            let [k, d, _] = law.matrices(own);
            // K₁ and a time or an exponent stay as they are.
            let rest = &own[law.stiffness.count() + law.damping.count()..];
            [coordinates(other, k, d), rest.to_vec()].concat()
        });
        own.chain(at[self.of_laws()..].iter().copied()).collect()
    }

    fn placed<'b>(&'b self, coordinates: &'b [f64]) -> Vec<Placed<'b>> {
        self.places().map(|(first, law)| law.placed(&coordinates[first..first + law.count()])).collect()
    }

    fn uncoupled(&self, coordinates: &[f64], before: Option<&Uncoupled>) -> Option<Uncoupled> {
        let setup = &self.test.setup;
        let fixture = moved(setup.fixture, self.test.quantities, &coordinates[self.own()..]);
        Uncoupled::of(setup, &fixture, self.mass_at(coordinates), before)
    }

    /// `None` where nothing finite is predicted.
    pub(super) fn point(&self, coordinates: Vec<f64>, before: Option<&Uncoupled>) -> Option<Point> {
        let uncoupled = Arc::new(self.uncoupled(&coordinates, before)?);
        self.coupled(uncoupled, coordinates)
    }

    /// The point where the joints alone are others than `at`, by coordinates of their laws.
    pub(super) fn with_joints(&self, at: &Point, own: &[f64]) -> Option<Point> {
        let coordinates = [own, &at.coordinates[own.len()..]].concat();
        self.coupled(Arc::clone(&at.uncoupled), coordinates)
    }

    fn coupled(&self, uncoupled: Arc<Uncoupled>, coordinates: Vec<f64>) -> Option<Point> {
        let recorded = self.test.setup.recorded;
        let predicted = uncoupled.coupled(recorded, &self.placed(&coordinates), None)?;
        let known = (self.parameters.as_slice(), coordinates.as_slice());
        let objective = recorded.objective(&predicted, self.test.weights, known);
        Some(Point { coordinates, uncoupled, predicted, objective })
    }

    /// Derivatives by the laws' coordinates.
    fn own_columns(&self, at: &Point) -> Columns {
        let mut columns = vec![vec![Complex64::ZERO; at.predicted.len()]; self.of_laws()];
        let laws = self.placed(&at.coordinates);
        // The point was predicted by the same laws, so it has finite derivatives.
        let _ = at.uncoupled.coupled(self.test.setup.recorded, &laws, Some((&laws, &mut columns)));
        columns
    }

    /// Derivatives by the mass and the quantities, by forward differences of what is left without the joints.
    pub(super) fn other_columns(&self, at: &Point) -> Option<Columns> {
        let laws = self.placed(&at.coordinates);
        let column = |index: usize| {
            let mut coordinates = at.coordinates.clone();
            coordinates[index] += QUANTITY_STEP;
            let moved = self.uncoupled(&coordinates, Some(&at.uncoupled))?;
            let mut column = moved.coupled(self.test.setup.recorded, &laws, None)?;
            column
                .iter_mut()
                .zip(&at.predicted)
                .for_each(|(there, here)| *there = (*there - here) / QUANTITY_STEP);
            Some(column)
        };
        (self.of_laws()..at.coordinates.len()).map(column).collect()
    }

    /// Normal equations with these weights.
    pub(super) fn equations_of(
        &self,
        at: &Point,
        others: &[Vec<Complex64>],
        weights: &[f64],
    ) -> NormalEquations {
        self.equations_by(at, (&self.own_columns(at), others), weights)
    }

    /// Normal equations at a point, from derivatives by the laws' coordinates and by the others.
    fn equations_by(
        &self,
        at: &Point,
        (own, others): (&[Vec<Complex64>], &[Vec<Complex64>]),
        weights: &[f64],
    ) -> NormalEquations {
        let columns: Vec<&[Complex64]> = own.iter().chain(others).map(Vec::as_slice).collect();
        let priors = |m: usize| (self.parameters[m].precision, at.coordinates[m]);
        let residual = self.test.setup.recorded.residual(&at.predicted);
        NormalEquations::of_columns(&columns, &residual, weights, |_| false, priors)
    }

    fn moved_by(&self, at: &Point, step: &[f64]) -> Option<Point> {
        let moved = at.coordinates.iter().zip(step).zip(&self.parameters);
        let coordinates = moved.map(|((at, step), parameter)| parameter.clamp(at + step)).collect();
        self.point(coordinates, Some(&at.uncoupled))
    }

    /// Coordinates of `law` by which it comes nearest to what the one joint's law here does at a point, with
    /// what that leaves of the FRFs: the FRFs are taken as linear in the dynamic stiffness, so that
    /// resonances weigh most. K, damping matrix and K₁ alone; `shape` is the law's time or exponent.
    pub(super) fn imitated(&self, at: &Point, law: &Dynamics, shape: f64) -> Option<(Vec<f64>, f64)> {
        let recorded = self.test.setup.recorded;
        let mut columns = self.own_columns(at);
        let mut target = recorded.residual(&at.predicted);
        for (column, coordinate) in columns.iter().zip(&at.coordinates) {
            target.iter_mut().zip(column).for_each(|(value, by)| *value += by * coordinate);
        }
        let matrices = law.count() - law.shapes();
        let mut start = vec![0.0; law.count()];
        start[matrices..].fill(shape);
        columns.resize(law.count(), Vec::new());
        columns.iter_mut().for_each(|column| column.resize(target.len(), Complex64::ZERO));
        let other = [law.placed(&start)];
        at.uncoupled.coupled(recorded, &self.placed(&at.coordinates), Some((&other, &mut columns)))?;
        columns.truncate(matrices);
        let equations =
            NormalEquations::of_columns(&columns, &target, self.test.weights, |_| false, |_| (1e-6, 0.0));
        let found = equations.step(0.0)?;
        let gain: f64 = found.iter().zip(&equations.right).map(|(a, b)| a * b).sum();
        start[..matrices].copy_from_slice(&found);
        Some((start, -gain))
    }

    /// The optimum next to `start`, with derivatives by the quantities known from nearby where there are any.
    pub(super) fn fit(&self, start: Vec<f64>, nearby: Option<Columns>) -> Option<Fitted> {
        self.fit_within(start, nearby, MOST_STEPS)
    }

    /// The same within a number of steps.
    pub(super) fn fit_within(
        &self,
        start: Vec<f64>,
        nearby: Option<Columns>,
        steps: usize,
    ) -> Option<Fitted> {
        self.fit_from(self.point(start, None)?, nearby, Course { steps, ..Course::default() })
    }

    /// The same from a point, by a course of its own.
    pub(super) fn fit_from(&self, start: Point, nearby: Option<Columns>, course: Course) -> Option<Fitted> {
        let floor = self.test.setup.recorded.degrees() as f64;
        let settings = Settings {
            steps: course.steps,
            damping: StepDamping { initial: 1e-6, decrease: 0.03, least: 1e-15, raised: 0.0, most: 1e8 },
            convergence: Convergence { gain: CONVERGED, share: CONVERGED_SHARE, floor },
            reuse: Some(REUSE),
            trust_old: true,
            fresh: course.fresh,
            limit: course.limit,
            curved_valley: CURVED_VALLEY,
            ..Settings::default()
        };
        let end = descend(self, start, nearby, &settings)?;
        Some(Fitted { point: end.point, others: end.derivatives })
    }

    /// A fit by stages in which less and less of the signal counts as noise, so that sharp resonances do not
    /// decide where it goes.
    pub(super) fn searched(&self, start: Vec<f64>) -> Option<Fitted> {
        let mut at = start;
        for share in SIGNAL_AS_NOISE {
            let weights = self.test.setup.recorded.weights_with(share);
            at = self.weighted(&weights).fit(at, None)?.point.coordinates;
        }
        self.fit(at, None)
    }

    /// Decrease of an objective that is worth another step.
    fn needed(&self, objective: f64) -> f64 {
        CONVERGED.max(CONVERGED_SHARE * (objective - self.test.setup.recorded.degrees() as f64))
    }

    /// The objective over what is left of the values by the parameters.
    pub(super) fn per_degree(&self, point: &Point) -> f64 {
        self.test.setup.recorded.per_degree(point.objective, self.own(), &self.parameters)
    }

    /// What the noise is multiplied by so that it explains what is left, correlated from line to line as that
    /// is.
    pub(super) fn inflation(&self, point: &Point) -> f64 {
        self.test.setup.recorded.inflation(self.per_degree(point), &point.predicted)
    }
}

impl LeastSquares for Problem<'_> {
    type Point = Point;
    type Weights = ();
    type Derivatives = Columns;
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Point) {}

    fn objective(&self, at: &Point, _: &()) -> f64 {
        at.objective
    }

    fn derivatives(&self, at: &Point, _: DerivativePrecision) -> Option<Columns> {
        self.other_columns(at)
    }

    fn equations(&self, at: &Point, others: &Columns, _: &()) -> NormalEquations {
        self.equations_of(at, others, self.test.weights)
    }

    fn equations_from(&self, at: &Point, from: &Point, others: &Columns, _: &()) -> NormalEquations {
        self.equations_by(at, (&self.own_columns(from), others), self.test.weights)
    }

    fn stepped(&self, at: &Point, equations: &NormalEquations, damping: f64) -> Option<Point> {
        self.moved_by(at, &equations.bounded_step(damping, &at.coordinates, &self.parameters)?)
    }

    fn shortened(&self, at: &Point, equations: &NormalEquations, share: f64) -> Option<Point> {
        let step = equations.bounded_step(0.0, &at.coordinates, &self.parameters)?;
        self.moved_by(at, &step.iter().map(|step| share * step).collect::<Vec<_>>())
    }

    fn corrected(
        &self,
        at: &Point,
        from: &Point,
        [own, before]: [&NormalEquations; 2],
        share: f64,
    ) -> Option<Point> {
        let earlier = (before, from.coordinates.as_slice());
        self.moved_by(at, &own.correction(&at.coordinates, earlier, share, &self.parameters)?)
    }

    fn promised(&self, at: &Point, equations: &NormalEquations) -> f64 {
        equations.promised(&at.coordinates, &self.parameters)
    }
}
