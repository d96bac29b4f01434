//! The inertia of a joint's own mass.

use jointscope_beam::mass_of_ends;
use jointscope_linalg::{ComplexMatrix2, Matrix2};
use num_complex::Complex64;

/// s²M of a uniform `mass` (kg) over a joint of this length (m) on the motion of its ends, by near and far
/// end.
pub(crate) fn inertia_of_ends(mass: f64, length: f64, s: Complex64) -> [[ComplexMatrix2; 2]; 2] {
    let all = mass_of_ends(mass, length);
    let between = |row: usize, column: usize| {
        let of = |i: usize, j: usize| s * s * all[2 * row + i][2 * column + j];
        Matrix2::new(of(0, 0), of(0, 1), of(1, 0), of(1, 1))
    };
    [[between(0, 0), between(0, 1)], [between(1, 0), between(1, 1)]]
}
