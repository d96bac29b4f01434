//! Supports: springs and dashpots to ground, and which of them the modes hold.
//!
//! Damping ratios of an assembly as it stands are those of its modes on their supports: the supports' springs
//! are then a part of the matrices that these modes belong to. Otherwise, and their dashpots always, supports
//! are a change of low rank.

use crate::Station;
use jointscope_fixture::{Damping, Dof, Fixture, RatiosOf};

/// A spring and a dashpot to ground in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Held {
    pub station: Station,
    /// N/m or N·m/rad.
    pub stiffness: f64,
    /// N·s/m or N·m·s/rad.
    pub damping: f64,
}

/// The springs and dashpots of all supports, those left out that are neither.
pub(crate) fn supports(fixture: &Fixture) -> impl Iterator<Item = Held> {
    fixture.supports().iter().flat_map(|support| {
        let (body, x) = fixture.support_place(support);
        let value = |quantity: Option<jointscope_fixture::Quantity>| quantity.map_or(0.0, |q| q.value);
        let of =
            move |dof, stiffness, damping| Held { station: Station { body, x, dof }, stiffness, damping };
        let both = [
            of(Dof::Translation, support.stiffness.value, value(support.damping)),
            of(Dof::Rotation, value(support.rotational_stiffness), value(support.rotational_damping)),
        ];
        both.into_iter().filter(|held| held.stiffness != 0.0 || held.damping != 0.0)
    })
}

/// What the modes hold of all supports: nothing where they are those of the assembly without.
pub(crate) fn held_by_modes(fixture: &Fixture) -> impl Iterator<Item = Held> {
    let holds = in_the_modes(fixture);
    supports(fixture).filter(move |_| holds)
}

/// Whether the modes are those of the assembly on its supports.
pub(crate) fn in_the_modes(fixture: &Fixture) -> bool {
    let as_it_stands = matches!(fixture.damping(), Damping::ModalRatios { of: RatiosOf::AsItStands, .. });
    as_it_stands && supports(fixture).any(|held| held.stiffness != 0.0)
}
