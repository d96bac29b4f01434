//! From bytes to functions: the frame of delimiters around the datasets. The datasets' insides are in the submodules.

mod ascii;
mod binary;
mod cursor;
mod dataset58;
mod fields;
mod header;
mod number;
mod units;

use crate::{ReadError, UffFile, Units};
use cursor::{Cursor, Line, is_delimiter};

/// Reads every function (dataset 58 and 58b) of a universal file.
///
/// # Errors
/// A [`ReadError`] naming the dataset and the line or byte for anything that is damaged, missing or not finite; a file is
/// read whole or not at all.
pub fn read(bytes: &[u8]) -> Result<UffFile, ReadError> {
    let mut cursor = Cursor::new(bytes);
    let mut file = UffFile::default();
    let mut units: Option<Units> = None;
    let mut dataset = 0;
    while open_dataset(&mut cursor, dataset + 1)? {
        dataset += 1;
        let identification = Identification::read(&mut cursor, dataset)?;
        match identification.number {
            58 => {
                let function = dataset58::read(&mut cursor, dataset, &identification, units.as_ref())?;
                file.datasets.push(function);
            }
            164 => units = Some(units::read(&mut cursor, dataset)?),
            other => {
                skip(&mut cursor, dataset, &identification)?;
                *file.skipped.entry(other).or_default() += 1;
            }
        }
    }
    Ok(file)
}

/// Passes the opening delimiter; false at the end of the file.
fn open_dataset(cursor: &mut Cursor, dataset: usize) -> Result<bool, ReadError> {
    let Some(line) = cursor.next_filled_line() else {
        return if dataset == 1 { Err(ReadError::Empty) } else { Ok(false) };
    };
    if is_delimiter(line.bytes) {
        return Ok(true);
    }
    if dataset == 1 {
        return Err(ReadError::NotUff);
    }
    Err(ReadError::BetweenDatasets { dataset, line: cursor.line_number(line.start), found: line.excerpt() })
}

/// The line after the delimiter: dataset number, and for binary datasets how they are stored.
struct Identification<'a> {
    line: Line<'a>,
    number: u32,
    /// What follows the `b` in column 7, if there is one.
    binary: Option<&'a [u8]>,
}

impl<'a> Identification<'a> {
    fn read(cursor: &mut Cursor<'a>, dataset: usize) -> Result<Self, ReadError> {
        let line = cursor.next_line().ok_or_else(|| cursor.truncated(dataset, "a dataset number"))?;
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
            _ => Err(ReadError::DatasetNumber {
                dataset,
                line: cursor.line_number(line.start),
                found: line.excerpt(),
            }),
        }
    }
}

/// Passes a dataset this crate does not read, to behind its closing delimiter.
fn skip(cursor: &mut Cursor, dataset: usize, identification: &Identification) -> Result<(), ReadError> {
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
    Err(cursor.truncated(dataset, "the `    -1` line that closes the dataset"))
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
