//! Magnitudes and phases that stand where real and imaginary parts belong.

use crate::levels::{median, ratios_apart};
use crate::settings::polar::{LEAST_TURNED, NEAR_WHOLE, WHOLE_SHARE};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;
use std::f64::consts::PI;

/// How a file's two numbers a line are meant, where they are not real and imaginary part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Polar {
    /// Magnitude, and phase in degrees.
    Degrees,
    /// Magnitude, and phase in radians.
    Radians,
    /// Level in dB, and phase in degrees.
    DecibelsDegrees,
    /// Level in dB, and phase in radians.
    DecibelsRadians,
}

impl Polar {
    /// The words for the two numbers.
    pub(crate) fn says(self) -> &'static str {
        match self {
            Polar::Degrees => "magnitudes and phases in degrees",
            Polar::Radians => "magnitudes and phases in radians",
            Polar::DecibelsDegrees => "levels in dB and phases in degrees",
            Polar::DecibelsRadians => "levels in dB and phases in radians",
        }
    }

    /// The value that two numbers mean; nothing stays nothing.
    pub(crate) fn value(self, Complex64 { re, im }: Complex64) -> Complex64 {
        if re == 0.0 && im == 0.0 {
            return Complex64::ZERO;
        }
        let magnitude = match self {
            Polar::Degrees | Polar::Radians => re,
            Polar::DecibelsDegrees | Polar::DecibelsRadians => 10f64.powf(re / 20.0),
        };
        let phase = match self {
            Polar::Degrees | Polar::DecibelsDegrees => im.to_radians(),
            Polar::Radians | Polar::DecibelsRadians => im,
        };
        Complex64::from_polar(magnitude, phase)
    }
}

/// How the numbers are meant, where the second of them are phases: those of a structure lie near whole half
/// turns on all lines but those about its resonances, and no imaginary parts lie near numbers of that kind. Levels
/// like those of the fixture's FRFs, `modelled`, tell magnitudes from decibels, or that no magnitude is negative: of
/// a channel that points the other way it is, and its phase falls as that of a conjugate.
pub(crate) fn polar(frfs: &FrfSet, modelled: Option<&[Complex64]>) -> Option<Polar> {
    let values = frfs.all_values();
    let [of_magnitudes, of_decibels] = if are_phases(values, 180.0) {
        [Polar::Degrees, Polar::DecibelsDegrees]
    } else if are_phases(values, PI) {
        [Polar::Radians, Polar::DecibelsRadians]
    } else {
        return None;
    };
    let Some(modelled) = modelled else {
        let is_level = values.iter().any(|value| value.re < 0.0);
        return Some(if is_level { of_decibels } else { of_magnitudes });
    };
    let apart = |polar: Polar| {
        let read: Vec<Complex64> = values.iter().map(|value| polar.value(*value)).collect();
        median(ratios_apart(&read, modelled)).unwrap_or(f64::INFINITY)
    };
    Some(if apart(of_decibels) < apart(of_magnitudes) { of_decibels } else { of_magnitudes })
}

/// Whether imaginary parts are phases, of which `half` is half a turn.
fn are_phases(values: &[Complex64], half: f64) -> bool {
    let is_turned = |value: &&Complex64| value.im.abs() > 0.5 * half;
    let is_whole = |value: &&Complex64| (value.im / half - (value.im / half).round()).abs() < NEAR_WHOLE;
    let turned = values.iter().filter(is_turned);
    let whole = turned.clone().filter(is_whole).count() as f64;
    let turned = turned.count() as f64;
    turned >= LEAST_TURNED * values.len() as f64 && whole >= WHOLE_SHARE * turned
}
