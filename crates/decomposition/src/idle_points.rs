//! Points whose places no FRF depends on.
//!
//! A geometry from an analyser has thousands of points, a hammer test uses a few of them. A point that is no
//! channel of the recording, holds nothing and bears no effect has a derivative of exactly zero, which need
//! not be computed.

use jointscope_fixture::{Fixture, Place, QuantityOwner};
use jointscope_spectra::FrfPair;
use std::collections::HashSet;

/// The points of a fixture on whose places no FRF of a recording depends.
pub(crate) struct IdlePoints {
    /// All others.
    used: HashSet<usize>,
}

impl IdlePoints {
    /// Of a fixture and the channels of a recording.
    pub(crate) fn of(fixture: &Fixture, pairs: &[FrfPair]) -> Self {
        let channels = pairs.iter().flat_map(|pair| [&pair.response, &pair.reference]);
        let of_effects = fixture.physics().iter().filter_map(|effect| match &effect.place {
            Place::Point(name) | Place::Response(name) | Place::Reference(name) => Some(name.as_str()),
            _ => None,
        });
        let names: HashSet<&str> = channels.map(|channel| channel.point.as_str()).chain(of_effects).collect();
        let all = fixture.points().iter().enumerate();
        let named = all.filter(|(_, point)| names.contains(point.name.as_str())).map(|(index, _)| index);
        IdlePoints { used: named.chain(fixture.held_points()).collect() }
    }

    /// Whether a quantity of this owner is the place of an idle point.
    pub(crate) fn have(&self, owner: QuantityOwner) -> bool {
        matches!(owner, QuantityOwner::Point(point) if !self.used.contains(&point))
    }
}
