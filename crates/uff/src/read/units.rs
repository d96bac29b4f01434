//! Dataset 164: units.

use super::ascii;
use super::cursor::{Cursor, Line};
use super::fields::{Column, columns_of, cut, line_text};
use crate::{ReadError, TemperatureMode, TextProblem, Units};

const EXPECTED: &str = "a units code, a description and a temperature mode (dataset 164, record 1)";
const FACTORS: &str = "factors of length, force and temperature above zero (dataset 164, record 2)";

/// Reads a dataset 164 from behind its identification line to behind its closing delimiter.
pub(super) fn read(cursor: &mut Cursor) -> Result<Units, ReadError> {
    let line = cursor.header_line(EXPECTED)?;
    let text = line_text(line.bytes);
    let (code, description, temperature_mode) =
        record1(&text).ok_or_else(|| cursor.unexpected(line, EXPECTED, line.bytes))?;
    let second = Line { start: cursor.position, bytes: &[] };
    let (factors, _) = ascii::numbers(cursor, &[25; 3], 4, 4).map_err(|error| match error {
        // Said of spectral lines, which units do not have.
        ReadError::NotFinite { .. } => cursor.unexpected(second, FACTORS, b"NaN or infinity"),
        error => error,
    })?;
    let &[length_factor, force_factor, temperature_factor, temperature_offset] = factors.as_slice() else {
        return Err(cursor.error(second, TextProblem::TooFew { expected: 4, found: factors.len() }));
    };
    if [length_factor, force_factor, temperature_factor].iter().any(|&factor| factor <= 0.0) {
        let found = format!("{length_factor} {force_factor} {temperature_factor}");
        return Err(cursor.unexpected(second, FACTORS, found.as_bytes()));
    }
    Ok(Units {
        code,
        description: description.to_owned(),
        temperature_mode,
        length_factor,
        force_factor,
        temperature_factor,
        temperature_offset,
    })
}

/// Record 1: `I10, 20A1, I10`. Descriptions longer than 20 characters push the temperature mode out of its
/// columns.
fn record1(text: &str) -> Option<(i32, &str, TemperatureMode)> {
    let by_columns = cut::<3>(text, &[Column::Number(10), Column::Text(20), Column::Number(10)]);
    let mode = |word: &str| match word {
        "1" | "" => Some(TemperatureMode::Absolute),
        "2" => Some(TemperatureMode::Relative),
        _ => None,
    };
    if let (Ok(code), Some(mode), true) = (
        by_columns.fields[0].parse(),
        mode(by_columns.fields[2]),
        columns_of(text, 40, usize::MAX).trim().is_empty(),
    ) {
        return Some((code, by_columns.fields[1], mode));
    }
    let text = text.trim();
    let (code, rest) = text.split_at(text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()));
    let (description, last) = rest.trim().rsplit_once(char::is_whitespace).unwrap_or((rest.trim(), ""));
    match (code.parse().ok()?, mode(last)) {
        (code, Some(mode)) => Some((code, description.trim(), mode)),
        (code, None) => Some((code, rest.trim(), TemperatureMode::Absolute)),
    }
}
