//! What a solid has and the lumped model has not, switched off one by one to see what each is worth.

use crate::{BrickOwner, Mesh};

/// What the lumped model leaves out, switched off in the solid: one at a time it shows what each is worth,
/// all together the twin is the lumped model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Omissions {
    /// Strips and layers weigh next to nothing.
    pub joint_mass: bool,
    /// Strips and layers do not shear in the plane of bending.
    pub shear: bool,
    /// Strips and layers have a Poisson's ratio of zero: no bending across the width, nothing for the blocks
    /// to restrain there.
    pub plate_action: bool,
    /// Blocks are all but rigid, and with them the strips' footing.
    pub block_flexibility: bool,
}

/// How much less a strip weighs, how much less it shears and how much stiffer a block is: a hundredth of each
/// effect stays. Further apart the masses and stiffnesses of neighbouring elements would cost the factor its
/// digits.
const SMALL: f64 = 1e-2;
const LARGE: f64 = 1e2;

impl Omissions {
    pub(crate) fn apply(self, mesh: &mut Mesh) {
        if self == Omissions::default() {
            return;
        }
        let count = mesh.materials.len();
        let (mut strips, mut blocks) = (mesh.materials.clone(), mesh.materials.clone());
        for strip in &mut strips {
            if self.joint_mass {
                strip.density *= SMALL;
            }
            if self.plate_action {
                strip.poisson_ratio = 0.0;
            }
            if self.shear {
                strip.shear_factor = LARGE;
            }
        }
        if self.block_flexibility {
            blocks.iter_mut().for_each(|block| block.youngs_modulus *= LARGE);
        }
        mesh.materials.append(&mut strips);
        mesh.materials.append(&mut blocks);
        for element in &mut mesh.elements {
            element.material += match element.part {
                BrickOwner::Body(_) => 2 * count,
                BrickOwner::Joint(_) | BrickOwner::Layer(..) => count,
            };
        }
    }
}
