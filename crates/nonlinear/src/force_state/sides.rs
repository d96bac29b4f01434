//! The two sides of a joint: whose inertia its force moves.

use crate::ForceStateError;
use jointscope_fixture::{Effect, EffectKind, Fixture, Joint};

/// Bodies (by index) beyond a joint's far end, and those beyond its near end.
pub(super) fn sides(fixture: &Fixture, joint: &Joint) -> Result<[Vec<usize>; 2], ForceStateError> {
    let far = beyond(fixture, joint, joint.to);
    if far.contains(&fixture.points()[joint.from].body) {
        return Err(ForceStateError::Loop(joint.name.clone()));
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

/// Refuses effects by which bodies bear more than their inertia, signals are not what sensors felt, or a
/// joint's linear part is no stiffness.
pub(super) fn check_effects(fixture: &Fixture) -> Result<(), ForceStateError> {
    use EffectKind::{AddedMass, PointOffset, StiffnessChange};
    let known =
        |kind: EffectKind| kind.is_nonlinear() || matches!(kind, AddedMass | StiffnessChange | PointOffset);
    match fixture.physics().iter().find(|effect| !known(effect.kind)) {
        Some(Effect { kind, place, .. }) => {
            Err(ForceStateError::Effect { kind: kind.name(), place: place.to_string() })
        }
        None => Ok(()),
    }
}
