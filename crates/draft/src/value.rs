//! Numbers as a file states them.

use serde_json::{Value, json};

/// Significant digits: more than any ruler has, few enough to be read.
const DIGITS: i32 = 6;

/// A number rounded to six significant digits.
pub(crate) fn rounded(value: f64) -> f64 {
    to_digits(value, DIGITS)
}

/// A number with its standard deviation, of two digits.
pub(crate) fn known(value: f64, std: f64) -> Value {
    json!({ "value": rounded(value), "std": to_digits(std, 2) })
}

/// A number to be fitted.
pub(crate) fn unknown(value: f64) -> Value {
    json!({ "value": rounded(value), "std": "unknown" })
}

fn to_digits(value: f64, digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    format!("{value:.*e}", digits as usize - 1).parse().unwrap_or(value)
}
