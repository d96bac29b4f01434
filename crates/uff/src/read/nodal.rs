//! Datasets 55 and 2414, each from behind its identification line to behind its closing delimiter.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::ascii;
use super::cursor::{Cursor, is_delimiter};
use super::fields::line_text;
use super::integers::{list, record};
use crate::{Analysis, NodalData, NodeValues, ReadError, ValueLocation};

/// Columns of single-precision and double-precision values.
const SINGLE: &[usize] = &[13; 6];
const DOUBLE: &[usize] = &[25; 3];

fn text(cursor: &mut Cursor, expected: &'static str) -> Result<String, ReadError> {
    Ok(line_text(cursor.header_line(expected)?.bytes).trim().to_owned())
}

/// What stands before the parameters, the same in both datasets.
struct Form {
    analysis: Analysis,
    quantity: i64,
    complex: bool,
    widths: &'static [usize],
    per_node: usize,
}

fn form(cursor: &mut Cursor) -> Result<Form, ReadError> {
    const EXPECTED: &str = "model, analysis, characteristic, quantity, data type (2, 4, 5 or 6) and values a node (record 6 of dataset 55, 9 of 2414)";
    let line = cursor.clone();
    let [_, analysis, _, quantity, data_type, per_node] = record(cursor, EXPECTED)?;
    let (complex, widths) = match data_type {
        2 => (false, SINGLE),
        4 => (false, DOUBLE),
        5 => (true, SINGLE),
        6 => (true, DOUBLE),
        other => return Err(unexpected(&line, EXPECTED, other)),
    };
    let per_node = match usize::try_from(per_node) {
        // A tensor has at most nine components; layers of shells do not come at nodes.
        Ok(count @ 1..=64) => count,
        _ => return Err(unexpected(&line, EXPECTED, per_node)),
    };
    Ok(Form { analysis: Analysis::from_code(analysis), quantity, complex, widths, per_node })
}

fn unexpected(at: &Cursor, expected: &'static str, found: i64) -> ReadError {
    let line = super::cursor::Line { start: at.position, bytes: &[] };
    at.unexpected(line, expected, found.to_string().as_bytes())
}

impl Form {
    fn empty(self, dataset: u32, name: String, location: ValueLocation) -> NodalData {
        NodalData {
            dataset,
            name,
            location,
            analysis: self.analysis,
            quantity: self.quantity,
            mode: 0,
            frequency: None,
            damping_ratio: None,
            hysteretic_damping: None,
            modal_mass: None,
            eigenvalue: None,
            per_node: self.per_node,
            complex: self.complex,
            values: Vec::new(),
        }
    }
}

fn above_zero(value: f64) -> Option<f64> {
    (value > 0.0).then_some(value)
}

/// Frequency and damping of a real mode.
fn of_normal_mode(data: &mut NodalData, [hertz, mass, viscous, hysteretic]: [f64; 4]) {
    data.frequency = above_zero(hertz);
    data.modal_mass = above_zero(mass);
    data.damping_ratio = (viscous >= 0.0 && data.frequency.is_some()).then_some(viscous);
    data.hysteretic_damping = above_zero(hysteretic);
}

/// Frequency and damping of a complex mode with eigenvalue λ.
fn of_complex_mode(data: &mut NodalData, re: f64, im: f64) {
    let eigenvalue = Complex64::new(re, im);
    if eigenvalue.norm() > 0.0 {
        data.eigenvalue = Some(eigenvalue);
        data.frequency = Some(eigenvalue.norm() / TAU);
        data.damping_ratio = Some(-eigenvalue.re / eigenvalue.norm());
    }
}

/// Dataset 55.
pub(super) fn read55(cursor: &mut Cursor) -> Result<NodalData, ReadError> {
    const COUNTS: &str = "two counts and the integer parameters of the analysis (dataset 55, record 7)";
    const REALS: &str = "the real parameters of the analysis (dataset 55, record 8)";
    let name = text(cursor, "an ID line (dataset 55, records 1 to 5)")?;
    for _ in 0..4 {
        text(cursor, "an ID line (dataset 55, records 1 to 5)")?;
    }
    let form = form(cursor)?;
    let widths = form.widths;
    let mut data = form.empty(55, name, ValueLocation::Nodes);
    let at = cursor.clone();
    let [integers, reals] = record(&mut cursor.clone(), COUNTS)?;
    if !(0..=10).contains(&integers) || !(0..=12).contains(&reals) {
        return Err(unexpected(&at, COUNTS, integers.max(reals)));
    }
    let integers = list(cursor, 2 + integers, COUNTS)?;
    let reals = ascii::some_numbers(cursor, SINGLE, usize::try_from(reals).unwrap_or(0), REALS)?;
    let real = |at: usize| reals.get(at).copied().unwrap_or(0.0);
    data.mode = integers.get(3).copied().unwrap_or(0);
    match data.analysis {
        Analysis::NormalMode => of_normal_mode(&mut data, [real(0), real(1), real(2), real(3)]),
        Analysis::ComplexFirstOrder | Analysis::ComplexSecondOrder => {
            of_complex_mode(&mut data, real(0), real(1))
        }
        Analysis::FrequencyResponse => data.frequency = above_zero(real(0)),
        Analysis::Other(_) => {}
    }
    values(cursor, &mut data, widths)?;
    Ok(data)
}

/// Dataset 2414; values that do not sit at nodes are passed.
pub(super) fn read2414(cursor: &mut Cursor) -> Result<NodalData, ReadError> {
    let [_label] = record(cursor, "a label (dataset 2414, record 1)")?;
    let name = text(cursor, "a name (dataset 2414, record 2)")?;
    let [location] = record(cursor, "a location (dataset 2414, record 3)")?;
    let location = if location == 1 { ValueLocation::Nodes } else { ValueLocation::Other(location) };
    for _ in 0..5 {
        text(cursor, "an ID line (dataset 2414, records 4 to 8)")?;
    }
    let form = form(cursor)?;
    let widths = form.widths;
    let mut data = form.empty(2414, name, location);
    let integers =
        list(cursor, 10, "the integer parameters of the analysis (dataset 2414, records 10 and 11)")?;
    let reals = ascii::some_numbers(
        cursor,
        SINGLE,
        12,
        "the real parameters of the analysis (dataset 2414, records 12 and 13)",
    )?;
    data.mode = integers.get(5).copied().unwrap_or(0);
    let real = |at: usize| reals.get(at).copied().unwrap_or(0.0);
    match data.analysis {
        Analysis::ComplexFirstOrder | Analysis::ComplexSecondOrder => {
            of_complex_mode(&mut data, real(6), real(7))
        }
        Analysis::Other(_) => {}
        _ => of_normal_mode(&mut data, [real(1), real(3), real(4), real(5)]),
    }
    if data.location == ValueLocation::Nodes {
        values(cursor, &mut data, widths)?;
    } else {
        cursor.skip_to_delimiter()?;
    }
    Ok(data)
}

/// Node after node, to behind the closing delimiter.
fn values(cursor: &mut Cursor, data: &mut NodalData, widths: &'static [usize]) -> Result<(), ReadError> {
    const VALUES: &str = "the values of a node (datasets 55 and 2414)";
    let parts = if data.complex { 2 } else { 1 };
    loop {
        let Some(line) = cursor.next_filled_line() else {
            return Err(cursor.truncated("a node or the `    -1` line that closes the dataset"));
        };
        if is_delimiter(line.bytes) {
            return Ok(());
        }
        cursor.position = line.start;
        let [node] = record(cursor, "a node number (datasets 55 and 2414)")?;
        let numbers = ascii::some_numbers(cursor, widths, parts * data.per_node, VALUES)?;
        let values = match parts {
            2 => numbers.as_chunks().0.iter().map(|&[re, im]| Complex64::new(re, im)).collect(),
            _ => numbers.into_iter().map(Complex64::from).collect(),
        };
        data.values.push(NodeValues { node, values });
    }
}
