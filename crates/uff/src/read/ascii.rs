//! Record 12 in ASCII: numbers in columns, or, where the columns do not fit, numbers between blanks.

use super::cursor::{Cursor, Line, excerpt, is_delimiter};
use super::header::Form;
use super::number::{self, BadNumber};
use super::values::Values;
use crate::{Precision, ReadError, TextProblem};

/// Column widths of one line: `6E13.5`, `4E20.12`, `2(E13.5,E20.12)` or `E13.5,2E20.12`.
fn line_layout(form: &Form) -> &'static [usize] {
    match (form.precision, form.even, form.complex) {
        (Precision::Single, _, _) => &[13; 6],
        (Precision::Double, true, _) => &[20; 4],
        (Precision::Double, false, false) => &[13, 20, 13, 20],
        (Precision::Double, false, true) => &[13, 20, 20],
    }
}

/// Reads the values of a dataset 58 and its closing delimiter: all that the header states, or fewer whole
/// points.
pub(super) fn read(cursor: &mut Cursor, form: &Form) -> Result<Values, ReadError> {
    let per_point = form.values_per_point();
    // A count beyond all bounds reads as one that the file cannot fulfil.
    let expected = form.points.saturating_mul(per_point);
    let (numbers, closing) = numbers(cursor, line_layout(form), expected, per_point)?;
    let found = numbers.len();
    if found < expected && (found == 0 || !found.is_multiple_of(per_point)) {
        return Err(cursor.error(closing, TextProblem::TooFew { expected, found }));
    }
    Ok(Values::from_interleaved(numbers, form))
}

/// Reads up to `expected` numbers, `per_point` of them a point, laid out in lines of `widths`, and the
/// closing delimiter, which is handed back.
pub(super) fn numbers<'a>(
    cursor: &mut Cursor<'a>,
    widths: &'static [usize],
    expected: usize,
    per_point: usize,
) -> Result<(Vec<f64>, Line<'a>), ReadError> {
    // No number takes less than two bytes: a wild count allocates no more than the file could hold.
    let mut numbers = Vec::with_capacity(expected.min(cursor.rest().len() / 2 + widths.len()));
    let mut reader = LineReader { widths, per_point, expected, numbers: &mut numbers };
    while let Some(line) = cursor.next_filled_line() {
        if is_delimiter(line.bytes) {
            return Ok((numbers, line));
        }
        let too_many = || cursor.error(line, TextProblem::TooMany(expected));
        if reader.numbers.len() >= expected {
            return Err(too_many());
        }
        reader.read(cursor, line)?;
        if let Some(surplus) = reader.numbers.get(expected..) {
            // Some writers fill the last line with zeros.
            if surplus.iter().any(|&value| value != 0.0) {
                return Err(too_many());
            }
            reader.numbers.truncate(expected);
        }
    }
    Err(cursor.truncated("data or the `    -1` line that closes the dataset"))
}

/// Reads the lines that hold the next `count` numbers, laid out in `widths`; what more a last line holds is
/// left aside. The closing delimiter must not come before.
pub(super) fn some_numbers(
    cursor: &mut Cursor,
    widths: &'static [usize],
    count: usize,
    expected: &'static str,
) -> Result<Vec<f64>, ReadError> {
    let mut numbers = Vec::with_capacity(count.min(cursor.rest().len() / 2 + widths.len()));
    let mut reader = LineReader { widths, per_point: 1, expected: count, numbers: &mut numbers };
    while reader.numbers.len() < count {
        let line = cursor.header_line(expected)?;
        let before = reader.numbers.len();
        reader.read(cursor, line).map_err(|error| match error {
            // Said of spectral lines, which this is not.
            ReadError::NotFinite { .. } => cursor.unexpected(line, expected, line.bytes),
            error => error,
        })?;
        if reader.numbers.len() == before {
            return Err(cursor.unexpected(line, expected, line.bytes));
        }
    }
    numbers.truncate(count);
    Ok(numbers)
}

/// Why the columns of a line do not fit.
enum Misfit {
    /// Not laid out in these columns.
    OtherLayout,
    /// Laid out in these columns, with one of them (from 1) blank.
    Blank(usize),
}

struct LineReader<'n> {
    widths: &'static [usize],
    per_point: usize,
    expected: usize,
    numbers: &'n mut Vec<f64>,
}

impl LineReader<'_> {
    fn read(&mut self, cursor: &Cursor, line: Line) -> Result<(), ReadError> {
        let before = self.numbers.len();
        let text = line.bytes.trim_ascii_end();
        match self.by_columns(text, false) {
            Ok(()) => return Ok(()),
            Err(Misfit::Blank(column)) => return Err(cursor.error(line, TextProblem::Blank(column))),
            Err(Misfit::OtherLayout) => self.numbers.truncate(before),
        }
        let Err((word, bad)) = self.by_blanks(text) else { return Ok(()) };
        let blank_delimited = self.numbers.len();
        self.numbers.truncate(before);
        if bad == BadNumber::NotFinite {
            let value = blank_delimited.min(self.expected.saturating_sub(1));
            return Err(ReadError::NotFinite { dataset: cursor.dataset, point: value / self.per_point });
        }
        // Unsigned numbers that fill their columns touch without a mark: only the columns can part them.
        if self.by_columns(text, true).is_ok() {
            return Ok(());
        }
        Err(cursor.error(line, TextProblem::NotANumber(excerpt(word))))
    }

    /// Reads a line by its columns. Unless `touching`, a number that runs into an unsigned one counts as a
    /// misfit: it is far likelier that a longer number has been cut in two.
    fn by_columns(&mut self, text: &[u8], touching: bool) -> Result<(), Misfit> {
        let mut start = 0;
        let mut blank = None;
        for (index, width) in self.widths.iter().enumerate() {
            if start >= text.len() {
                break;
            }
            let end = (start + width).min(text.len());
            let field = &text[start..end];
            let cuts = start > 0
                && !text[start - 1].is_ascii_whitespace()
                && (field[0].is_ascii_digit() || field[0] == b'.');
            if cuts && !touching {
                return Err(Misfit::OtherLayout);
            }
            match number::parse(field) {
                Ok(value) => self.numbers.push(value),
                Err(BadNumber::Blank) => blank = blank.or(Some(index + 1)),
                Err(_) => return Err(Misfit::OtherLayout),
            }
            start = end;
        }
        if start < text.len() {
            return Err(Misfit::OtherLayout);
        }
        match blank {
            Some(column) if self.ends_on_columns(text) => Err(Misfit::Blank(column)),
            Some(_) => Err(Misfit::OtherLayout),
            None => Ok(()),
        }
    }

    /// Whether every number of the line ends where a column ends: the line was written in these columns.
    fn ends_on_columns(&self, text: &[u8]) -> bool {
        let mut end = 0;
        self.widths.iter().all(|width| {
            let field = text.get(end..(end + width).min(text.len())).unwrap_or_default();
            end += width;
            field.trim_ascii().is_empty()
                || (field.len() == *width && !field[width - 1].is_ascii_whitespace())
        })
    }

    /// Reads a line by its blanks; a sign that starts no exponent also starts a number.
    fn by_blanks<'t>(&mut self, text: &'t [u8]) -> Result<(), (&'t [u8], BadNumber)> {
        for word in text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
            match number::parse(word) {
                Ok(value) => self.numbers.push(value),
                Err(bad) => self.touching_numbers(word).map_err(|part| (word, part.unwrap_or(bad)))?,
            }
        }
        Ok(())
    }

    /// Reads a word that is several signed numbers; the error is that of its first bad part, if it has parts.
    fn touching_numbers(&mut self, word: &[u8]) -> Result<(), Option<BadNumber>> {
        let mut start = 0;
        for at in 1..=word.len() {
            let ends = match word.get(at) {
                None => true,
                Some(b'+' | b'-') => !matches!(word[at - 1], b'e' | b'E' | b'd' | b'D'),
                Some(_) => false,
            };
            if !ends {
                continue;
            }
            if start == 0 && at == word.len() {
                return Err(None);
            }
            // An exponent without its letter is only found by its columns: `1.00000-100` was tried as one
            // word before.
            self.numbers.push(number::parse(&word[start..at]).map_err(Some)?);
            start = at;
        }
        Ok(())
    }
}
