//! Records 1 to 11 of a dataset 58.

use std::str::FromStr;

use super::cursor::{Cursor, Line};
use super::fields::Column::{self, Gap, Number, Text};
use super::fields::{columns_of, cut, line_text};
use super::number::{self, BadNumber};
use crate::{Abscissa, Axis, Data, Dataset58, FunctionType, Node, Precision, ReadError};

/// How the data behind a header is laid out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Form {
    pub(super) precision: Precision,
    pub(super) complex: bool,
    pub(super) even: bool,
    pub(super) points: usize,
}

impl Form {
    /// Numbers stored a point: the ordinate's parts, and the abscissa where the spacing is uneven.
    pub(super) fn values_per_point(&self) -> usize {
        1 + usize::from(self.complex) + usize::from(!self.even)
    }
}

/// Reads records 1 to 11: a function without data, and how its data is laid out.
pub(super) fn read(cursor: &mut Cursor) -> Result<(Dataset58, Form), ReadError> {
    let none = Abscissa::Even { start: 0.0, step: 0.0, count: 0 };
    let mut function = Dataset58::new(none, Data::Real(Vec::new()));
    for id_line in &mut function.id_lines {
        let line = cursor.header_line("an ID line (records 1 to 5)")?;
        *id_line = columns_of(&line_text(line.bytes), 0, 80).trim().to_owned();
    }
    identity(cursor, &mut function)?;
    let form = form(cursor, &mut function)?;
    let axes = [
        &mut function.abscissa_axis,
        &mut function.ordinate_axis,
        &mut function.denominator_axis,
        &mut function.z_axis,
    ];
    for (axis, [record, expected]) in axes.into_iter().zip(AXES) {
        *axis = read_axis(cursor, record, expected)?;
    }
    Ok((function, form))
}

/// Records 8 to 11, and what each must hold.
const AXES: [[&str; 2]; 4] = [
    ["record 8 (abscissa)", "data type and three exponents of the abscissa (record 8)"],
    ["record 9 (ordinate)", "data type and three exponents of the ordinate (record 9)"],
    [
        "record 10 (ordinate denominator)",
        "data type and three exponents of the ordinate denominator (record 10)",
    ],
    ["record 11 (z-axis)", "data type and three exponents of the z-axis (record 11)"],
];

/// A record whose fields are being read.
struct Record<'c, 'a> {
    cursor: &'c Cursor<'a>,
    line: Line<'a>,
}

impl Record<'_, '_> {
    fn error(&self, expected: &'static str, found: &str) -> ReadError {
        self.cursor.unexpected(self.line, expected, found.as_bytes())
    }

    /// A whole number; a blank one is 0 in Fortran.
    fn integer<T: FromStr + Default>(&self, field: &str, expected: &'static str) -> Result<T, ReadError> {
        if field.is_empty() { Ok(T::default()) } else { self.filled(field, expected) }
    }

    fn filled<T: FromStr>(&self, field: &str, expected: &'static str) -> Result<T, ReadError> {
        field.parse().map_err(|_| self.error(expected, field))
    }

    fn real(&self, field: &str, expected: &'static str) -> Result<f64, ReadError> {
        match number::parse(field.as_bytes()) {
            Ok(value) => Ok(value),
            Err(BadNumber::Blank) => Ok(0.0),
            Err(_) => Err(self.error(expected, field)),
        }
    }
}

/// Record 6: `2(I5,I10), 2(1X,10A1,I10,I4)`.
fn identity(cursor: &mut Cursor, function: &mut Dataset58) -> Result<(), ReadError> {
    const NODE: [Column; 4] = [Gap(1), Text(10), Number(10), Number(4)];
    let columns = [&[Number(5), Number(10), Number(5), Number(10)], &NODE, &NODE].into_iter().flatten();
    let line = cursor.header_line("record 6 (function type and nodes)")?;
    let text = line_text(line.bytes);
    let fields = cut::<10>(&text, columns).or_by_blanks(|| by_blanks_identity(&text));
    let record = Record { cursor, line };
    function.function =
        FunctionType::from_code(record.integer(fields[0], "a function type (record 6, field 1)")?);
    function.function_id =
        record.integer(fields[1], "a function identification number (record 6, field 2)")?;
    function.sequence_number = record.integer(fields[2], "a sequence number (record 6, field 3)")?;
    function.load_case = record.integer(fields[3], "a load case number (record 6, field 4)")?;
    function.response = Node {
        entity: fields[4].to_owned(),
        number: record.integer(fields[5], "a response node number (record 6, field 6)")?,
        direction: record.integer(fields[6], "a response direction (record 6, field 7)")?,
    };
    function.reference = Node {
        entity: fields[7].to_owned(),
        number: record.integer(fields[8], "a reference node number (record 6, field 9)")?,
        direction: record.integer(fields[9], "a reference direction (record 6, field 10)")?,
    };
    Ok(())
}

/// Record 7: `3I10, 3E13.5`.
fn form(cursor: &mut Cursor, function: &mut Dataset58) -> Result<Form, ReadError> {
    const COLUMNS: [Column; 6] = [Number(10), Number(10), Number(10), Number(13), Number(13), Number(13)];
    let line = cursor.header_line("record 7 (data type, number of points, abscissa)")?;
    let text = line_text(line.bytes);
    let fields = cut::<6>(&text, &COLUMNS).or_by_blanks(|| by_blanks_form(&text));
    let record = Record { cursor, line };
    let (precision, complex) = match fields[0] {
        "2" => (Precision::Single, false),
        "4" => (Precision::Double, false),
        "5" => (Precision::Single, true),
        "6" => (Precision::Double, true),
        other => return Err(record.error("ordinate data type 2, 4, 5 or 6 (record 7, field 1)", other)),
    };
    let even = match fields[2] {
        "0" => false,
        "1" => true,
        other => {
            return Err(record.error("abscissa spacing 0 (uneven) or 1 (even) (record 7, field 3)", other));
        }
    };
    let points = record.filled(fields[1], "a number of points (record 7, field 2)")?;
    function.precision = precision;
    function.abscissa = Abscissa::Even {
        start: record.real(fields[3], "a finite abscissa minimum (record 7, field 4)")?,
        step: record.real(fields[4], "a finite abscissa increment (record 7, field 5)")?,
        count: points,
    };
    function.z_value = record.real(fields[5], "a finite z-axis value (record 7, field 6)")?;
    Ok(Form { precision, complex, even, points })
}

/// Records 8 to 11: `I10, 3I5, 2(1X,20A1)`.
fn read_axis(cursor: &mut Cursor, record: &'static str, expected: &'static str) -> Result<Axis, ReadError> {
    const COLUMNS: [Column; 8] =
        [Number(10), Number(5), Number(5), Number(5), Gap(1), Text(20), Gap(1), Text(20)];
    let line = cursor.header_line(record)?;
    let text = line_text(line.bytes);
    let fields = cut::<6>(&text, &COLUMNS).or_by_blanks(|| by_blanks_axis(&text));
    let code = |field: &str| Record { cursor, line }.integer(field, expected);
    Ok(Axis {
        data_type: code(fields[0])?,
        exponents: [code(fields[1])?, code(fields[2])?, code(fields[3])?],
        label: fields[4].to_owned(),
        units: fields[5].to_owned(),
    })
}

fn is_integer(word: &str) -> bool {
    word.parse::<i64>().is_ok()
}

/// Record 6 by its blanks: ten words with single-word entity names, or eight numbers where the names are
/// blank.
fn by_blanks_identity(text: &str) -> Option<[&str; 10]> {
    let mut words = [""; 10];
    let mut count = 0;
    for word in text.split_ascii_whitespace() {
        *words.get_mut(count)? = word;
        count += 1;
    }
    if count == 8 {
        let [a, b, c, d, e, f, g, h, ..] = words;
        words = [a, b, c, d, "", e, f, "", g, h];
    } else if count != 10 {
        return None;
    }
    let numbers = [0, 1, 2, 3, 5, 6, 8, 9];
    numbers.iter().all(|&field| is_integer(words[field])).then_some(words)
}

/// Record 7 by its blanks: six words, or five where the z-axis value is left out.
fn by_blanks_form(text: &str) -> Option<[&str; 6]> {
    let mut words = [""; 6];
    let mut count = 0;
    for word in text.split_ascii_whitespace() {
        *words.get_mut(count)? = word;
        count += 1;
    }
    let integers = words[..3].iter().all(|word| is_integer(word));
    let reals = words[3..count.max(3)].iter().all(|word| number::parse(word.as_bytes()).is_ok());
    (count >= 5 && integers && reals).then_some(words)
}

/// Records 8 to 11 by their blanks: four numbers, then label and units with at least two blanks between.
fn by_blanks_axis(text: &str) -> Option<[&str; 6]> {
    let mut rest = text;
    let mut numbers = [""; 4];
    for number in &mut numbers {
        rest = rest.trim_start();
        let (word, tail) = rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len()));
        if !is_integer(word) {
            return None;
        }
        (*number, rest) = (word, tail);
    }
    let labels = rest.trim();
    let (label, units) = labels.split_once("  ").unwrap_or((labels, ""));
    let [data_type, length, force, temperature] = numbers;
    Some([data_type, length, force, temperature, label.trim(), units.trim()])
}
