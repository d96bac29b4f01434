//! The motions through which a change of the free assembly acts.

use crate::Station;

/// What a term acts through: a weighted sum of motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TermStation {
    parts: [(f64, Station); 3],
    /// What is subtracted because the modes hold it already acts on the rigid coordinates alone, without the
    /// bending of blocks.
    pub rigid_only: bool,
}

impl TermStation {
    /// One motion by itself.
    pub(crate) fn single(station: Station) -> Self {
        TermStation { parts: [(1.0, station), (0.0, station), (0.0, station)], rigid_only: false }
    }

    /// d = u_to − R·u_from over `length`: its deflection, then its rotation.
    pub(crate) fn relative(from: (usize, f64), to: (usize, f64), length: f64, rigid_only: bool) -> [Self; 2] {
        let [near, far] = [from, to].map(|(body, x)| Station::both(body, x));
        [
            TermStation { parts: [(1.0, far[0]), (-1.0, near[0]), (-length, near[1])], rigid_only },
            TermStation { parts: [(1.0, far[1]), (-1.0, near[1]), (0.0, near[1])], rigid_only },
        ]
    }

    /// How far two places move apart.
    pub(crate) fn between(one: (usize, f64), other: (usize, f64)) -> Self {
        let [one, other] = [one, other].map(|(body, x)| Station::transverse(body, x));
        TermStation { parts: [(1.0, other), (-1.0, one), (0.0, one)], rigid_only: false }
    }

    /// The same of the bodies' rigid motion alone.
    pub(crate) fn of_rigid_motion(self) -> Self {
        TermStation { rigid_only: true, ..self }
    }

    /// Motions and their weights.
    pub(crate) fn parts(&self) -> impl Iterator<Item = &(f64, Station)> {
        self.parts.iter().filter(|(weight, _)| *weight != 0.0)
    }
}
