//! The parameters of a finding with their intervals.

use crate::Hypothesis;
use jointscope_findings::Estimate;
use jointscope_fixture::Effect;
use jointscope_inference::{Covariance, Transform, Z95};

/// The parameters of effect `index` of a hypothesis, with deviations from the coordinates' `covariance`,
/// times `widening`.
pub(crate) fn estimates(
    hypothesis: &Hypothesis,
    index: usize,
    effect: &Effect,
    covariance: Option<&Covariance>,
    widening: f64,
) -> Vec<Estimate> {
    let first = hypothesis.range_of(index).start;
    let within = |estimate: Estimate, transform: Transform, free: usize| {
        let deviation = covariance.map(|covariance| covariance.std(first + free) * widening);
        match (transform, deviation.filter(|deviation| deviation.is_finite())) {
            (Transform::Linear { scale, .. }, Some(deviation)) => estimate.within(deviation * scale),
            (Transform::Logarithmic { scale, .. }, Some(deviation)) => {
                estimate.within_ratio(deviation * scale)
            }
            (Transform::Fixed, _) | (_, None) => estimate,
        }
    };
    estimates_by(hypothesis, index, effect, within)
}

/// The same with the 95 % `intervals` of its free coordinates.
pub(crate) fn estimates_within(
    hypothesis: &Hypothesis,
    index: usize,
    effect: &Effect,
    intervals: &[[f64; 2]],
) -> Vec<Estimate> {
    let within = |estimate: Estimate, transform: Transform, free: usize| {
        let ends = intervals[free].map(|coordinate| transform.value(coordinate).unwrap_or(estimate.value));
        Estimate { std: Some((ends[1] - ends[0]).abs() / (2.0 * Z95)), interval: Some(ends), ..estimate }
    };
    estimates_by(hypothesis, index, effect, within)
}

/// The parameters of effect `index`, those that move `within` what is known of them: by their transforms, and
/// the places of their coordinates among the effect's.
fn estimates_by(
    hypothesis: &Hypothesis,
    index: usize,
    effect: &Effect,
    within: impl Fn(Estimate, Transform, usize) -> Estimate,
) -> Vec<Estimate> {
    let mut free = 0;
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
            let estimate =
                Estimate { unit: effect.unit(place), ..Estimate::of(*parameter, effect.dof, value) };
            if !moves.is_free() {
                return estimate;
            }
            free += 1;
            within(estimate, moves.transform, free - 1)
        })
        .collect()
}
