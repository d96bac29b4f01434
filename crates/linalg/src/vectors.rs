//! What is too small for a library, and needed in many places.

/// Σ aᵢ bᵢ, term by term: of short vectors, and where every digit has to stay.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Two independent standard normal numbers (Marsaglia's polar method) from numbers that are uniform between 0 and 1.
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
