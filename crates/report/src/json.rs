//! Numbers and text of the plots as JSON that may stand inside a script element.

/// JSON that cannot end its script: `<` occurs in strings only, where its escape means the same, and without
/// it neither `</script>` nor `<!--` can be spelled.
pub(crate) fn script_safe(json: &str) -> String {
    json.replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

/// A JSON number of so many significant digits in its shortest spelling; `null` for what is not finite.
pub(crate) fn number(value: f64, digits: usize) -> String {
    let scientific = format!("{value:.*e}", digits.max(1) - 1);
    let Some(rounded) = scientific.parse::<f64>().ok().filter(|rounded| rounded.is_finite()) else {
        return "null".to_owned();
    };
    // Adding zero takes the sign off a negative zero.
    let (plain, scientific) = (format!("{}", rounded + 0.0), format!("{rounded:e}"));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len() as i32);
    let exponent = exponent.parse::<i32>().unwrap_or(0) - decimals;
    let short = format!("{}e{exponent}", mantissa.replace('.', ""));
    if plain.len() <= short.len() + 1 { plain } else { short }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn json_in_a_script_cannot_close_it_and_still_reads_the_same() {
        let text = "</script><!-- \u{2028}";
        let json = script_safe(&serde_json::to_string(text).unwrap());
        assert!(!json.contains('<') && !json.contains('\u{2028}'));
        assert_eq!(serde_json::from_str::<String>(&json).unwrap(), text);
    }

    #[test]
    fn numbers_are_spelled_in_their_shortest_form() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (3_312_451.7, "3312450"),
            (200.0, "200"),
            (200.125, "200.125"),
            (-0.001234567, "-0.00123457"),
            (1.5e-9, "15e-10"),
            (2.5e12, "25e11"),
            (999_999.7, "1e6"),
            (f64::NAN, "null"),
            (f64::INFINITY, "null"),
        ] {
            assert_eq!(number(value, 6), expected, "for {value:e}");
        }
    }

    proptest! {
        #[test]
        fn every_number_reads_back_to_six_digits(value in any::<f64>()) {
            prop_assume!(value.is_normal());
            let read: f64 = serde_json::from_str(&number(value, 6)).unwrap_or(f64::INFINITY);
            prop_assume!(value.abs() < 1.7e308);
            prop_assert!((read / value - 1.0).abs() < 6e-6, "{} read as {}", value, read);
        }
    }
}
