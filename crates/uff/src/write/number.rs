//! Numbers in columns.

use std::io::Write;

/// Appends a value as Fortran's `1PEw.d` prints it, right-justified in `width` columns.
pub(super) fn push_scientific(out: &mut Vec<u8>, value: f64, width: usize, decimals: usize) {
    let mut printed = Printed::default();
    printed.scientific(value, decimals, b'E');
    printed.push(out, width);
}

/// Appends a value as Fortran's `Dw.d` prints it: the double-precision mark of dataset 164.
pub(super) fn push_double_mark(out: &mut Vec<u8>, value: f64, width: usize, decimals: usize) {
    let mut printed = Printed::default();
    printed.scientific(value, decimals, b'D');
    printed.push(out, width);
}

/// Appends an abscissa value in 13 columns. `E13.5` is kept where it is exact; otherwise the spelling that is
/// nearest to the value while one column stays blank, for a frequency step of 1/51.2 Hz has more digits than
/// `E13.5` shows and 10⁵ lines multiply what is lost.
pub(super) fn push_abscissa(out: &mut Vec<u8>, value: f64) {
    let mut best = Printed::default();
    best.scientific(value, 5, b'E');
    let mut least = best.distance(value);
    // A decimal point always: Fortran would read `10` under E13.5 as 10·10⁻⁵.
    for decimals in 1..=10 {
        if least == 0.0 {
            break;
        }
        for fixed in [false, true] {
            let mut candidate = Printed::default();
            if fixed {
                candidate.format(format_args!("{value:.decimals$}"));
            } else {
                candidate.format(format_args!("{value:.decimals$e}"));
            }
            let distance = candidate.distance(value);
            if candidate.length <= 12 && distance < least {
                (best, least) = (candidate, distance);
            }
        }
    }
    best.push(out, 13);
}

/// One printed number on the stack: no allocation per spectral line.
struct Printed {
    text: [u8; 48],
    length: usize,
}

impl Default for Printed {
    fn default() -> Self {
        Printed { text: [0; 48], length: 0 }
    }
}

impl Printed {
    /// Prints; what does not fit counts as too long for any column.
    fn format(&mut self, number: std::fmt::Arguments) {
        let mut room = &mut self.text[..];
        let printed = room.write_fmt(number);
        let left = room.len();
        self.length = if printed.is_ok() { self.text.len() - left } else { usize::MAX };
    }

    /// Mantissa with `decimals`, exponent letter, sign and at least two digits.
    fn scientific(&mut self, value: f64, decimals: usize, letter: u8) {
        self.format(format_args!("{value:.decimals$e}"));
        let printed = self.as_bytes();
        let Some(at) = printed.iter().position(|&byte| byte == b'e') else { return };
        let (sign, digits) = match &printed[at + 1..] {
            [b'-', digits @ ..] => (b'-', digits),
            digits => (b'+', digits),
        };
        let mut exponent = [b'0'; 3];
        let count = digits.len().clamp(2, 3);
        exponent[count - digits.len().min(count)..count].copy_from_slice(&digits[..digits.len().min(count)]);
        self.text[at] = letter;
        self.text[at + 1] = sign;
        self.text[at + 2..at + 2 + count].copy_from_slice(&exponent[..count]);
        self.length = at + 2 + count;
    }

    fn as_bytes(&self) -> &[u8] {
        self.text.get(..self.length).unwrap_or_default()
    }

    /// How far from `value` a reader lands.
    fn distance(&self, value: f64) -> f64 {
        let read: Option<f64> = std::str::from_utf8(self.as_bytes()).ok().and_then(|text| text.parse().ok());
        read.map_or(f64::INFINITY, |read| (read - value).abs())
    }

    fn push(&self, out: &mut Vec<u8>, width: usize) {
        let text = self.as_bytes();
        out.extend(std::iter::repeat_n(b' ', width.saturating_sub(text.len())));
        out.extend_from_slice(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn scientific(value: f64, width: usize, decimals: usize) -> String {
        let mut out = Vec::new();
        push_scientific(&mut out, value, width, decimals);
        String::from_utf8(out).unwrap()
    }

    fn abscissa(value: f64) -> String {
        let mut out = Vec::new();
        push_abscissa(&mut out, value);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn numbers_fill_their_columns_as_fortran_prints_them() {
        assert_eq!(scientific(1.5, 13, 5), "  1.50000E+00");
        assert_eq!(scientific(-1.5e-7, 13, 5), " -1.50000E-07");
        assert_eq!(scientific(-1.5e-300, 13, 5), "-1.50000E-300");
        assert_eq!(scientific(-f64::MAX, 20, 12), "-1.797693134862E+308");
        assert_eq!(scientific(0.0, 20, 12), "  0.000000000000E+00");
    }

    #[test]
    fn an_abscissa_keeps_the_digits_its_columns_have_room_for() {
        assert_eq!(abscissa(2.5), "  2.50000E+00");
        assert_eq!(abscissa(0.01953125), "  1.953125e-2");
        assert_eq!(abscissa(1.0 / 3.0), " 0.3333333333");
        assert_eq!(abscissa(1.0 / 12_800.0), "  7.81250E-05");
    }

    proptest! {
        #[test]
        fn every_double_stays_within_its_columns(value in proptest::num::f64::NORMAL | proptest::num::f64::ZERO | proptest::num::f64::SUBNORMAL) {
            prop_assert_eq!(scientific(value, 13, 5).len(), 13);
            prop_assert_eq!(scientific(value, 20, 12).len(), 20);
            let text = abscissa(value);
            prop_assert_eq!(text.len(), 13);
            let got: f64 = text.trim().parse().unwrap();
            prop_assert!((got - value).abs() <= 5.1e-6 * value.abs(), "{value} was written as {text}");
        }
    }
}
