//! Likelihoods of several recordings that share parameters, put together without fitting anything again.
//!
//! Near the optimum of its fit a recording tells of its parameters x what a Gaussian tells: ln L(x) = gᵀ(x −
//! a) − ½ (x − a)ᵀ J (x − a) up to a constant, with the information J of the data *alone*: the prior of a
//! parameter that two recordings share must enter once, not twice. Parameters that only one recording knows
//! of are integrated out beforehand, with their own priors.

use crate::NormalEquations;
use jointscope_linalg::{Cholesky, dot};

/// What data tell of parameters, as a Gaussian near a point; without any prior.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadraticLikelihood {
    /// The point a.
    pub at: Vec<f64>,
    /// Gradient g of ln L there.
    pub gradient: Vec<f64>,
    /// J, row-major and whole. May be singular: what data say nothing of.
    pub information: Vec<f64>,
}

impl QuadraticLikelihood {
    /// From the normal equations at a point, of which the priors (precision by coordinate, centred at zero)
    /// are taken out.
    pub fn without_priors(
        equations: &NormalEquations,
        at: &[f64],
        precision: impl Fn(usize) -> f64,
    ) -> QuadraticLikelihood {
        let mut bare = equations.clone();
        // A negative prior takes away what the positive one added.
        (0..bare.order).for_each(|m| bare.add_prior(m, -precision(m), at[m]));
        QuadraticLikelihood { at: at.to_vec(), gradient: bare.right, information: bare.information }
    }

    /// Number of parameters.
    pub fn order(&self) -> usize {
        self.at.len()
    }

    /// The likelihood of the parameters `kept`, all others integrated out with the precisions of their own
    /// priors, which are centred at zero.
    ///
    /// `None` where data and priors leave one of the others undetermined.
    pub fn marginal(&self, kept: &[usize], precision: impl Fn(usize) -> f64) -> Option<QuadraticLikelihood> {
        let n = self.order();
        let left: Vec<usize> = (0..n).filter(|m| !kept.contains(m)).collect();
        let entry = |i: usize, j: usize| self.information[i * n + j];
        let pick =
            |rows: &[usize]| rows.iter().flat_map(|&i| kept.iter().map(move |&j| entry(i, j))).collect();
        let mut marginal = QuadraticLikelihood {
            at: kept.iter().map(|&i| self.at[i]).collect(),
            gradient: kept.iter().map(|&i| self.gradient[i]).collect(),
            information: pick(kept),
        };
        if left.is_empty() {
            return Some(marginal);
        }
        let mut own: Vec<f64> = left.iter().flat_map(|&i| left.iter().map(move |&j| entry(i, j))).collect();
        let mut pull: Vec<f64> = left.iter().map(|&i| self.gradient[i] - precision(i) * self.at[i]).collect();
        (0..left.len()).for_each(|i| own[i * left.len() + i] += precision(left[i]));
        let factor = Cholesky::of(left.len(), &own)?;
        factor.solve_lower_in_place(&mut pull);
        // L⁻¹ J_left,kept, a column for each parameter kept.
        let columns = kept.iter().map(|&j| {
            let mut column: Vec<f64> = left.iter().map(|&i| entry(i, j)).collect();
            factor.solve_lower_in_place(&mut column);
            column
        });
        let columns: Vec<Vec<f64>> = columns.collect();
        let k = kept.len();
        for i in 0..k {
            marginal.gradient[i] -= dot(&columns[i], &pull);
            (0..k).for_each(|j| marginal.information[i * k + j] -= dot(&columns[i], &columns[j]));
        }
        Some(marginal)
    }

    /// The same in units of which one of the present ones is `scale` many.
    pub fn scaled(mut self, scale: impl Fn(usize) -> f64) -> QuadraticLikelihood {
        let n = self.order();
        for i in 0..n {
            self.at[i] *= scale(i);
            self.gradient[i] /= scale(i);
            (0..n).for_each(|j| self.information[i * n + j] /= scale(i) * scale(j));
        }
        self
    }

    /// Adds it to normal equations about `reference`, parameter i of this likelihood being coordinate
    /// `places[i]` there.
    pub fn add_to(&self, equations: &mut NormalEquations, reference: &[f64], places: &[usize]) {
        let n = self.order();
        let away: Vec<f64> = places.iter().zip(&self.at).map(|(&place, at)| reference[place] - at).collect();
        for (i, &row) in places.iter().enumerate() {
            let own = &self.information[i * n..(i + 1) * n];
            let pulled: f64 = own.iter().zip(&away).map(|(entry, away)| entry * away).sum();
            equations.right[row] += self.gradient[i] - pulled;
            for (&column, entry) in places.iter().zip(own) {
                equations.information[row * equations.order + column] += entry;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Rows of a linear model y = A x + e, e of unit variance, about a point that is not the optimum.
    fn equations(rows: &[(&[f64], f64)], at: &[f64], precision: &[f64]) -> NormalEquations {
        let mut equations = NormalEquations::zero(at.len());
        for (row, y) in rows {
            let predicted: f64 = row.iter().zip(at).map(|(a, x)| a * x).sum();
            equations.add(1.0, y - predicted, row);
        }
        (0..at.len()).for_each(|m| equations.add_prior(m, precision[m], at[m]));
        equations
    }

    #[test]
    fn two_weighings_on_one_scale_have_the_closed_form_of_their_difference() {
        // y₁ = x₁ + q + e₁, y₂ = x₂ + q + e₂, of variances 1, with q of prior variance 100: x₂ − x₁ = y₂ − y₁
        // with variance 2 whatever q, each x by itself 101; the covariance of x₁ and x₂ is that of q.
        let about = [0.3, -1.7];
        let fit = |y: f64| {
            let equations = equations(&[(&[1.0, 1.0], y)], &about, &[0.0, 0.01]);
            QuadraticLikelihood::without_priors(&equations, &about, |m| if m == 1 { 0.01 } else { 0.0 })
        };
        let mut all = NormalEquations::zero(3);
        fit(5.0).add_to(&mut all, &[0.0; 3], &[0, 2]);
        fit(7.0).add_to(&mut all, &[0.0; 3], &[1, 2]);
        all.add_prior(2, 0.01, 0.0);
        let (found, covariance) = (all.step(0.0).unwrap(), all.covariance().unwrap());
        assert!((found[0] - 5.0).abs() < 1e-9 && (found[1] - 7.0).abs() < 1e-9, "{found:?}");
        assert!((covariance.at(0, 0) - 101.0).abs() < 1e-8 && (covariance.at(0, 1) - 100.0).abs() < 1e-8);
        let difference = covariance.at(0, 0) + covariance.at(1, 1) - 2.0 * covariance.at(0, 1);
        assert!((difference - 2.0).abs() < 1e-8, "{difference}");
    }

    proptest! {
        #[test]
        fn parts_put_together_are_the_fit_of_all_data_at_once(
            values in prop::collection::vec(-1.0f64..1.0, 80), about in prop::collection::vec(-2.0f64..2.0, 8)
        ) {
            // Each recording: two numbers of its own, one nuisance of its own (prior 2), one shared quantity
            // (prior 0.5).
            let precision = [0.0, 0.0, 2.0, 0.5];
            let (first, second) = values.split_at(40);
            let rows = |values: &[f64]| -> Vec<(Vec<f64>, f64)> {
                values.chunks_exact(5).map(|v| (v[..4].to_vec(), 3.0 * v[4])).collect()
            };
            // All at once: x₁ x₂ n | y₁ y₂ m | q.
            let mut whole = NormalEquations::zero(7);
            let mut parts = NormalEquations::zero(5);
            for (which, values) in [first, second].into_iter().enumerate() {
                let (rows, at) = (rows(values), &about[4 * which..4 * which + 4]);
                for (row, y) in &rows {
                    let mut wide = vec![0.0; 7];
                    wide[3 * which..3 * which + 3].copy_from_slice(&row[..3]);
                    wide[6] = row[3];
                    whole.add(1.0, *y, &wide);
                }
                let borrowed: Vec<(&[f64], f64)> = rows.iter().map(|(row, y)| (row.as_slice(), *y)).collect();
                let equations = equations(&borrowed, at, &precision);
                let likelihood = QuadraticLikelihood::without_priors(&equations, at, |m| precision[m]);
                let marginal = likelihood.marginal(&[0, 1, 3], |m| precision[m]).unwrap();
                // Units do not matter.
                let marginal = marginal.scaled(|i| [1e6, 1e-3, 1.0][i]).scaled(|i| [1e-6, 1e3, 1.0][i]);
                marginal.add_to(&mut parts, &[0.1, 0.2, 0.3, 0.4, 0.0], &[2 * which, 2 * which + 1, 4]);
            }
            [(2, 2.0), (5, 2.0), (6, 0.5)].into_iter().for_each(|(m, p)| whole.add_prior(m, p, 0.0));
            parts.add_prior(4, 0.5, 0.0);
            let (Some(all), Some(step)) = (whole.covariance(), parts.step(0.0)) else { return Ok(()) };
            let (found, expected, together) = (step, whole.step(0.0).unwrap(), parts.covariance().unwrap());
            let places = [0, 1, 3, 4, 6];
            for i in 0..5 {
                let value = found[i] + [0.1, 0.2, 0.3, 0.4, 0.0][i];
                let size = all.std(places[i]) + 1e-6;
                prop_assert!((value - expected[places[i]]).abs() < 1e-5 * size * (1.0 + size), "{value} {}", expected[places[i]]);
                for j in 0..5 {
                    let scale = all.std(places[i]) * all.std(places[j]);
                    prop_assert!((together.at(i, j) - all.at(places[i], places[j])).abs() < 1e-5 * scale * (1.0 + scale));
                }
            }
        }
    }

    #[test]
    fn a_nuisance_of_which_nothing_is_known_cannot_be_integrated_out() {
        let equations = equations(&[(&[1.0, 0.0], 1.0)], &[0.0, 0.0], &[0.0, 0.0]);
        let likelihood = QuadraticLikelihood::without_priors(&equations, &[0.0, 0.0], |_| 0.0);
        assert!(likelihood.marginal(&[0], |_| 0.0).is_none());
        assert!(likelihood.marginal(&[0], |_| 1.0).is_some());
    }
}
