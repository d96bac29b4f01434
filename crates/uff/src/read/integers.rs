//! Records of whole numbers and of reals outside dataset 58: by their columns, or by their blanks where a
//! writer was off.

use super::ascii;
use super::cursor::{Cursor, Line};
use super::fields::{columns_of, line_text};
use crate::ReadError;

/// The whole numbers of a line in columns of `width`: those that fit, by blanks where the columns cut a
/// number.
pub(super) fn of_line(
    cursor: &Cursor,
    line: Line,
    width: usize,
    expected: &'static str,
) -> Result<Vec<i64>, ReadError> {
    let text = line_text(line.bytes);
    let text = text.trim_end();
    by_blanks(text)
        .or_else(|| by_columns(text, width))
        .ok_or_else(|| cursor.unexpected(line, expected, line.bytes))
}

fn by_blanks(text: &str) -> Option<Vec<i64>> {
    text.split_ascii_whitespace().map(|word| word.parse().ok()).collect()
}

/// Numbers that fill their columns touch: only the columns part them.
fn by_columns(text: &str, width: usize) -> Option<Vec<i64>> {
    let columns = text.chars().count().div_ceil(width);
    (0..columns).map(|at| columns_of(text, at * width, (at + 1) * width).trim().parse().ok()).collect()
}

/// The next line, which must hold at least `N` whole numbers in columns of ten; more are left aside.
pub(super) fn record<const N: usize>(
    cursor: &mut Cursor,
    expected: &'static str,
) -> Result<[i64; N], ReadError> {
    let line = cursor.header_line(expected)?;
    let numbers = of_line(cursor, line, 10, expected)?;
    numbers
        .get(..N)
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| cursor.unexpected(line, expected, line.bytes))
}

/// `count` whole numbers on as many lines as they take.
pub(super) fn list(cursor: &mut Cursor, count: i64, expected: &'static str) -> Result<Vec<i64>, ReadError> {
    let count = usize::try_from(count).unwrap_or(0);
    // No number takes less than two bytes: a wild count allocates no more than the file could hold.
    let mut numbers = Vec::with_capacity(count.min(cursor.rest().len() / 2 + 1));
    while numbers.len() < count {
        let line = cursor.header_line(expected)?;
        let found = of_line(cursor, line, 10, expected)?;
        if found.is_empty() {
            return Err(cursor.unexpected(line, expected, line.bytes));
        }
        numbers.extend(found);
    }
    // Some writers fill the last line with zeros.
    numbers.truncate(count);
    Ok(numbers)
}

/// `N` reals in columns of `widths`, on as many lines as they take.
pub(super) fn reals<const N: usize>(
    cursor: &mut Cursor,
    widths: &'static [usize],
    expected: &'static str,
) -> Result<[f64; N], ReadError> {
    let start = Line { start: cursor.position, bytes: &[] };
    let found = ascii::some_numbers(cursor, widths, N, expected)?;
    found.try_into().map_err(|_| cursor.unexpected(start, expected, b""))
}
