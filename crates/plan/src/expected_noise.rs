//! The noise that a measurement to come will have, by what the present one has.
//!
//! Response noise is a floor in the accelerance, force noise a share of |H|². A floor belongs to a sensor and
//! its range: of an FRF that was never measured it is either as high as that of the present ones or in
//! proportion to its own size, whichever is more.

use crate::settings::noise::{FLOOR_WINDOW, FORCE_SHARE};
use jointscope_diagnosis::Observation;
use num_complex::Complex64;

/// Variance of an FRF by line: floor and share.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ExpectedNoise {
    /// Share of |H|².
    share: f64,
    /// Floor by line, (m/s²/N)².
    floor: Vec<f64>,
    /// Floor by line, relative to the mean of |H|² over the lines.
    relative: Vec<f64>,
}

impl ExpectedNoise {
    /// That of a recording.
    pub(crate) fn of(observation: &Observation) -> Self {
        let count = observation.lines().len();
        let frfs: Vec<(&[Complex64], Vec<f64>, f64)> = observation
            .values()
            .chunks_exact(count)
            .zip(observation.weights().chunks_exact(count))
            .map(|(values, weights)| {
                let variance = weights.iter().map(|w| if *w > 0.0 { 2.0 / w } else { 0.0 }).collect();
                (values, variance, mean_square(values))
            })
            .collect();
        let share = share(&frfs);
        let mut floor = vec![0.0; count];
        let mut relative = vec![0.0; count];
        for (values, variance, size) in &frfs {
            let own = floors(values, variance, share);
            for line in 0..count {
                floor[line] += own[line] / frfs.len() as f64;
                relative[line] += own[line] / size / frfs.len() as f64;
            }
        }
        ExpectedNoise { share, floor, relative }
    }

    /// Of a test that nobody has made, with these shares of |H| and of its root mean square as standard
    /// deviations.
    pub(crate) fn assumed(lines: usize, share: f64, floor: f64) -> Self {
        ExpectedNoise { share: share * share, floor: vec![0.0; lines], relative: vec![floor * floor; lines] }
    }

    /// Variances of an FRF of these squared magnitudes.
    pub(crate) fn variance(&self, squares: &[f64]) -> Vec<f64> {
        let size = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        let of = |(line, square): (usize, &f64)| {
            self.floor[line].max(self.relative[line] * size) + self.share * square
        };
        squares.iter().enumerate().map(of).collect()
    }
}

fn mean_square(values: &[Complex64]) -> f64 {
    values.iter().map(|v| v.norm_sqr()).sum::<f64>() / values.len().max(1) as f64
}

/// b of var/size = a + b·|H|²/size over all FRFs, both not negative, each relation weighed by its own size.
fn share(frfs: &[(&[Complex64], Vec<f64>, f64)]) -> f64 {
    let [mut a11, mut a12, mut a22, mut b1, mut b2] = [0.0; 5];
    for (values, variance, size) in frfs {
        for (value, variance) in values.iter().zip(variance).filter(|(_, v)| **v > 0.0) {
            let (v, h) = (variance / size, value.norm_sqr() / size);
            let weight = (v * v).recip();
            a11 += weight;
            a12 += weight * h;
            a22 += weight * h * h;
            b1 += weight * v;
            b2 += weight * v * h;
        }
    }
    let determinant = a11 * a22 - a12 * a12;
    let share = (a11 * b2 - a12 * b1) / determinant;
    if determinant > 1e-9 * a11 * a22 && share.is_finite() { share.max(0.0) } else { 0.0 }
}

/// The floor by line: the mean, over lines nearby, of the variance that the force does not make.
fn floors(values: &[Complex64], variance: &[f64], share: f64) -> Vec<f64> {
    let count = values.len();
    let own = |line: usize| {
        let force = share * values[line].norm_sqr();
        (variance[line] > 0.0 && force < FORCE_SHARE * variance[line]).then(|| variance[line] - force)
    };
    let all: Vec<Option<f64>> = (0..count).map(own).collect();
    let mean = |all: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = all.fold((0.0, 0usize), |(sum, count), value| (sum + value, count + 1));
        (count > 0).then(|| sum / count as f64)
    };
    // Where the force makes all of it there is no floor to be seen.
    let whole = mean(&mut all.iter().flatten().copied()).unwrap_or(0.0);
    let near = |line: usize| line.saturating_sub(FLOOR_WINDOW)..(line + FLOOR_WINDOW + 1).min(count);
    (0..count).map(|line| mean(&mut all[near(line)].iter().flatten().copied()).unwrap_or(whole)).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};

    #[test]
    fn a_floor_and_a_share_of_force_noise_are_told_apart_and_carried_to_another_frf() {
        let hz = SpectralLines::even(1.0, 1.0, 300).unwrap();
        let value = |x: f64| -x * x / Complex64::new(120.0 * 120.0 - x * x, 2.4 * x);
        let values: Vec<Complex64> = hz.hz().iter().map(|x| value(*x)).collect();
        let variance = values.iter().map(|v| 1e-4 + 2.5e-5 * v.norm_sqr()).collect();
        let pair = FrfPair::transverse("1", "1");
        let frfs = FrfSet::new(hz, FrfForm::Accelerance, vec![pair], values.clone()).unwrap();
        let observation = Observation::new(&frfs.with_variance(variance).unwrap(), |_| true).unwrap();
        let noise = ExpectedNoise::of(&observation);
        assert!((noise.share / 2.5e-5 - 1.0).abs() < 0.01, "{}", noise.share);
        // Half as large: the floor stays, the share goes along.
        let squares: Vec<f64> = values.iter().map(|v| 0.25 * v.norm_sqr()).collect();
        for (square, found) in squares.iter().zip(noise.variance(&squares)) {
            let expected = 1e-4 + 2.5e-5 * square;
            assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
        }
    }
}
