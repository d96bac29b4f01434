//! Numbers and lists as they are spoken.

use crate::format::significant;
use crate::unit::Scale;

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

/// A number with three significant digits and its unit.
pub(crate) fn plain(value: f64, unit: &str) -> String {
    let scale = Scale::of_stated([value], unit);
    with_unit(&significant(scale.of(value), if unit == "Hz" { 4 } else { 3 }), &scale)
}

/// A number and the unit that it is given in; a pure number by itself.
pub(crate) fn with_unit(number: &str, scale: &Scale) -> String {
    if scale.unit().is_empty() { number.to_owned() } else { format!("{number} {}", scale.unit()) }
}

/// Decimals that show two significant digits of a half-width.
pub(crate) fn decimals(half_width: f64) -> i32 {
    if half_width > 0.0 && half_width.is_finite() { 1 - half_width.log10().floor() as i32 } else { 3 }
}

/// A number with so many decimals, negative ones meaning tens and hundreds; never a negative zero.
pub(crate) fn rounded(value: f64, decimals: i32) -> String {
    if value != 0.0 && value.abs() < 1e-4 {
        return significant(value, 3);
    }
    crate::format::rounded(value, decimals.min(9))
}

/// χ² per degree of freedom: three digits, no decimals once they mean nothing.
pub(crate) fn figures(chi2: f64) -> String {
    significant(chi2, 3)
}

/// Two numbers with as many digits, from `digits` on and up to six, as it takes to tell them apart.
pub(crate) fn apart(pair: [f64; 2], digits: usize) -> [String; 2] {
    let told = |digits: usize| pair.map(|value| significant(value, digits));
    (digits..6).map(told).find(|[a, b]| a != b).unwrap_or_else(|| told(digits))
}

pub(crate) fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 2))
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
    fn a_sentence_begins_with_a_capital_and_a_symbol_stays_what_it_is() {
        assert_eq!(capitalised("the FRFs show"), "The FRFs show");
        assert_eq!(capitalised("k, c and the tests"), "k, c and the tests");
        assert_eq!(capitalised("a mass"), "A mass");
    }
}
