//! What tests for amplitude share.

use jointscope_fixture::Dof;

/// Units of a joint's relative motion and of its force.
pub(crate) fn units(dof: Dof) -> (&'static str, &'static str) {
    match dof {
        Dof::Translation => ("m", "N"),
        Dof::Rotation => ("rad", "N·m"),
    }
}
