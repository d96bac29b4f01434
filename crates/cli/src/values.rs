//! How values are spelled on the command line.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::time::Duration;

use jointscope::Band;
use jointscope::spectra::{Channel, Dof, FrfPair, SpectralLines};

/// Reads one of these names.
pub(crate) fn one_of<T: Copy + Send + Sync + 'static>(
    all: &'static [(&'static str, T)],
) -> impl TypedValueParser<Value = T> {
    let named = |text: &String| all.iter().find(|(name, _)| name.eq_ignore_ascii_case(text));
    PossibleValuesParser::new(all.iter().map(|(name, _)| *name))
        .try_map(move |text| named(&text).map(|(_, value)| *value).ok_or("no such name"))
}

/// Reads `F1:F2` in Hz.
pub(crate) fn band(text: &str) -> Result<Band, String> {
    let form = "two frequencies in Hz are needed, the lower first, such as 200:800";
    let (from, to) = text.split_once(':').ok_or(form)?;
    match (frequency(from), frequency(to)) {
        (Some(from), Some(to)) if from < to => Ok(Band { from, to }),
        _ => Err(form.to_owned()),
    }
}

/// More lines than any analyser makes: a slip in the step.
const MOST_LINES: f64 = 1e7;

/// Reads `FROM:TO:STEP` in Hz; the last line is the last step not beyond TO.
pub(crate) fn spectral_lines(text: &str) -> Result<SpectralLines, String> {
    let form = "first line, last line and step in Hz are needed, with decimal points, such as 2.5:1000:2.5";
    let mut fields = text.split(':');
    let (Some(from), Some(to), Some(step), None) =
        (fields.next(), fields.next(), fields.next(), fields.next())
    else {
        return Err(form.to_owned());
    };
    let (Some(from), Some(to), Some(step)) = (frequency(from), frequency(to), frequency(step)) else {
        return Err(form.to_owned());
    };
    if to < from {
        return Err(format!("the last line, {to} Hz, lies below the first, {from} Hz"));
    }
    if step == 0.0 {
        return Err("the step must be above 0 Hz".to_owned());
    }
    // 1000 Hz is the 400th of 2.5 Hz steps however the quotient rounds.
    let steps = ((to - from) / step * (1.0 + 1e-12) + 1e-9).floor();
    if steps >= MOST_LINES {
        return Err(format!("these are {} lines; take a larger step", steps + 1.0));
    }
    SpectralLines::even(from, step, steps as usize + 1).map_err(|error| error.to_string())
}

/// Reads seconds, above zero.
pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.trim().parse().ok().filter(|seconds: &f64| *seconds > 0.0);
    let duration = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    duration.ok_or_else(|| "a number of seconds above zero is needed, such as 30".to_owned())
}

/// Reads a percentage above zero.
pub(crate) fn percent(text: &str) -> Result<f64, String> {
    let percent = positive(text.trim().trim_end_matches('%')).filter(|percent| *percent <= 100.0);
    percent.ok_or_else(|| "per cent are needed, above zero and at most 100, such as 0.5".to_owned())
}

/// A finite number of Hz, zero or above.
pub(crate) fn frequency(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|hz: &f64| hz.is_finite() && *hz >= 0.0)
}

/// Reads `OUT/IN`: channels `4`, `4:y` or `4:theta`.
pub(crate) fn frf_pair(text: &str) -> Result<FrfPair, String> {
    let form = || "response over reference is needed, such as 4/1 or 4:theta/1".to_owned();
    let (response, reference) = text.split_once('/').ok_or_else(form)?;
    match (channel(response)?, channel(reference)?) {
        (Some(response), Some(reference)) => Ok(FrfPair::new(response, reference)),
        _ => Err(form()),
    }
}

/// Reads a channel: `4`, `4:y` or `4:theta`.
pub(crate) fn one_channel(text: &str) -> Result<Channel, String> {
    channel(text)?.ok_or_else(|| "a point is needed, such as 4 or 4:theta".to_owned())
}

/// `None` where the point has no name or more than one slash follows.
fn channel(text: &str) -> Result<Option<Channel>, String> {
    let (point, dof) = match text.trim().rsplit_once(':') {
        None => (text.trim(), Dof::Translation),
        Some((point, "y")) => (point, Dof::Translation),
        Some((point, "theta")) => (point, Dof::Rotation),
        Some((_, other)) => return Err(format!("`{other}` is neither `y` nor `theta`")),
    };
    let named = !point.is_empty() && !point.contains('/');
    Ok(named.then(|| Channel { point: point.to_owned(), dof }))
}

/// A finite number above zero.
pub(crate) fn positive(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_run_from_the_first_to_the_last_in_steps() {
        let lines = |text| spectral_lines(text).map(|lines| (lines.len(), lines.hz()[lines.len() - 1]));
        assert_eq!(lines("2.5:1000:2.5"), Ok((400, 1000.0)));
        assert_eq!(lines("0:1:0.1").unwrap().0, 11);
        assert_eq!(lines("10:12:1.5"), Ok((2, 11.5)));
        assert_eq!(lines("5:5:1"), Ok((1, 5.0)));
        for (bad, part) in [
            ("1:2", "such as"),
            ("1:2:3:4", "such as"),
            ("a:2:1", "such as"),
            ("-1:2:1", "such as"),
            ("1:inf:1", "such as"),
            ("2:1:1", "lies below"),
            ("1:2:0", "above 0 Hz"),
            ("0:1e9:1e-3", "larger step"),
        ] {
            let message = spectral_lines(bad).unwrap_err();
            assert!(message.contains(part), "{bad}: {message}");
        }
    }

    #[test]
    fn a_band_has_two_ends_the_lower_first() {
        assert_eq!(band("200:800"), Ok(Band { from: 200.0, to: 800.0 }));
        for bad in ["200", "800:200", "200:200", "a:b", "1:2:3", "-5:2", "nan:2"] {
            assert!(band(bad).unwrap_err().contains("such as 200:800"), "{bad}");
        }
    }

    #[test]
    fn an_frf_is_response_over_reference() {
        assert_eq!(frf_pair("4/1"), Ok(FrfPair::transverse("4", "1")));
        let theta = FrfPair::new(Channel::rotational("4"), Channel::transverse("a:b"));
        assert_eq!(frf_pair("4:theta/a:b:y"), Ok(theta));
        for bad in ["4", "4/", "/1", "4/1/2", ""] {
            assert!(frf_pair(bad).unwrap_err().contains("4:theta/1"), "{bad}");
        }
        assert!(frf_pair("4:x/1").unwrap_err().contains("`x`"));
    }
}
