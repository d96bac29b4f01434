//! What is too small for a library, and needed in many places.

/// Σ aᵢ bᵢ, term by term: of short vectors, and where every digit has to stay.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Numbers from 0 to below 1, the same on every machine: a linear congruential generator of 64 bits, of which
/// the upper 53 are taken.
#[derive(Debug, Clone)]
pub struct Uniform(u64);

impl Uniform {
    /// The stream from this state of its generator.
    pub fn from_state(state: u64) -> Self {
        Uniform(state)
    }

    /// The next number.
    pub fn next_number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Two independent standard normal numbers (Marsaglia's polar method) from numbers that are uniform between 0
/// and 1.
pub fn normal_pair(mut uniform: impl FnMut() -> f64) -> (f64, f64) {
    loop {
        let (u, v) = (2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0);
        let square = u * u + v * v;
        if square > 0.0 && square < 1.0 {
            let factor = (-2.0 * square.ln() / square).sqrt();
            return (u * factor, v * factor);
        }
    }
}
