//! K and C side by side, as every part of `stiffness.json` has them.

use jointscope_comparison::MatrixPair;
use jointscope_linalg::RealMatrix2;

/// K and C as a file has them.
pub(super) fn pair((k, c): (RealMatrix2, RealMatrix2)) -> MatrixPair {
    MatrixPair { stiffness: k.0, damping: c.0 }
}
