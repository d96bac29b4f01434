//! Numbers as Fortran and C programs print them.

/// Why a text is no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BadNumber {
    /// Nothing but blanks.
    Blank,
    /// Not the text of a number.
    NotANumber,
    /// NaN, infinity, or beyond the range of a double.
    NotFinite,
}

/// Value of a number with blanks around it, correctly rounded. Exponent letters e, E, d and D; three exponent
/// digits may stand without a letter (`1.00000-100`), as Fortran prints them where the letter finds no room.
pub(super) fn parse(text: &[u8]) -> Result<f64, BadNumber> {
    let text = std::str::from_utf8(text.trim_ascii()).map_err(|_| BadNumber::NotANumber)?;
    let value: f64 = match text.parse() {
        Ok(value) => value,
        Err(_) if text.is_empty() => return Err(BadNumber::Blank),
        Err(_) if names_no_number(text) => return Err(BadNumber::NotFinite),
        Err(_) => with_exponent_letter(text).parse().map_err(|_| BadNumber::NotANumber)?,
    };
    if value.is_finite() { Ok(value) } else { Err(BadNumber::NotFinite) }
}

/// The text with `e` for its exponent letter, or before an exponent that has none.
fn with_exponent_letter(text: &str) -> String {
    if let Some((mantissa, exponent)) = text.rfind(['+', '-']).map(|sign| text.split_at(sign))
        // Three digits behind a decimal point, or `1.5-2.5` would be a number.
        && exponent.len() == 4
        && mantissa.contains('.')
        && mantissa.ends_with(|c: char| c.is_ascii_digit() || c == '.')
    {
        return format!("{mantissa}e{exponent}");
    }
    text.replace(['d', 'D'], "e")
}

/// NaN and infinity in the spellings of Fortran and of Microsoft's C.
fn names_no_number(text: &str) -> bool {
    let name = text.trim_start_matches(['+', '-']).get(..3).unwrap_or_default().to_ascii_lowercase();
    ["nan", "inf", "1.#"].contains(&name.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(text: &str, expected: Result<f64, BadNumber>) {
        assert_eq!(parse(text.as_bytes()), expected, "`{text}`");
    }

    #[test]
    fn numbers_come_in_the_spellings_of_fortran_and_c() {
        check(" 1.5 ", Ok(1.5));
        check("-1.43019390106e+01", Ok(-14.3019390106));
        check("1.0D+00", Ok(1.0));
        check("1.0d-3", Ok(1e-3));
        check("1.0-100", Ok(1e-100));
        check("-1.00000+100", Ok(-1e100));
        check(".5", Ok(0.5));
        check("7.", Ok(7.0));
        check("+12", Ok(12.0));
        check("4.9e-324", Ok(5e-324));
        check("1.2345678901234567890123e+05", Ok(123456.78901234567));
    }

    #[test]
    fn what_is_no_number_is_told_apart() {
        check("   ", Err(BadNumber::Blank));
        for text in ["abc", "1.0 2.0", "1.5-2.5", "1-2", "1e", "e5", "-", "1.2.3", "*************", "1e5x"] {
            check(text, Err(BadNumber::NotANumber));
        }
        for text in ["NaN", "-nan", "Inf", "-Infinity", "1.#QNAN", "-1.#IND", "1e400"] {
            check(text, Err(BadNumber::NotFinite));
        }
    }

    proptest! {
        #[test]
        fn every_printed_double_is_read_as_the_standard_library_reads_it(value in proptest::num::f64::NORMAL, digits in 0_usize..22) {
            let text = format!("{value:.digits$e}");
            let expected: f64 = text.parse().unwrap();
            let got = parse(text.as_bytes());
            prop_assert_eq!(got.ok(), expected.is_finite().then_some(expected));
        }

        #[test]
        fn everyday_numbers_are_read_exactly(value in -1e6..1e6_f64) {
            prop_assert_eq!(parse(format!("{value}").as_bytes()), Ok(value));
        }
    }
}
