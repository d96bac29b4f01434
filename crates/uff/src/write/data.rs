//! Record 12: the data.

use super::number::{push_abscissa, push_scientific};
use crate::{Abscissa, ByteOrder, Data, Dataset58, Encoding, Precision};

/// Writes the values; in ASCII with a line end after the last, in binary with none.
pub(super) fn write(out: &mut Vec<u8>, function: &Dataset58) {
    match (function.encoding, function.precision) {
        (Encoding::Ascii, precision) => write_ascii(out, function, precision),
        (Encoding::Binary(ByteOrder::Little), Precision::Single) => {
            each_value(function, |value, _| out.extend_from_slice(&(value as f32).to_le_bytes()));
        }
        (Encoding::Binary(ByteOrder::Big), Precision::Single) => {
            each_value(function, |value, _| out.extend_from_slice(&(value as f32).to_be_bytes()));
        }
        (Encoding::Binary(ByteOrder::Little), Precision::Double) => {
            each_value(function, |value, _| out.extend_from_slice(&value.to_le_bytes()));
        }
        (Encoding::Binary(ByteOrder::Big), Precision::Double) => {
            each_value(function, |value, _| out.extend_from_slice(&value.to_be_bytes()));
        }
    }
}

/// Whose number it is: abscissae have their own columns.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Abscissa,
    Ordinate,
}

/// Hands on every number in file order: abscissa if uneven, real part, imaginary part.
fn each_value(function: &Dataset58, mut emit: impl FnMut(f64, Part)) {
    let abscissa = |point: usize, emit: &mut dyn FnMut(f64, Part)| {
        if let Abscissa::Uneven(values) = &function.abscissa
            && let Some(&value) = values.get(point)
        {
            emit(value, Part::Abscissa);
        }
    };
    match &function.data {
        Data::Real(values) => {
            for (point, &value) in values.iter().enumerate() {
                abscissa(point, &mut emit);
                emit(value, Part::Ordinate);
            }
        }
        Data::Complex(values) => {
            for (point, value) in values.iter().enumerate() {
                abscissa(point, &mut emit);
                emit(value.re, Part::Ordinate);
                emit(value.im, Part::Ordinate);
            }
        }
    }
}

/// `6E13.5`, `4E20.12`, `2(E13.5,E20.12)` or `E13.5,2E20.12`.
fn write_ascii(out: &mut Vec<u8>, function: &Dataset58, precision: Precision) {
    let uneven = matches!(function.abscissa, Abscissa::Uneven(_));
    let complex = matches!(function.data, Data::Complex(_));
    let per_line = match (precision, uneven && complex) {
        (Precision::Single, _) => 6,
        (Precision::Double, true) => 3,
        (Precision::Double, false) => 4,
    };
    let mut on_line = 0;
    each_value(function, |value, part| {
        match (part, precision) {
            (Part::Abscissa, _) => push_abscissa(out, value),
            (Part::Ordinate, Precision::Single) => push_scientific(out, value, 13, 5),
            (Part::Ordinate, Precision::Double) => push_scientific(out, value, 20, 12),
        }
        on_line += 1;
        if on_line == per_line {
            out.push(b'\n');
            on_line = 0;
        }
    });
    if on_line > 0 {
        out.push(b'\n');
    }
}
