//! How an analyst states what was drawn: six digits and a standard deviation.

use crate::random::{log_uniform, uniform};
use rand::Rng;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Young's modulus of steel, N/m².
pub(crate) const STEEL: f64 = 2.07e11;

/// A value rounded to as many significant digits as a person would write.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// A quantity with a standard deviation.
pub(crate) fn stated(value: f64, std: f64) -> Value {
    json!({ "value": rounded(value, 6), "std": rounded(std, 3) })
}

/// A quantity known to within a fraction of itself.
pub(crate) fn known_to(value: f64, fraction: f64) -> Value {
    stated(value, fraction * value.abs())
}

/// An abscissa, known to a tenth of a millimetre.
pub(crate) fn abscissa(x: f64) -> Value {
    stated(x, 1e-4)
}

/// A steel beam of second moment `second_moment` (m⁴).
pub(crate) fn steel_beam(second_moment: f64) -> Value {
    json!({ "youngs_modulus": known_to(STEEL, 0.005), "second_moment": known_to(second_moment, 0.005) })
}

/// Damping of one of the three kinds for an assembly with `modes` elastic modes of which the highest is at
/// `highest` (Hz).
pub(crate) fn damping(rng: &mut impl Rng, modes: usize, highest: f64) -> Value {
    match uniform(rng, 0.0, 5.0) as usize {
        0 => {
            let stiffness = 2.0 * log_uniform(rng, 0.003, 0.01) / (TAU * highest);
            json!({ "rayleigh": { "mass": 0.0, "stiffness": known_to(stiffness, 0.2) } })
        }
        1 => json!({ "loss_factor": stated(log_uniform(rng, 0.004, 0.01), 0.0012) }),
        _ => {
            let ratio = |rng: &mut _| stated(log_uniform(rng, 0.003, 0.01), uniform(rng, 0.0006, 0.0014));
            json!({ "modal_ratios": (0..modes).map(|_| ratio(rng)).collect::<Vec<_>>() })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stated_value_has_six_digits() {
        assert_eq!(rounded(1.234_567_89e-10, 6), 1.23457e-10);
        assert_eq!(rounded(-0.06, 6), -0.06);
        assert_eq!(rounded(0.0, 6), 0.0);
    }
}
