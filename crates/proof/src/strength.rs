//! How strong an effect is, in the one number by which what it does to the FRFs grows from nothing.

use jointscope_fixture::{Dof, Effect, EffectKind};

/// How the strength of a kind follows from its leading parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Law {
    /// The parameter itself: a mass, a stiffness to ground, a distance, a delay.
    Value,
    /// Its departure from one: a factor.
    FromOne,
    /// Its inverse: the stiffness of a spring in series.
    Inverse,
    /// Its inverse square: a natural frequency, whose compliance counts.
    InverseSquare,
}

/// Position of the leading parameter, and the law of its strength.
fn leading(kind: EffectKind) -> (usize, Law) {
    use EffectKind as Kind;
    match kind {
        Kind::AddedMass | Kind::Support | Kind::AttachedResonator => (1, Law::Value),
        Kind::BodyFlexibility => (0, Law::InverseSquare),
        Kind::InterfaceCompliance | Kind::ShearDeformation => (0, Law::Inverse),
        Kind::ChannelGain | Kind::StiffnessChange => (0, Law::FromOne),
        _ => (0, Law::Value),
    }
}

/// Strength of an effect: zero where it does nothing.
pub(crate) fn strength(effect: &Effect) -> f64 {
    let (parameter, law) = leading(effect.kind);
    let value = effect.value(parameter);
    match law {
        Law::Value => value,
        Law::FromOne => value - 1.0,
        Law::Inverse => value.recip(),
        Law::InverseSquare => value.powi(-2),
    }
}

/// The leading parameter of a strength.
fn parameter_of(law: Law, strength: f64) -> f64 {
    match law {
        Law::Value => strength,
        Law::FromOne => 1.0 + strength,
        Law::Inverse => strength.recip(),
        Law::InverseSquare => strength.abs().sqrt().recip(),
    }
}

/// The effect with another strength. A support's dashpot goes with its spring, an interface's loss stays the share of its spring that it was.
pub(crate) fn with_strength(effect: &Effect, wanted: f64) -> Effect {
    let (parameter, law) = leading(effect.kind);
    let mut other = effect.clone();
    let before = effect.value(parameter);
    let after = parameter_of(law, wanted);
    other.parameters[parameter].value = after;
    let dashpot = match effect.kind {
        EffectKind::Support => Some(2),
        EffectKind::InterfaceCompliance => Some(1),
        _ => None,
    };
    if let Some(dashpot) = dashpot.and_then(|index| other.parameters.get_mut(index)) {
        dashpot.value *= after / before;
    }
    other
}

/// Standard deviation of the strength, given that of the leading parameter.
pub(crate) fn strength_deviation(effect: &Effect, deviation: f64) -> f64 {
    let (parameter, law) = leading(effect.kind);
    let value = effect.value(parameter);
    let slope = match law {
        Law::Value | Law::FromOne => 1.0,
        Law::Inverse => value.powi(-2),
        Law::InverseSquare => 2.0 * value.powi(-3),
    };
    (slope * deviation).abs()
}

/// Position of the leading parameter of a kind.
pub(crate) fn leading_parameter(kind: EffectKind) -> usize {
    leading(kind).0
}

/// What is stated of a strength: the leading parameter, of a factor its departure from one. The weakest spring in series or lowest frequency
/// that does not show is the strongest effect that hides, so for those the figure is an upper end.
pub(crate) fn stated(kind: EffectKind, strength: f64) -> f64 {
    match leading(kind).1 {
        Law::FromOne => strength,
        law => parameter_of(law, strength),
    }
}

/// Whether a smaller effect has the larger parameter.
pub(crate) fn is_inverse(kind: EffectKind) -> bool {
    matches!(leading(kind).1, Law::Inverse | Law::InverseSquare)
}

/// Name and unit of the leading parameter.
pub(crate) fn parameter(kind: EffectKind, dof: Option<Dof>) -> (&'static str, &'static str) {
    let spec = kind.spec().parameters[leading(kind).0];
    match leading(kind).1 {
        Law::FromOne => ("factor − 1", ""),
        _ => (spec.name, spec.unit_in(dof)),
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
