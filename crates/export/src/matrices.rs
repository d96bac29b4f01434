//! The 4×4 matrices of joints on the nodes at their ends.

use crate::Joint;
use crate::joint::{both_ends, is_zero};
use jointscope_beam::Matrix4;
use std::collections::BTreeMap;

/// A row or column: node and degree of freedom.
pub(crate) type Coordinate = (u64, u8);

/// Matrices of all joints together, the elements on and below the diagonal: (column, row) and value.
#[derive(Debug, Default)]
pub(crate) struct Sparse(BTreeMap<(Coordinate, Coordinate), f64>);

impl Sparse {
    pub(crate) fn add(&mut self, joint: &Joint, matrix: &Matrix4) {
        let (from, to) = (joint.from.node, joint.to.node);
        let coordinates = [(from, 2), (from, 6), (to, 2), (to, 6)];
        for i in 0..4 {
            for j in 0..=i {
                if matrix[i][j] != 0.0 {
                    let (one, other) = (coordinates[i], coordinates[j]);
                    *self.0.entry((one.min(other), one.max(other))).or_default() += matrix[i][j];
                }
            }
        }
    }

    /// The columns with their rows, both ascending.
    pub(crate) fn columns(&self) -> BTreeMap<Coordinate, Vec<(Coordinate, f64)>> {
        let mut columns: BTreeMap<Coordinate, Vec<(Coordinate, f64)>> = BTreeMap::new();
        for ((column, row), value) in &self.0 {
            columns.entry(*column).or_default().push((*row, *value));
        }
        columns
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// The 4×4 matrices that a joint has, by kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Stiffness,
    Damping,
    Structural,
    Mass,
}

pub(crate) const KINDS: [Kind; 4] = [Kind::Stiffness, Kind::Damping, Kind::Structural, Kind::Mass];

impl Kind {
    /// A joint's matrix on both ends, if it has one.
    pub(crate) fn of(self, joint: &Joint) -> Option<Matrix4> {
        let matrix = match self {
            Kind::Stiffness => &joint.stiffness,
            Kind::Damping => &joint.damping,
            Kind::Structural => &joint.structural,
            Kind::Mass => return joint.mass,
        };
        (!is_zero(matrix)).then(|| both_ends(matrix, joint.length))
    }
}
