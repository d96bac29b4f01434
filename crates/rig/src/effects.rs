//! Picking effects from a fixture's list.

use crate::StructureError;
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};

/// The effects of a kind, wherever they sit.
pub(crate) fn all(effects: &[Effect], kind: EffectKind) -> impl Iterator<Item = &Effect> {
    effects.iter().filter(move |effect| effect.kind == kind)
}

/// The effects of a kind at a place.
pub(crate) fn at(effects: &[Effect], kind: EffectKind, place: Place) -> impl Iterator<Item = &Effect> {
    all(effects, kind).filter(move |effect| effect.place == place)
}

/// A fixture without the effects that depend on amplitude, and these.
pub(crate) fn linear_part(fixture: &Fixture) -> Result<(Fixture, Vec<Effect>), StructureError> {
    let (bent, linear) = fixture.physics().iter().cloned().partition(|effect| effect.kind.is_nonlinear());
    Ok((fixture.clone().with_physics(linear)?, bent))
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
