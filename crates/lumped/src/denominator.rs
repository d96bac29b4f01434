//! The denominator of one mode in a receptance.

use num_complex::Complex64;

/// A mode's denominator λ + i·structural + s·viscous + s², shared by modes that have the same one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Denominator {
    pub stiffness: Complex64,
    pub viscous: f64,
}
