//! A joint's 4×4 dynamic stiffness for those above that need no assembly, such as an export to finite
//! elements.

use crate::joint::JointDynamics;
use jointscope_fixture::{Fixture, Joint};
use num_complex::Complex64;

/// The dynamic stiffness of one joint with everything that the fixture says of it, on (y, θ) at its near end,
/// (y, θ) at its far end.
///
/// The viscous matrix of the assembly is not part of it: it belongs to the bodies' coordinates.
#[derive(Debug, Clone)]
pub struct JointElement {
    dynamics: JointDynamics,
}

impl JointElement {
    /// The joint as `fixture` and its effects have it.
    pub fn new(fixture: &Fixture, joint: &Joint) -> Self {
        JointElement { dynamics: JointDynamics::new(fixture, joint) }
    }

    /// Its free length, m, effects included.
    pub fn length(&self) -> f64 {
        self.dynamics.lengths().0
    }

    /// Whether it has mass of its own.
    pub fn is_heavy(&self) -> bool {
        self.dynamics.is_heavy()
    }

    /// Column `end` (0 to 3) of the symmetric 4×4 dynamic stiffness at s = iω (or decay + iω): the forces at
    /// both ends per unit of that motion alone, N/m to N·m/rad.
    pub fn column(&self, s: Complex64, end: usize) -> [Complex64; 4] {
        let element = self.dynamics.on_both_ends(s);
        [0, 1, 2, 3].map(|row| element.at(row, end.min(3)))
    }
}
