//! Records 1 to 11 of a dataset 58.

use super::cursor::{Cursor, Line, excerpt, is_delimiter};
use super::fields::{Column, cut, line_text};
use super::number;
use crate::{Axis, FunctionType, Node, Precision, ReadError};

/// Everything a dataset 58 says before its data.
pub(super) struct Header {
    pub(super) id_lines: [String; 5],
    pub(super) identity: Identity,
    pub(super) form: Form,
    pub(super) abscissa_axis: Axis,
    pub(super) ordinate_axis: Axis,
    pub(super) denominator_axis: Axis,
    pub(super) z_axis: Axis,
}

/// Record 6.
pub(super) struct Identity {
    pub(super) function: FunctionType,
    pub(super) function_id: i64,
    pub(super) sequence_number: i64,
    pub(super) load_case: i64,
    pub(super) response: Node,
    pub(super) reference: Node,
}

/// Record 7.
#[derive(Debug, Clone, Copy)]
pub(super) struct Form {
    pub(super) precision: Precision,
    pub(super) complex: bool,
    pub(super) even: bool,
    pub(super) points: usize,
    pub(super) start: f64,
    pub(super) step: f64,
    pub(super) z_value: f64,
}

impl Form {
    /// Numbers stored a point: the ordinate's parts, and the abscissa where the spacing is uneven.
    pub(super) fn values_per_point(&self) -> usize {
        1 + usize::from(self.complex) + usize::from(!self.even)
    }
}

/// Reads records 1 to 11.
pub(super) fn read(cursor: &mut Cursor, dataset: usize) -> Result<Header, ReadError> {
    let mut records = Records { cursor, dataset };
    let mut id_lines: [String; 5] = Default::default();
    for id_line in &mut id_lines {
        let line = records.next("an ID line (records 1 to 5)")?;
        *id_line = super::fields::columns_of(&line_text(line.bytes), 0, 80).trim().to_owned();
    }
    Ok(Header {
        id_lines,
        identity: records.identity()?,
        form: records.form()?,
        abscissa_axis: records.axis("record 8 (abscissa)", AXIS_EXPECTED[0])?,
        ordinate_axis: records.axis("record 9 (ordinate)", AXIS_EXPECTED[1])?,
        denominator_axis: records.axis("record 10 (ordinate denominator)", AXIS_EXPECTED[2])?,
        z_axis: records.axis("record 11 (z-axis)", AXIS_EXPECTED[3])?,
    })
}

const AXIS_EXPECTED: [&str; 4] = [
    "data type and three exponents of the abscissa (record 8)",
    "data type and three exponents of the ordinate (record 9)",
    "data type and three exponents of the ordinate denominator (record 10)",
    "data type and three exponents of the z-axis (record 11)",
];

struct Records<'c, 'a> {
    cursor: &'c mut Cursor<'a>,
    dataset: usize,
}

impl<'a> Records<'_, 'a> {
    fn next(&mut self, expected: &'static str) -> Result<Line<'a>, ReadError> {
        let dataset = self.dataset;
        let line = self.cursor.next_line().ok_or_else(|| self.cursor.truncated(dataset, expected))?;
        if is_delimiter(line.bytes) {
            let line = self.cursor.line_number(line.start);
            return Err(ReadError::HeaderEndsEarly { dataset, line, expected });
        }
        Ok(line)
    }

    fn error(&self, line: Line, expected: &'static str, found: &str) -> ReadError {
        ReadError::Header {
            dataset: self.dataset,
            line: self.cursor.line_number(line.start),
            expected,
            found: excerpt(found.as_bytes()),
        }
    }

    fn integer(&self, line: Line, field: &str, expected: &'static str) -> Result<i64, ReadError> {
        // A blank integer is 0 in Fortran.
        if field.is_empty() {
            return Ok(0);
        }
        field.parse().map_err(|_| self.error(line, expected, field))
    }

    fn code(&self, line: Line, field: &str, expected: &'static str) -> Result<i32, ReadError> {
        let code = self.integer(line, field, expected)?;
        i32::try_from(code).map_err(|_| self.error(line, expected, field))
    }

    fn real(&self, line: Line, field: &str, expected: &'static str) -> Result<f64, ReadError> {
        match number::parse(field.as_bytes()) {
            Ok(value) => Ok(value),
            Err(number::BadNumber::Blank) => Ok(0.0),
            Err(_) => Err(self.error(line, expected, field)),
        }
    }

    /// Record 6: `2(I5,I10), 2(1X,10A1,I10,I4)`.
    fn identity(&mut self) -> Result<Identity, ReadError> {
        use Column::{Gap, Number, Text};
        const COLUMNS: [Column; 12] = [
            Number(5),
            Number(10),
            Number(5),
            Number(10),
            Gap(1),
            Text(10),
            Number(10),
            Number(4),
            Gap(1),
            Text(10),
            Number(10),
            Number(4),
        ];
        let line = self.next("record 6 (function type and nodes)")?;
        let text = line_text(line.bytes);
        let by_columns = cut::<10>(&text, &COLUMNS);
        let fields = match by_blanks_identity(&text) {
            Some(fields) if !by_columns.clean => fields,
            _ => by_columns.fields,
        };
        let function = self.code(line, fields[0], "a function type (record 6, field 1)")?;
        Ok(Identity {
            function: FunctionType::from_code(function),
            function_id: self.integer(
                line,
                fields[1],
                "a function identification number (record 6, field 2)",
            )?,
            sequence_number: self.integer(line, fields[2], "a sequence number (record 6, field 3)")?,
            load_case: self.integer(line, fields[3], "a load case number (record 6, field 4)")?,
            response: Node {
                entity: fields[4].to_owned(),
                number: self.integer(line, fields[5], "a response node number (record 6, field 6)")?,
                direction: self.code(line, fields[6], "a response direction (record 6, field 7)")?,
            },
            reference: Node {
                entity: fields[7].to_owned(),
                number: self.integer(line, fields[8], "a reference node number (record 6, field 9)")?,
                direction: self.code(line, fields[9], "a reference direction (record 6, field 10)")?,
            },
        })
    }

    /// Record 7: `3I10, 3E13.5`.
    fn form(&mut self) -> Result<Form, ReadError> {
        use Column::Number;
        const COLUMNS: [Column; 6] = [Number(10), Number(10), Number(10), Number(13), Number(13), Number(13)];
        const DATA_TYPE: &str = "ordinate data type 2, 4, 5 or 6 (record 7, field 1)";
        const POINTS: &str = "a number of points (record 7, field 2)";
        const SPACING: &str = "abscissa spacing 0 (uneven) or 1 (even) (record 7, field 3)";
        let line = self.next("record 7 (data type, number of points, abscissa)")?;
        let text = line_text(line.bytes);
        let by_columns = cut::<6>(&text, &COLUMNS);
        let fields = match by_blanks_form(&text) {
            Some(fields) if !by_columns.clean => fields,
            _ => by_columns.fields,
        };
        let (precision, complex) = match fields[0] {
            "2" => (Precision::Single, false),
            "4" => (Precision::Double, false),
            "5" => (Precision::Single, true),
            "6" => (Precision::Double, true),
            other => return Err(self.error(line, DATA_TYPE, other)),
        };
        let even = match fields[2] {
            "0" => false,
            "1" => true,
            other => return Err(self.error(line, SPACING, other)),
        };
        Ok(Form {
            precision,
            complex,
            even,
            points: fields[1].parse().map_err(|_| self.error(line, POINTS, fields[1]))?,
            start: self.real(line, fields[3], "a finite abscissa minimum (record 7, field 4)")?,
            step: self.real(line, fields[4], "a finite abscissa increment (record 7, field 5)")?,
            z_value: self.real(line, fields[5], "a finite z-axis value (record 7, field 6)")?,
        })
    }

    /// Records 8 to 11: `I10, 3I5, 2(1X,20A1)`.
    fn axis(&mut self, record: &'static str, expected: &'static str) -> Result<Axis, ReadError> {
        use Column::{Gap, Number, Text};
        const COLUMNS: [Column; 8] =
            [Number(10), Number(5), Number(5), Number(5), Gap(1), Text(20), Gap(1), Text(20)];
        let line = self.next(record)?;
        let text = line_text(line.bytes);
        let by_columns = cut::<6>(&text, &COLUMNS);
        let fields = match by_blanks_axis(&text) {
            Some(fields) if !by_columns.clean => fields,
            _ => by_columns.fields,
        };
        Ok(Axis {
            data_type: self.code(line, fields[0], expected)?,
            exponents: [
                self.code(line, fields[1], expected)?,
                self.code(line, fields[2], expected)?,
                self.code(line, fields[3], expected)?,
            ],
            label: fields[4].to_owned(),
            units: fields[5].to_owned(),
        })
    }
}

fn is_integer(word: &str) -> bool {
    word.parse::<i64>().is_ok()
}

/// Record 6 by its blanks: ten words with single-word entity names, or eight numbers where the names are blank.
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
