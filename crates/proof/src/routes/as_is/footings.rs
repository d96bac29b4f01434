//! What the footings of a strip yield.

/// Compliances of a strip in its blocks beyond its bending.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Footings {
    /// In rotation at either end, rad/(N·m).
    pub rotation: [f64; 2],
    /// Across the strip: its shear and both ends, m/N.
    pub across: f64,
}

impl Footings {
    /// Rotational stiffnesses, N·m/rad.
    pub(super) fn stiffness(&self) -> [f64; 2] {
        self.rotation.map(f64::recip)
    }
}
