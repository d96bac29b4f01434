//! Normal equations of a weighted least-squares problem with priors, and the damped, bounded steps that they
//! ask for.

use crate::{Covariance, Parameter, weighted_products};
use jointscope_linalg::{Cholesky, solve_positive_definite};
use num_complex::Complex64;

/// The normal equations of a fit: the information JᵀWJ with the priors' precisions on its diagonal, and minus
/// half the objective's gradient, JᵀWr less what the priors pull.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalEquations {
    /// Number of coordinates.
    pub order: usize,
    /// Information, row-major and whole.
    pub information: Vec<f64>,
    /// Minus half the gradient.
    pub right: Vec<f64>,
}

/// Curvature, relative to the largest, below which a coordinate is damped as if it had that much.
const FLATTEST: f64 = 1e-14;
/// Rounds in which coordinates may come to their bounds within one step.
const ROUNDS: usize = 4;

impl NormalEquations {
    /// Nothing measured, nothing known.
    pub fn zero(order: usize) -> Self {
        NormalEquations { order, information: vec![0.0; order * order], right: vec![0.0; order] }
    }

    /// From complex columns of derivatives (as many as coordinates) and the residual, each value weighted by
    /// 2/σ², both parts of a complex value counting. Coordinates for which `held` is true stay where they
    /// are; `priors` are (precision, coordinate).
    pub fn of_columns(
        columns: &[impl AsRef<[Complex64]>],
        residual: &[Complex64],
        weights: &[f64],
        held: impl Fn(usize) -> bool,
        priors: impl Fn(usize) -> (f64, f64),
    ) -> Self {
        let n = columns.len();
        let free: Vec<usize> = (0..n).filter(|&m| !held(m)).collect();
        let used: Vec<&[Complex64]> = free.iter().map(|&m| columns[m].as_ref()).chain([residual]).collect();
        let all = weighted_products(&used, weights);
        let width = used.len();
        let mut equations = NormalEquations::zero(n);
        (0..n).filter(|&m| held(m)).for_each(|m| equations.information[m * n + m] = 1.0);
        for (i, &m) in free.iter().enumerate() {
            equations.right[m] = all[free.len() * width + i];
            free.iter().enumerate().for_each(|(j, &k)| equations.information[m * n + k] = all[i * width + j]);
            let (precision, coordinate) = priors(m);
            equations.add_prior(m, precision, coordinate);
        }
        equations
    }

    /// Adds one real residual of the given weight with its derivatives by all coordinates.
    pub fn add(&mut self, weight: f64, residual: f64, derivatives: &[f64]) {
        for (m, derivative) in derivatives.iter().enumerate().filter(|(_, d)| **d != 0.0) {
            let weighted = weight * derivative;
            self.right[m] += weighted * residual;
            let row = &mut self.information[m * self.order..(m + 1) * self.order];
            row.iter_mut().zip(derivatives).for_each(|(entry, other)| *entry += weighted * other);
        }
    }

    /// Adds the prior of coordinate `index`, which stands at `coordinate` from its centre.
    pub fn add_prior(&mut self, index: usize, precision: f64, coordinate: f64) {
        self.information[index * self.order + index] += precision;
        self.right[index] -= precision * coordinate;
    }

    fn damped(&self, damping: f64) -> Vec<f64> {
        let n = self.order;
        let largest = (0..n).map(|m| self.information[m * n + m]).fold(0.0, f64::max);
        let mut matrix = self.information.clone();
        for m in 0..n {
            matrix[m * n + m] += damping * self.information[m * n + m].max(FLATTEST * largest);
        }
        matrix
    }

    /// The step with every curvature raised by the share `damping`; `None` where that is not positive
    /// definite.
    pub fn step(&self, damping: f64) -> Option<Vec<f64>> {
        let (mut matrix, mut step) = (self.damped(damping), self.right.clone());
        solve_positive_definite(&mut matrix, &mut step).then_some(step)
    }

    /// As [`NormalEquations::step`] from `coordinates`, within the parameters' bounds: a coordinate whose
    /// step would cross its bound stops there, and the others are solved for again.
    pub fn bounded_step(
        &self,
        damping: f64,
        coordinates: &[f64],
        parameters: &[Parameter],
    ) -> Option<Vec<f64>> {
        let n = self.order;
        let matrix = self.damped(damping);
        let mut stopped: Vec<Option<f64>> = vec![None; n];
        for _ in 0..ROUNDS {
            let free: Vec<usize> = (0..n).filter(|&m| stopped[m].is_none()).collect();
            let mut reduced = Vec::with_capacity(free.len() * free.len());
            let mut rest = Vec::with_capacity(free.len());
            for &i in &free {
                reduced.extend(free.iter().map(|&j| matrix[i * n + j]));
                let known: f64 = (0..n).filter_map(|j| stopped[j].map(|s| matrix[i * n + j] * s)).sum();
                rest.push(self.right[i] - known);
            }
            if !free.is_empty() && !solve_positive_definite(&mut reduced, &mut rest) {
                return None;
            }
            let mut crossed = false;
            for (&m, step) in free.iter().zip(&rest) {
                let target = coordinates[m] + step;
                let inside = parameters[m].clamp(target);
                if inside != target {
                    stopped[m] = Some(inside - coordinates[m]);
                    crossed = true;
                }
            }
            if !crossed {
                let mut step: Vec<f64> = stopped.iter().map(|s| s.unwrap_or(0.0)).collect();
                free.iter().zip(&rest).for_each(|(&m, value)| step[m] = *value);
                return Some(step);
            }
        }
        None
    }

    /// The step across a curved valley that corrects a `share` of an undamped one: what an undamped step from
    /// where it led (`self`, at `coordinates`) differs from the rest of the first one (`before`, at
    /// `earlier`).
    pub fn correction(
        &self,
        coordinates: &[f64],
        (before, earlier): (&NormalEquations, &[f64]),
        share: f64,
        parameters: &[Parameter],
    ) -> Option<Vec<f64>> {
        let here = self.bounded_step(0.0, coordinates, parameters)?;
        let first = before.bounded_step(0.0, earlier, parameters)?;
        Some(here.iter().zip(&first).map(|(here, first)| here - (1.0 - share) * first).collect())
    }

    /// Decrease of the objective by an undamped step within bounds, if the model follows its derivatives.
    pub fn promised(&self, coordinates: &[f64], parameters: &[Parameter]) -> f64 {
        let step = self.bounded_step(0.0, coordinates, parameters).unwrap_or_default();
        step.iter().zip(&self.right).map(|(step, right)| step * right).sum::<f64>().abs()
    }

    /// Covariance of the coordinates, the inverse of the information; `None` where a combination is not
    /// determined.
    pub fn covariance(&self) -> Option<Covariance> {
        let factor = Cholesky::of(self.order, &self.information)?;
        Some(Covariance::new(self.order, factor.inverse()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Transform;
    use proptest::prelude::*;

    fn of(values: &[f64]) -> NormalEquations {
        let mut equations = NormalEquations::zero(3);
        for row in values.chunks_exact(4) {
            equations.add(1.0, row[3], &row[..3]);
        }
        (0..3).for_each(|m| equations.add_prior(m, 0.1, 0.0));
        equations
    }

    proptest! {
        #[test]
        fn a_step_within_bounds_is_the_best_of_all_points_within_them(values in prop::collection::vec(-1.0f64..1.0, 24), high in 0.01f64..0.5) {
            let equations = of(&values);
            let free = Parameter::new(Transform::Linear { centre: 0.0, scale: 1.0 });
            let parameters = [free.between(-high, high), free, free];
            let at = [0.0; 3];
            let step = equations.bounded_step(0.0, &at, &parameters).unwrap();
            prop_assert!(step[0].abs() <= high);
            let decrease = |step: &[f64]| {
                let curved: f64 = (0..9).map(|e| step[e / 3] * equations.information[e] * step[e % 3]).sum();
                2.0 * step.iter().zip(&equations.right).map(|(s, r)| s * r).sum::<f64>() - curved
            };
            let best = decrease(&step);
            for m in 0..3 {
                for by in [-1e-3, 1e-3] {
                    let mut other = step.clone();
                    other[m] += by;
                    if other[0].abs() <= high {
                        prop_assert!(decrease(&other) <= best + 1e-12);
                    }
                }
            }
        }

        #[test]
        fn complex_values_count_by_both_of_their_parts(values in prop::collection::vec(-1.0f64..1.0, 8)) {
            let z = |k: usize| Complex64::new(values[k], values[k + 1]);
            let mut real = NormalEquations::zero(2);
            real.add(3.0, z(0).re, &[z(2).re, z(4).re]);
            real.add(3.0, z(0).im, &[z(2).im, z(4).im]);
            let columns = NormalEquations::of_columns(&[vec![z(2)], vec![z(4)]], &[z(0)], &[3.0], |_| false, |_| (0.0, 0.0));
            let pairs = real.information.iter().zip(&columns.information).chain(real.right.iter().zip(&columns.right));
            for (a, b) in pairs {
                prop_assert!((a - b).abs() < 1e-12);
            }
        }

        #[test]
        fn covariance_times_information_is_the_identity(values in prop::collection::vec(-1.0f64..1.0, 24)) {
            let equations = of(&values);
            let covariance = equations.covariance().unwrap();
            for i in 0..3 {
                for j in 0..3 {
                    let product: f64 = (0..3).map(|k| equations.information[3 * i + k] * covariance.at(k, j)).sum();
                    prop_assert!((product - f64::from(u8::from(i == j))).abs() < 1e-9);
                }
            }
        }
    }
}
