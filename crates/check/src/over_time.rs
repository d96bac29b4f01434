//! A fixture with effects that are known by frequency only, as near as equations of motion over time come to it.
//!
//! Modes of the model are eigenvalues of these equations. A joint's own mass, which is exact by frequency, is
//! then half of it at each of its ends; losses that are known by frequency only are left out, since they move
//! natural frequencies by the square of a loss factor.

use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_lumped::LumpedError;

/// What `answer` makes of the fixture, or of the nearest one that has a form over time; and the kinds of effects
/// that are not in it as they stand.
///
/// # Errors
/// Those of `answer` that no effect makes.
pub(crate) fn nearest_over_time<T>(
    fixture: &Fixture,
    answer: impl Fn(&Fixture) -> Result<T, LumpedError>,
) -> Result<(T, Vec<&'static str>), LumpedError> {
    let mut nearest = fixture.clone();
    let mut not_as_they_stand = Vec::new();
    loop {
        match answer(&nearest) {
            Err(LumpedError::NotInTime { kind }) => {
                nearest = without(&nearest, kind).ok_or(LumpedError::NotInTime { kind })?;
                not_as_they_stand.push(kind);
            }
            other => return other.map(|answer| (answer, not_as_they_stand)),
        }
    }
}

/// The fixture without its effects of that kind, masses of joints at their ends instead; `None` where it has none.
fn without(fixture: &Fixture, kind: &str) -> Option<Fixture> {
    let (gone, mut physics): (Vec<Effect>, Vec<Effect>) =
        fixture.physics().iter().cloned().partition(|effect| effect.kind.spec().name == kind);
    if gone.is_empty() {
        return None;
    }
    physics.extend(gone.iter().flat_map(|effect| at_its_ends(fixture, effect)));
    fixture.clone().with_physics(physics).ok()
}

/// Half the mass of a joint at each of its ends; nothing of any other effect.
fn at_its_ends(fixture: &Fixture, effect: &Effect) -> Vec<Effect> {
    let Place::Joint(name) = &effect.place else { return Vec::new() };
    let joint = fixture.joints().iter().find(|joint| joint.name == *name);
    let Some(joint) = joint.filter(|_| effect.kind == EffectKind::JointMass) else { return Vec::new() };
    let ends = [joint.from, joint.to].map(|end| &fixture.points()[end]);
    let half = |point: &jointscope_fixture::Point| {
        let body = Place::Body(fixture.bodies()[point.body].name.clone());
        Effect::new(EffectKind::AddedMass, body, None, &[point.x.value, 0.5 * effect.value(0)])
    };
    ends.map(half).into()
}
