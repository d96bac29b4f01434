//! From functions to bytes: delimiters, units where they change, and the order of the records.

mod data;
mod header;
mod layout;
mod number;
mod write_error;

pub use write_error::{WriteError, WriteProblem};

use crate::{Abscissa, Data, Dataset58, Encoding, Precision, Units};
use layout::{DELIMITER, values_per_point};

/// Writes functions as one universal file, each in its own precision and encoding, in the given order. A
/// dataset 164 precedes the first function and every function whose units differ from those before.
///
/// ```
/// use jointscope_uff::{Abscissa, Data, Dataset58, write};
/// let history = Dataset58::new(Abscissa::Even { start: 0.0, step: 1e-3, count: 2 }, Data::Real(vec![0.5, f64::NAN]));
/// let error = write(&[history]).unwrap_err();
/// assert_eq!(error.to_string(), "function 1: the value at spectral line (point) 1, counted from 0, is not finite; nothing was written");
/// ```
///
/// # Errors
/// A [`WriteError`] naming the function, counted from 1, that a universal file cannot hold: a value that is
/// not finite, text or a number wider than its columns, an abscissa of another length than the data. Nothing
/// is cut off or rounded to fit.
pub fn write(datasets: &[Dataset58]) -> Result<Vec<u8>, WriteError> {
    let mut out = Vec::with_capacity(datasets.iter().map(size_estimate).sum());
    let mut in_force = None;
    for (index, function) in datasets.iter().enumerate() {
        write_function(&mut out, function, &mut in_force)
            .map_err(|problem| WriteError { function: index + 1, problem })?;
    }
    Ok(out)
}

/// Writes a function, its units before it where others are `in_force`.
fn write_function<'d>(
    out: &mut Vec<u8>,
    function: &'d Dataset58,
    in_force: &mut Option<&'d Units>,
) -> Result<(), WriteProblem> {
    check_values(function)?;
    match (&function.units, *in_force) {
        (Some(units), before) if Some(units) != before => {
            header::write_units(out, units)?;
            *in_force = Some(units);
        }
        (None, Some(_)) => return Err(WriteProblem::UnitsWithdrawn),
        _ => {}
    }
    header::write(out, function)?;
    data::write(out, function);
    out.extend_from_slice(DELIMITER);
    Ok(())
}

fn size_estimate(function: &Dataset58) -> usize {
    let width = match (function.encoding, function.precision) {
        (Encoding::Ascii, _) => 21,
        (Encoding::Binary(_), Precision::Single) => 4,
        (Encoding::Binary(_), Precision::Double) => 8,
    };
    1100 + function.data.len() * values_per_point(function) * width
}

/// Refuses what no reader could take for a value.
fn check_values(function: &Dataset58) -> Result<(), WriteProblem> {
    let (ordinates, abscissae) = (function.data.len(), function.abscissa.len());
    if ordinates != abscissae {
        return Err(WriteProblem::LengthMismatch { ordinates, abscissae });
    }
    if let Some(point) = function.data.first_non_finite() {
        return Err(WriteProblem::NotFinite(point));
    }
    let header_values = match function.abscissa {
        Abscissa::Even { start, step, .. } => [start, step, function.z_value],
        Abscissa::Uneven(_) => [0.0, 0.0, function.z_value],
    };
    if !header_values.iter().all(|value| value.is_finite()) {
        return Err(WriteProblem::HeaderNotFinite);
    }
    if let Abscissa::Uneven(values) = &function.abscissa
        && let Some(point) = values.iter().position(|value| !value.is_finite())
    {
        return Err(WriteProblem::NotFinite(point));
    }
    // Binary single precision has the range of a 4-byte float.
    let single = function.precision == Precision::Single && function.encoding != Encoding::Ascii;
    if single && let Some(point) = first_beyond_single(function) {
        return Err(WriteProblem::BeyondSingle(point));
    }
    Ok(())
}

fn first_beyond_single(function: &Dataset58) -> Option<usize> {
    let beyond = |value: &f64| !(*value as f32).is_finite();
    let ordinate = match &function.data {
        Data::Real(values) => values.iter().position(beyond),
        Data::Complex(values) => values.iter().position(|value| beyond(&value.re) || beyond(&value.im)),
    };
    ordinate.or_else(|| match &function.abscissa {
        Abscissa::Even { .. } => None,
        Abscissa::Uneven(values) => values.iter().position(beyond),
    })
}
