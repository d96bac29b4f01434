//! How strong an effect is, in the one number by which what it does to the FRFs grows from nothing.

use jointscope_fixture::{Dof, Effect, EffectKind, Size, SizeLaw};

fn size_of(kind: EffectKind) -> Size {
    kind.spec().size
}

/// Strength of an effect: zero where it does nothing.
pub(crate) fn strength(effect: &Effect) -> f64 {
    let size = size_of(effect.kind);
    size.law.size(effect.value(size.parameter))
}

/// The effect with another strength. A support's dashpot goes with its spring, an interface's loss stays the
/// share of its spring that it was.
pub(crate) fn with_strength(effect: &Effect, wanted: f64) -> Effect {
    let size = size_of(effect.kind);
    let mut other = effect.clone();
    let before = effect.value(size.parameter);
    let after = size.law.parameter(wanted);
    other.parameters[size.parameter].value = after;
    if let Some(dashpot) = size.dashpot.and_then(|index| other.parameters.get_mut(index)) {
        dashpot.value *= after / before;
    }
    other
}

/// Standard deviation of the strength, given that of the leading parameter.
pub(crate) fn strength_deviation(effect: &Effect, deviation: f64) -> f64 {
    let size = size_of(effect.kind);
    (size.law.slope(effect.value(size.parameter)) * deviation).abs()
}

/// Position of the leading parameter of a kind.
pub(crate) fn leading_parameter(kind: EffectKind) -> usize {
    size_of(kind).parameter
}

/// What is stated of a strength: the leading parameter, of a factor its departure from one. The weakest
/// spring in series or lowest frequency that does not show is the strongest effect that hides, so for those
/// the figure is an upper end.
pub(crate) fn stated(kind: EffectKind, strength: f64) -> f64 {
    match size_of(kind).law {
        SizeLaw::FromOne => strength,
        law => law.parameter(strength),
    }
}

/// Whether a smaller effect has the larger parameter.
pub(crate) fn is_inverse(kind: EffectKind) -> bool {
    size_of(kind).law.is_inverse()
}

/// Name and unit of the leading parameter.
pub(crate) fn parameter(kind: EffectKind, dof: Option<Dof>) -> (&'static str, &'static str) {
    let leading = &kind.spec().parameters[leading_parameter(kind)];
    match size_of(kind).law {
        SizeLaw::FromOne => ("factor − 1", ""),
        _ => (leading.name, leading.unit_in(dof)),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_fixture::Place;

    #[test]
    fn an_effect_of_a_given_strength_has_it() {
        for kind in EffectKind::ALL {
            let values: Vec<f64> = kind.spec().parameters.iter().map(|_| 0.3).collect();
            let effect = Effect::new(kind, Place::All, None, &values);
            let other = with_strength(&effect, 0.5 * strength(&effect));
            assert!((strength(&other) / strength(&effect) - 0.5).abs() < 1e-12, "{}", kind.name());
        }
    }

    #[test]
    fn a_deviation_of_the_parameter_is_one_of_the_strength() {
        for kind in [EffectKind::AddedMass, EffectKind::InterfaceCompliance, EffectKind::BodyFlexibility] {
            let values: Vec<f64> = kind.spec().parameters.iter().map(|_| 40.0).collect();
            let effect = Effect::new(kind, Place::All, None, &values);
            let mut moved = effect.clone();
            moved.parameters[leading_parameter(kind)].value += 1e-4;
            let change = (strength(&moved) - strength(&effect)).abs();
            assert!((strength_deviation(&effect, 1e-4) / change - 1.0).abs() < 1e-4, "{}", kind.name());
        }
    }
}
