//! One dataset 58 or 58b: header, data, closing delimiter.

use num_complex::Complex64;

use super::cursor::Cursor;
use super::fields::BinaryForm;
use super::header::{self, Form};
use super::{Identification, ascii, binary};
use crate::{Abscissa, ByteOrder, Data, Dataset58, Encoding, ReadError, Units};

/// What record 12 holds, taken apart.
pub(super) struct Values {
    /// The abscissa where its spacing is uneven.
    pub(super) abscissa: Vec<f64>,
    pub(super) data: Data,
}

impl Values {
    /// Takes apart numbers that follow one another as in the file: abscissa if uneven, real part, imaginary part.
    pub(super) fn from_interleaved(numbers: Vec<f64>, form: &Form) -> Self {
        let abscissa = |stride| numbers.iter().copied().step_by(stride).collect();
        match (form.even, form.complex) {
            (true, false) => Values { abscissa: Vec::new(), data: Data::Real(numbers) },
            (true, true) => {
                let pairs = numbers.as_chunks().0.iter().map(|&[re, im]| Complex64::new(re, im)).collect();
                Values { abscissa: Vec::new(), data: Data::Complex(pairs) }
            }
            (false, false) => {
                let ordinates = numbers.iter().copied().skip(1).step_by(2).collect();
                Values { abscissa: abscissa(2), data: Data::Real(ordinates) }
            }
            (false, true) => {
                let pairs = numbers.as_chunks().0.iter().map(|&[_, re, im]| Complex64::new(re, im)).collect();
                Values { abscissa: abscissa(3), data: Data::Complex(pairs) }
            }
        }
    }
}

/// Reads a dataset 58 from behind its identification line to behind its closing delimiter.
pub(super) fn read(
    cursor: &mut Cursor,
    dataset: usize,
    identification: &Identification,
    units: Option<&Units>,
) -> Result<Dataset58, ReadError> {
    let stored = identification.binary.map(|_| stated_form(cursor, dataset, identification)).transpose()?;
    let header = header::read(cursor, dataset)?;
    let form = header.form;
    let (values, precision, encoding) = match stored {
        None => (ascii::read(cursor, dataset, &form)?, form.precision, Encoding::Ascii),
        Some((order, byte_count)) => {
            let (values, precision) = binary::read(cursor, dataset, &form, order, byte_count)?;
            (values, precision, Encoding::Binary(order))
        }
    };
    let abscissa = if form.even {
        Abscissa::Even { start: form.start, step: form.step, count: form.points }
    } else {
        Abscissa::Uneven(values.abscissa)
    };
    Ok(Dataset58 {
        id_lines: header.id_lines,
        function: header.identity.function,
        function_id: header.identity.function_id,
        sequence_number: header.identity.sequence_number,
        load_case: header.identity.load_case,
        response: header.identity.response,
        reference: header.identity.reference,
        abscissa,
        z_value: form.z_value,
        abscissa_axis: header.abscissa_axis,
        ordinate_axis: header.ordinate_axis,
        denominator_axis: header.denominator_axis,
        z_axis: header.z_axis,
        data: values.data,
        precision,
        encoding,
        units: units.cloned(),
    })
}

/// Byte order and byte count of a 58b.
fn stated_form(
    cursor: &Cursor,
    dataset: usize,
    identification: &Identification,
) -> Result<(ByteOrder, u64), ReadError> {
    let line = identification.line;
    let wrong = |expected| ReadError::Header {
        dataset,
        line: cursor.line_number(line.start),
        expected,
        found: line.excerpt(),
    };
    let form = identification
        .binary
        .and_then(BinaryForm::read)
        .ok_or_else(|| wrong("byte order and floating-point format behind `58b`"))?;
    if form.float_format != 2 {
        return Err(ReadError::FloatFormat {
            dataset,
            line: cursor.line_number(line.start),
            code: form.float_format,
        });
    }
    let order = match form.byte_order {
        1 => ByteOrder::Little,
        2 => ByteOrder::Big,
        _ => return Err(wrong("byte order 1 (little endian) or 2 (big endian) behind `58b`")),
    };
    Ok((order, form.byte_count))
}
