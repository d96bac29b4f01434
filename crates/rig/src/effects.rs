//! Picking effects from a fixture's list.

use jointscope_fixture::{Effect, EffectKind, Place};

/// The effects of a kind, wherever they sit.
pub(crate) fn all(effects: &[Effect], kind: EffectKind) -> impl Iterator<Item = &Effect> {
    effects.iter().filter(move |effect| effect.kind == kind)
}

/// The effects of a kind on a body.
pub(crate) fn all_at_body<'a>(
    effects: &'a [Effect],
    kind: EffectKind,
    body: &'a str,
) -> impl Iterator<Item = &'a Effect> {
    all(effects, kind).filter(move |effect| matches!(&effect.place, Place::Body(name) if name == body))
}

/// The effects of a kind on a joint.
pub(crate) fn all_at_joint<'a>(
    effects: &'a [Effect],
    kind: EffectKind,
    joint: &'a str,
) -> impl Iterator<Item = &'a Effect> {
    all(effects, kind).filter(move |effect| matches!(&effect.place, Place::Joint(name) if name == joint))
}

/// The effects of a kind at a point.
pub(crate) fn all_at_point<'a>(
    effects: &'a [Effect],
    kind: EffectKind,
    point: &'a str,
) -> impl Iterator<Item = &'a Effect> {
    all(effects, kind).filter(move |effect| matches!(&effect.place, Place::Point(name) if name == point))
}

/// Product of the first parameters.
pub(crate) fn product<'a>(effects: impl Iterator<Item = &'a Effect>) -> f64 {
    effects.map(|effect| effect.value(0)).product()
}

/// Sum of the first parameters, +0 of none (the standard sum of nothing is −0, whose inverse is −∞).
pub(crate) fn sum<'a>(effects: impl Iterator<Item = &'a Effect>) -> f64 {
    effects.fold(0.0, |total, effect| total + effect.value(0))
}

/// Sum of the shear compliances 1/κGA of `shear_deformation` effects, 1/N.
pub(crate) fn shear_compliance<'a>(effects: impl Iterator<Item = &'a Effect>) -> f64 {
    effects.fold(0.0, |total, effect| total + effect.value(0).recip())
}
