//! The Euler–Bernoulli beam, and how motions and loads travel along rigid ground.
//!
//! Convention: x runs along the beam, y is transverse, θ is positive from x to y, so θ = dy/dx. A motion
//! is u = (y, θ), a load is (force, moment).
//!
//! * [`transport`]: R = [[1, L],[0, 1]] carries a motion from x to x + L; its transpose carries a load back;
//! * [`end_stiffness`]: the 2×2 stiffness EI/L³·[[12, −6L],[−6L, 4L²]] of the beam seen from its far end,
//!   acting on the relative motion d = u_to − R·u_from;
//! * [`element_stiffness`], [`consistent_mass`]: the 4×4 matrices on (y, θ) at both ends;
//! * [`shape_functions`]: where a point inside the beam goes when the ends move.
//!
//! The 4×4 stiffness is the 2×2 one with its transports, `[−R, I]ᵀ k [−R, I]`:
//!
//! ```
//! use jointscope_beam::{element_stiffness, end_stiffness, from_end_stiffness};
//!
//! let (bending_stiffness, length) = (76.0, 0.065);
//! let direct = element_stiffness(bending_stiffness, length);
//! let assembled = from_end_stiffness(end_stiffness(bending_stiffness, length), length);
//! for i in 0..4 {
//!     for j in 0..4 {
//!         assert!((direct[i][j] - assembled[i][j]).abs() < 1e-9 * direct[0][0]);
//!     }
//! }
//! ```

use jointscope_linalg::{Matrix2, RealMatrix2};

/// A 4×4 matrix on (y, θ) at the near end, (y, θ) at the far end.
pub type Matrix4 = [[f64; 4]; 4];

/// R = [[1, L],[0, 1]]: the motion at x + `length` of a rigid body whose motion at x is known.
///
/// Its transpose turns a load at x + `length` into the equivalent load at x.
pub const fn transport(length: f64) -> RealMatrix2 {
    Matrix2::new(1.0, length, 0.0, 1.0)
}

/// Stiffness seen from the far end, on d = u_to − R·u_from; `bending_stiffness` EI in N·m², `length` in m.
///
/// Units: N/m, N/rad; N·m/m, N·m/rad.
pub fn end_stiffness(bending_stiffness: f64, length: f64) -> RealMatrix2 {
    let factor = bending_stiffness / length.powi(3);
    Matrix2::new(
        12.0 * factor,
        -6.0 * length * factor,
        -6.0 * length * factor,
        4.0 * length * length * factor,
    )
}

/// Compliance seen from the far end, the inverse of [`end_stiffness`]: L/(6EI)·[[2L², 3L],[3L, 6]].
pub fn end_compliance(bending_stiffness: f64, length: f64) -> RealMatrix2 {
    let factor = length / (6.0 * bending_stiffness);
    Matrix2::new(2.0 * length * length * factor, 3.0 * length * factor, 3.0 * length * factor, 6.0 * factor)
}

/// `[−R, I]ᵀ k [−R, I]`: the 4×4 matrix of a joint whose 2×2 `stiffness` acts on d = u_to − R·u_from.
pub fn from_end_stiffness(stiffness: RealMatrix2, length: f64) -> Matrix4 {
    let transport = transport(length);
    let cross = stiffness * transport;
    let near = transport.transpose() * cross;
    let back = transport.transpose() * stiffness;
    let mut all = [[0.0; 4]; 4];
    for i in 0..2 {
        for j in 0..2 {
            all[i][j] = near.at(i, j);
            all[i][j + 2] = -back.at(i, j);
            all[i + 2][j] = -cross.at(i, j);
            all[i + 2][j + 2] = stiffness.at(i, j);
        }
    }
    all
}

/// Stiffness of an Euler–Bernoulli element, EI in N·m², length in m.
pub fn element_stiffness(bending_stiffness: f64, length: f64) -> Matrix4 {
    let l = length;
    let factor = bending_stiffness / l.powi(3);
    [
        [12.0, 6.0 * l, -12.0, 6.0 * l],
        [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
        [-12.0, -6.0 * l, 12.0, -6.0 * l],
        [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
    ]
    .map(|row| row.map(|e| factor * e))
}

/// Stiffness of a Timoshenko element: as [`element_stiffness`], softened by the shear stiffness κGA in N.
///
/// An infinite shear stiffness gives the Euler–Bernoulli element.
pub fn shear_element_stiffness(bending_stiffness: f64, shear_stiffness: f64, length: f64) -> Matrix4 {
    let l = length;
    let shear = 12.0 * bending_stiffness / (shear_stiffness * l * l);
    let factor = bending_stiffness / (l.powi(3) * (1.0 + shear));
    let (own, other) = ((4.0 + shear) * l * l, (2.0 - shear) * l * l);
    [
        [12.0, 6.0 * l, -12.0, 6.0 * l],
        [6.0 * l, own, -6.0 * l, other],
        [-12.0, -6.0 * l, 12.0, -6.0 * l],
        [6.0 * l, other, -6.0 * l, own],
    ]
    .map(|row| row.map(|e| factor * e))
}

/// Consistent mass of an Euler–Bernoulli element, mass per length in kg/m.
pub fn consistent_mass(mass_per_length: f64, length: f64) -> Matrix4 {
    let l = length;
    let factor = mass_per_length * l / 420.0;
    [
        [156.0, 22.0 * l, 54.0, -13.0 * l],
        [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
        [54.0, 13.0 * l, 156.0, -22.0 * l],
        [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
    ]
    .map(|row| row.map(|e| factor * e))
}

/// Mass of a joint, kg, on (y, θ) of both ends: consistent along its length, m, and half of it at each end
/// where it has none.
pub fn mass_of_ends(mass: f64, length: f64) -> Matrix4 {
    if length > 0.0 {
        return consistent_mass(mass / length, length);
    }
    let mut halves = [[0.0; 4]; 4];
    (halves[0][0], halves[2][2]) = (0.5 * mass, 0.5 * mass);
    halves
}

/// Consistent rotary inertia of an Euler–Bernoulli element, ρI in kg·m.
pub fn consistent_rotary_inertia(rotary_inertia: f64, length: f64) -> Matrix4 {
    let l = length;
    let factor = rotary_inertia / (30.0 * l);
    [
        [36.0, 3.0 * l, -36.0, 3.0 * l],
        [3.0 * l, 4.0 * l * l, -3.0 * l, -l * l],
        [-36.0, -3.0 * l, 36.0, -3.0 * l],
        [3.0 * l, -l * l, -3.0 * l, 4.0 * l * l],
    ]
    .map(|row| row.map(|e| factor * e))
}

/// Deflection and slope at `position` (0 to `length`, m) for unit motions (y, θ) of the two ends:
/// the cubic Hermite polynomials and their derivatives.
pub fn shape_functions(position: f64, length: f64) -> [[f64; 4]; 2] {
    let s = position / length;
    let (s2, s3) = (s * s, s * s * s);
    let deflection =
        [1.0 - 3.0 * s2 + 2.0 * s3, length * (s - 2.0 * s2 + s3), 3.0 * s2 - 2.0 * s3, length * (s3 - s2)];
    let slope =
        [6.0 * (s2 - s) / length, 1.0 - 4.0 * s + 3.0 * s2, 6.0 * (s - s2) / length, 3.0 * s2 - 2.0 * s];
    [deflection, slope]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn times(matrix: &Matrix4, vector: [f64; 4]) -> [f64; 4] {
        matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
    }

    proptest! {
        #[test]
        fn a_rigid_motion_strains_no_element(l in 0.01f64..2.0, ei in 1e-2f64..1e6, y in -1.0f64..1.0, theta in -1.0f64..1.0) {
            let rigid = [y, theta, y + theta * l, theta];
            for matrix in [element_stiffness(ei, l), shear_element_stiffness(ei, 1e5, l)] {
                for load in times(&matrix, rigid) {
                    prop_assert!(load.abs() < 1e-9 * ei / l.powi(3).min(1.0), "{load}");
                }
            }
        }

        #[test]
        fn the_consistent_mass_of_a_rigid_motion_is_that_of_a_bar(l in 0.01f64..2.0, rho in 0.1f64..10.0) {
            let kinetic = |v: [f64; 4]| times(&consistent_mass(rho, l), v).iter().zip(v).map(|(a, b)| a * b).sum::<f64>();
            prop_assert!((kinetic([1.0, 0.0, 1.0, 0.0]) / (rho * l) - 1.0).abs() < 1e-12);
            // Rotation about the near end: ρ L³ / 3.
            prop_assert!((kinetic([0.0, 1.0, l, 1.0]) / (rho * l.powi(3) / 3.0) - 1.0).abs() < 1e-12);
        }

        /// Four Gauss points integrate polynomials of degree seven exactly.
        #[test]
        fn masses_are_those_of_the_shape_functions_and_a_joint_without_length_has_half_its_mass_at_each_end(
            l in 0.01f64..2.0, rho in 0.1f64..10.0
        ) {
            let (inner, outer) = ((3.0 / 7.0 - 2.0 / 7.0 * 1.2f64.sqrt()).sqrt(), (3.0 / 7.0 + 2.0 / 7.0 * 1.2f64.sqrt()).sqrt());
            let weights = [(inner, (18.0 + 30f64.sqrt()) / 72.0), (outer, (18.0 - 30f64.sqrt()) / 72.0)];
            let points = weights.iter().flat_map(|(x, w)| [(0.5 - 0.5 * x, w), (0.5 + 0.5 * x, w)]);
            let shapes: Vec<([[f64; 4]; 2], f64)> = points.map(|(x, w)| (shape_functions(x * l, l), w * l * rho)).collect();
            for (which, matrix) in [consistent_mass(rho, l), consistent_rotary_inertia(rho, l)].iter().enumerate() {
                for i in 0..4 {
                    for j in 0..4 {
                        let expected: f64 = shapes.iter().map(|(shape, w)| w * shape[which][i] * shape[which][j]).sum();
                        let size = (matrix[i][i] * matrix[j][j]).sqrt();
                        prop_assert!((matrix[i][j] - expected).abs() < 1e-10 * size, "{} ({}, {}): {} for {}", which, i, j, matrix[i][j], expected);
                    }
                }
            }
            let point = mass_of_ends(rho, 0.0);
            prop_assert_eq!(point, [[rho / 2.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0, 0.0, rho / 2.0, 0.0], [0.0; 4]]);
        }

        #[test]
        fn a_joint_weighs_what_it_weighs_at_any_length(l in 0.0f64..1.0, mass in 0.01f64..10.0) {
            for length in [0.0, l] {
                let rigid = [1.0, 0.0, 1.0, 0.0];
                let inertial: f64 = times(&mass_of_ends(mass, length), rigid).iter().zip(rigid).map(|(a, b)| a * b).sum();
                prop_assert!((inertial - mass).abs() < 1e-12 * mass);
            }
        }

        #[test]
        fn stiffness_and_compliance_of_the_far_end_are_inverse(l in 0.01f64..2.0, ei in 1e-2f64..1e6) {
            let product = end_stiffness(ei, l) * end_compliance(ei, l);
            prop_assert!((product.at(0, 0) - 1.0).abs() < 1e-12 && (product.at(1, 1) - 1.0).abs() < 1e-12);
            prop_assert!(product.at(0, 1).abs() < 1e-9 / l && product.at(1, 0).abs() < 1e-9 * l);
        }
    }

    #[test]
    fn a_cantilever_deflects_by_the_textbook_amount() {
        let (ei, l, force) = (50.0, 0.3, 7.0);
        let compliance = end_compliance(ei, l);
        assert!((compliance.at(0, 0) * force - force * l.powi(3) / (3.0 * ei)).abs() < 1e-15);
        assert!((compliance.at(1, 0) * force - force * l.powi(2) / (2.0 * ei)).abs() < 1e-15);
    }

    #[test]
    fn an_infinite_shear_stiffness_gives_the_euler_bernoulli_element() {
        let (plain, stiff) = (element_stiffness(50.0, 0.3), shear_element_stiffness(50.0, 1e30, 0.3));
        for i in 0..4 {
            for j in 0..4 {
                assert!((plain[i][j] - stiff[i][j]).abs() < 1e-9 * plain[0][0]);
            }
        }
    }

    #[test]
    fn a_short_cantilever_deflects_in_shear_too() {
        let (ei, ga, l) = (50.0, 2e4, 0.1);
        let matrix = shear_element_stiffness(ei, ga, l);
        let tip = Matrix2::new(matrix[2][2], matrix[2][3], matrix[3][2], matrix[3][3]).inverse().unwrap();
        let expected = l.powi(3) / (3.0 * ei) + l / ga;
        assert!((tip.at(0, 0) / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn shape_functions_take_the_ends_values_at_the_ends_and_reproduce_rigid_motions_between() {
        let l = 0.4;
        assert_eq!(shape_functions(0.0, l)[0], [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(shape_functions(l, l)[1], [0.0, 0.0, 0.0, 1.0]);
        let motion = [0.2, 0.7, 0.2 + 0.7 * l, 0.7];
        let [deflection, slope] = shape_functions(0.13, l);
        let y: f64 = deflection.iter().zip(motion).map(|(a, b)| a * b).sum();
        let theta: f64 = slope.iter().zip(motion).map(|(a, b)| a * b).sum();
        assert!((y - (0.2 + 0.7 * 0.13)).abs() < 1e-14 && (theta - 0.7).abs() < 1e-12);
    }

    #[test]
    fn rotary_inertia_resists_rotation_and_not_translation() {
        let matrix = consistent_rotary_inertia(3e-4, 0.2);
        assert!(times(&matrix, [1.0, 0.0, 1.0, 0.0]).iter().all(|e| e.abs() < 1e-15));
        let turning = [0.0, 1.0, 0.2, 1.0];
        let inertia: f64 = times(&matrix, turning).iter().zip(turning).map(|(a, b)| a * b).sum();
        assert!((inertia - 3e-4 * 0.2).abs() < 1e-15);
    }
}
