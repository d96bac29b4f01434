//! One line's scalar, eliminated by weighted least squares over the FRFs.

use super::pattern::RationalResponse;
use crate::settings::location::scalar::{DAMPING, ENOUGH, MOST_STEPS, STARTS};
use jointscope_inference::{DerivativePrecision, LeastSquares, Settings, descend};
use num_complex::Complex64;

/// The scalar that fits the line's FRFs best; zero where the pattern vanishes.
pub(super) fn eliminated(
    responses: &[RationalResponse],
    measured: &[Complex64],
    weights: &[f64],
    neighbour: Complex64,
) -> Complex64 {
    if responses.iter().all(RationalResponse::is_linear) {
        let (mut size, mut along) = (0.0, Complex64::ZERO);
        for ((response, measured), weight) in responses.iter().zip(measured).zip(weights) {
            size += weight * response.linear.norm_sqr();
            along += response.linear.conj() * *weight * (measured - response.start);
        }
        return if size > 0.0 { along / size } else { Complex64::ZERO };
    }
    let mut best = newton(responses, measured, weights, neighbour);
    if best.1 < ENOUGH * 2.0 * responses.len() as f64 {
        return best.0;
    }
    let others = [0.0].into_iter().chain(STARTS).map(|re| Complex64::new(re, 0.0));
    for start in others.filter(|start| *start != neighbour) {
        let other = newton(responses, measured, weights, start);
        if other.1 < best.1 {
            best = other;
        }
    }
    best.0
}

/// The scalar's fit from one start; with what is left of the weighted squares.
fn newton(
    responses: &[RationalResponse],
    measured: &[Complex64],
    weights: &[f64],
    start: Complex64,
) -> (Complex64, f64) {
    let settings = Settings { steps: MOST_STEPS, damping: DAMPING, ..Settings::default() };
    let line = Line { responses, measured, weights };
    let left = line.objective(&start, &());
    descend(&line, start, None, &settings).map_or((start, left), |end| (end.point, end.objective))
}

/// One line's FRFs as functions of one complex scalar.
struct Line<'a> {
    responses: &'a [RationalResponse],
    measured: &'a [Complex64],
    weights: &'a [f64],
}

impl LeastSquares for Line<'_> {
    type Point = Complex64;
    type Weights = ();
    type Derivatives = ();
    /// (information, minus half the gradient).
    type Equations = (f64, Complex64);
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Complex64) {}

    fn objective(&self, z: &Complex64, _: &()) -> f64 {
        let terms = self.responses.iter().zip(self.measured).zip(self.weights);
        terms.map(|((response, measured), weight)| weight * (measured - response.at(*z)).norm_sqr()).sum()
    }

    fn derivatives(&self, _: &Complex64, _: DerivativePrecision) -> Option<()> {
        Some(())
    }

    fn equations(&self, z: &Complex64, _: &(), _: &()) -> (f64, Complex64) {
        let (mut size, mut along) = (0.0, Complex64::ZERO);
        for ((response, measured), weight) in self.responses.iter().zip(self.measured).zip(self.weights) {
            let (value, slope) = response.with_slope(*z);
            size += weight * slope.norm_sqr();
            along += slope.conj() * *weight * (measured - value);
        }
        (size, along)
    }

    fn stepped(&self, z: &Complex64, (size, along): &(f64, Complex64), damping: f64) -> Option<Complex64> {
        (*size > 0.0).then(|| z + along / (size * (1.0 + damping)))
    }
}
