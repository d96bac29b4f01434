//! Noise that a fit counts in proportion to the signal while it is far from its optimum.

/// The weight 2/σ² of a complex value when a share `epsilon` of `size` (a squared amplitude) counts as noise
/// too: 2/(σ² + ε²·size).
///
/// Far from the optimum a sharp resonance would decide where a fit goes; with this it does not. A value of
/// weight zero keeps it.
pub fn inflated_weight(weight: f64, size: f64, epsilon: f64) -> f64 {
    if epsilon == 0.0 || weight == 0.0 {
        return weight;
    }
    1.0 / (1.0 / weight + 0.5 * epsilon * epsilon * size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn variances_of_noise_and_of_the_share_of_the_signal_add(variance in 1e-6f64..1.0, size in 0.0f64..1e3, epsilon in 0.0f64..1.0) {
            let weight = inflated_weight(2.0 / variance, size, epsilon);
            prop_assert!((2.0 / weight / (variance + epsilon * epsilon * size) - 1.0).abs() < 1e-12);
        }
    }
}
