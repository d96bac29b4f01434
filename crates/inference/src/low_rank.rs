use jointscope_linalg::Cholesky;

/// A covariance S = diag(1/w) + B·Bᵀ: independent noise, and a few nuisance directions B (columns scaled by their standard
/// deviations) along which data and model differ together, such as an error of one natural frequency.
///
/// S is never formed: by Woodbury's identity residuals are weighted at the cost of one product with B each.
#[derive(Debug, Clone)]
pub struct LowRankCovariance {
    weights: Vec<f64>,
    /// Directions, one after another.
    directions: Vec<f64>,
    /// I + Bᵀ diag(w) B.
    capacitance: Cholesky,
}

impl LowRankCovariance {
    /// From weights 1/σ², one for each value, and directions of the same length, already scaled by their standard deviations. `None` where a
    /// length differs or a number is not finite.
    pub fn new(weights: Vec<f64>, directions: &[Vec<f64>]) -> Option<Self> {
        let (n, rank) = (weights.len(), directions.len());
        if directions.iter().any(|direction| direction.len() != n) {
            return None;
        }
        let product = |a: &[f64], b: &[f64]| -> f64 {
            a.iter().zip(b).zip(&weights).map(|((a, b), w)| w * a * b).sum()
        };
        let entry = |e: usize| {
            let (i, j) = (e / rank, e % rank);
            product(&directions[i], &directions[j]) + f64::from(u8::from(i == j))
        };
        let capacitance = Cholesky::of(rank, &(0..rank * rank).map(entry).collect::<Vec<f64>>())?;
        Some(LowRankCovariance { weights, directions: directions.concat(), capacitance })
    }

    /// S⁻¹·r.
    pub fn weighted(&self, residual: &[f64]) -> Vec<f64> {
        let mut weighted: Vec<f64> = residual.iter().zip(&self.weights).map(|(r, w)| r * w).collect();
        let mut amplitudes = self.along(&weighted);
        self.capacitance.solve_in_place(&mut amplitudes);
        for (direction, amplitude) in self.columns().zip(&amplitudes) {
            for ((value, along), weight) in weighted.iter_mut().zip(direction).zip(&self.weights) {
                *value -= weight * along * amplitude;
            }
        }
        weighted
    }

    /// rᵀ·S⁻¹·r.
    pub fn chi2(&self, residual: &[f64]) -> f64 {
        residual.iter().zip(self.weighted(residual)).map(|(r, w)| r * w).sum()
    }

    /// ln det S.
    pub fn ln_determinant(&self) -> f64 {
        self.capacitance.ln_determinant() - self.weights.iter().map(|w| w.ln()).sum::<f64>()
    }

    /// The most probable amplitude of each direction in a residual, in standard deviations.
    pub fn amplitudes(&self, residual: &[f64]) -> Vec<f64> {
        let weighted: Vec<f64> = residual.iter().zip(&self.weights).map(|(r, w)| r * w).collect();
        let mut amplitudes = self.along(&weighted);
        self.capacitance.solve_in_place(&mut amplitudes);
        amplitudes
    }

    fn columns(&self) -> std::slice::ChunksExact<'_, f64> {
        self.directions.chunks_exact(self.weights.len().max(1))
    }

    fn along(&self, values: &[f64]) -> Vec<f64> {
        self.columns().map(|direction| direction.iter().zip(values).map(|(d, v)| d * v).sum()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_the_dense_covariance(
            weights in prop::collection::vec(0.1f64..5.0, 6), values in prop::collection::vec(-2.0f64..2.0, 18)
        ) {
            let directions = [values[..6].to_vec(), values[6..12].to_vec()];
            let residual = &values[12..];
            let covariance = LowRankCovariance::new(weights.clone(), &directions).unwrap();
            let dense: Vec<f64> = (0..36)
                .map(|e| {
                    let (i, j) = (e / 6, e % 6);
                    let noise = if i == j { 1.0 / weights[i] } else { 0.0 };
                    noise + directions.iter().map(|d| d[i] * d[j]).sum::<f64>()
                })
                .collect();
            let factor = Cholesky::of(6, &dense).unwrap();
            let mut solved = residual.to_vec();
            factor.solve_in_place(&mut solved);
            for (a, b) in covariance.weighted(residual).iter().zip(&solved) {
                prop_assert!((a - b).abs() < 1e-9);
            }
            let chi2: f64 = residual.iter().zip(&solved).map(|(r, s)| r * s).sum();
            prop_assert!((covariance.chi2(residual) - chi2).abs() < 1e-9);
            prop_assert!((covariance.ln_determinant() - factor.ln_determinant()).abs() < 1e-9);
        }
    }

    #[test]
    fn a_residual_along_a_direction_costs_one_standard_deviation_and_not_the_noise() {
        let covariance = LowRankCovariance::new(vec![1e6; 4], &[vec![1.0, 2.0, -1.0, 0.5]]).unwrap();
        let residual = [3.0, 6.0, -3.0, 1.5];
        assert!((covariance.chi2(&residual) - 9.0).abs() < 1e-3);
        assert!((covariance.amplitudes(&residual)[0] - 3.0).abs() < 1e-5);
    }
}
