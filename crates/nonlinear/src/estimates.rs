//! The parameters of an amplitude-dependent effect with their intervals.

use crate::RestoringLaw;
use crate::settings::judgement::VAGUE;
use jointscope_findings::Estimate;
use jointscope_fixture::{Effect, ParameterSpec};

/// The parameters of an effect known to these standard deviations: of the logarithm of what is positive, of
/// the value of a cubic stiffness. `inexact` is the share of every value that the method itself leaves open.
pub(crate) fn estimates(effect: &Effect, std: &[Option<f64>], inexact: f64) -> Vec<Estimate> {
    let positive = RestoringLaw::of(effect).is_none_or(|law| law.is_positive());
    let of = |(index, parameter): (usize, &ParameterSpec)| {
        let value = effect.value(index);
        let estimate = Estimate::of(*parameter, effect.dof, value);
        let inexact = inexact * if positive { 1.0 } else { value };
        match std.get(index).copied().flatten().map(|std| std.hypot(inexact)) {
            Some(std) if positive && std < VAGUE => estimate.within_ratio(std),
            Some(std) if !positive && std.is_finite() => estimate.within(std),
            _ => estimate,
        }
    };
    effect.kind.spec().parameters.iter().enumerate().map(of).collect()
}
