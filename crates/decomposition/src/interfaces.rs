//! What the joint's ends add to its beam (eq 6): the compliance left when the beam's is taken out.

use jointscope_beam::{end_compliance, transport};
use jointscope_inference::interval95;
use jointscope_linalg::{Matrix2, RealMatrix2};
use serde::Serialize;

use crate::FittedLength;

/// A compliance with its standard deviation, m/N or rad/(N·m).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Compliance {
    /// The compliance.
    pub value: f64,
    /// One standard deviation.
    pub std: f64,
}

/// What a compliance and its uncertainty say of a stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InterfaceStiffness {
    /// The compliance is positive beyond its uncertainty.
    Found {
        /// One over the compliance, N/m or N·m/rad.
        stiffness: f64,
        /// 95 % interval, N/m or N·m/rad.
        interval: [f64; 2],
    },
    /// The compliance cannot be told from zero: stiffer than this test can see.
    StifferThan {
        /// The stiffness it is above, with 97.5 % probability, N/m or N·m/rad.
        above: f64,
    },
    /// The compliance is negative beyond its uncertainty: the joint is stiffer than the beam it is said to
    /// be.
    StifferThanTheBeam,
}

impl Compliance {
    /// The stiffness behind the compliance, with 95 % intervals.
    pub fn stiffness(&self) -> InterfaceStiffness {
        let [low, high] = interval95(self.value, self.std);
        if high <= 0.0 {
            InterfaceStiffness::StifferThanTheBeam
        } else if low <= 0.0 {
            InterfaceStiffness::StifferThan { above: 1.0 / high }
        } else {
            InterfaceStiffness::Found { stiffness: 1.0 / self.value, interval: [1.0 / high, 1.0 / low] }
        }
    }
}

/// The interfaces at both ends of the joint.
///
/// In the matrix form D = k_J⁻¹ − k_E⁻¹ is the sum of the interfaces' compliances, each seen through its own
/// R: at the far end diag(t₃, r₃), at the near end R diag(t₂, r₂) Rᵀ = [[t₂ + r₂L², r₂L], [r₂L, r₂]]. Its
/// three elements give r₂, r₃ and t₂ + t₃; the two translations act on one displacement and cannot be told
/// apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interfaces {
    /// Eq (6) element by element on the diagonal, both interfaces together: (1,1) in m/N, (2,2) in rad/(N·m).
    pub scalar: [Compliance; 2],
    /// Translation of both interfaces together, t₂ + t₃, m/N.
    pub translation: Compliance,
    /// Rotation at the near end (point 2), r₂, rad/(N·m).
    pub near_rotation: Compliance,
    /// Rotation at the far end (point 3), r₃, rad/(N·m).
    pub far_rotation: Compliance,
}

/// (D11, D12, D22) of k_J⁻¹ − k_E⁻¹ and (1/k − 1/k_E) of the two diagonal elements; `None` for a singular
/// k_J.
pub(crate) fn left_over(joint: RealMatrix2, bending_stiffness: f64, length: f64) -> Option<[f64; 5]> {
    let all = joint.inverse()? - end_compliance(bending_stiffness, length);
    let beam = jointscope_beam::end_stiffness(bending_stiffness, length);
    let scalar = |i: usize| 1.0 / joint.at(i, i) - 1.0 / beam.at(i, i);
    Some([all.at(0, 0), all.at(0, 1), all.at(1, 1), scalar(0), scalar(1)])
}

/// Interfaces of a joint whose beam has EI `bending_stiffness` (N·m²) and `length` (m).
///
/// `covariance` is that of (k11, k12, k22); `shifts` are changes of (D11, D12, D22) and of the two scalar
/// compliances when a quantity of the fixture moves by one standard deviation, each independent of the
/// others. `None` where the joint's stiffness is singular.
pub fn interfaces(
    joint: RealMatrix2,
    covariance: [[f64; 3]; 3],
    bending_stiffness: f64,
    length: f64,
    shifts: &[[f64; 5]],
) -> Option<Interfaces> {
    let value = left_over(joint, bending_stiffness, length)?;
    let flexibility = joint.inverse()?;
    let f = [flexibility.at(0, 0), flexibility.at(0, 1), flexibility.at(1, 1)];
    // δ(k⁻¹) = −k⁻¹ δk k⁻¹ for a symmetric k, by (k11, k12, k22).
    let by_k = [
        [-f[0] * f[0], -2.0 * f[0] * f[1], -f[1] * f[1]],
        [-f[0] * f[1], -(f[0] * f[2] + f[1] * f[1]), -f[1] * f[2]],
        [-f[1] * f[1], -2.0 * f[1] * f[2], -f[2] * f[2]],
        [-1.0 / joint.at(0, 0).powi(2), 0.0, 0.0],
        [0.0, 0.0, -1.0 / joint.at(1, 1).powi(2)],
    ];
    let combined = |weights: [f64; 5]| {
        let row: [f64; 3] = std::array::from_fn(|m| (0..5).map(|e| weights[e] * by_k[e][m]).sum());
        let noise: f64 =
            (0..3).map(|m| (0..3).map(|n| row[m] * covariance[m][n] * row[n]).sum::<f64>()).sum();
        let dot = |v: &[f64; 5]| v.iter().zip(weights).map(|(a, b)| a * b).sum::<f64>();
        let tolerance: f64 = shifts.iter().map(|shift| dot(shift).powi(2)).sum();
        Compliance { value: dot(&value), std: (noise.max(0.0) + tolerance).sqrt() }
    };
    let l = transport(length).at(0, 1);
    Some(Interfaces {
        scalar: [combined([0.0, 0.0, 0.0, 1.0, 0.0]), combined([0.0, 0.0, 0.0, 0.0, 1.0])],
        translation: combined([1.0, -l, 0.0, 0.0, 0.0]),
        near_rotation: combined([0.0, 1.0 / l, 0.0, 0.0, 0.0]),
        far_rotation: combined([0.0, -1.0 / l, 1.0, 0.0, 0.0]),
    })
}

/// Interfaces of a joint from all FRFs: `covariance` of (k11, k12, k22) holds the length's uncertainty, to
/// which K is tied.
///
/// `bending_stiffness` is the beam's EI with its standard deviation, N·m². `None` where the joint's stiffness
/// is singular.
pub(crate) fn interfaces_of_fit(
    joint: RealMatrix2,
    mut covariance: [[f64; 3]; 3],
    (bending_stiffness, std): (f64, f64),
    length: &FittedLength,
) -> Option<Interfaces> {
    let half_difference = |of: &dyn Fn(f64) -> Option<[f64; 5]>| -> Option<[f64; 5]> {
        let (up, down) = (of(1.0)?, of(-1.0)?);
        Some(std::array::from_fn(|e| 0.5 * (up[e] - down[e])))
    };
    let mut shifts =
        vec![half_difference(&|sign| left_over(joint, bending_stiffness + sign * std, length.value))?];
    if length.variance > 0.0 {
        // K as the length takes it along; what is left of its covariance is independent of the length.
        let deviation = length.variance.sqrt();
        let along = length.with_stiffness.map(|covariance| covariance / deviation);
        shifts.push(half_difference(&|sign| {
            let [a, b, d] = along.map(|by| sign * by);
            left_over(joint + Matrix2::new(a, b, b, d), bending_stiffness, length.value + sign * deviation)
        })?);
        for (m, row) in covariance.iter_mut().enumerate() {
            row.iter_mut().zip(along).for_each(|(entry, by)| *entry -= along[m] * by);
        }
    }
    interfaces(joint, covariance, bending_stiffness, length.value, &shifts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn springs_put_at_both_ends_of_a_beam_are_found_again(
            ei in 1.0f64..500.0, l in 0.02f64..0.1, t in 1e-9f64..1e-6, near in 1e-6f64..1e-3, far in 1e-6f64..1e-3
        ) {
            let at_near = Matrix2::new(near * l * l, near * l, near * l, near);
            let joint = (end_compliance(ei, l) + at_near + Matrix2::new(t, 0.0, 0.0, far)).inverse().unwrap();
            let found = interfaces(joint, [[0.0; 3]; 3], ei, l, &[]).unwrap();
            let scale = end_compliance(ei, l);
            prop_assert!((found.translation.value - t).abs() < 1e-8 * (scale.at(0, 0) + t + near * l * l));
            prop_assert!((found.near_rotation.value - near).abs() < 1e-8 * (scale.at(1, 1) + near + far));
            prop_assert!((found.far_rotation.value - far).abs() < 1e-8 * (scale.at(1, 1) + near + far));
        }
    }

    /// All five compliances.
    fn all(of: &Interfaces) -> [Compliance; 5] {
        [of.scalar[0], of.scalar[1], of.translation, of.near_rotation, of.far_rotation]
    }

    const EI: f64 = 76.0;
    const LENGTH: f64 = 0.065;

    fn joint(moved: [f64; 3]) -> RealMatrix2 {
        Matrix2::new(3e6 + moved[0], -1e5 + moved[1], -1e5 + moved[1], 5e3 + moved[2])
    }

    /// By how much each compliance changes to first order when K does so.
    fn by_stiffness(direction: [f64; 3]) -> [f64; 5] {
        let at = |step: f64| {
            let moved = joint(direction.map(|by| step * by));
            all(&interfaces(moved, [[0.0; 3]; 3], EI, LENGTH, &[]).unwrap())
        };
        let (up, down) = (at(1e-3), at(-1e-3));
        std::array::from_fn(|e| 0.5e3 * (up[e].value - down[e].value))
    }

    #[test]
    fn deviations_of_compliances_follow_those_of_the_stiffness_and_add_to_those_of_tolerances_as_squares() {
        // Columns of the covariance's Cholesky factor.
        let columns = [[1e4, 30.0, 3.0], [0.0, 2e3, 0.5], [0.0, 0.0, 30.0]];
        let covariance: [[f64; 3]; 3] = std::array::from_fn(|m| {
            std::array::from_fn(|n| columns.iter().map(|column| column[m] * column[n]).sum())
        });
        // A tolerance that moves what is left over as this change of K does.
        let (before, after) =
            (left_over(joint([0.0; 3]), EI, LENGTH), left_over(joint([3e4, 2e3, 90.0]), EI, LENGTH));
        let shift: [f64; 5] = std::array::from_fn(|e| after.unwrap()[e] - before.unwrap()[e]);
        let moved = all(&interfaces(joint([3e4, 2e3, 90.0]), covariance, EI, LENGTH, &[]).unwrap());
        let found = all(&interfaces(joint([0.0; 3]), covariance, EI, LENGTH, &[shift]).unwrap());
        let changes = columns.map(by_stiffness);
        for e in 0..5 {
            let noise: f64 = changes.iter().map(|change| change[e].powi(2)).sum();
            let tolerance = (moved[e].value - found[e].value).powi(2);
            let expected = (noise + tolerance).sqrt();
            assert!((found[e].std / expected - 1.0).abs() < 1e-5, "{e}: {} for {expected}", found[e].std);
        }
    }

    #[test]
    fn a_length_tied_to_the_stiffness_counts_with_it_and_the_beams_bending_stiffness_by_itself() {
        let (variance, ei_std) = (4e-8, 0.5);
        let deviation = f64::sqrt(variance);
        // K moves by `along` with one deviation of the length, and by the columns without it.
        let along = [-2e4, 700.0, -8.0];
        let columns = [[5e3, 40.0, 1.0], [0.0, 900.0, 0.2], [0.0, 0.0, 11.0]];
        let covariance = std::array::from_fn(|m| {
            std::array::from_fn(|n| along[m] * along[n] + columns.iter().map(|c| c[m] * c[n]).sum::<f64>())
        });
        let length = FittedLength { value: LENGTH, variance, with_stiffness: along.map(|by| by * deviation) };
        let found = all(&interfaces_of_fit(joint([0.0; 3]), covariance, (EI, ei_std), &length).unwrap());
        let exact = FittedLength { variance: 0.0, with_stiffness: [0.0; 3], ..length };
        let of_beam = |sign: f64| {
            all(&interfaces_of_fit(joint([0.0; 3]), [[0.0; 3]; 3], (EI + sign * ei_std, 0.0), &exact)
                .unwrap())
        };
        let mut changes = columns.map(by_stiffness).to_vec();
        // The length as `left_over` takes it; it does not move the arm at which rotations are told.
        let of_length =
            |sign: f64| left_over(joint(along.map(|by| sign * by)), EI, LENGTH + sign * deviation).unwrap();
        let (up, down) = (of_length(1.0), of_length(-1.0));
        let left: [f64; 5] = std::array::from_fn(|e| 0.5 * (up[e] - down[e]));
        changes.push([
            left[3],
            left[4],
            left[0] - LENGTH * left[1],
            left[1] / LENGTH,
            left[2] - left[1] / LENGTH,
        ]);
        changes.push(std::array::from_fn(|e| 0.5 * (of_beam(1.0)[e].value - of_beam(-1.0)[e].value)));
        for e in 0..5 {
            let expected = changes.iter().map(|change| change[e].powi(2)).sum::<f64>().sqrt();
            assert!((found[e].std / expected - 1.0).abs() < 1e-3, "{e}: {} for {expected}", found[e].std);
        }
    }

    #[test]
    fn a_length_that_takes_the_stiffness_along_as_a_beam_does_leaves_interfaces_exact() {
        // K = EI(L) exactly: whatever L is, no interface is left.
        let (ei, l, variance) = (76.0, 0.065, 1e-8);
        let of = |l: f64| jointscope_beam::end_stiffness(ei, l);
        let by_length = (of(l + 1e-6) - of(l - 1e-6)).scale(0.5e6);
        let slope = [by_length.at(0, 0), by_length.at(0, 1), by_length.at(1, 1)];
        let covariance = std::array::from_fn(|m| std::array::from_fn(|n| slope[m] * variance * slope[n]));
        let tied = FittedLength { value: l, variance, with_stiffness: slope.map(|by| by * variance) };
        let found = interfaces_of_fit(of(l), covariance, (ei, 0.0), &tied).unwrap();
        let untied = FittedLength { with_stiffness: [0.0; 3], ..tied };
        let loose = interfaces_of_fit(of(l), covariance, (ei, 0.0), &untied).unwrap();
        assert!(found.near_rotation.std < 0.05 * loose.near_rotation.std, "{found:?} {loose:?}");
        assert!(found.scalar[0].std < 0.05 * loose.scalar[0].std);
    }

    #[test]
    fn a_compliance_that_may_be_zero_gives_a_bound_and_no_number() {
        let of = |value: f64, std: f64| Compliance { value, std }.stiffness();
        assert!(
            matches!(of(1e-9, 1e-9), InterfaceStiffness::StifferThan { above } if (above * 2.96e-9 - 1.0).abs() < 1e-12)
        );
        let InterfaceStiffness::Found { stiffness, interval: [low, high] } = of(1e-8, 1e-9) else {
            unreachable!()
        };
        for (found, expected) in [(stiffness, 1e-8), (low, 1.196e-8), (high, 0.804e-8)] {
            assert!((found * expected - 1.0).abs() < 1e-12, "{found}");
        }
        assert_eq!(of(-1e-8, 1e-9), InterfaceStiffness::StifferThanTheBeam);
        // Exactly at either end of the interval nothing is found: a compliance of zero is possible.
        assert_eq!(of(0.0, 0.0), InterfaceStiffness::StifferThanTheBeam);
        assert_eq!(of(1.96, 1.0), InterfaceStiffness::StifferThan { above: 1.0 / 3.92 });
    }
}
