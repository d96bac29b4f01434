//! Averages over hits: auto and cross spectra, FRF, coherence, and how much each hit counts.

use num_complex::Complex64;

use crate::Estimator;
use crate::settings::weights::{
    ALONE, FEWEST_LINES, LEAST_FREEDOM, LINES_LOOKED_AT, MOST_RATIO, PASS_RANGE, SETTLED, UNEQUAL,
    WEIGHT_PASSES,
};

/// The averaged spectra of one response and force on one line.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Averaged {
    pub force: f64,
    pub response: f64,
    /// Σ Y·X*.
    pub cross: Complex64,
}

/// Force and response spectrum of one hit.
pub(crate) type Pair<'a> = (&'a [Complex64], &'a [Complex64]);

/// Σ over the hits, each weighted.
pub(crate) fn averaged(hits: &[Pair], weights: &[f64], line: usize) -> Averaged {
    let mut sum = Averaged::default();
    for ((force, response), weight) in hits.iter().zip(weights) {
        let (x, y) = (force[line], response[line]);
        sum.force += weight * x.norm_sqr();
        sum.response += weight * y.norm_sqr();
        sum.cross += y * x.conj() * *weight;
    }
    sum
}

impl Averaged {
    /// The FRF, or nothing where the force, or for H2 the cross spectrum, vanishes.
    pub(crate) fn frf(&self, estimator: Estimator) -> Option<Complex64> {
        let h1 = self.cross / self.force;
        let cross = self.cross.norm_sqr();
        let value = match estimator {
            Estimator::H1 => h1,
            Estimator::H2 => self.cross * (self.response / cross),
            Estimator::Hv => self.cross * (self.response / (self.force * cross)).sqrt(),
        };
        (self.force > 0.0 && value.is_finite()).then_some(value)
    }

    /// Ordinary coherence γ².
    pub(crate) fn coherence(&self) -> f64 {
        let product = self.force * self.response;
        if product > 0.0 { (self.cross.norm_sqr() / product).min(1.0) } else { 0.0 }
    }
}

/// Variance E|ε|² of H1 on one line from the residuals of the hits, each with its own noise: Σ w²|X|²|Y − H
/// X|²/(1 − h) / (Σ w|X|²)², h the hit's leverage. Where the noise of all hits is alike its mean is that of
/// (1 − γ²)/((n − 1)γ²)·|H|², but it scatters more.
pub(crate) fn variance_of_unequal_hits(hits: &[Pair], weights: &[f64], line: usize) -> f64 {
    let sum = averaged(hits, weights, line);
    let Some(h1) = sum.frf(Estimator::H1) else { return 0.0 };
    let of_hit = |((force, response), weight): (&Pair, &f64)| {
        let power = weight * force[line].norm_sqr();
        let rest = (1.0 - power / sum.force).max(LEAST_FREEDOM);
        power * weight * (response[line] - h1 * force[line]).norm_sqr() / rest
    };
    hits.iter().zip(weights).map(of_hit).sum::<f64>() / (sum.force * sum.force)
}

/// How much each hit counts on the `lines` that the hammer excites.
///
/// H1 of several hits is a least-squares line through the origin, response over force, and so is its variance
/// from the coherence: both hold where the noise of all hits is alike. An analyser that adapts its range to
/// each hit, or sensors whose error is a share of what they read, make the noise of a hard hit larger. Then
/// spectra are divided by the noise of their hit: the noise σ_k² is what makes the residuals |Y_k − H·X_k|²,
/// relative to their mean over the hits on each line, as large as their leverage lets them be.
///
/// Equal weights where the noise is alike, or cannot be told. It cannot where hits differ by one thing, each by
/// as much as it has of it, as by a blow that lands a little beside the last one: any of them then explains
/// itself without a residual, and the weights run towards one that is no better than the others.
pub(crate) fn weights_by_noise(hits: &[Pair], lines: std::ops::Range<usize>) -> Vec<f64> {
    let n = hits.len();
    let plain = vec![1.0; n];
    let every = (lines.len() / LINES_LOOKED_AT).max(1);
    let lines: Vec<usize> = lines.step_by(every).collect();
    // The residuals of two hits are one number per line: they do not tell whose it is.
    if n < 3 || lines.len() < FEWEST_LINES {
        return plain;
    }
    // Hits of very different strength are begun as noisy as they are strong.
    let strength = |force: &[Complex64]| lines.iter().map(|&l| force[l].norm_sqr()).sum::<f64>();
    let mut variance: Vec<f64> =
        hits.iter().map(|(force, _)| strength(force).max(f64::MIN_POSITIVE)).collect();
    for _ in 0..WEIGHT_PASSES {
        let weights: Vec<f64> = variance.iter().map(|v| 1.0 / v).collect();
        let mut ratio = vec![0.0; n];
        for &line in &lines {
            let sum = averaged(hits, &weights, line);
            let Some(h1) = sum.frf(Estimator::H1) else { continue };
            let residual = |k: usize| weights[k] * (hits[k].1[line] - h1 * hits[k].0[line]).norm_sqr();
            let mean = (0..n).map(residual).sum::<f64>() / (n - 1) as f64;
            if mean > 0.0 {
                for (k, ratio) in ratio.iter_mut().enumerate() {
                    let leverage = weights[k] * hits[k].0[line].norm_sqr() / sum.force;
                    *ratio += residual(k) / (mean * (1.0 - leverage).max(LEAST_FREEDOM));
                }
            }
        }
        let mut moved = 0.0f64;
        for (variance, ratio) in variance.iter_mut().zip(&ratio) {
            let step = (ratio / lines.len() as f64).clamp(PASS_RANGE.0, PASS_RANGE.1);
            moved = moved.max((step - 1.0).abs());
            *variance *= step;
        }
        let mean = variance.iter().map(|v| v.ln()).sum::<f64>() / n as f64;
        variance.iter_mut().for_each(|v| *v = (*v / mean.exp()).clamp(1.0 / MOST_RATIO, MOST_RATIO));
        if moved < SETTLED {
            break;
        }
    }
    let (low, high) =
        variance.iter().fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(*v), high.max(*v)));
    let weights: Vec<f64> = variance.iter().map(|v| 1.0 / v).collect();
    if high > UNEQUAL * UNEQUAL * low && !differ_by_one_thing(hits, &weights, &lines) {
        weights
    } else {
        plain
    }
}

/// Whether the average is one hit's alone, and what two others differ from it by has one course over the lines:
/// noise of two hits has none in common.
fn differ_by_one_thing(hits: &[Pair], weights: &[f64], lines: &[usize]) -> bool {
    let mut shares = vec![0.0; hits.len()];
    let mut residuals = vec![Vec::with_capacity(lines.len()); hits.len()];
    for &line in lines {
        let sum = averaged(hits, weights, line);
        let Some(h1) = sum.frf(Estimator::H1) else { continue };
        for (k, (force, response)) in hits.iter().enumerate() {
            shares[k] += weights[k] * force[line].norm_sqr() / sum.force / lines.len() as f64;
            residuals[k].push(response[line] - h1 * force[line]);
        }
    }
    let Some(alone) = (0..hits.len()).max_by(|&a, &b| shares[a].total_cmp(&shares[b])) else { return false };
    let others: Vec<usize> = (0..hits.len()).filter(|&k| k != alone).collect();
    let power = |k: usize| residuals[k].iter().map(|r: &Complex64| r.norm_sqr()).sum::<f64>();
    let coherent = |a: usize, b: usize| {
        let common: Complex64 = residuals[a].iter().zip(&residuals[b]).map(|(x, y)| x * y.conj()).sum();
        common.norm() > ALONE.1 * (power(a) * power(b)).sqrt()
    };
    let pairs = || others.iter().enumerate().flat_map(|(i, &a)| others[i + 1..].iter().map(move |&b| (a, b)));
    shares[alone] > ALONE.0 && pairs().filter(|&(a, b)| coherent(a, b)).count() * 2 > pairs().count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn normal(random: &mut ChaCha8Rng) -> Complex64 {
        let uniform =
            |random: &mut ChaCha8Rng| ((random.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
        let radius = (-uniform(random).ln()).sqrt();
        Complex64::from_polar(radius, std::f64::consts::TAU * uniform(random))
    }

    /// Hits of these strengths with these noises about an FRF of 2.
    fn simulated(strengths: &[f64], noises: &[f64], seed: u64) -> Vec<(Vec<Complex64>, Vec<Complex64>)> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let hit = |(strength, noise): (&f64, &f64)| {
            let force = vec![Complex64::from(*strength); 600];
            let response = force.iter().map(|x| x * 2.0 + normal(&mut random) * *noise).collect();
            (force, response)
        };
        strengths.iter().zip(noises).map(hit).collect()
    }

    fn found(strengths: &[f64], noises: &[f64], seed: u64) -> Vec<f64> {
        let hits = simulated(strengths, noises, seed);
        let pairs: Vec<Pair> = hits.iter().map(|(x, y)| (x.as_slice(), y.as_slice())).collect();
        weights_by_noise(&pairs, 0..600)
    }

    #[test]
    fn hits_of_equal_noise_count_as_the_textbook_says_however_strong_they_are() {
        assert_eq!(found(&[1.0, 5.0, 20.0, 3.0], &[0.1; 4], 1), [1.0; 4]);
        assert_eq!(found(&[1.0, 20.0], &[0.1, 2.0], 2), [1.0; 2], "two hits cannot tell");
    }

    #[test]
    fn hits_whose_noise_differs_count_inversely_to_its_power() {
        for (strengths, noises) in [
            (vec![1.0, 1.1, 5.0, 5.2, 20.0, 21.0], vec![0.1, 0.1, 0.5, 0.5, 2.0, 2.0]),
            (vec![1.0, 1.0, 1.0], vec![0.1, 0.4, 0.1]),
            (vec![1.0, 1.0, 1.0, 3.0], vec![0.2, 0.2, 1.0, 0.2]),
        ] {
            let weights = found(&strengths, &noises, 3);
            for (weight, noise) in weights.iter().zip(&noises) {
                let share = weight * noise * noise / (weights[0] * noises[0] * noises[0]);
                assert!((0.7..1.4).contains(&share), "noises {noises:?}: {weights:?}");
            }
        }
    }

    #[test]
    fn blows_that_land_beside_each_other_are_no_hits_of_unequal_noise_and_one_clean_hit_is() {
        // What a blow that lands elsewhere adds, of one course over the lines, as much as it is off.
        let scattered = |off: &[f64]| {
            let mut hits = simulated(&vec![1.0; off.len()], &vec![1e-3; off.len()], 6);
            for ((force, response), off) in hits.iter_mut().zip(off) {
                for (line, (x, y)) in force.iter().zip(response.iter_mut()).enumerate() {
                    *y += x * Complex64::from_polar(*off, 0.02 * line as f64);
                }
            }
            let pairs: Vec<Pair> = hits.iter().map(|(x, y)| (x.as_slice(), y.as_slice())).collect();
            weights_by_noise(&pairs, 0..600)
        };
        assert_eq!(scattered(&[0.01, -0.05, 0.04, 0.02, -0.03]), [1.0; 5]);
        let clean = found(&[1.0; 5], &[2e-3, 0.2, 0.2, 0.2, 0.2], 7);
        assert!(clean[0] > 100.0 * clean[1], "{clean:?}");
    }

    #[test]
    fn h2_lies_above_h1_by_the_coherence_and_hv_between_them() {
        let hits = simulated(&[1.0, 2.0, 3.0], &[1.0; 3], 4);
        let pairs: Vec<Pair> = hits.iter().map(|(x, y)| (x.as_slice(), y.as_slice())).collect();
        let sum = averaged(&pairs, &[1.0; 3], 5);
        let [h1, h2, hv] = [Estimator::H1, Estimator::H2, Estimator::Hv].map(|e| sum.frf(e).unwrap());
        assert!((h1 / h2 - sum.coherence()).norm() < 1e-12);
        assert!((hv * hv / (h1 * h2) - 1.0).norm() < 1e-12);
        assert_eq!(Averaged::default().frf(Estimator::H1), None);
        assert_eq!(Averaged::default().coherence(), 0.0);
    }
}
