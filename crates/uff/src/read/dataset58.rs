//! One dataset 58 or 58b: header, data, closing delimiter.

use super::cursor::Cursor;
use super::fields::BinaryForm;
use super::header;
use super::identification::Identification;
use super::{ascii, binary};
use crate::{Abscissa, ByteOrder, Dataset58, Encoding, ReadError, TextProblem, Units};

/// Reads a dataset 58 from behind its identification line to behind its closing delimiter.
pub(super) fn read(
    cursor: &mut Cursor,
    identification: &Identification,
    units: Option<&Units>,
) -> Result<Dataset58, ReadError> {
    let stored = identification.binary.map(|form| stated_form(cursor, identification, form)).transpose()?;
    let (mut function, form) = header::read(cursor)?;
    let values = match stored {
        None => {
            function.encoding = Encoding::Ascii;
            ascii::read(cursor, &form)?
        }
        Some((order, byte_count)) => {
            let (values, precision) = binary::read(cursor, &form, order, byte_count)?;
            (function.encoding, function.precision) = (Encoding::Binary(order), precision);
            values
        }
    };
    if !form.even {
        function.abscissa = Abscissa::Uneven(values.abscissa);
    }
    if values.data.len() < form.points {
        function.stated_points = Some(form.points);
        if let Abscissa::Even { count, .. } = &mut function.abscissa {
            *count = values.data.len();
        }
    }
    Ok(Dataset58 { data: values.data, units: units.cloned(), ..function })
}

/// Byte order and byte count of a 58b.
fn stated_form(
    cursor: &Cursor,
    identification: &Identification,
    form: &[u8],
) -> Result<(ByteOrder, u64), ReadError> {
    let line = identification.line;
    let wrong = |expected| cursor.unexpected(line, expected, line.bytes);
    let form =
        BinaryForm::read(form).ok_or_else(|| wrong("byte order and floating-point format behind `58b`"))?;
    if form.float_format != 2 {
        return Err(cursor.error(line, TextProblem::FloatFormat(form.float_format)));
    }
    let order = match form.byte_order {
        1 => ByteOrder::Little,
        2 => ByteOrder::Big,
        _ => return Err(wrong("byte order 1 (little endian) or 2 (big endian) behind `58b`")),
    };
    Ok((order, form.byte_count))
}
