//! What the joint's ends add to its beam (eq 6): the compliance left when the beam's is taken out.

use jointscope_beam::{end_compliance, transport};
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
    /// The compliance is negative beyond its uncertainty: the joint is stiffer than the beam it is said to be.
    StifferThanTheBeam,
}

impl Compliance {
    /// The stiffness behind the compliance, with 95 % intervals.
    pub fn stiffness(&self) -> InterfaceStiffness {
        let (low, high) = (self.value - 1.96 * self.std, self.value + 1.96 * self.std);
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
/// In the matrix form D = k_J⁻¹ − k_E⁻¹ is the sum of the interfaces' compliances, each seen through its own R: at the far
/// end diag(t₃, r₃), at the near end R diag(t₂, r₂) Rᵀ = [[t₂ + r₂L², r₂L], [r₂L, r₂]]. Its three elements give r₂, r₃
/// and t₂ + t₃; the two translations act on one displacement and cannot be told apart.
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

/// (D11, D12, D22) of k_J⁻¹ − k_E⁻¹ and (1/k − 1/k_E) of the two diagonal elements; `None` for a singular k_J.
pub(crate) fn left_over(joint: RealMatrix2, bending_stiffness: f64, length: f64) -> Option<[f64; 5]> {
    let all = joint.inverse()? - end_compliance(bending_stiffness, length);
    let beam = jointscope_beam::end_stiffness(bending_stiffness, length);
    let scalar = |i: usize| 1.0 / joint.at(i, i) - 1.0 / beam.at(i, i);
    Some([all.at(0, 0), all.at(0, 1), all.at(1, 1), scalar(0), scalar(1)])
}

/// Interfaces of a joint whose beam has EI `bending_stiffness` (N·m²) and `length` (m).
///
/// `covariance` is that of (k11, k12, k22); `shifts` are changes of (D11, D12, D22) and of the two scalar
/// compliances when a quantity of the fixture moves by one standard deviation, each independent of the others.
/// `None` where the joint's stiffness is singular.
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

/// Interfaces of a joint from all FRFs: `covariance` of (k11, k12, k22) holds the length's uncertainty, to which K is tied.
///
/// `bending_stiffness` is the beam's EI with its standard deviation, N·m². `None` where the joint's stiffness is singular.
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

    #[test]
    fn deviations_of_compliances_follow_those_of_the_stiffness() {
        let joint = Matrix2::new(3e6, -1e5, -1e5, 5e3);
        let covariance = [[1e8, 0.0, 0.0], [0.0, 4e6, 1e3], [0.0, 1e3, 900.0]];
        let base = interfaces(joint, covariance, 76.0, 0.065, &[]).unwrap();
        // Against finite differences along the eigen-directions of a diagonalised covariance (Cholesky columns).
        let columns = [[1e4, 0.0, 0.0], [0.0, 2e3, 0.5], [0.0, 0.0, (900.0f64 - 0.25).sqrt()]];
        let variance: f64 = columns
            .iter()
            .map(|d| {
                let moved = |s: f64| {
                    let m = Matrix2::new(3e6 + s * d[0], -1e5 + s * d[1], -1e5 + s * d[1], 5e3 + s * d[2]);
                    interfaces(m, covariance, 76.0, 0.065, &[]).unwrap().far_rotation.value
                };
                (0.5 * (moved(1e-3) - moved(-1e-3)) / 1e-3).powi(2)
            })
            .sum();
        assert!(
            (base.far_rotation.std / variance.sqrt() - 1.0).abs() < 1e-4,
            "{} {}",
            base.far_rotation.std,
            variance.sqrt()
        );
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
        let open = Compliance { value: 1e-9, std: 1e-9 };
        assert!(
            matches!(open.stiffness(), InterfaceStiffness::StifferThan { above } if (above * 2.96e-9 - 1.0).abs() < 1e-12)
        );
        let found = Compliance { value: 1e-8, std: 1e-9 };
        assert!(
            matches!(found.stiffness(), InterfaceStiffness::Found { interval: [low, high], .. } if low < 1e8 && 1e8 < high)
        );
        let wrong = Compliance { value: -1e-8, std: 1e-9 };
        assert_eq!(wrong.stiffness(), InterfaceStiffness::StifferThanTheBeam);
    }
}
