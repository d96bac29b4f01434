//! Several specimens of one kind: how far they scatter, apart from how well each is measured.
//!
//! A number of specimen i is x_i = μ + b_i + e_i: b_i is what the specimens differ by, normal with the
//! standard deviation τ; e_i the error of measurement, whose covariance is known, common errors included.
//! With n − 1 orthonormal contrasts A, y = A x is free of μ and has the covariance A V Aᵀ + τ², so that
//! Q(τ²) = yᵀ (A V Aᵀ + τ²)⁻¹ y is χ² with n − 1 degrees of freedom for the true τ: its quantiles give an
//! exact interval, Q = n − 1 the estimate (Mandel and Paule), Q(0) the test of equal specimens.

use crate::{FigureInterval, Number, Together};
use jointscope_inference::{SIGNIFICANT, Z95, chi_squared_above, chi_squared_exceeded, student_exceeded};
use jointscope_linalg::{Cholesky, dot};
use serde::Serialize;

/// Specimens of one kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Specimens {
    /// What they are called.
    pub name: String,
    /// The joints.
    pub joints: Vec<String>,
    /// By number.
    pub numbers: Vec<Scatter>,
}

/// How one number scatters between specimens.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scatter {
    /// `K11` ….
    pub element: String,
    /// SI unit.
    pub unit: &'static str,
    /// Mean over the specimens, as that of their kind: the scatter of so few included.
    pub mean: FigureInterval,
    /// Standard deviation between specimens.
    pub between: f64,
    /// Its 95 % interval: from zero where the measurement explains the scatter, without an upper end where
    /// specimens are closer to each other than errors of measurement leave them in 97.5 of 100 cases, so that
    /// no scatter at all explains them.
    pub between_ci95: (f64, Option<f64>),
    /// Standard deviation of measurement in what specimens differ by: errors that all share are no part of
    /// it.
    pub measurement: f64,
    /// Probability of a scatter as large or larger, if the specimens are the same.
    pub p_value: f64,
}

impl Scatter {
    /// Whether specimens differ by more than their measurement explains.
    pub fn is_significant(&self) -> bool {
        self.p_value < SIGNIFICANT
    }
}

impl Specimens {
    /// Of the joints at these places among all.
    pub(crate) fn of(name: &str, together: &Together, numbers: &[Number], joints: &[(usize, &str)]) -> Self {
        let places: Vec<usize> = joints.iter().map(|(place, _)| *place).collect();
        let scatter = |n: usize| {
            let values: Vec<f64> = places.iter().map(|&joint| together.value(joint, n)).collect();
            let covariance: Vec<f64> = places
                .iter()
                .flat_map(|&a| places.iter().map(move |&b| together.covariance((a, n), (b, n))))
                .collect();
            Scatter::of((numbers[n].name(), numbers[n].unit()), &values, &covariance)
        };
        Specimens {
            name: name.to_owned(),
            joints: joints.iter().map(|(_, name)| (*name).to_owned()).collect(),
            numbers: (0..numbers.len()).map(scatter).collect(),
        }
    }
}

impl Scatter {
    /// Of two values or more with the covariance of their errors, row-major.
    fn of((element, unit): (String, &'static str), values: &[f64], covariance: &[f64]) -> Self {
        let n = values.len();
        let degrees = n - 1;
        let contrasts = Contrasts::of(values, covariance);
        let size = contrasts.y.iter().map(|y| y * y).sum::<f64>();
        let root = |q: f64| contrasts.variance_where(q, size).sqrt();
        let mean = values.iter().sum::<f64>() / n as f64;
        // The scatter of the values themselves holds all errors but those in common.
        let scatter = size / degrees as f64;
        let own = contrasts.trace / degrees as f64;
        let whole = covariance.iter().sum::<f64>() / (n * n) as f64;
        let common = (whole - own / n as f64).max(0.0);
        let t = student_exceeded(0.025, degrees as f64);
        // A mean is never known better than its values are measured.
        let scatter = scatter.max(own);
        let highest = chi_squared_exceeded(0.975, degrees as f64);
        let has_upper = contrasts.q(0.0) > highest;
        let half = (t * t * scatter / n as f64 + Z95 * Z95 * common).sqrt();
        let std = (scatter / n as f64 + common).sqrt();
        Scatter {
            element,
            unit,
            mean: FigureInterval { value: mean, std, ci95: [mean - half, mean + half] },
            between: root(degrees as f64),
            between_ci95: (
                root(chi_squared_exceeded(0.025, degrees as f64)),
                has_upper.then(|| root(highest)),
            ),
            measurement: own.max(0.0).sqrt(),
            p_value: if size > 0.0 { chi_squared_above(contrasts.q(0.0), degrees as f64) } else { 1.0 },
        }
    }
}

/// Orthonormal contrasts of values and the covariance of their errors.
struct Contrasts {
    y: Vec<f64>,
    covariance: Vec<f64>,
    trace: f64,
}

impl Contrasts {
    /// Helmert's: each value against the mean of those before it.
    fn of(values: &[f64], covariance: &[f64]) -> Self {
        let n = values.len();
        let row = |k: usize| -> Vec<f64> {
            let scale = ((k * (k + 1)) as f64).sqrt();
            (0..n)
                .map(|i| if i < k { -1.0 } else { f64::from(u8::from(i == k)) * k as f64 } / scale)
                .collect()
        };
        let rows: Vec<Vec<f64>> = (1..n).map(row).collect();
        let product = |a: &[f64], b: &[f64]| -> f64 {
            a.iter().zip(covariance.chunks_exact(n)).map(|(a, row)| a * dot(row, b)).sum()
        };
        let covariance: Vec<f64> =
            rows.iter().flat_map(|a| rows.iter().map(move |b| product(a, b))).collect();
        let trace = (0..n - 1).map(|i| covariance[i * n]).sum();
        Contrasts { y: rows.iter().map(|row| dot(row, values)).collect(), covariance, trace }
    }

    /// Q at a variance between specimens; infinite where nothing at all scatters by then.
    fn q(&self, variance: f64) -> f64 {
        let n = self.y.len();
        let mut matrix = self.covariance.clone();
        (0..n).for_each(|i| matrix[i * n + i] += variance);
        let Some(factor) = Cholesky::of(n, &matrix) else { return f64::INFINITY };
        let mut solved = self.y.clone();
        factor.solve_lower_in_place(&mut solved);
        solved.iter().map(|x| x * x).sum()
    }

    /// The variance at which Q falls to `target`; zero where it is below it already.
    fn variance_where(&self, target: f64, size: f64) -> f64 {
        if size == 0.0 || self.q(0.0) <= target {
            return 0.0;
        }
        // Q is at most |y|²/τ².
        let (mut low, mut high) = (0.0, size / target);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if self.q(middle) > target { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn of(values: &[f64], covariance: &[f64]) -> Scatter {
        Scatter::of(("K11".to_owned(), "N/m"), values, covariance)
    }

    /// Independent errors of variance `own` with one in common of variance `common`.
    fn errors(n: usize, own: f64, common: f64) -> Vec<f64> {
        (0..n * n).map(|e| common + if e / n == e % n { own } else { 0.0 }).collect()
    }

    #[test]
    fn without_errors_of_measurement_the_scatter_is_that_of_the_values() {
        let values = [10.0, 12.0, 11.0, 15.0];
        let found = of(&values, &errors(4, 0.0, 0.0));
        // s² = 14/3; its interval by χ² of three degrees of freedom: 9.3484 and 0.2158.
        assert!((found.between - (14.0_f64 / 3.0).sqrt()).abs() < 1e-9, "{found:?}");
        assert!((found.between_ci95.0 - (14.0_f64 / 9.348_404).sqrt()).abs() < 1e-5, "{found:?}");
        assert!((found.between_ci95.1.unwrap() - (14.0_f64 / 0.215_795).sqrt()).abs() < 1e-4, "{found:?}");
        // Student's t of three degrees of freedom: 3.1824.
        assert!((found.mean.ci95[1] - 12.0 - 3.182_446 * (14.0_f64 / 12.0).sqrt()).abs() < 1e-5);
    }

    #[test]
    fn specimens_closer_than_they_are_measured_tell_no_upper_end_and_no_better_mean() {
        // Q(0) = 0.5·10⁻⁴, below the 9.8·10⁻⁴ that it exceeds in 97.5 of 100 cases.
        let found = of(&[10.0, 10.01], &errors(2, 1.0, 0.0));
        assert_eq!((found.between, found.between_ci95), (0.0, (0.0, None)));
        assert!((found.mean.std - 0.5_f64.sqrt()).abs() < 1e-9, "{found:?}");
        assert!((found.mean.ci95[1] - 10.005 - 12.706_205 * 0.5_f64.sqrt()).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn errors_that_all_specimens_share_are_no_scatter_between_them() {
        let values = [10.0, 12.0, 11.0, 15.0];
        let (alone, shared) = (of(&values, &errors(4, 0.5, 0.0)), of(&values, &errors(4, 0.5, 100.0)));
        assert!(
            (alone.between - shared.between).abs() < 1e-6
                && (alone.measurement - 0.5_f64.sqrt()).abs() < 1e-12
        );
        // 14/(0.5 + τ²) = 3.
        assert!((alone.between - (14.0_f64 / 3.0 - 0.5).sqrt()).abs() < 1e-6);
        assert!(shared.mean.std > 10.0 && alone.mean.std < 2.0);
    }

    #[test]
    fn the_interval_of_the_scatter_holds_it_95_times_in_100_and_equal_specimens_are_told_apart_5_times() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut normal = || crate::ranking::normal(&mut random);
        let runs = 2000;
        let (mut holds, mut mean_holds, mut told) = (0, 0, 0);
        for _ in 0..runs {
            let common = 2.0 * normal();
            let errors: Vec<f64> = (0..5).map(|_| common + 0.7 * normal()).collect();
            let values: Vec<f64> = errors.iter().map(|error| 50.0 + 1.3 * normal() + error).collect();
            let covariance = super::tests::errors(5, 0.49, 4.0);
            let found = of(&values, &covariance);
            let (low, high) = found.between_ci95;
            holds += usize::from(low <= 1.3 && high.is_some_and(|high| 1.3 <= high));
            mean_holds += usize::from((found.mean.ci95[0]..=found.mean.ci95[1]).contains(&50.0));
            told += usize::from(of(&errors, &covariance).p_value < 0.05);
        }
        // Three standard errors of 0.95 in 2000 runs are 0.015.
        let share = |count: usize| count as f64 / f64::from(runs);
        assert!((0.935..0.965).contains(&share(holds)), "{}", share(holds));
        assert!((0.935..0.99).contains(&share(mean_holds)), "{}", share(mean_holds));
        assert!((0.035..0.065).contains(&share(told)), "{}", share(told));
    }
}
