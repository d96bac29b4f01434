//! A parameter with its interval.

use crate::numbers::{decimals, plain, rounded, with_unit};
use crate::unit::Scale;
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
    let scale = Scale::of_stated([value], unit);
    let half_width = scale.of(0.5 * (high - low));
    let number = |value: f64| to_precision(scale.of(value), half_width);
    let [most, high] = [value, high].map(|value| with_unit(&number(value), &scale));
    format!("{most} (95 %: {} to {high})", number(low))
}

/// The value alone, with as many digits as its deviation leaves.
pub(crate) fn rounded_value(estimate: &Estimate) -> String {
    match estimate.std.filter(|std| *std > 0.0 && *std < estimate.value.abs()) {
        Some(std) => {
            let scale = Scale::of_stated([estimate.value], estimate.unit);
            with_unit(&rounded(scale.of(estimate.value), decimals(scale.of(Z95 * std))), &scale)
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
