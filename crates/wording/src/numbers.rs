//! Numbers and lists as they are spoken.

use crate::format::minus;
use std::fmt;

/// `a`, `a and b`, `a, b and c`.
pub fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

/// `1 line`, `2 lines`.
pub fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// Factor from SI to the prefixed unit in which a magnitude is spoken of, and that unit.
pub(crate) fn prefixed(value: f64, unit: &str) -> (f64, String) {
    let size = value.abs();
    let printed = unit.replace('*', "·").replace("^2", "²").replace("^3", "³").replace("^4", "⁴");
    let large = matches!(unit, "N/m" | "N*m/rad" | "N" | "N/rad" | "Pa" | "N*s/m");
    match unit {
        "kg" if size > 0.0 && size < 1e-4 => (1e6, "mg".to_owned()),
        "kg" if size < 0.1 => (1e3, "g".to_owned()),
        "m" if size < 1.0 => (1e3, "mm".to_owned()),
        "s" if size < 1e-3 => (1e6, "µs".to_owned()),
        "s" if size < 1.0 => (1e3, "ms".to_owned()),
        _ if large && size >= 1e9 => (1e-9, format!("G{printed}")),
        _ if large && size >= 1e6 => (1e-6, format!("M{printed}")),
        _ if large && size >= 1e3 => (1e-3, format!("k{printed}")),
        _ => (1.0, printed),
    }
}

/// A number with three significant digits and its unit.
pub(crate) fn plain(value: f64, unit: &str) -> String {
    let (factor, unit) = prefixed(value, unit);
    let number = significant(value * factor, if unit == "Hz" { 4 } else { 3 });
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

pub(crate) fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { "of no finite value".to_owned() };
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-4..5).contains(&exponent) {
        rounded(value, digits - 1 - exponent)
    } else {
        crate::format::significant(value, digits.max(1) as usize)
    }
}

/// Decimals that show two significant digits of a half-width.
pub(crate) fn decimals(half_width: f64) -> i32 {
    if half_width > 0.0 && half_width.is_finite() { 1 - half_width.log10().floor() as i32 } else { 3 }
}

/// A number with so many decimals, negative ones meaning tens and hundreds; never a negative zero.
pub(crate) fn rounded(value: f64, decimals: i32) -> String {
    if value != 0.0 && value.abs() < 1e-4 {
        return crate::format::significant(value, 3);
    }
    // Negative decimals round to tens and hundreds.
    let step = 10f64.powi(-decimals.min(0));
    let value = if step > 1.0 { (value / step).round() * step } else { value };
    minus(&format!("{value:.*}", decimals.clamp(0, 9) as usize))
}

/// χ² per degree of freedom: three digits, no decimals once they mean nothing.
pub(crate) fn figures(chi2: f64) -> String {
    significant(chi2, 3)
}

/// Two numbers with as many digits, from `digits` on and up to six, as it takes to tell them apart.
pub(crate) fn apart(pair: [f64; 2], digits: i32) -> [String; 2] {
    let told = |digits: i32| pair.map(|value| significant(value, digits));
    (digits..6).map(told).find(|[a, b]| a != b).unwrap_or_else(|| told(digits))
}

pub(crate) fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 2))
}

/// A number with four digits, by powers of ten where it is large or small.
pub(crate) struct Short(pub f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 {
            f.write_str("0")
        } else if (0.01..1e5).contains(&size) {
            let decimals = (3 - size.log10().floor() as i32).max(0) as usize;
            write!(f, "{:.decimals$}", self.0)
        } else {
            f.write_str(&crate::format::significant(self.0, 4))
        }
    }
}

/// A text with its first letter as a capital; a symbol that it begins with, such as k, stays what it is.
pub fn capitalised(text: &str) -> String {
    let first = text.split(' ').next().unwrap_or_default();
    if first != "a" && first.chars().filter(|c| c.is_alphabetic()).count() == 1 {
        return text.to_owned();
    }
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_numbers_have_the_digits_that_tell_them_apart() {
        assert_eq!(apart([1.0477, 3.5596], 3), ["1.05", "3.56"]);
        assert_eq!(apart([1.0212, 1.0214], 3), ["1.0212", "1.0214"]);
        assert_eq!(apart([0.5, 0.5], 3), ["0.500", "0.500"]);
    }

    #[test]
    fn a_short_number_has_four_digits_and_a_power_of_ten_where_it_is_small_or_large() {
        let short = |value: f64| Short(value).to_string();
        assert_eq!([0.0, 324.21, 0.01236].map(short), ["0", "324.2", "0.01236"]);
        assert_eq!([5.5031e-5, 2.1e9].map(short), ["5.503×10⁻⁵", "2.100×10⁹"]);
    }

    #[test]
    fn a_sentence_begins_with_a_capital_and_a_symbol_stays_what_it_is() {
        assert_eq!(capitalised("the FRFs show"), "The FRFs show");
        assert_eq!(capitalised("k, c and the tests"), "k, c and the tests");
        assert_eq!(capitalised("a mass"), "A mass");
    }
}
