//! The parameters of a finding with their intervals.

use crate::{Fit, Observation};
use jointscope_findings::Estimate;
use jointscope_fixture::Effect;
use jointscope_inference::{Covariance, Transform};

/// The parameters of effect `index` of a fit, with deviations from its `covariance`.
pub(crate) fn estimates(
    fit: &Fit,
    index: usize,
    effect: &Effect,
    covariance: Option<&Covariance>,
    observation: &Observation,
) -> Vec<Estimate> {
    let mut coordinate = fit.hypothesis.range_of(index).start;
    let widening = fit.inflation(observation).sqrt();
    let moves = fit.hypothesis.effect_parameters_of(index).iter();
    effect
        .kind
        .spec()
        .parameters
        .iter()
        .zip(moves)
        .enumerate()
        .map(|(place, (parameter, moves))| {
            let value = effect.value(place);
            let deviation = moves.is_free().then(|| {
                coordinate += 1;
                Some(covariance?.std(coordinate - 1) * widening).filter(|deviation| deviation.is_finite())
            });
            let estimate = Estimate::of(*parameter, effect.dof, value);
            match (moves.transform, deviation.flatten()) {
                (Transform::Fixed, _) | (_, None) => estimate,
                (Transform::Linear { scale, .. }, Some(deviation)) => estimate.within(deviation * scale),
                (Transform::Logarithmic { scale, .. }, Some(deviation)) => {
                    estimate.within_ratio(deviation * scale)
                }
            }
        })
        .collect()
}
