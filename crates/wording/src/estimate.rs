//! A parameter with its interval.

use crate::numbers::{decimals, plain, prefixed, rounded};
use jointscope_findings::Estimate;
use jointscope_inference::Z95;

/// Size from which a number is written with a power of ten.
const LARGE: f64 = 1e7;

/// Value and 95 % interval with unit, rounded to what is known by the `data`:
/// `49.8 g (95 %: 49.1 to 50.5 g)`.
pub(crate) fn size_of(estimate: &Estimate, data: &str) -> String {
    let Estimate { value, unit, .. } = *estimate;
    let Some([low, high]) = estimate.possible_interval() else {
        return format!("{} (not determined by these {data})", plain(value, unit));
    };
    if estimate.is_vague() {
        return format!("{} (order of magnitude only)", plain(value, unit));
    }
    let (factor, unit) = prefixed(value, unit);
    let half_width = (high - low) * 0.5 * factor;
    let number = |value: f64| to_precision(value * factor, half_width);
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    format!("{}{unit} (95 %: {} to {}{unit})", number(value), number(low), number(high))
}

/// The value alone, with as many digits as its deviation leaves.
pub(crate) fn rounded_value(estimate: &Estimate) -> String {
    match estimate.std.filter(|std| *std > 0.0 && *std < estimate.value.abs()) {
        Some(std) => {
            let (factor, unit) = prefixed(estimate.value, estimate.unit);
            let number = rounded(estimate.value * factor, decimals(Z95 * std * factor));
            if unit.is_empty() { number } else { format!("{number} {unit}") }
        }
        None => plain(estimate.value, estimate.unit),
    }
}

/// A number with two digits of its half-width.
fn to_precision(value: f64, half_width: f64) -> String {
    if value.abs() < LARGE {
        return rounded(value, decimals(half_width));
    }
    let digits = value.abs().log10().floor() as i32 + decimals(half_width);
    format!("{value:.*e}", digits.clamp(1, 5) as usize)
}
