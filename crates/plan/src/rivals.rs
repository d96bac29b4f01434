//! Names as rivals over one measurement that has not been made: what it would tell, on average and how often.
//!
//! By name i, whose parameters are known to the covariance P_i, the measurement would be normal about m_i
//! with the covariance S_i = Σ + J_i P_i J_iᵀ. Whitened by the noise Σ, S_i = I + A_i A_iᵀ with A_i = Σ^−½
//! J_i P_i^½. The expected ln of the Bayes factor for i against j, if i is true, is the divergence of the two
//! (Kullback–Leibler),
//!
//! D_ij = ½ [tr(S_j⁻¹ S_i) − n + (m_i − m_j)ᵀ S_j⁻¹ (m_i − m_j) + ln det S_j − ln det S_i],
//!
//! and Box & Hill's expected gain (*Technometrics* 9 (1967) 57) is Σ_i<j p_i p_j (D_ij + D_ji). With
//! S_j⁻¹ = I − A_j (I + A_jᵀA_j)⁻¹ A_jᵀ all of it follows from products of the columns of A and m: nothing is
//! as long as the measurement.
//!
//! What a diagnosis makes of one measurement is drawn from the same products: parameters of the true name and
//! noise at random, and every name at the minimum of its χ² and priors, as the diagnosis weighs names.

use crate::products::Products;
use crate::settings::outcome::{DRAWS, ROUNDING, SURE};
use jointscope_linalg::{Cholesky, normal_pair, semidefinite_factor};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Names over one measurement.
pub(crate) struct Rivals {
    products: Products,
    /// Factors of I + A_iᵀA_i.
    capacitances: Vec<Cholesky>,
}

/// What one measurement would do for a set of names.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ExpectedOutcome {
    /// D_ij, nats.
    pub divergence: Vec<Vec<f64>>,
    /// Probability that the true name is sure thereafter.
    pub sure: f64,
    /// Probability by pair that the true one of the two is at least so many times as probable as the other as
    /// sure is to unsure.
    pub separated: Vec<Vec<f64>>,
}

impl Rivals {
    /// From the products of a measurement and, of each name, the factor of the information that there is of
    /// its coordinates before. `None` where products are not finite.
    pub(crate) fn of(products: &Products, known: &[Cholesky]) -> Option<Self> {
        let order = products.order();
        let mut entries = products.entries.clone();
        // A = J·R⁻ᵀ with the information R·Rᵀ: rows first, then columns, which are rows of the transpose.
        for _ in 0..2 {
            for row in entries.chunks_exact_mut(order) {
                for (name, factor) in known.iter().enumerate() {
                    let first = products.first(name);
                    factor.solve_lower_in_place(&mut row[first..first + products.widths[name]]);
                }
            }
            for i in 0..order {
                for j in 0..i {
                    entries.swap(i * order + j, j * order + i);
                }
            }
        }
        if !entries.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        let products = Products { entries, ..products.clone() };
        let capacitance = |name: usize| {
            let width = products.widths[name];
            let mut own = products.information(name);
            (0..width).for_each(|m| own[m * width + m] += 1.0);
            Cholesky::of(width, &own)
        };
        let capacitances = (0..known.len()).map(capacitance).collect::<Option<_>>()?;
        Some(Rivals { products, capacitances })
    }

    /// D_ij: expected ln of the Bayes factor for i against j if i is true.
    pub(crate) fn divergence(&self, i: usize, j: usize) -> f64 {
        let p = &self.products;
        let (of_i, of_j) = (p.first(i)..p.first(i) + p.widths[i], p.first(j)..p.first(j) + p.widths[j]);
        let (at_i, at_j) = (p.value(i), p.value(j));
        let factor = &self.capacitances[j];
        // ‖R⁻¹A_jᵀx‖² of a column x with these products.
        let explained = |with: &dyn Fn(usize) -> f64| {
            let mut along: Vec<f64> = of_j.clone().map(with).collect();
            factor.solve_lower_in_place(&mut along);
            along.iter().map(|a| a * a).sum::<f64>()
        };
        let own: f64 = of_i.clone().map(|m| p.at(m, m)).sum();
        let own_explained: f64 = of_i.map(|column| explained(&|row| p.at(row, column))).sum();
        // tr((I + AᵀA)⁻¹AᵀA) = k − tr((I + AᵀA)⁻¹).
        let inverse = factor.inverse();
        let width = p.widths[j];
        let noise: f64 = width as f64 - (0..width).map(|m| inverse[m * width + m]).sum::<f64>();
        let apart = p.at(at_i, at_i) - 2.0 * p.at(at_i, at_j) + p.at(at_j, at_j);
        let apart_explained = explained(&|row| p.at(row, at_i) - p.at(row, at_j));
        let widths = factor.ln_determinant() - self.capacitances[i].ln_determinant();
        (0.5 * (own - own_explained - noise + apart - apart_explained + widths)).max(0.0)
    }

    /// What the measurement would do: names have the weights `weights` now, up to a factor, and physics that
    /// none covers has `unlisted` against one for the best.
    pub(crate) fn expected_outcome(&self, weights: &[f64], unlisted: f64, seed: u64) -> ExpectedOutcome {
        let count = weights.len();
        let divergence = (0..count)
            .map(|i| (0..count).map(|j| if i == j { 0.0 } else { self.divergence(i, j) }).collect())
            .collect();
        let mut sure = 0.0;
        let mut separated = vec![vec![0.0; count]; count];
        let total: f64 = weights.iter().sum();
        let noise = semidefinite_factor(self.products.order(), &self.products.entries, ROUNDING);
        for truth in 0..count {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            random.set_stream(truth as u64);
            let share = weights[truth] / total / DRAWS as f64;
            for _ in 0..DRAWS {
                let costs = self.drawn(truth, &noise, &mut random);
                let odds = |j: usize| (0.5 * (costs[truth] - costs[j])).exp() * weights[j] / weights[truth];
                let after: Vec<f64> = (0..count).map(odds).collect();
                let best = after.iter().copied().fold(0.0, f64::max);
                let all: f64 = after.iter().sum::<f64>() + unlisted * best;
                sure += if 1.0 / all >= SURE { share } else { 0.0 };
                for j in (0..count).filter(|j| *j != truth) {
                    let apart = after[j] <= (1.0 - SURE) / SURE;
                    separated[truth][j] += if apart { 1.0 / DRAWS as f64 } else { 0.0 };
                }
            }
        }
        let both = |i: usize, j: usize| if i == j { 0.0 } else { f64::min(separated[i][j], separated[j][i]) };
        let separated = (0..count).map(|i| (0..count).map(|j| both(i, j)).collect()).collect();
        ExpectedOutcome { divergence, sure, separated }
    }

    /// (y − m_j)ᵀS_j⁻¹(y − m_j) of every name, less yᵀy, for a measurement y drawn by the name `truth`.
    fn drawn(&self, truth: usize, noise: &[f64], random: &mut ChaCha8Rng) -> Vec<f64> {
        let p = &self.products;
        let order = p.order();
        let own: Vec<f64> = (0..p.widths[truth]).map(|_| normal(random)).collect();
        let free: Vec<f64> = (0..order).map(|_| normal(random)).collect();
        // Products of y = m + A·own + noise with every column.
        let with: Vec<f64> = (0..order)
            .map(|row| {
                let along: f64 =
                    own.iter().enumerate().map(|(m, z)| z * p.at(row, p.first(truth) + m)).sum::<f64>();
                let noise: f64 =
                    noise[row * order..=row * order + row].iter().zip(&free).map(|(f, z)| f * z).sum();
                p.at(row, p.value(truth)) + along + noise
            })
            .collect();
        let cost = |j: usize| {
            let at = p.value(j);
            let first = p.first(j);
            let mut along: Vec<f64> =
                (first..first + p.widths[j]).map(|row| with[row] - p.at(row, at)).collect();
            self.capacitances[j].solve_lower_in_place(&mut along);
            p.at(at, at) - 2.0 * with[at] - along.iter().map(|a| a * a).sum::<f64>()
        };
        (0..self.capacitances.len()).map(cost).collect()
    }
}

/// A standard normal number.
fn normal(random: &mut ChaCha8Rng) -> f64 {
    normal_pair(|| (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64).0
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::products::Predicted;
    use num_complex::Complex64;
    use proptest::prelude::*;

    fn normal_cdf(z: f64) -> f64 {
        // Abramowitz & Stegun 7.1.26, to 1e-7.
        let t = 1.0 / (1.0 + 0.3275911 * z.abs() / 2f64.sqrt());
        let poly =
            t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
        let upper = 0.5 * poly * (-z * z / 2.0).exp();
        if z > 0.0 { 1.0 - upper } else { upper }
    }

    #[test]
    fn two_exact_names_d_deviations_apart_have_the_closed_form_of_their_odds() {
        // y ~ N(0, 1) or N(d, 1): ln of the odds is normal about d²/2 with the variance d², whichever is
        // true.
        for d in [0.5, 2.0, 4.0] {
            let products = Products::of_number(&[(0.0, vec![]), (d, vec![])], 1.0);
            let rivals =
                Rivals::of(&products, &[Cholesky::of(0, &[]).unwrap(), Cholesky::of(0, &[]).unwrap()])
                    .unwrap();
            let outcome = rivals.expected_outcome(&[0.5, 0.5], 0.0, 1);
            assert!((outcome.divergence[0][1] - d * d / 2.0).abs() < 1e-12);
            let expected = normal_cdf((d * d / 2.0 - 9f64.ln()) / d);
            assert!((outcome.sure - expected).abs() < 0.05, "d = {d}: {} for {expected}", outcome.sure);
            assert!((outcome.separated[0][1] - expected).abs() < 0.08);
        }
    }

    #[test]
    fn an_unknown_parameter_that_does_what_the_other_name_does_leaves_nothing_to_be_told() {
        // Name 1 differs by 3, and has a parameter of deviation 100 that moves the same number.
        let products = Products::of_number(&[(0.0, vec![1.0]), (3.0, vec![1.0])], 1.0);
        let wide = || Cholesky::of(1, &[1e-4]).unwrap();
        let outcome = Rivals::of(&products, &[wide(), wide()]).unwrap().expected_outcome(&[0.5, 0.5], 0.0, 1);
        assert!(outcome.divergence[0][1] < 1e-3 && outcome.sure < 0.01, "{outcome:?}");
        let narrow = || Cholesky::of(1, &[1e6]).unwrap();
        let outcome =
            Rivals::of(&products, &[narrow(), narrow()]).unwrap().expected_outcome(&[0.5, 0.5], 0.0, 1);
        assert!((outcome.divergence[0][1] - 4.5).abs() < 1e-3);
    }

    /// ½[tr(S₁⁻¹S₀) − n + dᵀS₁⁻¹d + ln det S₁/S₀] by dense matrices of order four.
    fn dense(columns: &[Vec<f64>], values: [&[f64]; 2], widths: [usize; 2], deviations: &[f64]) -> f64 {
        let n = values[0].len();
        let covariance = |from: usize, width: usize| -> Vec<f64> {
            let entry = |e: usize| {
                let (i, j) = (e / n, e % n);
                let own = (from..from + width).map(|c| columns[c][i] * columns[c][j] * deviations[c].powi(2));
                own.sum::<f64>() + f64::from(u8::from(i == j))
            };
            (0..n * n).map(entry).collect()
        };
        let (first, second) = (covariance(0, widths[0]), covariance(widths[0], widths[1]));
        let (own, other) = (Cholesky::of(n, &first).unwrap(), Cholesky::of(n, &second).unwrap());
        let inverse = other.inverse();
        let trace: f64 = (0..n * n).map(|e| inverse[e] * first[(e % n) * n + e / n]).sum();
        let apart: Vec<f64> = (0..n).map(|i| values[0][i] - values[1][i]).collect();
        let square: f64 = (0..n * n).map(|e| apart[e / n] * inverse[e] * apart[e % n]).sum();
        0.5 * (trace - n as f64 + square + other.ln_determinant() - own.ln_determinant())
    }

    proptest! {
        #[test]
        fn it_is_the_divergence_of_dense_normal_distributions(
            entries in prop::collection::vec(-2.0f64..2.0, 20), deviations in prop::collection::vec(0.1f64..3.0, 3)
        ) {
            let columns: Vec<Vec<f64>> = entries[..12].chunks_exact(4).map(<[f64]>::to_vec).collect();
            let values = [&entries[12..16], &entries[16..]];
            let complex = |column: &[f64]| -> Vec<Complex64> {
                column.chunks_exact(2).map(|part| Complex64::new(part[0], part[1])).collect()
            };
            let names = [(0, 2), (2, 1)].map(|(from, width)| Predicted {
                values: complex(values[from / 2]),
                derivatives: columns[from..from + width].iter().map(|column| complex(column)).collect(),
            });
            let products = Products::of(&names, 0..2, &[1.0, 1.0]);
            let precision = |m: usize| deviations[m].powi(-2);
            let known = [
                Cholesky::of(2, &[precision(0), 0.0, 0.0, precision(1)]).unwrap(),
                Cholesky::of(1, &[precision(2)]).unwrap(),
            ];
            let rivals = Rivals::of(&products, &known).unwrap();
            let expected = dense(&columns, values, [2, 1], &deviations);
            prop_assert!((rivals.divergence(0, 1) - expected).abs() < 1e-9 * (1.0 + expected), "{} {expected}", rivals.divergence(0, 1));
        }
    }
}
