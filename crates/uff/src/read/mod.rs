//! From bytes to functions: the frame of delimiters around the datasets. The datasets' insides are in the submodules.

mod ascii;
mod binary;
mod cursor;
mod dataset58;
mod fields;
mod header;
mod number;
mod units;
mod values;

use crate::{ReadError, UffFile, Units};
use cursor::{Cursor, Line, excerpt, is_delimiter};

/// Reads every function (dataset 58 and 58b) of a universal file.
///
/// # Errors
/// A [`ReadError`] naming the dataset and the line or byte for anything that is damaged, missing or not finite; a file is
/// read whole or not at all.
pub fn read(bytes: &[u8]) -> Result<UffFile, ReadError> {
    let mut cursor = Cursor::new(bytes);
    let mut file = UffFile::default();
    let mut units: Option<Units> = None;
    while open_dataset(&mut cursor)? {
        let identification = Identification::read(&mut cursor)?;
        match identification.number {
            58 => file.datasets.push(dataset58::read(&mut cursor, &identification, units.as_ref())?),
            164 => units = Some(units::read(&mut cursor)?),
            other => {
                skip(&mut cursor, &identification)?;
                *file.skipped.entry(other).or_default() += 1;
            }
        }
    }
    Ok(file)
}

/// Passes the opening delimiter of the next dataset; false at the end of the file.
fn open_dataset(cursor: &mut Cursor) -> Result<bool, ReadError> {
    cursor.dataset += 1;
    let dataset = cursor.dataset;
    match cursor.next_filled_line() {
        None if dataset == 1 => Err(ReadError::Empty),
        None => Ok(false),
        Some(line) if is_delimiter(line.bytes) => Ok(true),
        Some(_) if dataset == 1 => Err(ReadError::NotUff),
        Some(line) => {
            let (line, found) = (cursor.line_number(line.start), excerpt(line.bytes));
            Err(ReadError::BetweenDatasets { dataset, line, found })
        }
    }
}

/// The line after the delimiter: dataset number, and for binary datasets how they are stored.
struct Identification<'a> {
    line: Line<'a>,
    number: u32,
    /// What follows the `b` in column 7, if there is one.
    binary: Option<&'a [u8]>,
}

impl<'a> Identification<'a> {
    fn read(cursor: &mut Cursor<'a>) -> Result<Self, ReadError> {
        let line = cursor.expect_line("a dataset number")?;
        let text = line.bytes.trim_ascii_start();
        let digits = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let (number, rest) = text.split_at(digits);
        let binary = match rest {
            [b'b' | b'B', form @ ..] => Some(Some(form)),
            [] => Some(None),
            [blank, ..] if blank.is_ascii_whitespace() => Some(None),
            _ => None,
        };
        let number = std::str::from_utf8(number).ok().and_then(|number| number.parse().ok());
        match (number, binary) {
            (Some(number), Some(binary)) => Ok(Identification { line, number, binary }),
            _ => Err(cursor.unexpected(line, "a dataset number in columns 1 to 6", line.bytes)),
        }
    }
}

/// Passes a dataset this crate does not read, to behind its closing delimiter.
fn skip(cursor: &mut Cursor, identification: &Identification) -> Result<(), ReadError> {
    if let Some(form) = identification.binary
        && let Some(after) = end_of_foreign_binary(cursor, form)
    {
        cursor.position = after;
        return Ok(());
    }
    while let Some(line) = cursor.next_line() {
        if is_delimiter(line.bytes) {
            return Ok(());
        }
    }
    Err(cursor.truncated("the `    -1` line that closes the dataset"))
}

/// Where a binary dataset of another number ends, by the text lines and bytes it states.
fn end_of_foreign_binary(cursor: &Cursor, form: &[u8]) -> Option<usize> {
    let form = fields::BinaryForm::read(form)?;
    let mut cursor = cursor.clone();
    for _ in 0..form.text_lines {
        cursor.next_line()?;
    }
    cursor.after_closing_delimiter(cursor.position.checked_add(usize::try_from(form.byte_count).ok()?)?)
}
