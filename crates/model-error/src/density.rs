//! How probable recorded features are at given sizes of a model's error: ln N(d; 0, C), with d the features
//! less those of the model and C = S(τ) + J·Jᵀ their covariance, by errors of the model and of the recording
//! and by the parameters of a linear model.

use crate::errors::{ErrorSizes, SharedFeatures};
use jointscope_linalg::Cholesky;
use std::f64::consts::TAU;

/// The density at many sizes of the error: what does not depend on them is formed once.
pub(crate) struct Density<'a> {
    comparison: &'a SharedFeatures,
    difference: &'a [f64],
    /// Noise and J·Jᵀ, lower triangle.
    fixed: Vec<f64>,
    covariance: Vec<f64>,
    factor: Cholesky,
    white: Vec<f64>,
}

impl<'a> Density<'a> {
    /// Of these differences, which each of the parameters moves by its slopes, J's columns.
    pub(crate) fn of(difference: &'a [f64], slopes: &[Vec<f64>], comparison: &'a SharedFeatures) -> Self {
        let n = comparison.count();
        let mut fixed = comparison.noise.to_vec();
        for slope in slopes {
            for i in 0..n {
                let a = slope[i];
                if a != 0.0 {
                    fixed[i * n..=i * n + i].iter_mut().zip(slope).for_each(|(entry, b)| *entry += a * b);
                }
            }
        }
        let covariance = vec![0.0; n * n];
        let (factor, white) = (Cholesky::identity(n), vec![0.0; n]);
        Density { comparison, difference, fixed, covariance, factor, white }
    }

    /// ln N(d; 0, C), nats; `None` where C is not positive definite.
    pub(crate) fn ln(&mut self, sizes: &ErrorSizes) -> Option<f64> {
        self.covariance.copy_from_slice(&self.fixed);
        self.comparison.add_errors(sizes, &mut self.covariance);
        let factor = self.factor.anew(&self.covariance)?;
        self.white.copy_from_slice(self.difference);
        factor.solve_lower_in_place(&mut self.white);
        let chi2: f64 = self.white.iter().map(|v| v * v).sum();
        Some(-0.5 * (chi2 + factor.ln_determinant() + self.white.len() as f64 * TAU.ln()))
    }
}
