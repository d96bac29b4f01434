//! `check.json`: totals, modes, meanings of numbers and what is odd in each channel.

use crate::file::value;
use jointscope_check::Check;
use serde_json::Value;

/// The contents of `check.json`: the result as it is, SI units.
pub fn check_file(check: &Check) -> Value {
    value(check)
}
