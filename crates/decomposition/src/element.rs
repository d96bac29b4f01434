//! Which number of a joint is spoken of: an element of K or of C.

use jointscope_linalg::RealMatrix2;
use serde::Serialize;

/// An element of the joint's 2×2 matrices K and C.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct MatrixElement {
    /// 0 for the force, 1 for the moment.
    pub row: usize,
    /// 0 for the displacement, 1 for the rotation.
    pub column: usize,
}

const ELEMENTS: [MatrixElement; 4] = [
    MatrixElement { row: 0, column: 0 },
    MatrixElement { row: 0, column: 1 },
    MatrixElement { row: 1, column: 0 },
    MatrixElement { row: 1, column: 1 },
];

impl MatrixElement {
    /// The elements that mean anything: all four, or (1,1) where the blocks do not rotate.
    pub fn all(scalar: bool) -> &'static [MatrixElement] {
        if scalar { &ELEMENTS[..1] } else { &ELEMENTS }
    }

    /// The elements of a symmetric matrix: 11, 12, 22.
    pub fn distinct(scalar: bool) -> impl Iterator<Item = MatrixElement> {
        Self::all(scalar).iter().copied().filter(|e| e.column >= e.row)
    }

    /// Its value in a matrix.
    pub fn of(self, matrix: &RealMatrix2) -> f64 {
        matrix.at(self.row, self.column)
    }
}

/// Which part of a dynamic stiffness K + iωC is spoken of: of a joint its two matrices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DynamicStiffnessPart {
    /// K, N/m and so on.
    Stiffness,
    /// C, N·s/m and so on.
    Damping,
}

impl DynamicStiffnessPart {
    /// Both.
    pub const ALL: [DynamicStiffnessPart; 2] =
        [DynamicStiffnessPart::Stiffness, DynamicStiffnessPart::Damping];

    /// This one of a pair of stiffness and damping.
    pub fn of<T>(self, (stiffness, damping): (T, T)) -> T {
        match self {
            DynamicStiffnessPart::Stiffness => stiffness,
            DynamicStiffnessPart::Damping => damping,
        }
    }
}
