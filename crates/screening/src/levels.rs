//! Medians, and whether FRFs are like others.

use crate::settings::levels::{BETTER_SHARE, CALIBRATION};
use num_complex::Complex64;

/// The median; `None` of nothing.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    jointscope_spectra::median(&mut values)
}

/// |ln(|H|/|Ĥ|)| value by value, where it is a number.
pub(crate) fn ratios_apart(recorded: &[Complex64], modelled: &[Complex64]) -> Vec<f64> {
    let apart = recorded.iter().zip(modelled).map(|(a, b)| (a / b).norm().ln().abs());
    apart.filter(|apart| apart.is_finite()).collect()
}

/// Whether a reading that leaves `apart` is better than one that leaves `other` by more than what the fixture
/// leaves out.
pub(crate) fn better(apart: f64, other: f64) -> bool {
    apart.max(CALIBRATION) < BETTER_SHARE * other
}
