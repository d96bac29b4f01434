//! Where forces act on the assembly and where motions are read.

use jointscope_spectra::Dof;

/// A place on the assembly and a direction there: where it is pushed, or where its motion is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Index of the body.
    pub body: usize,
    /// Abscissa, m.
    pub x: f64,
    /// Transverse or rotation (force or moment).
    pub dof: Dof,
}

impl Station {
    /// The transverse motion (or a force) at `x` of body `body`.
    pub fn transverse(body: usize, x: f64) -> Self {
        Station { body, x, dof: Dof::Translation }
    }

    /// The rotation (or a moment) at `x` of body `body`.
    pub fn rotational(body: usize, x: f64) -> Self {
        Station { body, x, dof: Dof::Rotation }
    }

    /// Both at one place: y then θ.
    pub fn both(body: usize, x: f64) -> [Self; 2] {
        [Self::transverse(body, x), Self::rotational(body, x)]
    }
}
