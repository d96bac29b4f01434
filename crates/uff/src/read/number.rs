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

/// Powers of ten that a double holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Value of a number with blanks around it, correctly rounded. Exponent letters e, E, d and D; three exponent digits may
/// stand without a letter (`1.00000-100`), as Fortran prints them where the letter finds no room.
pub(super) fn parse(text: &[u8]) -> Result<f64, BadNumber> {
    let text = text.trim_ascii();
    let scanned = match Scanned::scan(text) {
        Some(scanned) => scanned,
        None if text.is_empty() => return Err(BadNumber::Blank),
        None if names_no_number(text) => return Err(BadNumber::NotFinite),
        None => return Err(BadNumber::NotANumber),
    };
    let value = scanned.value(text);
    if value.is_finite() { Ok(value) } else { Err(BadNumber::NotFinite) }
}

/// A number taken apart: mantissa·10^exponent.
struct Scanned {
    negative: bool,
    mantissa: u64,
    /// The mantissa holds every digit.
    complete: bool,
    exponent: i32,
    /// Length of the mantissa's text, and the written exponent: what the slow path reads again.
    mantissa_length: usize,
    written_exponent: i32,
}

impl Scanned {
    fn scan(text: &[u8]) -> Option<Self> {
        let mut at = 0;
        let negative = text.first() == Some(&b'-');
        if matches!(text.first(), Some(b'-' | b'+')) {
            at = 1;
        }
        let (mut mantissa, mut digits, mut fraction, mut point, mut complete) =
            (0_u64, 0_usize, 0_i32, false, true);
        while let Some(&byte) = text.get(at) {
            match byte {
                b'0'..=b'9' => {
                    digits += 1;
                    // 10¹⁸ leaves room for one more digit in 64 bits.
                    if mantissa < 1_000_000_000_000_000_000 {
                        mantissa = mantissa * 10 + u64::from(byte - b'0');
                        fraction += i32::from(point);
                    } else {
                        complete = false;
                    }
                }
                b'.' if !point => point = true,
                _ => break,
            }
            at += 1;
        }
        if digits == 0 {
            return None;
        }
        let written_exponent = scan_exponent(&text[at..], point)?;
        Some(Scanned {
            negative,
            mantissa,
            complete,
            exponent: written_exponent - fraction,
            mantissa_length: at,
            written_exponent,
        })
    }

    fn value(&self, text: &[u8]) -> f64 {
        let power = POWERS.get(self.exponent.unsigned_abs() as usize);
        // Both factors exact in a double, so the one operation rounds correctly.
        if let (true, true, Some(power)) = (self.complete, self.mantissa <= 1 << 53, power) {
            let mantissa = self.mantissa as f64;
            let magnitude = if self.exponent < 0 { mantissa / power } else { mantissa * power };
            return if self.negative { -magnitude } else { magnitude };
        }
        self.value_by_the_standard_library(&text[..self.mantissa_length])
    }

    /// The rare rest, respelled in the standard library's grammar.
    fn value_by_the_standard_library(&self, mantissa: &[u8]) -> f64 {
        use std::io::Write;
        let mut buffer = [0_u8; 64];
        let mut room = &mut buffer[..];
        let written = room.write_all(mantissa).and_then(|()| write!(room, "e{}", self.written_exponent));
        let left = room.len();
        let respelled = match written {
            Ok(()) => std::str::from_utf8(&buffer[..64 - left]).unwrap_or_default().parse(),
            Err(_) => format!("{}e{}", String::from_utf8_lossy(mantissa), self.written_exponent).parse(),
        };
        respelled.unwrap_or(f64::NAN)
    }
}

/// The exponent that ends a number; 0 if there is none.
fn scan_exponent(text: &[u8], mantissa_has_point: bool) -> Option<i32> {
    let digits = match text {
        [] => return Some(0),
        [b'e' | b'E' | b'd' | b'D', rest @ ..] => rest,
        // Without a letter: three digits, or `1.5-2.5` would be a number.
        [b'+' | b'-', a, b, c]
            if mantissa_has_point && [a, b, c].iter().all(|digit| digit.is_ascii_digit()) =>
        {
            text
        }
        _ => return None,
    };
    let (negative, digits) = match digits {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let magnitude = digits.iter().fold(0_i32, |sum, digit| (sum * 10 + i32::from(digit - b'0')).min(100_000));
    Some(if negative { -magnitude } else { magnitude })
}

/// NaN and infinity in the spellings of Fortran and of Microsoft's C.
fn names_no_number(text: &[u8]) -> bool {
    let text = text.strip_prefix(b"-").or(text.strip_prefix(b"+")).unwrap_or(text);
    let starts = |name: &[u8]| text.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
    starts(b"nan") || starts(b"inf") || starts(b"1.#")
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
