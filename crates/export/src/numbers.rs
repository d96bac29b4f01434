//! Numbers in the fields that programs read.

/// Six significant digits for people.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let size = value.abs().log10().floor() as i32;
    if (-4..7).contains(&size) {
        let digits = usize::try_from(5 - size).unwrap_or(0);
        let text = format!("{value:.digits$}");
        return match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        };
    }
    let text = format!("{value:.5e}");
    match text.split_once('e') {
        Some((mantissa, power)) => {
            format!("{}e{power}", mantissa.trim_end_matches('0').trim_end_matches('.'))
        }
        None => text,
    }
}

/// As many digits as 16 characters hold, at least ten where its power has two digits, with the sign of its
/// power in place of the letter E: a real number of Nastran's large field.
pub(crate) fn nastran(value: f64) -> String {
    fitted(value, 16, "")
}

/// The same of a double-precision matrix, whose numbers need the letter D.
pub(crate) fn nastran_double(value: f64) -> String {
    fitted(value, 16, "D")
}

/// As many digits as 20 characters hold: what Abaqus and CalculiX read. It always has a decimal point,
/// without which CalculiX takes it for a degree of freedom.
pub(crate) fn twenty(value: f64) -> String {
    fitted(value, 20, "E")
}

/// Every digit.
pub(crate) fn exact(value: f64) -> String {
    let text = format!("{value:E}");
    match text.contains('.') {
        true => text,
        false => text.replacen('E', ".0E", 1),
    }
}

fn fitted(value: f64, width: usize, letter: &str) -> String {
    for digits in (1..=16).rev() {
        let text = format!("{value:.digits$e}");
        let Some((mantissa, power)) = text.split_once('e') else { continue };
        let sign = if power.starts_with('-') { "" } else { "+" };
        let text = format!("{mantissa}{letter}{sign}{power}");
        if text.len() <= width {
            return text;
        }
    }
    format!("0.0{letter}+0")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn figures_for_people_have_six_digits_and_no_idle_zeros() {
        for (value, text) in
            [(0.065, "0.065"), (3318537.1234, "3318537"), (-1.5e-9, "-1.5e-9"), (1.0, "1"), (2.0e8, "2e8")]
        {
            assert_eq!(short(value), text);
        }
    }

    proptest! {
        #[test]
        fn fields_hold_ten_digits_and_never_overflow(mantissa in -9.99f64..9.99, power in -90i32..90) {
            let value = mantissa * 10f64.powi(power);
            let close = |read: f64, digits: f64| (read - value).abs() <= digits * value.abs();
            let text = nastran(value);
            prop_assert!(text.len() <= 16 && text.contains('.'));
            // 1.5-3 is 1.5e-3.
            let at = text.rfind(['+', '-']).unwrap();
            let read: f64 = format!("{}e{}", &text[..at], &text[at..]).parse().unwrap();
            prop_assert!(close(read, 1e-9), "{text} for {value}");
            let text = nastran_double(value);
            prop_assert!(text.len() <= 16 && close(text.replace('D', "e").parse().unwrap(), 1e-9));
            let text = twenty(value);
            prop_assert!(text.len() <= 20 && text.contains('.') && close(text.parse().unwrap(), 1e-12));
            prop_assert_eq!(exact(value).parse::<f64>().unwrap(), value);
        }
    }
}
