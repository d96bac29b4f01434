//! What a fit leaves uncertain: the covariance by its curvature, by the fits without each block of the data,
//! and how much larger it is where residuals are correlated.

use num_complex::Complex64;

/// Covariance of the coordinates of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Covariance {
    order: usize,
    entries: Vec<f64>,
}

impl Covariance {
    /// From its entries, row-major and whole.
    pub fn new(order: usize, entries: Vec<f64>) -> Self {
        Covariance { order, entries }
    }

    /// Number of coordinates.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Covariance of coordinates `i` and `j`.
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.order + j]
    }

    /// Standard deviation of coordinate `index`.
    pub fn std(&self, index: usize) -> f64 {
        self.at(index, index).sqrt()
    }

    /// The entries, row-major and whole.
    pub fn entries(&self) -> &[f64] {
        &self.entries
    }
}

/// Covariance of a fit to all blocks of the data from the fits without each of them (Tukey's jackknife).
pub fn jackknife(without_each: &[Vec<f64>]) -> Covariance {
    let blocks = without_each.len() as f64;
    let order = without_each.first().map_or(0, Vec::len);
    let mean = |m: usize| without_each.iter().map(|fit| fit[m]).sum::<f64>() / blocks;
    let means: Vec<f64> = (0..order).map(mean).collect();
    let product = |m: usize, n: usize| {
        let products = without_each.iter().map(|fit| (fit[m] - means[m]) * (fit[n] - means[n]));
        (blocks - 1.0) / blocks * products.sum::<f64>()
    };
    Covariance::new(order, (0..order * order).map(|e| product(e / order, e % order)).collect())
}

/// Correlation of neighbours within series of `length` values each, of mean zero: near zero where residuals
/// are white.
pub fn autocorrelation(values: &[Complex64], length: usize) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for series in values.chunks_exact(length.max(1)) {
        product += series.windows(2).map(|pair| (pair[0].conj() * pair[1]).re).sum::<f64>();
        square += series.iter().map(|value| value.norm_sqr()).sum::<f64>();
    }
    if square > 0.0 { product / square } else { 0.0 }
}

/// Autocorrelation that chance hardly makes, and the largest that is corrected for.
const CORRELATED: (f64, f64) = (0.15, 0.9);

/// Variance inflation: χ² per degree of freedom where that is above one, times (1 + ρ)/(1 − ρ) where
/// residuals of neighbouring lines are correlated by ρ. What a gain in χ² is divided by to count as one of
/// independent values of known noise.
pub fn variance_inflation(chi2_per_dof: f64, autocorrelation: f64) -> f64 {
    let (least, most) = CORRELATED;
    let rho = autocorrelation.min(most);
    let correlated = if rho > least { (1.0 + rho) / (1.0 - rho) } else { 1.0 };
    chi2_per_dof.max(1.0) * correlated
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let data = [1.0, 4.0, 2.0, 8.0, 5.0, 7.0];
        let sum: f64 = data.iter().sum();
        let without: Vec<Vec<f64>> = data.iter().map(|x| vec![(sum - x) / 5.0]).collect();
        let variance = data.iter().map(|x| (x - sum / 6.0).powi(2)).sum::<f64>() / 5.0;
        assert!((jackknife(&without).at(0, 0) - variance / 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_first_order_process_inflates_by_the_ratio_of_its_sums() {
        let mut state = 0.5f64;
        let mut seed = 1u64;
        let values: Vec<Complex64> = (0..20000)
            .map(|_| {
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                state = 0.6 * state + (seed >> 40) as f64 / (1u64 << 24) as f64 - 0.5;
                Complex64::new(state, 0.0)
            })
            .collect();
        let rho = autocorrelation(&values, values.len());
        assert!((rho - 0.6).abs() < 0.02, "{rho}");
        assert!((variance_inflation(0.9, 0.6) - 4.0).abs() < 1e-12);
        assert_eq!(variance_inflation(2.0, 0.1), 2.0);
    }
}
