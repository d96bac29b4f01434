//! Damping of an assembly from what can be measured: modal damping ratios, Rayleigh constants or a
//! loss factor (eq 16, 17, 24–31).
//!
//! [`DampingLaw::of_modes`] gives each undamped mode its viscous and structural coefficient, which is all
//! that a modal sum needs; [`viscous_matrix`] turns the viscous ones back into the matrix on the
//! coordinates, C = Ξ⁻ᵀ diag(C_r) Ξ⁻¹ (eq 27, with Ξ for the E of the print).
//!
//! ```
//! use jointscope_damping::{DampingLaw, viscous_matrix};
//! use jointscope_linalg::generalized_symmetric_eigen;
//!
//! // Two masses on a spring: λ = k (1/m1 + 1/m2), damped by 1 %.
//! let mass = [2.0, 0.0, 0.0, 3.0];
//! let modes = generalized_symmetric_eigen(2, &mass, &[5e6, -5e6, -5e6, 5e6])?;
//! let damping = DampingLaw::ModalRatios(vec![0.01]).of_modes(modes.eigenvalues());
//! let matrix = viscous_matrix(&mass, &modes, &damping);
//! // One elastic mode: its dashpot is c = 2ζ √(k m), m the reduced mass.
//! let c = 2.0 * 0.01 * (5e6_f64 * 1.2).sqrt();
//! assert!((matrix[0] - c).abs() < 1e-9 * c && (matrix[1] + c).abs() < 1e-9 * c);
//! # Ok::<(), jointscope_linalg::EigenError>(())
//! ```

use jointscope_linalg::ModalBasis;

/// How an assembly is damped.
#[derive(Debug, Clone, PartialEq)]
pub enum DampingLaw {
    /// Not at all.
    Undamped,
    /// Ratios ζ_r of the elastic modes in ascending frequency; modes beyond the list take the last one,
    /// rigid motions are not damped.
    ModalRatios(Vec<f64>),
    /// C = mass·M + stiffness·K (eq 16), in 1/s and s. The mass term damps rigid motions too.
    Rayleigh {
        /// Factor of the mass matrix, 1/s.
        mass: f64,
        /// Factor of the stiffness matrix, s.
        stiffness: f64,
    },
    /// K(1 + iη) (eq 17).
    LossFactor(f64),
}

/// Share of a mode's strain energy in supports above which it is a suspension's: a structure hung up for a
/// test moves as rigid at less than a fifth of the frequency at which it bends.
const SUSPENDED: f64 = 0.95;

/// A mass-normalised mode of an assembly on supports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldMode {
    /// λ_r, (rad/s)².
    pub eigenvalue: f64,
    /// Share of its strain energy in supports.
    pub in_supports: f64,
    /// What the supports' dashpots do to it, Σ c φ², 1/s.
    pub dashpots: f64,
}

/// The places of the modes that have a ratio of their own: not motions as rigid, and not modes of a
/// suspension, in which hardly anything but supports is strained, unless no mode is any other.
pub fn elastic_modes(modes: &[HeldMode]) -> Vec<usize> {
    let moves = |r: &usize| modes[*r].eigenvalue > 0.0;
    let strains = |r: &usize| modes[*r].in_supports <= SUSPENDED;
    let elastic: Vec<usize> = (0..modes.len()).filter(moves).filter(strains).collect();
    if elastic.is_empty() { (0..modes.len()).filter(moves).collect() } else { elastic }
}

/// Damping of one mass-normalised mode.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ModeDamping {
    /// Viscous coefficient C_r = 2 ζ_r ω_r (eq 26), 1/s.
    pub viscous: f64,
    /// Structural coefficient η λ_r, (rad/s)².
    pub structural: f64,
}

impl DampingLaw {
    /// The damping of each mode, given the eigenvalues λ_r in (rad/s)², ascending, rigid modes exactly zero.
    pub fn of_modes(&self, eigenvalues: &[f64]) -> Vec<ModeDamping> {
        let mut elastic = 0;
        eigenvalues
            .iter()
            .map(|&eigenvalue| match self {
                DampingLaw::Undamped => ModeDamping::default(),
                DampingLaw::ModalRatios(ratios) => {
                    if eigenvalue <= 0.0 {
                        return ModeDamping::default();
                    }
                    let ratio = ratios.get(elastic).or(ratios.last()).copied().unwrap_or(0.0);
                    elastic += 1;
                    ModeDamping { viscous: 2.0 * ratio * eigenvalue.sqrt(), structural: 0.0 }
                }
                DampingLaw::Rayleigh { mass, stiffness } => {
                    ModeDamping { viscous: mass + stiffness * eigenvalue, structural: 0.0 }
                }
                DampingLaw::LossFactor(factor) => {
                    ModeDamping { viscous: 0.0, structural: factor * eigenvalue }
                }
            })
            .collect()
    }

    /// The damping of each mode of an assembly that is tested as it stands on its supports, modes in
    /// ascending frequency; what its dashpots contribute to the ratios that a test reads is taken off, for
    /// they stand in the model themselves.
    ///
    /// Ratios are those of the [`elastic_modes`]. Laws other than [`DampingLaw::ModalRatios`] know no
    /// supports.
    pub fn of_held_modes(&self, modes: &[HeldMode]) -> Vec<ModeDamping> {
        let DampingLaw::ModalRatios(ratios) = self else {
            return self.of_modes(&modes.iter().map(|mode| mode.eigenvalue).collect::<Vec<_>>());
        };
        let mut all = vec![ModeDamping::default(); modes.len()];
        for (which, r) in elastic_modes(modes).into_iter().enumerate() {
            let ratio = ratios.get(which).or(ratios.last()).copied().unwrap_or(0.0);
            let viscous = 2.0 * ratio * modes[r].eigenvalue.sqrt() - modes[r].dashpots;
            all[r].viscous = viscous.max(0.0);
        }
        all
    }
}

/// The viscous matrix C = (MΞ) diag(C_r) (MΞ)ᵀ on the coordinates, row-major, N·s/m and so on.
///
/// Since ΞᵀMΞ = I, MΞ is the Ξ⁻ᵀ of eq (27) without an inversion. `mass` is row-major, of the basis' order.
pub fn viscous_matrix(mass: &[f64], modes: &ModalBasis, damping: &[ModeDamping]) -> Vec<f64> {
    let order = modes.order();
    let mut matrix = vec![0.0; order * order];
    let mut weighted = vec![0.0; order];
    for (r, mode) in damping.iter().enumerate() {
        if mode.viscous == 0.0 {
            continue;
        }
        let shape = modes.shape(r);
        for (i, entry) in weighted.iter_mut().enumerate() {
            *entry = mass[i * order..(i + 1) * order].iter().zip(shape).map(|(m, p)| m * p).sum();
        }
        for i in 0..order {
            for j in 0..order {
                matrix[i * order + j] += weighted[i] * mode.viscous * weighted[j];
            }
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_beam::element_stiffness;
    use jointscope_linalg::generalized_symmetric_eigen;
    use proptest::prelude::*;

    /// Mass matrix of two rigid blocks about the interfaces 2 and 3, coordinates (y2, θ2, y3, θ3).
    fn two_blocks(m: [f64; 2], inertia: [f64; 2], c: [f64; 2]) -> [f64; 16] {
        let mut mass = [0.0; 16];
        for (block, sign) in [(0, -1.0), (1, 1.0)] {
            let (o, arm) = (2 * block, sign * c[block]);
            mass[o * 4 + o] = m[block];
            mass[o * 4 + o + 1] = m[block] * arm;
            mass[(o + 1) * 4 + o] = m[block] * arm;
            mass[(o + 1) * 4 + o + 1] = inertia[block] + m[block] * arm * arm;
        }
        mass
    }

    #[test]
    fn the_damping_matrix_of_example_d0_is_eq_40_as_corrected() {
        // Dimensions inferred from the paper's tables, not published.
        let mass = two_blocks([5.362173, 5.113312], [0.010467574, 0.009247089], [0.06895, 0.06575]);
        let stiffness: Vec<f64> = element_stiffness(59.29946, 0.0651).concat();
        let modes = generalized_symmetric_eigen(4, &mass, &stiffness).unwrap();
        let damping = DampingLaw::ModalRatios(vec![0.00716, 0.00072]).of_modes(modes.eigenvalues());
        let c = viscous_matrix(&mass, &modes, &damping);
        // (row, column, printed, half of the last printed digit); (2,3) and (2,4) with the corrected sign.
        let printed = [
            (1, 1, 1.5, 0.05),
            (1, 2, 0.06, 0.005),
            (1, 3, -1.5, 0.05),
            (2, 2, 0.033, 0.0005),
            (2, 3, -0.06, 0.005),
            (2, 4, -0.029, 0.0005),
            (3, 3, 1.5, 0.05),
        ];
        for (i, j, value, rounding) in printed {
            let found = c[(i - 1) * 4 + j - 1];
            assert!((found - value).abs() <= rounding, "C({i},{j}) = {found}, eq (40) has {value}");
        }
        // (1,4) is printed 0.06 too, but 0.06 + 0.06 = 1.5 L needs L = 0.080 m where row 2 needs 0.067 m:
        // with the dimensions that give everything else it is 0.037, as a rigid rotation demands.
        assert!((c[1] + c[3] - 0.0651 * c[0]).abs() < 1e-12 && (c[3] - 0.037).abs() < 0.0005, "{}", c[3]);
    }

    #[test]
    fn a_rigid_rotation_costs_nothing_with_the_corrected_sign_and_something_as_printed() {
        // θ = 1 about point 2 takes point 3 to L: C u must vanish up to the printed digits. L is 0.065 m.
        let corrected: [f64; 4] = [0.06, 0.033, -0.06, -0.029];
        let moment = corrected[1] + corrected[2] * 0.0651 + corrected[3];
        assert!(moment.abs() < 0.001, "{moment}");
        let printed = [0.06, 0.033, 0.06, 0.029];
        assert!(printed[1] + printed[2] * 0.0651 + printed[3] > 0.06);
    }

    proptest! {
        #[test]
        fn modal_ratios_come_back_from_the_matrix_and_rigid_motions_stay_undamped(
            m in prop::array::uniform2(0.2f64..6.0), size in prop::array::uniform2(0.02f64..0.15),
            ei in 1.0f64..1e3, length in 0.02f64..0.1, ratios in prop::array::uniform2(1e-4f64..0.05)
        ) {
            let inertia = [m[0] * size[0] * size[0] / 3.0, m[1] * size[1] * size[1] / 3.0];
            let mass = two_blocks(m, inertia, size);
            let modes = generalized_symmetric_eigen(4, &mass, &element_stiffness(ei, length).concat()).unwrap();
            let damping = DampingLaw::ModalRatios(ratios.to_vec()).of_modes(modes.eigenvalues());
            prop_assert_eq!(&modes.eigenvalues()[..2], &[0.0, 0.0]);
            let c = viscous_matrix(&mass, &modes, &damping);
            for r in 0..4 {
                for q in 0..4 {
                    let (left, right) = (modes.shape(r), modes.shape(q));
                    let modal: f64 = (0..4).map(|i| (0..4).map(|j| left[i] * c[i * 4 + j] * right[j]).sum::<f64>()).sum();
                    let expected = if r == q { damping[r].viscous } else { 0.0 };
                    prop_assert!((modal - expected).abs() < 1e-9 * damping[3].viscous.max(damping[2].viscous), "({}, {}): {} for {}", r, q, modal, expected);
                }
            }
            for (r, ratio) in ratios.iter().enumerate() {
                let omega = modes.eigenvalues()[2 + r].sqrt();
                prop_assert!((damping[2 + r].viscous / (2.0 * omega) - ratio).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn modes_beyond_the_list_take_the_last_ratio() {
        let damping = DampingLaw::ModalRatios(vec![0.01, 0.04, 0.02]).of_modes(&[0.0, 1.0, 4.0, 9.0, 16.0]);
        let viscous: Vec<f64> = damping.iter().map(|d| d.viscous).collect();
        assert_eq!(viscous, [0.0, 0.02, 0.16, 0.12, 0.16]);
    }

    #[test]
    fn rayleigh_constants_damp_rigid_motions_by_their_mass_term_only() {
        let law = DampingLaw::Rayleigh { mass: 2.0, stiffness: 1e-5 };
        let damping = law.of_modes(&[0.0, 1e6]);
        assert_eq!((damping[0].viscous, damping[1].viscous), (2.0, 12.0));
    }

    #[test]
    fn a_loss_factor_is_a_share_of_each_modes_stiffness_and_leaves_a_rigid_motion_alone() {
        let law = DampingLaw::LossFactor(0.02);
        let damping = |structural| ModeDamping { viscous: 0.0, structural };
        assert_eq!(law.of_modes(&[0.0, 500.0]), [damping(0.0), damping(10.0)]);
        assert_eq!(DampingLaw::Undamped.of_modes(&[0.0, 500.0]), [damping(0.0); 2]);
    }

    fn held(eigenvalue: f64, in_supports: f64, dashpots: f64) -> HeldMode {
        HeldMode { eigenvalue, in_supports, dashpots }
    }

    #[test]
    fn ratios_are_those_of_modes_that_strain_the_structure_and_of_a_suspension_only_where_nothing_else_moves()
    {
        let suspension = [held(0.0, 0.0, 0.0), held(9.0, 0.96, 0.0), held(16.0, 1.0, 0.0)];
        assert_eq!(elastic_modes(&suspension), [1, 2]);
        // A share of 0.95 is not above 0.95.
        let mut all = suspension.to_vec();
        all.extend([held(100.0, SUSPENDED, 0.0), held(400.0, 0.1, 0.0)]);
        assert_eq!(elastic_modes(&all), [3, 4]);
        let viscous = |modes: &[HeldMode]| -> Vec<f64> {
            let damping = DampingLaw::ModalRatios(vec![0.25, 0.5]).of_held_modes(modes);
            damping.iter().map(|mode| mode.viscous).collect()
        };
        assert_eq!(viscous(&all), [0.0, 0.0, 0.0, 5.0, 20.0]);
        assert_eq!(viscous(&suspension), [0.0, 1.5, 4.0]);
    }

    #[test]
    fn what_the_supports_dashpots_do_is_taken_off_the_measured_ratio_down_to_nothing() {
        let modes = [held(100.0, 0.3, 1.5), held(100.0, 0.3, 7.0)];
        let damping = DampingLaw::ModalRatios(vec![0.25]).of_held_modes(&modes);
        assert_eq!([damping[0].viscous, damping[1].viscous], [3.5, 0.0]);
        let law = DampingLaw::Rayleigh { mass: 2.0, stiffness: 0.5 };
        assert_eq!(law.of_held_modes(&modes), law.of_modes(&[100.0, 100.0]));
    }
}
