//! Poles that each FRF has by itself: whether they agree, and what their scatter says of the mode.

use num_complex::Complex64;
use std::f64::consts::TAU;

use crate::likelihood::{Likelihood, Poles, Prior};
use crate::observed::Observed;
use crate::settings::drift::{
    BEYOND_NOISE, KNOWN_DAMPING, KNOWN_FREQUENCY, LEAST_DRIFT, OWN_POLE_WORTH, VARIANCE_PRECISION,
};
use crate::settings::each_frf::{FEWEST_FRFS, HELD, OWN_STEPS};

/// A mode that is not at one place: its frequencies differ among the FRFs by more than their noise, as those
/// of a structure that warms up between hits do.
#[derive(Debug, Clone, PartialEq)]
pub struct DriftingMode {
    /// Standard deviation of the frequency among the FRFs beyond noise, Hz.
    pub frequency: f64,
    /// Standard deviation of the damping ratio among the FRFs beyond noise.
    pub damping_ratio: f64,
    /// FRFs in which the mode was told by itself: (index, frequency, its standard deviation, damping ratio,
    /// its standard deviation).
    pub by_frf: Vec<(usize, f64, f64, f64, f64)>,
}

/// A number and its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Value {
    pub value: f64,
    pub std: f64,
}

/// What the FRFs one by one say of a mode.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Scatter {
    /// Frequency (Hz) and damping ratio from the FRFs one by one, where they do not agree.
    pub means: Option<[Value; 2]>,
    pub drift: Option<DriftingMode>,
}

/// The scatter of each mode of `fit`.
pub(crate) fn scatter(observed: &Observed, fit: &Likelihood) -> Vec<Scatter> {
    let count = fit.poles.poles.len();
    if observed.frfs() < FEWEST_FRFS {
        return vec![Scatter::default(); count];
    }
    let prior = Prior { poles: fit.poles.poles.clone(), std: HELD };
    let one = vec![Complex64::ONE];
    let start = Poles { poles: fit.poles.poles.clone(), participations: vec![one; count] };
    let mut by_mode = vec![Vec::new(); count];
    let mut apart = Sharing::default();
    for frf in 0..observed.frfs() {
        let single = observed.single(frf);
        let Some(own) = Likelihood::search(&single, start.clone(), fit.terms, OWN_STEPS, Some(&prior)) else {
            continue;
        };
        apart.add(&single, &own);
        let inflation = own.chi2_per_dof(&single).max(1.0);
        for (mode, covariance) in own.pole_covariance().into_iter().enumerate() {
            let covariance = covariance.map(|row| row.map(|c| c * inflation));
            let pole = own.poles.poles[mode];
            if covariance[0][0].sqrt() < KNOWN_FREQUENCY && covariance[1][1].sqrt() < KNOWN_DAMPING {
                let [f, z] = deviations(pole, covariance);
                by_mode[mode].push((frf, pole.norm() / TAU, f.0, -pole.re / pole.norm(), z.0));
            }
        }
    }
    if !apart.is_paid_for(observed, fit) {
        return vec![Scatter::default(); count];
    }
    by_mode.into_iter().zip(&fit.poles.poles).map(|(own, pole)| of_mode(own, -pole.re / TAU)).collect()
}

/// χ² and unknowns of the FRFs each with poles of its own.
#[derive(Debug, Default)]
struct Sharing {
    chi2: f64,
    unknowns: usize,
    degrees: usize,
}

impl Sharing {
    fn add(&mut self, single: &Observed, own: &Likelihood) {
        self.chi2 += own.chi2;
        self.unknowns += own.unknowns();
        self.degrees += single.degrees();
    }

    /// Whether the FRFs are explained better by poles of their own than noise alone would have it. Where they
    /// are not, poles that one FRF cannot tell by itself, such as those of a close pair, differ for no
    /// reason.
    fn is_paid_for(&self, observed: &Observed, shared: &Likelihood) -> bool {
        if self.degrees != observed.degrees() || self.unknowns <= shared.unknowns() {
            return false;
        }
        let scale = self.chi2 / self.degrees.saturating_sub(self.unknowns).max(1) as f64;
        let fall = (shared.chi2 - self.chi2) / (self.unknowns - shared.unknowns()) as f64;
        fall > OWN_POLE_WORTH * scale
    }
}

fn of_mode(by_frf: Vec<(usize, f64, f64, f64, f64)>, half_width: f64) -> Scatter {
    if by_frf.len() < FEWEST_FRFS {
        return Scatter::default();
    }
    let frequency = Heterogeneity::of(by_frf.iter().map(|o| (o.1, o.2)));
    let ratio = Heterogeneity::of(by_frf.iter().map(|o| (o.3, o.4)));
    if !frequency.certain || frequency.of_the_precise.sqrt() < LEAST_DRIFT * half_width {
        return Scatter::default();
    }
    Scatter {
        means: Some([frequency.value(), ratio.value()]),
        drift: Some(DriftingMode {
            frequency: frequency.between.sqrt(),
            damping_ratio: ratio.between.sqrt(),
            by_frf,
        }),
    }
}

/// Measurements of one thing that may have changed between them (random effects). Its variance is the one
/// with which they scatter as much as they should (Paule and Mandel 1982): where it is large they count
/// alike, the precise as those that noise leaves less sure.
struct Heterogeneity {
    mean: f64,
    mean_variance: f64,
    /// Variance of the thing itself.
    between: f64,
    /// The same by weights of the measurements' own deviations (DerSimonian and Laird 1986): a few that noise
    /// leaves unsure, and says little of, do not make it large.
    of_the_precise: f64,
    certain: bool,
}

impl Heterogeneity {
    fn of(measured: impl Iterator<Item = (f64, f64)> + Clone) -> Self {
        let weighted = |between: f64| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for (value, std) in measured.clone() {
                let weight = 1.0 / (std * std + between).max(f64::MIN_POSITIVE);
                sum += weight * value;
                weights += weight;
            }
            (sum / weights, weights)
        };
        let degrees = measured.clone().count() as f64 - 1.0;
        let squares = |between: f64| -> f64 {
            let (mean, _) = weighted(between);
            measured
                .clone()
                .map(|(value, std)| (value - mean).powi(2) / (std * std + between).max(f64::MIN_POSITIVE))
                .sum()
        };
        let q = squares(0.0);
        let (_, weights) = weighted(0.0);
        let squared_weights: f64 = measured.clone().map(|(_, std)| std.powi(-4)).sum();
        let of_the_precise = ((q - degrees) / (weights - squared_weights / weights)).max(0.0);
        // Were all of the scatter the thing's own.
        let mean = measured.clone().map(|(value, _)| value).sum::<f64>() / (degrees + 1.0);
        let most = measured.clone().map(|(value, _)| (value - mean).powi(2)).sum::<f64>() / degrees;
        let mut between = 0.0;
        if q > degrees {
            let (mut low, mut high) = (0.0, most);
            while high - low > VARIANCE_PRECISION * most {
                let middle = 0.5 * (low + high);
                if squares(middle) > degrees { low = middle } else { high = middle }
            }
            between = 0.5 * (low + high);
        }
        // The mean leans on the precise ones, and is as sure as all of the scatter leaves it.
        let (mean, weights) = weighted(of_the_precise);
        let share = |std: f64| 1.0 / ((std * std + of_the_precise).max(f64::MIN_POSITIVE) * weights);
        let mean_variance = measured.clone().map(|(_, std)| share(std).powi(2) * (std * std + between)).sum();
        Heterogeneity {
            mean,
            mean_variance,
            between,
            of_the_precise,
            certain: q > degrees + BEYOND_NOISE * (2.0 * degrees).sqrt(),
        }
    }

    /// Where one further measurement would find it: the mean, and its own scatter besides the mean's.
    fn value(&self) -> Value {
        Value { value: self.mean, std: (self.mean_variance + self.between).sqrt() }
    }
}

/// Standard deviations of |λ|/2π and ζ from the covariance of (δω/σ, δ ln σ), and the correlation with the
/// second.
pub(crate) fn deviations(pole: Complex64, covariance: [[f64; 2]; 2]) -> [(f64, f64); 2] {
    let (sigma, omega, natural) = (-pole.re, pole.im, pole.norm());
    // d|λ| = (ω dω + σ dσ)/|λ|; dζ = (dσ − ζ d|λ|)/|λ|.
    let frequency = [omega * sigma / natural, sigma * sigma / natural];
    let ratio =
        [-sigma / natural * frequency[0] / natural, (sigma - sigma / natural * frequency[1]) / natural];
    let product = |a: [f64; 2], b: [f64; 2]| {
        (0..2).map(|i| (0..2).map(|j| a[i] * covariance[i][j] * b[j]).sum::<f64>()).sum::<f64>()
    };
    let (f, z) = (product(frequency, frequency).max(0.0).sqrt(), product(ratio, ratio).max(0.0).sqrt());
    let correlation = if f * z > 0.0 { product(frequency, ratio) / (f * z) } else { 0.0 };
    [(f / TAU, correlation), (z, correlation)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_that_agree_within_their_deviations_have_no_scatter_of_their_own() {
        let alike = Heterogeneity::of([(1.0, 0.1), (1.1, 0.1), (0.95, 0.1), (1.02, 0.1)].into_iter());
        assert!(!alike.certain && alike.between == 0.0);
        assert!((alike.mean_variance.sqrt() - 0.05).abs() < 1e-12);
    }

    #[test]
    fn a_thing_that_moves_is_known_no_better_than_it_stays() {
        let moving = Heterogeneity::of([(1.0, 1e-3), (1.4, 1e-3), (0.6, 1e-3), (1.2, 1e-3)].into_iter());
        assert!(moving.certain);
        let value = moving.value();
        assert!((value.value - 1.05).abs() < 1e-3 && (0.3..0.45).contains(&value.std), "{value:?}");
    }

    #[test]
    fn what_moves_far_moves_as_far_whether_the_records_near_each_other_are_the_precise_ones_or_not() {
        // A real beam's fourth mode in nine records, Hz above 974: 0.031 is their deviation.
        let values = [0.1778, 0.1775, 0.1565, 0.1409, 0.1317, 0.1292, 0.1260, 0.1275, 0.0784];
        let precise = [0.009, 0.004, 9e-4, 1e-3, 1e-3, 2e-3, 2e-3, 4e-3, 6e-3];
        for stds in [precise, [1e-3; 9]] {
            let moving = Heterogeneity::of(values.into_iter().zip(stds));
            assert!((0.027..0.034).contains(&moving.between.sqrt()), "{}", moving.between.sqrt());
        }
    }

    #[test]
    fn deviations_of_a_lightly_damped_pole_are_those_of_its_parts() {
        let pole = Complex64::new(-1.0, 1000.0);
        let [frequency, ratio] = deviations(pole, [[0.04, 0.0], [0.0, 0.09]]);
        assert!((frequency.0 * TAU - 0.2).abs() < 1e-6, "a fifth of a half-width");
        assert!((ratio.0 - 0.3 * 1e-3).abs() < 1e-9, "three tenths of the ratio");
    }
}
