//! Seeds and draws of numbers.

use rand::{Rng, RngExt};
use sha2::{Digest, Sha256};

/// A seed of its own for every case.
pub(crate) fn seed_of(source: &str, number: usize) -> u64 {
    let digest = Sha256::digest(format!("{source} case {number}").as_bytes());
    digest.iter().take(8).fold(0, |seed, byte| seed << 8 | u64::from(*byte))
}

/// Uniform between two bounds.
pub(crate) fn between(random: &mut impl Rng, [from, to]: [f64; 2]) -> f64 {
    random.random_range(from..to)
}

/// Uniform in the logarithm between two positive bounds.
pub(crate) fn log_uniform(random: &mut impl Rng, [from, to]: [f64; 2]) -> f64 {
    between(random, [from.ln(), to.ln()]).exp()
}
