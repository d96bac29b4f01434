//! The parameters of a finding with their intervals.

use crate::Hypothesis;
use jointscope_findings::Estimate;
use jointscope_fixture::Effect;
use jointscope_inference::{Covariance, Transform};

/// The parameters of effect `index` of a hypothesis, with deviations from the coordinates' `covariance`, times `widening`.
pub(crate) fn estimates(
    hypothesis: &Hypothesis,
    index: usize,
    effect: &Effect,
    covariance: Option<&Covariance>,
    widening: f64,
) -> Vec<Estimate> {
    let mut coordinate = hypothesis.range_of(index).start;
    let moves = hypothesis.effect_parameters_of(index).iter();
    effect
        .kind
        .spec()
        .parameters
        .iter()
        .zip(moves)
        .enumerate()
        .filter(|(place, _)| effect.has_parameter(*place))
        .map(|(place, (parameter, moves))| {
            let value = effect.value(place);
            let deviation = moves.is_free().then(|| {
                coordinate += 1;
                Some(covariance?.std(coordinate - 1) * widening).filter(|deviation| deviation.is_finite())
            });
            let estimate =
                Estimate { unit: effect.unit(place), ..Estimate::of(*parameter, effect.dof, value) };
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
