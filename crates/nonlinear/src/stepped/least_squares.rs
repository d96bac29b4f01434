//! Least squares of a few parameters, derivatives by central differences.

use crate::identification::misfit::products;
use crate::settings::level_fit::{DIFFERENCE, STEP_DAMPING};
use jointscope_inference::{DerivativePrecision, LeastSquares, NormalEquations, Settings, descend, dot};

/// What residuals a set of parameters leaves; `None` where they are not finite.
pub(crate) type Residual<'a> = &'a dyn Fn(&[f64]) -> Option<Vec<f64>>;

/// Parameters and what they leave.
#[derive(Debug, Clone)]
pub(crate) struct Iterate {
    pub x: Vec<f64>,
    residual: Vec<f64>,
    /// Sum of squared residuals.
    pub cost: f64,
}

/// Goes down from `start`, parameters measured in `scale`; `None` where nothing finite is found.
pub(crate) fn minimum(residual: Residual, start: &[f64], scale: &[f64]) -> Option<Iterate> {
    let problem = Problem { residual, scale };
    let settings = Settings { damping: STEP_DAMPING, ..Settings::default() };
    descend(&problem, problem.at(start.to_vec())?, None, &settings).map(|fit| fit.point)
}

/// Standard deviations of the parameters at `x` where the residuals' variance is what they leave a degree of
/// freedom; `None` where a combination is free.
pub(crate) fn deviations(residual: Residual, x: &[f64], scale: &[f64], degrees: usize) -> Option<Vec<f64>> {
    let problem = Problem { residual, scale };
    let point = problem.at(x.to_vec())?;
    let derivatives = problem.derivatives(&point, DerivativePrecision::Exact)?;
    let covariance = problem.equations(&point, &derivatives, &()).covariance()?;
    let variance = point.cost / degrees as f64;
    let std = |i: usize| (covariance.at(i, i) * variance).sqrt() * scale[i];
    Some((0..x.len()).map(std).collect::<Vec<f64>>()).filter(|all| all.iter().all(|s| s.is_finite()))
}

struct Problem<'a> {
    residual: Residual<'a>,
    scale: &'a [f64],
}

impl Problem<'_> {
    fn at(&self, x: Vec<f64>) -> Option<Iterate> {
        let residual = (self.residual)(&x)?;
        let cost = dot(&residual, &residual);
        cost.is_finite().then_some(Iterate { x, residual, cost })
    }
}

impl LeastSquares for Problem<'_> {
    type Point = Iterate;
    type Weights = ();
    type Derivatives = Vec<Vec<f64>>;
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Iterate) {}

    fn objective(&self, point: &Iterate, _: &()) -> f64 {
        point.cost
    }

    fn derivatives(&self, point: &Iterate, _: DerivativePrecision) -> Option<Vec<Vec<f64>>> {
        let column = |p: usize| {
            let moved = |sign: f64| {
                let mut to = point.x.clone();
                to[p] += sign * DIFFERENCE * self.scale[p];
                (self.residual)(&to)
            };
            let (up, down) = (moved(1.0)?, moved(-1.0)?);
            Some(up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * DIFFERENCE)).collect())
        };
        (0..point.x.len()).map(column).collect()
    }

    fn equations(&self, point: &Iterate, columns: &Vec<Vec<f64>>, _: &()) -> NormalEquations {
        let right = columns.iter().map(|column| -dot(column, &point.residual)).collect();
        NormalEquations { order: columns.len(), information: products(columns), right }
    }

    fn stepped(&self, point: &Iterate, equations: &NormalEquations, damping: f64) -> Option<Iterate> {
        let step = equations.step(damping)?;
        self.at(point.x.iter().zip(&step).zip(self.scale).map(|((x, d), s)| x + d * s).collect())
    }
}
