//! The fit itself: a law's coordinates, perhaps the joint's mass, and the fixture's uncertain quantities.

use super::law::Dynamics;
use super::quantities::{Uncertain, moved};
use super::recorded::Recorded;
use super::uncoupled::Uncoupled;
use crate::Sides;
use jointscope_fixture::Fixture;
use jointscope_inference::{
    Convergence, Damping, LeastSquares, NormalEquations, Parameter, Precision, Settings, descend,
};
use num_complex::Complex64;
use std::sync::Arc;

/// What a joint is fitted to, whatever its law.
pub(super) struct Test<'a> {
    pub recorded: &'a Recorded,
    pub fixture: &'a Fixture,
    pub joint: &'a str,
    pub quantities: &'a [Uncertain],
    /// 2/σ², divided by what the model's error inflates the noise by.
    pub weights: &'a [f64],
}

/// A law to be fitted to a test.
pub(super) struct Problem<'a> {
    pub test: &'a Test<'a>,
    pub law: Dynamics,
    /// Coordinates: those of the law, the joint's mass if it has one, the fixture's quantities.
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
    /// The same joint and fixture in the coordinates of another law.
    pub fn with(&self, coordinates: Vec<f64>) -> Self {
        let (uncoupled, predicted) = (Arc::clone(&self.uncoupled), self.predicted.clone());
        Point { coordinates, uncoupled, predicted, objective: self.objective }
    }
}

/// What the mass and the quantities do to each value, in their order.
pub(super) type Columns = Vec<Vec<Complex64>>;

/// Step of forward differences by a quantity, in standard deviations: resonances bend within a tenth of one.
pub(super) const DIFFERENCE: f64 = 1e-3;
/// Share of a promised decrease below which a step follows a bent valley: resonances tie the joint to the blocks along one.
const BENT: f64 = 0.5;
/// Steps of a fit at the most.
pub(super) const STEPS: usize = 80;
/// Change of χ² below which a fit has converged: a thousandth of what one standard deviation makes.
const CONVERGED: f64 = 1e-3;
/// The same as a share of what χ² exceeds noise by: what the model gets wrong is counted as noise anyway.
const NEGLIGIBLE: f64 = 1e-4;
/// Differences by quantities serve for as long as steps gain this share of the first one's.
const REUSE: f64 = 0.02;

impl<'a> Problem<'a> {
    /// Number of coordinates before those of the fixture's quantities.
    pub fn own(&self) -> usize {
        self.law.count() + usize::from(self.mass.is_some())
    }

    /// The joint's mass at these coordinates, kg.
    pub fn mass_at(&self, coordinates: &[f64]) -> f64 {
        self.mass.map_or(0.0, |scale| scale * coordinates[self.law.count()])
    }

    fn uncoupled(&self, coordinates: &[f64], before: Option<&Uncoupled>) -> Option<Uncoupled> {
        let fixture = moved(self.test.fixture, self.test.quantities, &coordinates[self.own()..]);
        let sides = Sides::of(&fixture, Some(self.test.joint)).ok()?;
        Uncoupled::of(self.test.recorded, &sides, self.mass_at(coordinates), before)
    }

    /// `None` where nothing finite is predicted.
    pub fn point(&self, coordinates: Vec<f64>, before: Option<&Uncoupled>) -> Option<Point> {
        let uncoupled = Arc::new(self.uncoupled(&coordinates, before)?);
        let law = self.law.placed(&coordinates[..self.law.count()]);
        let predicted = uncoupled.coupled(self.test.recorded, &law, None)?;
        let known = (self.parameters.as_slice(), coordinates.as_slice());
        let objective = self.test.recorded.objective(&predicted, self.test.weights, known);
        Some(Point { coordinates, uncoupled, predicted, objective })
    }

    /// Derivatives by the law's coordinates.
    fn own_columns(&self, at: &Point) -> Columns {
        let mut columns = vec![vec![Complex64::ZERO; at.predicted.len()]; self.law.count()];
        let law = self.law.placed(&at.coordinates[..self.law.count()]);
        // The point was predicted by the same law, so it has finite derivatives.
        let _ = at.uncoupled.coupled(self.test.recorded, &law, Some((&law, &mut columns)));
        columns
    }

    /// Derivatives by the mass and the quantities, by forward differences of the sides alone.
    pub fn other_columns(&self, at: &Point) -> Option<Columns> {
        let law = self.law.placed(&at.coordinates[..self.law.count()]);
        let column = |index: usize| {
            let mut coordinates = at.coordinates.clone();
            coordinates[index] += DIFFERENCE;
            let moved = self.uncoupled(&coordinates, Some(&at.uncoupled))?;
            let there = moved.coupled(self.test.recorded, &law, None)?;
            Some(there.iter().zip(&at.predicted).map(|(t, h)| (t - h) / DIFFERENCE).collect())
        };
        (self.law.count()..at.coordinates.len()).map(column).collect()
    }

    /// Normal equations with these weights.
    pub fn equations_of(&self, at: &Point, others: &[Vec<Complex64>], weights: &[f64]) -> NormalEquations {
        let own = self.own_columns(at);
        let columns: Vec<&[Complex64]> = own.iter().chain(others).map(Vec::as_slice).collect();
        let priors = |m: usize| (self.parameters[m].precision, at.coordinates[m]);
        NormalEquations::of_columns(
            &columns,
            &self.test.recorded.residual(&at.predicted),
            weights,
            |_| false,
            priors,
        )
    }

    fn moved_by(&self, at: &Point, step: &[f64]) -> Option<Point> {
        let moved = at.coordinates.iter().zip(step).zip(&self.parameters);
        let coordinates = moved.map(|((at, step), parameter)| parameter.clamp(at + step)).collect();
        self.point(coordinates, Some(&at.uncoupled))
    }

    /// Coordinates of `law` by which it comes nearest to what the law here does at a point, with what that leaves of the FRFs: the FRFs are taken
    /// as linear in the dynamic stiffness, so that resonances weigh most. K, damping matrix and K₁ alone; `shape` is the law's time or exponent.
    pub fn imitated(&self, at: &Point, law: &Dynamics, shape: f64) -> Option<(Vec<f64>, f64)> {
        let own = &at.coordinates[..self.law.count()];
        let here = self.law.placed(own);
        let mut columns = self.own_columns(at);
        let mut target = self.test.recorded.residual(&at.predicted);
        for (column, coordinate) in columns.iter().zip(own) {
            target.iter_mut().zip(column).for_each(|(value, by)| *value += by * coordinate);
        }
        let matrices = law.count() - law.shapes();
        let mut start = vec![0.0; law.count()];
        start[matrices..].fill(shape);
        columns.resize(law.count(), Vec::new());
        columns.iter_mut().for_each(|column| column.resize(target.len(), Complex64::ZERO));
        let other = law.placed(&start);
        at.uncoupled.coupled(self.test.recorded, &here, Some((&other, &mut columns)))?;
        columns.truncate(matrices);
        let equations =
            NormalEquations::of_columns(&columns, &target, self.test.weights, |_| false, |_| (1e-6, 0.0));
        let found = equations.step(0.0)?;
        let gain: f64 = found.iter().zip(&equations.right).map(|(a, b)| a * b).sum();
        start[..matrices].copy_from_slice(&found);
        Some((start, -gain))
    }

    /// The optimum next to `start`, with derivatives by the quantities known from nearby where there are any.
    pub fn fit(&self, start: Vec<f64>, nearby: Option<Columns>) -> Option<(Point, Columns)> {
        self.fit_within(start, nearby, STEPS)
    }

    /// The same within a number of steps.
    pub fn fit_within(
        &self,
        start: Vec<f64>,
        nearby: Option<Columns>,
        steps: usize,
    ) -> Option<(Point, Columns)> {
        let start = self.point(start, None)?;
        let settings = Settings { steps, ..settings(self.test.recorded) };
        let end = descend(self, start, nearby, &settings)?;
        Some((end.point, end.derivatives))
    }
}

/// Decrease of an objective that is worth another step.
pub(super) fn needed(recorded: &Recorded, objective: f64) -> f64 {
    CONVERGED.max(NEGLIGIBLE * (objective - recorded.degrees() as f64))
}

/// How a fit goes down.
pub(super) fn settings(recorded: &Recorded) -> Settings {
    Settings {
        steps: STEPS,
        damping: Damping { initial: 1e-6, decrease: 0.03, least: 1e-15, raised: 0.0, most: 1e8 },
        convergence: Convergence { gain: CONVERGED, share: NEGLIGIBLE, floor: recorded.degrees() as f64 },
        reuse: Some(REUSE),
        trust_old: true,
        bent: BENT,
        ..Settings::default()
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

    fn derivatives(&self, at: &Point, _: Precision) -> Option<Columns> {
        self.other_columns(at)
    }

    fn equations(&self, at: &Point, others: &Columns, _: &()) -> NormalEquations {
        self.equations_of(at, others, self.test.weights)
    }

    fn stepped(&self, at: &Point, equations: &NormalEquations, damping: f64) -> Option<Point> {
        let step = equations.bounded_step(damping, &at.coordinates, &self.parameters)?;
        self.moved_by(at, &step)
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
