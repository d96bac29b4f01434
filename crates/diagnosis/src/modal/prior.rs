//! What is known of a hypothesis' coordinates before the recording: normal distributions.

use crate::Hypothesis;
use crate::candidate::Candidate;
use crate::settings::modal::prior::{
    LEAST_OF_LOGARITHM, OF_DASHPOT, OF_HEIGHT, OF_ROTARY_INERTIA, OF_SIZE, UNKNOWN_QUANTITY,
};
use jointscope_fixture::{Effect, Motion, ParameterSpec, Starts};
use jointscope_inference::{Parameter, Transform};

/// Mean and standard deviation of a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Prior {
    pub mean: f64,
    pub std: f64,
}

/// The priors of a hypothesis whose effects go by the names `candidates`, in their order.
pub(crate) fn priors(hypothesis: &Hypothesis, candidates: &[&Candidate]) -> Vec<Prior> {
    let tolerance = |index: usize| {
        let precision = hypothesis.prior(index);
        Prior { mean: 0.0, std: if precision > 0.0 { precision.sqrt().recip() } else { UNKNOWN_QUANTITY } }
    };
    let mut all: Vec<Prior> = (0..hypothesis.tolerances().len()).map(tolerance).collect();
    for (index, candidate) in candidates.iter().enumerate() {
        all.extend(of_effect(hypothesis, index, candidate));
    }
    all
}

/// The priors of a hypothesis each of whose effects goes by one of the names `all`; `None` where one goes by
/// none.
pub(crate) fn priors_among(hypothesis: &Hypothesis, all: &[Candidate]) -> Option<Vec<Prior>> {
    let named = |effect: &Effect| all.iter().find(|candidate| candidate.names(effect));
    let candidates: Option<Vec<&Candidate>> = hypothesis.effects().iter().map(named).collect();
    Some(priors(hypothesis, &candidates?))
}

/// Priors of the free parameters of effect `index`: logarithms over the range of a search's starts, abscissae
/// over the body, sizes of either sign about nothing.
fn of_effect(hypothesis: &Hypothesis, index: usize, candidate: &Candidate) -> Vec<Prior> {
    let spec = candidate.kind.spec();
    let in_series = matches!(spec.parameters[spec.size.parameter].motion, Motion::Logarithm { .. });
    let parameters = spec.parameters.iter().zip(hypothesis.effect_parameters_of(index));
    let prior = |(place, (parameter, moves)): (usize, (&ParameterSpec, &Parameter))| {
        let coordinate = |start: &Vec<f64>| moves.transform.coordinate(start[place]);
        let coordinates: Vec<f64> = candidate.starts.iter().filter_map(coordinate).collect();
        let low = coordinates.iter().copied().reduce(f64::min)?;
        let high = coordinates.iter().copied().reduce(f64::max)?;
        let largest = low.abs().max(high.abs());
        Some(match (moves.transform, parameter.motion) {
            (_, Motion::OfQuantity) => Prior { mean: 0.0, std: moves.precision.sqrt().recip() },
            (Transform::Logarithmic { .. }, _) => {
                Prior { mean: 0.5 * (low + high), std: (0.5 * (high - low)).max(LEAST_OF_LOGARITHM) }
            }
            (_, Motion::AlongBody | Motion::AlongSecondBody) => {
                let (from, to) = (moves.low, moves.high);
                Prior { mean: 0.5 * (from + to), std: (to - from) / 12f64.sqrt() }
            }
            (_, Motion::AcrossBody) => Prior { mean: 0.0, std: OF_HEIGHT },
            // What yields in series may be far stiffer or softer than the joint, and its dashpot with it.
            (_, Motion::NonNegative(_)) if in_series && matches!(parameter.starts, Starts::OfLeading(_)) => {
                Prior { mean: 0.0, std: OF_DASHPOT }
            }
            (_, Motion::NonNegative(_)) if parameter.usual.is_some() => {
                Prior { mean: 0.0, std: moves.transform.coordinate(parameter.usual?)? }
            }
            (_, Motion::NonNegative(_)) if place != spec.size.parameter => {
                let times = if parameter.of_bodies_only { OF_ROTARY_INERTIA } else { OF_DASHPOT };
                Prior { mean: 0.0, std: (times * largest).max(f64::MIN_POSITIVE.sqrt()) }
            }
            _ => Prior { mean: 0.0, std: (OF_SIZE * largest).max(f64::MIN_POSITIVE.sqrt()) },
        })
    };
    parameters.enumerate().filter_map(prior).collect()
}
