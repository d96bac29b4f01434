//! Record 12 in binary: IEEE floats in the order of the ASCII form, without line ends.

use num_complex::Complex64;

use super::cursor::Cursor;
use super::header::Form;
use super::values::Values;
use crate::{BinaryProblem, ByteOrder, Data, Precision, ReadError};

/// How wide the numbers of a payload are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Layout {
    abscissa: Precision,
    ordinate: Precision,
}

impl Layout {
    /// The layouts in circulation, likeliest first.
    fn candidates(form: &Form) -> [Layout; 3] {
        use Precision::{Double, Single};
        let uniform = |precision| Layout { abscissa: precision, ordinate: precision };
        match form.precision {
            // Some writers state single precision and store doubles all the same.
            Single => [uniform(Single), uniform(Double), uniform(Single)],
            // The specification keeps the abscissa in single precision; most writers do not.
            Double => [uniform(Double), Layout { abscissa: Single, ordinate: Double }, uniform(Single)],
        }
    }

    fn bytes_per_point(self, form: &Form) -> usize {
        let abscissa = if form.even { 0 } else { width(self.abscissa) };
        abscissa + width(self.ordinate) * (1 + usize::from(form.complex))
    }
}

fn width(precision: Precision) -> usize {
    match precision {
        Precision::Single => 4,
        Precision::Double => 8,
    }
}

/// Reads the payload and its closing delimiter; the precision is that of the ordinates as they are stored.
pub(super) fn read(
    cursor: &mut Cursor,
    form: &Form,
    order: ByteOrder,
    stated: u64,
) -> Result<(Values, Precision), ReadError> {
    let (layout, payload, after) = find_layout(cursor, form, stated)?;
    let values = decode(payload, form, layout, order).map_err(|NotFinite { value }| {
        let values_per_element = if form.even { 1 } else { form.values_per_point() };
        ReadError::NotFinite { dataset: cursor.dataset, point: value / values_per_element }
    })?;
    cursor.position = after;
    // An empty payload fits every layout and says nothing of its precision.
    Ok((values, if form.points == 0 { form.precision } else { layout.ordinate }))
}

/// The layout after which a closing delimiter stands; of several, the one whose length the header states.
fn find_layout<'a>(
    cursor: &Cursor<'a>,
    form: &Form,
    stated: u64,
) -> Result<(Layout, &'a [u8], usize), ReadError> {
    let rest = cursor.rest();
    let mut found: Option<(Layout, &[u8], usize)> = None;
    for layout in Layout::candidates(form) {
        let payload =
            form.points.checked_mul(layout.bytes_per_point(form)).and_then(|length| rest.get(..length));
        let Some(payload) = payload else { continue };
        let Some(after) = cursor.after_closing_delimiter(cursor.position + payload.len()) else { continue };
        if found.is_none() || payload.len() as u64 == stated {
            found = Some((layout, payload, after));
        }
    }
    found.ok_or_else(|| explain(cursor, form, stated))
}

/// Why no layout fits.
fn explain(cursor: &Cursor, form: &Form, stated: u64) -> ReadError {
    let points = form.points;
    let per_point = Layout::candidates(form)[0].bytes_per_point(form);
    let (dataset, offset) = (cursor.dataset, cursor.position);
    let expected = points as u64 * per_point as u64;
    let left = cursor.rest().len();
    let stated_end = usize::try_from(stated).ok().and_then(|stated| offset.checked_add(stated));
    if stated_end.and_then(|end| cursor.after_closing_delimiter(end)).is_some() {
        let problem = BinaryProblem::PointsAgainstBytes { points, stated };
        return ReadError::Binary { dataset, offset, problem };
    }
    match usize::try_from(expected) {
        Ok(expected) if expected < left => {
            let problem = BinaryProblem::NoEnd { points, stated };
            ReadError::Binary { dataset, offset: offset + expected, problem }
        }
        _ => {
            let problem = BinaryProblem::Truncated { points, expected, found: left };
            ReadError::Binary { dataset, offset, problem }
        }
    }
}

/// Something that is NaN or infinite: which element of the decoded row, counted from 0.
struct NotFinite {
    value: usize,
}

fn decode(payload: &[u8], form: &Form, layout: Layout, order: ByteOrder) -> Result<Values, NotFinite> {
    if form.even && form.complex {
        let lines = complex_values(payload, layout.ordinate, order)?;
        return Ok(Values { abscissa: Vec::new(), data: Data::Complex(lines) });
    }
    let numbers = if form.even || layout.abscissa == layout.ordinate {
        real_values(payload, layout.ordinate, order)?
    } else {
        mixed_values(payload, form, layout, order)?
    };
    Ok(Values::from_interleaved(numbers, form))
}

/// Decodes block by block and looks for NaN while the block is still in cache: a pass over the whole data
/// afterwards would cost as much as the decoding.
fn decode_blocks<S: Copy, T>(
    stored: &[S],
    decode: impl Fn(S) -> T,
    is_finite: impl Fn(&T) -> bool,
) -> Result<Vec<T>, NotFinite> {
    let mut values = Vec::with_capacity(stored.len());
    for block in stored.chunks(1024) {
        let before = values.len();
        values.extend(block.iter().map(|&bytes| decode(bytes)));
        let decoded = &values[before..];
        // Without a branch a value, so that the compiler can test several at once.
        if !decoded.iter().fold(true, |all, value| all & is_finite(value)) {
            let within = decoded.iter().position(|value| !is_finite(value)).unwrap_or_default();
            return Err(NotFinite { value: before + within });
        }
    }
    Ok(values)
}

fn real_values(payload: &[u8], precision: Precision, order: ByteOrder) -> Result<Vec<f64>, NotFinite> {
    fn reals<const W: usize>(payload: &[u8], value: impl Fn([u8; W]) -> f64) -> Result<Vec<f64>, NotFinite> {
        decode_blocks(payload.as_chunks::<W>().0, value, |value| value.is_finite())
    }
    match (precision, order) {
        (Precision::Single, ByteOrder::Little) => reals(payload, |b| f64::from(f32::from_le_bytes(b))),
        (Precision::Single, ByteOrder::Big) => reals(payload, |b| f64::from(f32::from_be_bytes(b))),
        (Precision::Double, ByteOrder::Little) => reals(payload, f64::from_le_bytes),
        (Precision::Double, ByteOrder::Big) => reals(payload, f64::from_be_bytes),
    }
}

fn complex_values(
    payload: &[u8],
    precision: Precision,
    order: ByteOrder,
) -> Result<Vec<Complex64>, NotFinite> {
    fn pairs<const W: usize>(
        payload: &[u8],
        value: impl Fn([u8; W]) -> f64,
    ) -> Result<Vec<Complex64>, NotFinite> {
        decode_blocks(
            payload.as_chunks::<W>().0.as_chunks().0,
            |[re, im]| Complex64::new(value(re), value(im)),
            |line| line.re.is_finite() & line.im.is_finite(),
        )
    }
    match (precision, order) {
        (Precision::Single, ByteOrder::Little) => pairs(payload, |b| f64::from(f32::from_le_bytes(b))),
        (Precision::Single, ByteOrder::Big) => pairs(payload, |b| f64::from(f32::from_be_bytes(b))),
        (Precision::Double, ByteOrder::Little) => pairs(payload, f64::from_le_bytes),
        (Precision::Double, ByteOrder::Big) => pairs(payload, f64::from_be_bytes),
    }
}

/// A single-precision abscissa before each double-precision ordinate.
fn mixed_values(
    payload: &[u8],
    form: &Form,
    layout: Layout,
    order: ByteOrder,
) -> Result<Vec<f64>, NotFinite> {
    let mut values = Vec::with_capacity(form.points.saturating_mul(form.values_per_point()));
    for point in payload.chunks_exact(layout.bytes_per_point(form)) {
        let (abscissa, ordinate) = point.split_at(width(layout.abscissa));
        values.extend(abscissa.as_chunks().0.iter().map(|&bytes| f64::from(single(bytes, order))));
        values.extend(ordinate.as_chunks().0.iter().map(|&bytes| double(bytes, order)));
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(value) => Err(NotFinite { value }),
        None => Ok(values),
    }
}

fn single(bytes: [u8; 4], order: ByteOrder) -> f32 {
    match order {
        ByteOrder::Little => f32::from_le_bytes(bytes),
        ByteOrder::Big => f32::from_be_bytes(bytes),
    }
}

fn double(bytes: [u8; 8], order: ByteOrder) -> f64 {
    match order {
        ByteOrder::Little => f64::from_le_bytes(bytes),
        ByteOrder::Big => f64::from_be_bytes(bytes),
    }
}
