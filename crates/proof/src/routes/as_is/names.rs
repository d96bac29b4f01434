//! Names that are true of a solid beyond what is hidden in it.

use super::assembly::{ENDS, Stated};
use crate::routes::by_name::TrueName;
use jointscope_fixture::{Dof, EffectKind};
use rand::{Rng, RngExt};

/// What the fixture leaves unstated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Gap {
    pub strip_mass: bool,
    pub shear: bool,
    pub footings: bool,
    /// A strip so wide that it bends as a plate.
    pub wide: bool,
}

impl Gap {
    /// Leaves out one to three of the strip's mass, its shear and its footings.
    pub(super) fn drawn(random: &mut impl Rng) -> Self {
        let left_out = random.random_range(1..8);
        Gap {
            strip_mass: left_out & 1 != 0,
            shear: left_out & 2 != 0,
            footings: left_out & 4 != 0,
            wide: false,
        }
    }

    pub(super) fn is_any(self) -> bool {
        self != Gap::default()
    }

    pub(super) fn stated(self) -> Stated {
        Stated { strip_mass: !self.strip_mass, shear: !self.shear, footings: !self.footings }
    }

    /// Names that are true of any solid with this gap, its blocks' first bending at these frequencies (Hz).
    ///
    /// Ends of a strip yield across it as well as in rotation, and its shear coefficient is that of an ideal
    /// section: both stay true where the usual shear is stated. A yielding end is a longer strip, or a softer
    /// one; a plate is a shorter or a stiffer one.
    pub(super) fn true_names(self, first_bending: [f64; 2]) -> Vec<TrueName> {
        let mut names = vec![
            TrueName::of(EffectKind::ShearDeformation).at(&["J"]),
            TrueName::of(EffectKind::InterfaceCompliance).in_dof(Dof::Translation),
        ];
        for (body, hz) in ["A", "B"].into_iter().zip(first_bending) {
            let near = [0.5 * hz, 1.6 * hz];
            names.push(TrueName::of(EffectKind::BodyFlexibility).at(&[body]).above(near[0]).below(near[1]));
        }
        if self.footings {
            names.push(TrueName::of(EffectKind::InterfaceCompliance).in_dof(Dof::Rotation).at(&ENDS));
            names.push(TrueName::of(EffectKind::Footing).at(&["J"]));
        }
        if self.footings || self.shear {
            names.push(TrueName::of(EffectKind::StiffnessChange).at(&["J"]).below(1.0));
            names.push(TrueName::of(EffectKind::JointLength).at(&["J"]).above(0.0));
        }
        if self.strip_mass {
            names.push(TrueName::of(EffectKind::JointMass).at(&["J"]).above(0.0));
        }
        if self.wide {
            names.push(TrueName::of(EffectKind::StiffnessChange).at(&["J"]).above(1.0));
            names.push(TrueName::of(EffectKind::JointLength).at(&["J"]).below(0.0));
        }
        names
    }
}
