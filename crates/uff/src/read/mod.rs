//! From bytes to functions: the frame of delimiters around the datasets. The datasets' insides are in the
//! submodules.

mod ascii;
mod binary;
mod cursor;
mod dataset58;
mod fields;
mod geometry;
mod header;
mod identification;
mod integers;
mod nodal;
mod number;
mod units;
mod values;

use crate::{Nodes, ReadError, UffFile, Units, Unreadable};
use cursor::{Cursor, excerpt, is_delimiter};
use identification::Identification;

/// Reads every function (dataset 58 and 58b), the geometry and the mode shapes of a universal file.
///
/// # Errors
/// A [`ReadError`] naming the dataset and the line or byte for anything in a function or in the units that is
/// damaged, missing or not finite; functions are read whole or not at all. A damaged dataset of geometry or
/// shapes is passed and told in [`UffFile::unreadable`]: it says nothing of the functions beside it.
pub fn read(bytes: &[u8]) -> Result<UffFile, ReadError> {
    let mut cursor = Cursor::new(bytes);
    let mut file = UffFile::default();
    let mut units: Option<Units> = None;
    while open_dataset(&mut cursor)? {
        let identification = Identification::read(&mut cursor)?;
        match identification.number {
            58 => file.datasets.push(dataset58::read(&mut cursor, &identification, units.as_ref())?),
            164 => units = Some(units::read(&mut cursor)?),
            number => {
                let mut inside = cursor.clone();
                match beside_functions(&mut inside, &identification, units.as_ref(), &mut file) {
                    None => {
                        skip(&mut cursor, &identification)?;
                        *file.skipped.entry(number).or_default() += 1;
                    }
                    Some(Ok(())) => cursor.position = inside.position,
                    Some(Err(error)) => {
                        skip(&mut cursor, &identification)?;
                        file.unreadable.push(Unreadable { number, error });
                    }
                }
            }
        }
    }
    Ok(file)
}

/// Reads a dataset of geometry, shapes or the header into the file; nothing for one of another number.
fn beside_functions(
    cursor: &mut Cursor,
    identification: &Identification,
    units: Option<&Units>,
    file: &mut UffFile,
) -> Option<Result<(), ReadError>> {
    if identification.binary.is_some() {
        return None;
    }
    let nodes = |nodes| Nodes { nodes, units: units.cloned() };
    Some(match identification.number {
        15 => geometry::nodes15(cursor).map(|found| file.nodes.push(nodes(found))),
        2411 => geometry::nodes2411(cursor).map(|found| file.nodes.push(nodes(found))),
        18 => geometry::systems18(cursor).map(|found| file.systems.extend(found)),
        2420 => geometry::systems2420(cursor).map(|found| file.systems.extend(found)),
        2412 => geometry::elements(cursor).map(|found| file.elements.extend(found)),
        82 => geometry::trace(cursor).map(|found| file.traces.push(found)),
        151 => geometry::header(cursor).map(|found| file.header = Some(found)),
        55 => nodal::read55(cursor).map(|found| file.nodal.push(found)),
        2414 => nodal::read2414(cursor).map(|found| file.nodal.push(found)),
        _ => return None,
    })
}

/// Passes the opening delimiter of the next dataset; false at the end of the file.
fn open_dataset(cursor: &mut Cursor) -> Result<bool, ReadError> {
    cursor.dataset += 1;
    let dataset = cursor.dataset;
    match cursor.next_filled_line() {
        None if dataset == 1 => Err(ReadError::Empty),
        None => Ok(false),
        Some(line) if is_delimiter(line.bytes) => match dataset == 1 && closes(cursor) {
            true => Err(ReadError::FirstLost),
            false => Ok(true),
        },
        Some(_) if dataset == 1 => Err(ReadError::NotUff),
        Some(line) => {
            let (line, found) = (cursor.line_number(line.start), excerpt(line.bytes));
            Err(ReadError::BetweenDatasets { dataset, line, found })
        }
    }
}

/// Whether the delimiter just passed opens nothing: another one opens a dataset right behind it.
fn closes(cursor: &Cursor) -> bool {
    let mut ahead = cursor.clone();
    let next = ahead.next_filled_line();
    next.is_some_and(|line| is_delimiter(line.bytes)) && Identification::read(&mut ahead).is_ok()
}

/// Passes a dataset this crate does not read, to behind its closing delimiter.
fn skip(cursor: &mut Cursor, identification: &Identification) -> Result<(), ReadError> {
    if let Some(form) = identification.binary
        && let Some(after) = end_of_foreign_binary(cursor, form)
    {
        cursor.position = after;
        return Ok(());
    }
    cursor.skip_to_delimiter()
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
