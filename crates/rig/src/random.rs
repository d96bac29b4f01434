//! Random numbers that are the same for the same seed.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A generator of random numbers, the same for the same seed.
pub fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// Uniform on [0, 1), with 53 bits.
pub(crate) fn unit(rng: &mut impl Rng) -> f64 {
    (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// Uniform between two bounds.
pub(crate) fn uniform(rng: &mut impl Rng, from: f64, to: f64) -> f64 {
    from + (to - from) * unit(rng)
}

/// Uniform in its logarithm between two positive bounds.
pub(crate) fn log_uniform(rng: &mut impl Rng, from: f64, to: f64) -> f64 {
    uniform(rng, from.ln(), to.ln()).exp()
}

/// One of several, all alike; `None` of none.
pub(crate) fn choice<'a, T>(rng: &mut impl Rng, of: &'a [T]) -> Option<&'a T> {
    of.get((unit(rng) * of.len() as f64) as usize)
}

/// −1 or 1.
pub(crate) fn sign(rng: &mut impl Rng) -> f64 {
    if rng.next_u64() & 1 == 0 { 1.0 } else { -1.0 }
}

/// Normal with mean zero and unit variance, by the polar method.
pub(crate) fn normal(rng: &mut impl Rng) -> f64 {
    normal_pair(rng).0
}

/// Two independent normal numbers.
pub(crate) fn normal_pair(rng: &mut impl Rng) -> (f64, f64) {
    jointscope_linalg::normal_pair(|| unit(rng))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn normal_numbers_have_the_moments_of_the_normal_distribution() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let n = 100_000;
        let sample: Vec<f64> = (0..n).map(|_| normal(&mut rng)).collect();
        let moment = |p: i32| sample.iter().map(|x| x.powi(p)).sum::<f64>() / n as f64;
        assert!(moment(1).abs() < 0.01, "mean {}", moment(1));
        assert!((moment(2) - 1.0).abs() < 0.02, "variance {}", moment(2));
        assert!((moment(4) - 3.0).abs() < 0.15, "fourth moment {}", moment(4));
    }
}
