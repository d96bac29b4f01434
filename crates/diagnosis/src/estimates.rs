//! The parameters of a finding with their intervals.

use crate::{Fit, Hypothesis, Observation};
use jointscope_fixture::{Effect, ParameterSpec};

/// A parameter of a finding, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The parameter's specification: name and range.
    pub parameter: ParameterSpec,
    /// Its unit, decided by the finding's degree of freedom.
    pub unit: &'static str,
    /// The value.
    pub value: f64,
    /// One standard deviation; `None` where the FRFs do not determine it.
    pub std: Option<f64>,
    /// 95 % interval.
    pub interval: Option<[f64; 2]>,
}

/// The parameters of effect `index` of a fit, with deviations from its `covariance`.
pub(crate) fn estimates(
    hypothesis: &Hypothesis,
    index: usize,
    effect: &Effect,
    covariance: Option<&[f64]>,
    fit: &Fit,
    observation: &Observation,
) -> Vec<Estimate> {
    let n = hypothesis.coordinates.len();
    let first = hypothesis.range_of(index).start;
    let slopes = hypothesis.parameter_slopes(index);
    let widening = fit.scale(observation).sqrt();
    let specs = effect.kind.spec().parameters;
    specs
        .iter()
        .enumerate()
        .map(|(place, parameter)| {
            let value = effect.value(place);
            let slot = slopes.iter().position(|(p, _)| *p == place);
            // A logarithm's deviation is relative: its interval is lopsided.
            let relative = slot.is_some_and(|s| slopes[s].1 == value) && value > 0.0;
            let std = slot.and_then(|s| {
                let coordinate = covariance?[(first + s) * n + first + s].sqrt() * widening;
                (coordinate.is_finite()).then_some((coordinate, coordinate * slopes[s].1.abs()))
            });
            let interval = std.map(|(coordinate, std)| {
                if relative {
                    let factor = (1.96 * coordinate).min(50.0).exp();
                    [value / factor, value * factor]
                } else {
                    [value - 1.96 * std, value + 1.96 * std]
                }
            });
            let unit = parameter.unit_in(effect.dof);
            Estimate { parameter: *parameter, unit, value, std: std.map(|s| s.1), interval }
        })
        .collect()
}
