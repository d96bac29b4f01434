//! The two sides of a joint: whose inertia its force moves.

use crate::ForceStateError;
use jointscope_fixture::{EffectKind, Fixture, Joint, Place};

/// Bodies (by index) beyond a joint's far end, and those beyond its near end.
pub(super) fn sides(fixture: &Fixture, joint: &Joint) -> Result<[Vec<usize>; 2], ForceStateError> {
    let far = beyond(fixture, joint, joint.to);
    if far.contains(&fixture.points()[joint.from].body) {
        return Err(ForceStateError::Loop { joint: joint.name.clone() });
    }
    Ok([far, beyond(fixture, joint, joint.from)])
}

fn beyond(fixture: &Fixture, joint: &Joint, point: usize) -> Vec<usize> {
    let body = |p: usize| fixture.points()[p].body;
    let mut reached = vec![body(point)];
    let mut next = 0;
    while let Some(&here) = reached.get(next) {
        for other in fixture.joints().iter().filter(|j| j.name != joint.name) {
            for (a, b) in [(other.from, other.to), (other.to, other.from)] {
                if body(a) == here && !reached.contains(&body(b)) {
                    reached.push(body(b));
                }
            }
        }
        next += 1;
    }
    reached
}

/// Whether nothing but joints holds these bodies.
pub(super) fn free(fixture: &Fixture, bodies: &[usize]) -> bool {
    fixture.supports().iter().all(|support| !bodies.contains(&fixture.support_place(support).0))
}

/// Refuses effects by which bodies bear more than their inertia, signals are not what sensors felt, or a joint's linear part is no
/// stiffness.
pub(super) fn check_effects(fixture: &Fixture) -> Result<(), ForceStateError> {
    let known = |kind: EffectKind| {
        matches!(
            kind,
            EffectKind::AddedMass
                | EffectKind::StiffnessChange
                | EffectKind::PointOffset
                | EffectKind::CubicStiffness
                | EffectKind::Friction
                | EffectKind::Gap
        )
    };
    match fixture.physics().iter().find(|effect| !known(effect.kind)) {
        Some(effect) => Err(ForceStateError::Effect {
            kind: effect.kind.name().to_owned(),
            place: effect.place.to_string(),
        }),
        None => Ok(()),
    }
}

/// Factor on a joint's stiffness that the fixture's effects state.
pub(super) fn stiffness_factor(fixture: &Fixture, joint: &str) -> f64 {
    let here = |place: &Place| matches!(place, Place::Joint(name) if name == joint);
    let changes = fixture.physics().iter();
    changes.filter(|e| e.kind == EffectKind::StiffnessChange && here(&e.place)).map(|e| e.value(0)).product()
}

/// Abscissa at which a point really lies, m.
pub(super) fn abscissa(fixture: &Fixture, point: &jointscope_fixture::Point) -> f64 {
    let here = |place: &Place| matches!(place, Place::Point(name) if *name == point.name);
    let offsets = fixture.physics().iter();
    point.x.value
        + offsets
            .filter(|e| e.kind == EffectKind::PointOffset && here(&e.place))
            .map(|e| e.value(0))
            .sum::<f64>()
}
