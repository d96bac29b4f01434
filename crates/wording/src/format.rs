//! Numbers for engineers: the uncertainty sets the digits, the unit takes a prefix, and what is not finite is
//! said in words.

use crate::unit::{Scale, superscript};

/// What is printed in place of a value that is not finite.
pub const NOT_DETERMINED: &str = "not determined";

/// Significant digits of a value whose uncertainty is not known.
const DIGITS_WITHOUT_STD: usize = 4;

/// A value with its standard deviation and unit, as one string.
///
/// Two significant digits of the standard deviation set the digits of the value; an SI prefix is taken where
/// the unit allows one. `std` of `None` means not known (four significant digits, no ±), zero means exact, a
/// standard deviation that is not finite is said in words.
///
/// ```
/// use jointscope_wording::format::quantity;
/// assert_eq!(quantity(3.3204e6, 2.04e4, "N/m"), "3.320 ± 0.020 MN/m");
/// assert_eq!(quantity(-1.1e5, None, "N/rad"), "−110.0 kN/rad");
/// assert_eq!(quantity(3.67e-10, 3.7e-12, "m^4"), "(3.670 ± 0.037)×10⁻¹⁰ m⁴");
/// assert_eq!(quantity(f64::NAN, 1.0, "N/m"), "not determined");
/// ```
pub fn quantity(value: f64, std: impl Into<Option<f64>>, unit: &str) -> String {
    QuantityText::new(value, std, unit).line()
}

/// The same in a given unit, for values that are read beside each other: a row, a pair, a value and its
/// interval.
///
/// ```
/// use jointscope_wording::format::quantity_in;
/// use jointscope_wording::unit::Scale;
/// let scale = Scale::of_stated([0.0, 1e-4, -2.926e-3], "m");
/// assert_eq!(quantity_in(0.0, 1e-4, &scale), "0.00 ± 0.10 mm");
/// assert_eq!(quantity_in(-2.926e-3, None, &scale), "−2.926 mm");
/// ```
pub fn quantity_in(value: f64, std: impl Into<Option<f64>>, scale: &Scale) -> String {
    QuantityText::on(value, std, scale).line()
}

impl QuantityText {
    fn line(self) -> String {
        let QuantityText { number, unit, note } = self;
        // A percent sign follows its number as other units do (ISO 80000-1).
        let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
        let note = note.map_or(String::new(), |note| format!(" ({note})"));
        format!("{number}{unit}{note}")
    }
}

/// A quantity in the parts a page typesets apart from each other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct QuantityText {
    /// The number with its ± and power of ten, or [`NOT_DETERMINED`].
    pub number: String,
    /// The typeset unit with its prefix; empty for a pure number or an undetermined one.
    pub unit: String,
    /// A word on the uncertainty where it cannot be printed as a number.
    pub note: Option<&'static str>,
}

impl QuantityText {
    /// See [`quantity`] for what the arguments mean.
    pub fn new(value: f64, std: impl Into<Option<f64>>, unit: &str) -> Self {
        let std = std.into();
        Self::on(value, std, &Scale::for_values([value, std.unwrap_or(0.0)], unit))
    }

    /// The same in a given unit.
    pub fn on(value: f64, std: impl Into<Option<f64>>, scale: &Scale) -> Self {
        if !value.is_finite() {
            return Self { number: NOT_DETERMINED.to_owned(), unit: String::new(), note: None };
        }
        let std = std.into();
        let usable = std.filter(|std| std.is_finite() && *std > 0.0);
        let number = with_power_of_ten(scale.of(value), usable.map(|std| scale.of(std)), std);
        let note = match std {
            Some(0.0) => Some("exact"),
            Some(_) if usable.is_none() => Some("uncertainty not determined"),
            _ => None,
        };
        Self { number, unit: scale.unit().to_owned(), note }
    }
}

/// The number, with its power of ten set apart when it would otherwise be a row of zeros.
fn with_power_of_ten(value: f64, usable: Option<f64>, stated: Option<f64>) -> String {
    let digits = if stated == Some(0.0) { 6 } else { DIGITS_WITHOUT_STD };
    let magnitude = value.abs().max(usable.unwrap_or(0.0));
    let exponent = decimal_exponent(magnitude);
    // Beyond six decimals zeros are what one sees: 0.0010200 ± 0.0000050.
    let fine = exponent < 0 && usable.is_some_and(|std| decimals_for(std, 2) > 6);
    let written_out = magnitude == 0.0 || (-3..6).contains(&exponent) && !fine;
    // Two steps: 10^-exponent alone overflows for subnormal values.
    let half = exponent / 2;
    let shift = |x: f64| x / 10f64.powi(half) / 10f64.powi(exponent - half);
    match (usable, written_out) {
        (None, _) if stated == Some(0.0) => plain(value, digits),
        (None, true) => significant(value, digits),
        (None, false) => format!("{}{}", significant(shift(value), digits), power_of_ten(exponent)),
        (Some(std), true) => plus_minus(value, std),
        (Some(std), false) => {
            format!("({}){}", plus_minus(shift(value), shift(std)), power_of_ten(exponent))
        }
    }
}

/// `value ± std` with two significant digits of the standard deviation.
fn plus_minus(value: f64, std: f64) -> String {
    if std < 1e-7 * value.abs() {
        return format!("{} ± {}", significant(value, 8), significant(std, 2));
    }
    let decimals = decimals_for(std, 2);
    format!("{} ± {}", rounded(value, decimals), rounded(std, decimals))
}

/// The ends of an interval in one unit: `1.20 to 3.40 MN/m`.
pub fn interval([low, high]: [f64; 2], scale: &Scale, digits: usize) -> String {
    let number = |value: f64| significant(scale.of(value), digits);
    let unit = if scale.unit().is_empty() { String::new() } else { format!(" {}", scale.unit()) };
    format!("{} to {}{unit}", number(low), number(high))
}

/// The ends of an interval in one unit, two digits of its width: `8.96 to 9.32 kN·m/rad`.
pub fn ends([low, high]: [f64; 2], scale: &Scale) -> String {
    let (low, high) = (scale.of(low), scale.of(high));
    let decimals = if high > low { decimals_for(high - low, 2) } else { 4 };
    let unit = if scale.unit().is_empty() { String::new() } else { format!(" {}", scale.unit()) };
    format!("{} to {}{unit}", rounded(low, decimals), rounded(high, decimals))
}

/// A magnitude without its uncertainty: `1.23 MN/m`.
pub fn magnitude(value: f64, unit: &str, digits: usize) -> String {
    let scale = Scale::for_magnitude(value, unit);
    format!("{} {}", significant(scale.of(value), digits), scale.unit()).trim_end().to_owned()
}

/// `1.432 ± 0.012 ± 0.031` for a column: the largest of the standard deviations and `coarsest` (SI) sets the
/// digits, each keeps one of its own at least.
pub fn in_parts(value: f64, stds: &[f64], coarsest: f64, scale: &Scale) -> String {
    if !value.is_finite() {
        return NOT_DETERMINED.to_owned();
    }
    let stds = stds.iter().map(|std| scale.of(*std)).filter(|std| std.is_finite());
    let largest = stds.clone().fold(scale.of(coarsest), f64::max);
    if largest <= 0.0 {
        return significant(scale.of(value), DIGITS_WITHOUT_STD);
    }
    let decimals = |std: f64, digits: i32| (digits - 1 - std.log10().floor() as i32).clamp(0, 8) as usize;
    let common = decimals(largest, 2);
    let own = |std: f64| if std > 0.0 { common.max(decimals(std, 1)) } else { common };
    stds.fold(fixed(scale.of(value), common), |text, std| format!("{text} ± {}", fixed(std, own(std))))
}

/// A value and its standard deviation as numbers of a table column that states the unit: `3.320 ± 0.020`, or
/// [`NOT_DETERMINED`].
pub fn in_column(value: f64, std: impl Into<Option<f64>>, scale: &Scale) -> String {
    if !value.is_finite() {
        return NOT_DETERMINED.to_owned();
    }
    match std.into() {
        Some(std) if std.is_finite() && std > 0.0 => plus_minus(scale.of(value), scale.of(std)),
        Some(0.0) => plain(scale.of(value), 6),
        _ => significant(scale.of(value), DIGITS_WITHOUT_STD),
    }
}

/// A number of so many significant digits, a power of ten where it would be a row of zeros: `0.01234`,
/// `1.234×10⁻⁷`.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return NOT_DETERMINED.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.max(1);
    let scientific = format!("{:.*e}", digits - 1, value);
    let (mantissa, exponent) = match scientific.split_once('e') {
        Some((mantissa, exponent)) => (mantissa, exponent.parse().unwrap_or(0)),
        None => (scientific.as_str(), 0),
    };
    if (-4..6).contains(&exponent) {
        rounded(value, digits as i32 - 1 - exponent)
    } else {
        format!("{}{}", minus(mantissa), power_of_ten(exponent))
    }
}

/// A number of so many significant digits at the most, without the zeros that only rounding put there: `0.5`,
/// `1000`.
pub fn plain(value: f64, digits: usize) -> String {
    trimmed(&significant(value, digits))
}

/// A number with a fixed count of decimals; never a negative zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() { rounded(value, decimals as i32) } else { NOT_DETERMINED.to_owned() }
}

/// The same with its sign, `+` where it is positive; none on what rounds to zero.
pub fn with_sign(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    let is_zero = text.chars().all(|c| matches!(c, '0' | '.'));
    if value > 0.0 && value.is_finite() && !is_zero { format!("+{text}") } else { text }
}

/// A share such as a coherence or a probability as a percentage: `0.972` reads `97.2 %`.
pub fn percent(share: f64, decimals: usize) -> String {
    if share.is_finite() {
        format!("{} %", fixed(100.0 * share, decimals))
    } else {
        NOT_DETERMINED.to_owned()
    }
}

/// Rounds to `decimals`, negative ones meaning tens and hundreds.
pub(crate) fn rounded(value: f64, decimals: i32) -> String {
    let value = if decimals < 0 {
        let step = 10f64.powi(-decimals);
        (value / step).round() * step
    } else {
        value
    };
    minus(&format!("{:.*}", decimals.clamp(0, 17) as usize, value))
}

/// Decimals that show `digits` significant digits of a positive number, with 0.0996 taken as 0.10.
fn decimals_for(value: f64, digits: i32) -> i32 {
    let rounded = format!("{:.*e}", (digits - 1).max(0) as usize, value);
    let exponent =
        rounded.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok()).unwrap_or(0);
    digits - 1 - exponent
}

fn decimal_exponent(value: f64) -> i32 {
    if value == 0.0 { 0 } else { 1 - decimals_for(value.abs(), 2) }
}

fn power_of_ten(exponent: i32) -> String {
    let raised: String = exponent.to_string().chars().map(superscript).collect();
    format!("×10{raised}")
}

/// The typographic minus sign, and no sign on a number that rounded to zero.
fn minus(number: &str) -> String {
    match number.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| matches!(c, '0' | '.')) => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => number.to_owned(),
    }
}

/// Whether a character shows nothing itself but changes how others are shown: control characters other than
/// line ends and tabs, line separators, and marks that turn the direction of writing. Neither page nor
/// terminal may get one from a name.
pub fn hides(c: char) -> bool {
    c.is_control() && !matches!(c, '\n' | '\t')
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A number without the zeros that only rounding put there.
pub fn trimmed(number: &str) -> String {
    let (mantissa, power) = match number.find('×') {
        Some(at) => number.split_at(at),
        None => (number, ""),
    };
    if mantissa.contains('.') {
        let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
        format!("{mantissa}{power}")
    } else {
        number.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(value: f64, std: impl Into<Option<f64>>, unit: &str, expected: &str) {
        assert_eq!(quantity(value, std, unit), expected, "for {value:e}");
    }

    #[test]
    fn two_digits_of_the_standard_deviation_set_the_digits_of_the_value() {
        check(3.3212e6, 2.0e4, "N/m", "3.321 ± 0.020 MN/m");
        check(474.318, 0.0312, "Hz", "474.318 ± 0.031 Hz");
        check(12_345.0, 2_500.0, "%", "12300 ± 2500 %");
    }

    #[test]
    fn a_standard_deviation_that_rounds_up_a_decade_keeps_two_digits() {
        check(5.0, 0.0996, "N", "5.00 ± 0.10 N");
        check(5.0, 0.996, "N", "5.0 ± 1.0 N");
    }

    #[test]
    fn zero_is_printed_with_the_digits_of_its_uncertainty() {
        check(0.0, 0.25, "N", "0 ± 250 mN");
        check(0.0, None, "N/m", "0 N/m");
        check(0.0, 0.0, "N/m", "0 N/m (exact)");
    }

    #[test]
    fn a_change_has_its_sign_and_none_has_none() {
        let told = [1.234, -3.86, -0.004].map(|change| with_sign(change, 2));
        assert_eq!(told, ["+1.23", "−3.86", "0.00"]);
    }

    #[test]
    fn an_exact_value_has_no_plus_minus_and_no_trailing_zeros() {
        check(1.1, 0.0, "kg", "1.1 kg (exact)");
        check(2.07e11, 0.0, "Pa", "207 GPa (exact)");
    }

    #[test]
    fn an_unknown_standard_deviation_gives_four_digits_and_no_plus_minus() {
        check(3.32e6, None, "N/m", "3.320 MN/m");
        check(0.00213, None, "1", "0.002130");
    }

    #[test]
    fn an_undetermined_standard_deviation_is_said_in_words() {
        for std in [f64::NAN, f64::INFINITY, -1.0] {
            check(3.32e6, std, "N/m", "3.320 MN/m (uncertainty not determined)");
        }
    }

    #[test]
    fn a_standard_deviation_larger_than_the_value_sets_the_prefix() {
        check(1.0, 2.5e5, "N/m", "0 ± 250 kN/m");
        check(-40.0, 2.5e5, "N/m", "0 ± 250 kN/m");
    }

    #[test]
    fn what_would_be_a_row_of_zeros_has_a_power_of_ten() {
        check(0.00102, 5e-6, "kg*m^2", "(1.0200 ± 0.0050)×10⁻³ kg·m²");
        check(5.928e-4, None, "kg*m^2", "5.928×10⁻⁴ kg·m²");
        check(0.0040, 1e-3, "1", "0.0040 ± 0.0010");
        check(806.5552, 1.4e-4, "Hz", "806.55520 ± 0.00014 Hz");
    }

    #[test]
    fn negative_values_carry_a_minus_sign_not_a_hyphen() {
        check(-1.101e5, 220.0, "N/rad", "−110.10 ± 0.22 kN/rad");
    }

    #[test]
    fn a_tiny_standard_deviation_does_not_print_a_row_of_digits() {
        check(3.32e6, 1e-3, "N/m", "3.3200000 ± 1.0×10⁻⁹ MN/m");
    }

    #[test]
    fn a_value_that_is_not_finite_is_not_determined() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            check(value, 1.0, "N/m", NOT_DETERMINED);
            assert_eq!(significant(value, 3), NOT_DETERMINED);
            assert_eq!(percent(value, 1), NOT_DETERMINED);
        }
    }

    #[test]
    fn a_column_states_its_unit_once() {
        let scale = Scale::for_magnitude(3.3e6, "N/m");
        assert_eq!(in_column(3.3212e6, 2.0e4, &scale), "3.321 ± 0.020");
        assert_eq!(in_column(1.1e3, None, &scale), "0.001100");
        assert_eq!(in_column(f64::NAN, None, &scale), NOT_DETERMINED);
    }

    proptest! {
        #[test]
        fn no_input_prints_nan_or_inf_and_none_is_longer_than_a_line(value in any::<f64>(), std in any::<f64>()) {
            for unit in ["N/m", "1", "m^4", "kg", "Hz"] {
                let text = quantity(value, std, unit);
                prop_assert!(!text.contains("NaN") && !text.contains("inf"), "{}", text);
                prop_assert!(text.chars().count() < 60, "{}", text);
            }
        }
    }
}
