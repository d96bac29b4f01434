//! The stiffness matrix of a joint as its fixture states it.

use jointscope_beam::end_stiffness;
use jointscope_fixture::JointLaw;
use jointscope_linalg::{Matrix2, RealMatrix2};

/// Stiffness of a joint as the fixture states it, without effects, on d = u_to − R·u_from.
pub fn nominal_stiffness(law: &JointLaw, length: f64) -> RealMatrix2 {
    match law {
        JointLaw::Beam { youngs_modulus, second_moment } => {
            end_stiffness(youngs_modulus.value * second_moment.value, length)
        }
        JointLaw::Stiffness { stiffness: [a, b, d], .. } => Matrix2::new(a.value, b.value, b.value, d.value),
    }
}
