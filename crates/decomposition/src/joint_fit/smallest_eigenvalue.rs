//! The probability of a smallest eigenvalue as low as that of a matrix found, if the true matrix lies on the
//! edge of what has none below zero.
//!
//! The smallest eigenvalue λ of a noisy matrix is no normal number: what other elements scatter turns the
//! eigenvector and takes λ down, whatever is true, most where the other eigenvalue is not much larger than
//! the noise. So it is not λ over its deviation that is asked for, but P(λ(M₀ + e) ≤ λ found), e normal with
//! the covariance of the elements and M₀ = v vᵀ the matrix on the edge that is nearest to the one found.
//!
//! Adding s to both diagonal elements adds s to λ. With s the part of e along the unit matrix that is
//! independent of the rest u of e, Var s = 1/(1ᵀV⁻¹1), the probability is the mean over u, which has two
//! dimensions, of Φ((λ found − λ(M₀ + u))/σ_s): a sum over a grid.
//!
//! So it is with noise. What the fixture's quantities do to a matrix turns it as a whole, k as T k Tᵀ where a
//! place is off, and does not lead away from the edge however far it goes: of their part of the covariance
//! only what λ varies by to first order counts.

use crate::settings::symmetry::PROJECTION_ROUNDS;
use jointscope_inference::normal_below;
use jointscope_linalg::Cholesky;

/// Elements 11, 12, 22 of a symmetric matrix.
type Elements = [f64; 3];

/// Of the unit matrix.
const UNIT: Elements = [1.0, 0.0, 1.0];
/// Grid in standard deviations: a sum over a normal density at this spacing is exact to rounding where the
/// rest is smooth.
const REACH: i32 = 24;
const SPACING: f64 = 0.35;

/// P(a smallest eigenvalue as low | one of zero) of a matrix found with this covariance, of which `noise` is
/// what would be left if the fixture were exact; nothing where an element is exact.
pub(super) fn as_low_if_zero(
    found: Elements,
    covariance: [[f64; 3]; 3],
    noise: [[f64; 3]; 3],
) -> Option<f64> {
    let of_quantities = {
        let by = gradient(found);
        let all = (0..9).map(|e| by[e / 3] * by[e % 3] * (covariance[e / 3][e % 3] - noise[e / 3][e % 3]));
        all.sum::<f64>().max(0.0)
    };
    let covariance = noise;
    let flat: Vec<f64> = covariance.into_iter().flatten().collect();
    let factor = Cholesky::of(3, &flat)?;
    let solved = |of: Elements| {
        let mut all = of.to_vec();
        factor.solve_in_place(&mut all);
        [all[0], all[1], all[2]]
    };
    let along = dot(UNIT, solved(UNIT)).recip();
    let edge = nearest_on_the_edge(found, &solved);
    let [first, second] = rest(&covariance, along);
    let lowest = smallest(found);
    let deviation = (along + of_quantities).sqrt();
    let (mut sum, mut total) = (0.0, 0.0);
    for i in -REACH..=REACH {
        for j in -REACH..=REACH {
            let (y, z) = (SPACING * f64::from(i), SPACING * f64::from(j));
            let weight = (-0.5 * (y * y + z * z)).exp();
            let at = std::array::from_fn(|e| edge[e] + y * first[e] + z * second[e]);
            sum += weight * normal_below((lowest - smallest(at)) / deviation);
            total += weight;
        }
    }
    Some(sum / total)
}

/// Smallest eigenvalue.
pub(super) fn smallest([a, b, d]: Elements) -> f64 {
    0.5 * (a + d) - (0.5 * (a - d)).hypot(b)
}

/// Its derivatives by the elements 11, 12, 22: vᵀ dM v of its eigenvector v.
fn gradient([a, b, d]: Elements) -> Elements {
    let angle = 0.5 * b.atan2(0.5 * (a - d));
    let (v, w) = (-angle.sin(), angle.cos());
    [v * v, 2.0 * v * w, w * w]
}

fn dot(a: Elements, b: Elements) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Two vectors whose outer products sum to V − σ²·11ᵀ: a Cholesky factor with the pivot sought, since that is
/// of rank two.
fn rest(covariance: &[[f64; 3]; 3], along: f64) -> [Elements; 2] {
    let mut left: [[f64; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| covariance[i][j] - along * UNIT[i] * UNIT[j]));
    let mut factors = [[0.0; 3]; 2];
    for factor in &mut factors {
        // Of largest share of its own variance: elements differ in size.
        let share = |i: usize| left[i][i] / covariance[i][i];
        let pivot = (0..3).fold(0, |best, i| if share(i) > share(best) { i } else { best });
        if left[pivot][pivot] <= 0.0 {
            continue;
        }
        let column = left.map(|row| row[pivot] / left[pivot][pivot].sqrt());
        left.iter_mut().zip(column).for_each(|(row, a)| {
            row.iter_mut().zip(column).for_each(|(entry, b)| *entry -= a * b);
        });
        *factor = column;
    }
    factors
}

/// v vᵀ nearest to a matrix in the metric of its covariance, `solved` being multiplied by its inverse.
fn nearest_on_the_edge(found: Elements, solved: &dyn Fn(Elements) -> Elements) -> Elements {
    let of = |[v, w]: [f64; 2]| [v * v, v * w, w * w];
    let less = |a: Elements, b: Elements| std::array::from_fn(|e| a[e] - b[e]);
    let distance = |at: [f64; 2]| {
        let residual = less(found, of(at));
        dot(residual, solved(residual))
    };
    let [a, b, d] = found;
    let largest = 0.5 * (a + d) + (0.5 * (a - d)).hypot(b);
    let angle = 0.5 * b.atan2(0.5 * (a - d));
    let length = largest.max(0.0).sqrt();
    let mut at = [length * angle.cos(), length * angle.sin()];
    let (mut least, mut damping) = (distance(at), 1e-6);
    for _ in 0..PROJECTION_ROUNDS {
        let [v, w] = at;
        let columns = [[2.0 * v, w, 0.0], [0.0, v, 2.0 * w]];
        let projected = solved(less(found, of(at)));
        let right = columns.map(|column| dot(column, projected));
        let weighted = columns.map(solved);
        let own = |i: usize, j: usize| dot(columns[i], weighted[j]);
        let (p, q, r) = (own(0, 0) * (1.0 + damping), own(0, 1), own(1, 1) * (1.0 + damping));
        let determinant = p * r - q * q;
        if determinant <= 0.0 || !determinant.is_finite() {
            break;
        }
        let step = [(r * right[0] - q * right[1]) / determinant, (p * right[1] - q * right[0]) / determinant];
        let next = [v + step[0], w + step[1]];
        let there = distance(next);
        if there < least {
            let gained = least - there;
            (at, least, damping) = (next, there, 0.1 * damping);
            if gained < 1e-9 {
                break;
            }
        } else {
            damping = 10.0 * f64::max(damping, 1e-6);
        }
    }
    of(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_samples::Noise;
    use proptest::prelude::*;

    /// P(z ≤ λ/σ): right where the eigenvector does not turn.
    fn linear(found: Elements, covariance: &[[f64; 3]; 3]) -> f64 {
        let by = gradient(found);
        let variance: f64 = (0..9).map(|e| by[e / 3] * by[e % 3] * covariance[e / 3][e % 3]).sum();
        normal_below(smallest(found) / variance.sqrt())
    }

    fn covariance(columns: [f64; 9], size: f64) -> [[f64; 3]; 3] {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let own = if i == j { 0.2 } else { 0.0 };
                size * size * (own + (0..3).map(|k| columns[3 * i + k] * columns[3 * j + k]).sum::<f64>())
            })
        })
    }

    proptest! {
        /// Against the closed form of the eigenvalue and its derivatives.
        #[test]
        fn a_matrix_is_as_likely_not_negative_as_its_smallest_eigenvalue_where_noise_is_small(
            vector in prop::array::uniform2(0.3f64..1.0), columns in prop::array::uniform9(-1.0f64..1.0), off in -2.0f64..2.0
        ) {
            let covariance = covariance(columns, 1e-4);
            let [v, w] = vector;
            let found = [v * v + 1e-4 * off, v * w, w * w + 1e-4 * off];
            let (p, expected) = (as_low_if_zero(found, covariance, covariance).unwrap(), linear(found, &covariance));
            prop_assert!((p - expected).abs() < 1e-3, "{} for {}", p, expected);
        }
    }

    #[test]
    fn p_values_are_uniform_on_the_edge_where_noise_turns_the_eigenvector() {
        // A stream of normal numbers by sums, fixed.
        let mut noise = Noise::from_state(7);
        let mut uniform = || noise.uniform();
        let mut normal = || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos();
        let runs = 1500;
        // Deviations of all elements of v vᵀ = [1, −0.8, 0.64] or of zero, and what of their variance is left
        // along the gradient of the smallest eigenvalue.
        let along = [0.3902, 0.9756, 0.6098].map(|e: f64| e / 1.2151);
        for (name, edge, deviation, left, farthest_allowed, failing_allowed) in [
            ("little noise", [1.0, -0.8, 0.64], 0.02, 1.0, 0.042, 0.067),
            ("noise", [1.0, -0.8, 0.64], 0.25, 1.0, 0.05, 0.067),
            ("eigenvalue known best", [1.0, -0.8, 0.64], 0.25, 0.02, 0.08, 0.067),
            // Where the other eigenvalue is not seen either, the nearest matrix on the edge is too large.
            ("matrix of zero", [0.0, 0.0, 0.0], 0.1, 1.0, 0.2, 0.09),
        ] {
            let covariance: [[f64; 3]; 3] = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    let own = if i == j { 1.0 } else { 0.0 };
                    deviation * deviation * (own - (1.0 - left) * along[i] * along[j])
                })
            });
            let (mut p, mut linear_p) = (Vec::new(), Vec::new());
            for _ in 0..runs {
                let noise: Elements = std::array::from_fn(|_| deviation * normal());
                let taken = (1.0 - left.sqrt()) * dot(noise, along);
                let found = std::array::from_fn(|e| edge[e] + noise[e] - taken * along[e]);
                p.push(as_low_if_zero(found, covariance, covariance).unwrap());
                linear_p.push(linear(found, &covariance));
            }
            let farthest = |p: &mut Vec<f64>| {
                p.sort_by(f64::total_cmp);
                let n = p.len() as f64;
                p.iter().enumerate().map(|(i, p)| (p - (i as f64 + 0.5) / n).abs()).fold(0.0, f64::max)
            };
            let below = |p: &[f64], q: f64| p.iter().filter(|p| **p < q).count() as f64 / f64::from(runs);
            println!(
                "{name}: below 0.05 {:.3} (by the linear formula {:.3}), 0.5 {:.3} ({:.3}), farthest {:.3} ({:.3})",
                below(&p, 0.05),
                below(&linear_p, 0.05),
                below(&p, 0.5),
                below(&linear_p, 0.5),
                farthest(&mut p),
                farthest(&mut linear_p)
            );
            assert!(farthest(&mut p) < farthest_allowed, "{name}");
            assert!(below(&p, 0.05) < failing_allowed, "{name}: {}", below(&p, 0.05));
        }
    }

    #[test]
    fn what_quantities_do_to_a_matrix_turns_it_and_counts_to_first_order_alone() {
        let noise = covariance([0.0; 9], 1e-3);
        let mut whole = noise;
        // A large common error of both elements beside the diagonal's first: congruence of v vᵀ with v
        // turned.
        let turn = [0.0, 0.1, 0.128];
        (0..3).for_each(|i| (0..3).for_each(|j| whole[i][j] += turn[i] * turn[j]));
        let found = [1.0, 0.64, 0.64 * 0.64];
        let p = as_low_if_zero(found, whole, noise).unwrap();
        // The smallest eigenvalue is not changed by it to first order.
        assert!((p - as_low_if_zero(found, noise, noise).unwrap()).abs() < 1e-3, "{p}");
        assert!((p - 0.5).abs() < 0.01, "{p}");
    }

    #[test]
    fn an_exact_matrix_is_not_tested() {
        assert_eq!(as_low_if_zero([1.0, 0.0, 1.0], [[0.0; 3]; 3], [[0.0; 3]; 3]), None);
    }
}
