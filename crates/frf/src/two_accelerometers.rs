use jointscope_linalg::{ComplexMatrix2, Matrix2};
use num_complex::Complex64;

/// Rotation of a rigid surface from two translations `distance` (m) apart (eq 19): `right` lies at the
/// larger x, so that θ = dy/dx is positive from x to y.
pub fn rotation_from_two(right: Complex64, left: Complex64, distance: f64) -> Complex64 {
    (right - left) / distance
}

/// Response per unit moment at point 1 from the responses to forces at 2 and at 1, `distance` (m) from 1
/// to 2 (eq 22): a force at 2 and its opposite at 1 are a moment.
pub fn per_moment_from_two(per_force_at_2: Complex64, per_force_at_1: Complex64, distance: f64) -> Complex64 {
    (per_force_at_2 - per_force_at_1) / distance
}

/// H41 from the four transverse FRFs (eq 23).
///
/// `per_force_1` and `per_force_2` each hold the responses at points 4 and 3; `sensors` is the distance from 3
/// to 4, `hits` that from 1 to 2, m. Rows of the result are (y, θ) at 4, columns (force, moment) at 1.
pub fn from_four_frfs(
    per_force_1: [Complex64; 2],
    per_force_2: [Complex64; 2],
    sensors: f64,
    hits: f64,
) -> ComplexMatrix2 {
    let rotation_1 = rotation_from_two(per_force_1[0], per_force_1[1], sensors);
    let rotation_2 = rotation_from_two(per_force_2[0], per_force_2[1], sensors);
    Matrix2::new(
        per_force_1[0],
        per_moment_from_two(per_force_2[0], per_force_1[0], hits),
        rotation_1,
        per_moment_from_two(rotation_2, rotation_1, hits),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_four_frfs_of_a_known_matrix_give_it_back(h in prop::array::uniform8(-1.0f64..1.0), sensors in 0.01f64..0.2, hits in 0.01f64..0.2) {
            let c = |i: usize| Complex64::new(h[2 * i], h[2 * i + 1]);
            let known = Matrix2::new(c(0), c(1), c(2), c(3));
            // y at 3 is y4 − d θ4; a force at 2 is a force and a moment ℓA at 1.
            let response = |hit: f64, back: f64| {
                let y = known.at(0, 0) + known.at(0, 1) * hit;
                let theta = known.at(1, 0) + known.at(1, 1) * hit;
                y - theta * back
            };
            let found = from_four_frfs(
                [response(0.0, 0.0), response(0.0, sensors)], [response(hits, 0.0), response(hits, sensors)], sensors, hits);
            prop_assert!((found - known).norm_squared().sqrt() < 1e-10);
        }
    }
}
