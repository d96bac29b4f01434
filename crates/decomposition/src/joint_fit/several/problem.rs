//! The fit itself: the coordinates of every joint's law, then the fixture's uncertain quantities.

use super::super::law::{Dynamics, Placed};
use super::super::problem::{Columns, DIFFERENCE, STEPS, settings};
use super::super::quantities::{Uncertain, moved};
use super::super::recorded::Recorded;
use super::free::Free;
use jointscope_fixture::Fixture;
use jointscope_inference::{LeastSquares, NormalEquations, Parameter, Precision, Settings, descend};
use num_complex::Complex64;
use std::sync::Arc;

/// What joints are fitted to, whatever their laws.
pub(super) struct Test<'a> {
    pub recorded: &'a Recorded,
    pub fixture: &'a Fixture,
    pub joints: &'a [usize],
    pub quantities: &'a [Uncertain],
    /// 2/σ², divided by what the model's error inflates the noise by.
    pub weights: &'a [f64],
}

/// Laws to be fitted to a test, one a joint.
pub(super) struct Problem<'a> {
    pub test: &'a Test<'a>,
    pub laws: Vec<Dynamics>,
    pub parameters: Vec<Parameter>,
}

/// Where a fit stands.
pub(super) struct Point {
    pub coordinates: Vec<f64>,
    free: Arc<Free>,
    pub predicted: Vec<Complex64>,
    pub objective: f64,
}

impl Problem<'_> {
    /// Number of coordinates before those of the fixture's quantities.
    pub fn own(&self) -> usize {
        self.laws.iter().map(Dynamics::count).sum()
    }

    /// Each joint's law with the place of its first coordinate.
    pub fn places(&self) -> impl Iterator<Item = (usize, &Dynamics)> {
        self.laws.iter().scan(0, |next, law| {
            let first = *next;
            *next += law.count();
            Some((first, law))
        })
    }

    fn placed<'b>(&'b self, coordinates: &'b [f64]) -> Vec<Placed<'b>> {
        self.places().map(|(first, law)| law.placed(&coordinates[first..first + law.count()])).collect()
    }

    fn free(&self, coordinates: &[f64]) -> Option<Free> {
        let fixture = moved(self.test.fixture, self.test.quantities, &coordinates[self.own()..]);
        Free::of(self.test.recorded, &fixture, self.test.joints)
    }

    /// `None` where nothing finite is predicted.
    pub fn point(&self, coordinates: Vec<f64>) -> Option<Point> {
        let free = Arc::new(self.free(&coordinates)?);
        let predicted = free.coupled(self.test.recorded, &self.placed(&coordinates), None)?;
        let known = (self.parameters.as_slice(), coordinates.as_slice());
        let objective = self.test.recorded.objective(&predicted, self.test.weights, known);
        Some(Point { coordinates, free, predicted, objective })
    }

    /// Derivatives by the quantities, by forward differences of the fixture without its joints.
    pub fn other_columns(&self, at: &Point) -> Option<Columns> {
        let laws = self.placed(&at.coordinates);
        let column = |index: usize| {
            let mut coordinates = at.coordinates.clone();
            coordinates[index] += DIFFERENCE;
            let there = self.free(&coordinates)?.coupled(self.test.recorded, &laws, None)?;
            Some(there.iter().zip(&at.predicted).map(|(t, h)| (t - h) / DIFFERENCE).collect())
        };
        (self.own()..at.coordinates.len()).map(column).collect()
    }

    /// Normal equations with these weights.
    pub fn equations_of(&self, at: &Point, others: &[Vec<Complex64>], weights: &[f64]) -> NormalEquations {
        let mut own = vec![vec![Complex64::ZERO; at.predicted.len()]; self.own()];
        // The point was predicted by the same laws, so it has finite derivatives.
        let _ = at.free.coupled(self.test.recorded, &self.placed(&at.coordinates), Some(&mut own));
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

    /// The same joints and fixture in the coordinates of other laws.
    pub fn relabelled(at: &Point, coordinates: Vec<f64>) -> Point {
        let (free, predicted) = (Arc::clone(&at.free), at.predicted.clone());
        Point { coordinates, free, predicted, objective: at.objective }
    }

    fn moved_by(&self, at: &Point, step: &[f64]) -> Option<Point> {
        let moved = at.coordinates.iter().zip(step).zip(&self.parameters);
        self.point(moved.map(|((at, step), parameter)| parameter.clamp(at + step)).collect())
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
        let start = self.point(start)?;
        let settings = Settings { steps, ..settings(self.test.recorded) };
        let end = descend(self, start, nearby, &settings)?;
        Some((end.point, end.derivatives))
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
