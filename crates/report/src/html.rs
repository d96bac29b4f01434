//! Text into HTML and numbers into JSON, such that no fixture name can leave the place it was put in.

use std::fmt::Write;

/// Appends text with the five characters escaped that could end a text or a quoted attribute.
pub(crate) fn push_escaped(html: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '&' => html.push_str("&amp;"),
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '"' => html.push_str("&quot;"),
            '\'' => html.push_str("&#39;"),
            // Control characters are no HTML text; the replacement character says that something stood here.
            c if c.is_control() && !matches!(c, '\n' | '\t') => html.push('\u{fffd}'),
            c => html.push(c),
        }
    }
}

/// The escaped form as a string of its own.
pub(crate) fn escaped(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    push_escaped(&mut html, text);
    html
}

/// Appends `<tag class="class">text</tag>` with the text escaped; no attribute for an empty class.
pub(crate) fn push_element(html: &mut String, tag: &str, class: &str, text: &str) {
    html.push('<');
    html.push_str(tag);
    if !class.is_empty() {
        html.push_str(" class=\"");
        html.push_str(class);
        html.push('"');
    }
    html.push('>');
    push_escaped(html, text);
    html.push_str("</");
    html.push_str(tag);
    html.push('>');
}

/// JSON that may stand inside a script element: `<` occurs in strings only, where its escape means the same, and without it neither `</script>` nor
/// `<!--` can be spelled.
pub(crate) fn script_safe(json: &str) -> String {
    json.replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

/// Appends a JSON number of so many significant digits in its shortest spelling; `null` for what is not finite.
pub(crate) fn push_number(json: &mut String, value: f64, digits: usize) {
    if !value.is_finite() {
        json.push_str("null");
        return;
    }
    if value == 0.0 {
        json.push('0');
        return;
    }
    let mut scientific = String::with_capacity(24);
    // Writing to a String does not fail.
    let _ = write!(scientific, "{:.*e}", digits.max(1) - 1, value.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let digits: String = mantissa.chars().filter(|c| *c != '.').collect();
    let digits = digits.trim_end_matches('0');
    let digits = if digits.is_empty() { "0" } else { digits };
    let count = digits.len() as i32;

    if value < 0.0 {
        json.push('-');
    }
    // The last digit's power of ten; the number is digits × 10^last.
    let last = exponent + 1 - count;
    match last {
        0..=2 => {
            json.push_str(digits);
            json.extend((0..last).map(|_| '0'));
        }
        _ if last < 0 && exponent >= 0 => {
            let (whole, fraction) = digits.split_at((exponent + 1) as usize);
            json.push_str(whole);
            json.push('.');
            json.push_str(fraction);
        }
        _ if (-3..0).contains(&exponent) => {
            json.push_str("0.");
            json.extend((1..-exponent).map(|_| '0'));
            json.push_str(digits);
        }
        _ => {
            let _ = write!(json, "{digits}e{last}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn number(value: f64) -> String {
        let mut json = String::new();
        push_number(&mut json, value, 6);
        json
    }

    #[test]
    fn text_cannot_open_a_tag_or_leave_an_attribute() {
        assert_eq!(
            escaped("</script><b a='1' b=\"2\">&\u{7}"),
            "&lt;/script&gt;&lt;b a=&#39;1&#39; b=&quot;2&quot;&gt;&amp;\u{fffd}"
        );
    }

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
            assert_eq!(number(value), expected, "for {value:e}");
        }
    }

    proptest! {
        #[test]
        fn every_number_reads_back_to_six_digits(value in any::<f64>()) {
            prop_assume!(value.is_normal());
            let read: f64 = serde_json::from_str(&number(value)).unwrap_or(f64::INFINITY);
            prop_assume!(value.abs() < 1.7e308);
            prop_assert!((read / value - 1.0).abs() < 6e-6, "{} read as {}", value, read);
        }
    }
}
