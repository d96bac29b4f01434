//! What lines of a file consist of.

use crate::{Abscissa, Data, Dataset58};

/// The line before and behind a dataset.
pub(super) const DELIMITER: &[u8] = b"    -1\n";

/// Numbers that are written for each point.
pub(super) fn values_per_point(function: &Dataset58) -> usize {
    let parts = match function.data {
        Data::Real(_) => 1,
        Data::Complex(_) => 2,
    };
    match function.abscissa {
        Abscissa::Even { .. } => parts,
        Abscissa::Uneven(_) => parts + 1,
    }
}
