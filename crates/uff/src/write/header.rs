//! Identification line and records 1 to 11 of a dataset 58, and the whole of a dataset 164.

use std::io::Write;

use super::layout::{DELIMITER, values_per_point};
use super::number;
use super::write_error::WriteProblem;
use crate::{Abscissa, Axis, ByteOrder, Data, Dataset58, Encoding, Node, Precision, TemperatureMode, Units};

/// Writes everything from the opening delimiter to record 11.
pub(super) fn write(out: &mut Vec<u8>, function: &Dataset58) -> Result<(), WriteProblem> {
    let mut record = Record { out };
    record.out.extend_from_slice(DELIMITER);
    record.identification(function)?;
    for (id_line, field) in function.id_lines.iter().zip(ID_LINES) {
        record.text(id_line, 80, field)?;
        record.end();
    }
    record.identity(function)?;
    record.form(function)?;
    record.axis(&function.abscissa_axis)?;
    record.axis(&function.ordinate_axis)?;
    record.axis(&function.denominator_axis)?;
    record.axis(&function.z_axis)
}

/// Writes a dataset 164.
pub(super) fn write_units(out: &mut Vec<u8>, units: &Units) -> Result<(), WriteProblem> {
    let factors = [units.length_factor, units.force_factor, units.temperature_factor];
    let positive = factors.iter().all(|factor| factor.is_finite() && *factor > 0.0);
    if !positive || !units.temperature_offset.is_finite() {
        return Err(WriteProblem::UnitFactors);
    }
    let mut record = Record { out };
    record.out.extend_from_slice(DELIMITER);
    record.out.extend_from_slice(b"   164");
    record.blanks(74);
    record.end();
    record.integer(i64::from(units.code), 10, "the units code (dataset 164)")?;
    record.text(&units.description, 20, "the units description (dataset 164)")?;
    let mode = match units.temperature_mode {
        TemperatureMode::Absolute => 1,
        TemperatureMode::Relative => 2,
    };
    record.integer(mode, 10, "the temperature mode (dataset 164)")?;
    record.end();
    for factor in factors {
        number::push_double_mark(record.out, factor, 25, 17);
    }
    record.end();
    number::push_double_mark(record.out, units.temperature_offset, 25, 17);
    record.end();
    record.out.extend_from_slice(DELIMITER);
    Ok(())
}

const ID_LINES: [&str; 5] = ["ID line 1", "ID line 2", "ID line 3", "ID line 4", "ID line 5"];

/// The header under construction.
struct Record<'o> {
    out: &'o mut Vec<u8>,
}

impl Record<'_> {
    fn end(&mut self) {
        self.out.push(b'\n');
    }

    fn blanks(&mut self, count: usize) {
        self.out.extend(std::iter::repeat_n(b' ', count));
    }

    /// Right-justified integer.
    fn integer(&mut self, value: i64, width: usize, field: &'static str) -> Result<(), WriteProblem> {
        let before = self.out.len();
        // Writing to a vector cannot fail.
        let _ = write!(self.out, "{value:width$}");
        if self.out.len() - before > width {
            return Err(WriteProblem::Number { field, width, found: value });
        }
        Ok(())
    }

    /// Left-justified text; none is spelled `NONE`, as the specification demands.
    fn text(&mut self, text: &str, width: usize, field: &'static str) -> Result<(), WriteProblem> {
        let text = if text.trim().is_empty() { "NONE" } else { text };
        let columns = text.chars().count();
        if columns > width || text.chars().any(char::is_control) || text.trim() == "-1" {
            let found = text.chars().take(100).collect();
            return Err(WriteProblem::Text { field, width, found });
        }
        self.out.extend_from_slice(text.as_bytes());
        self.blanks(width - columns);
        Ok(())
    }

    fn identification(&mut self, function: &Dataset58) -> Result<(), WriteProblem> {
        self.out.extend_from_slice(b"    58");
        match function.encoding {
            Encoding::Ascii => self.blanks(74),
            Encoding::Binary(order) => {
                let width = match function.precision {
                    Precision::Single => 4,
                    Precision::Double => 8,
                };
                let byte_count = function.data.len() * values_per_point(function) * width;
                let order = match order {
                    ByteOrder::Little => 1,
                    ByteOrder::Big => 2,
                };
                // IEEE floats behind eleven text records.
                let _ = write!(self.out, "b{order:6}{:6}{:12}", 2, 11);
                let byte_count = i64::try_from(byte_count).unwrap_or(i64::MAX);
                self.integer(byte_count, 12, "the byte count of the data")?;
                let _ = write!(self.out, "{:6}{:6}{:12}{:12}", 0, 0, 0, 0);
            }
        }
        self.end();
        Ok(())
    }

    /// Record 6.
    fn identity(&mut self, function: &Dataset58) -> Result<(), WriteProblem> {
        self.integer(i64::from(function.function.code()), 5, "the function type")?;
        self.integer(function.function_id, 10, "the function identification number")?;
        self.integer(function.sequence_number, 5, "the sequence number")?;
        self.integer(function.load_case, 10, "the load case number")?;
        self.node(
            &function.response,
            ["the response entity name", "the response node", "the response direction"],
        )?;
        self.node(
            &function.reference,
            ["the reference entity name", "the reference node", "the reference direction"],
        )?;
        self.end();
        Ok(())
    }

    fn node(&mut self, node: &Node, fields: [&'static str; 3]) -> Result<(), WriteProblem> {
        self.blanks(1);
        self.text(&node.entity, 10, fields[0])?;
        self.integer(node.number, 10, fields[1])?;
        // A blank before it: numbers that touch are one to a reader.
        self.blanks(1);
        self.integer(i64::from(node.direction), 3, fields[2])
    }

    /// Record 7.
    fn form(&mut self, function: &Dataset58) -> Result<(), WriteProblem> {
        let data_type = match (&function.data, function.precision) {
            (Data::Real(_), Precision::Single) => 2,
            (Data::Real(_), Precision::Double) => 4,
            (Data::Complex(_), Precision::Single) => 5,
            (Data::Complex(_), Precision::Double) => 6,
        };
        let (spacing, start, step) = match function.abscissa {
            Abscissa::Even { start, step, .. } => (1, start, step),
            Abscissa::Uneven(_) => (0, 0.0, 0.0),
        };
        let points = i64::try_from(function.data.len()).unwrap_or(i64::MAX);
        self.integer(data_type, 10, "the ordinate data type")?;
        self.integer(points, 10, "the number of points")?;
        self.integer(spacing, 10, "the abscissa spacing")?;
        for value in [start, step, function.z_value] {
            number::push_abscissa(self.out, value);
        }
        self.end();
        Ok(())
    }

    /// Records 8 to 11.
    fn axis(&mut self, axis: &Axis) -> Result<(), WriteProblem> {
        self.integer(i64::from(axis.data_type), 10, "the data type of an axis")?;
        for exponent in axis.exponents {
            self.blanks(1);
            self.integer(i64::from(exponent), 4, "a unit exponent of an axis")?;
        }
        self.blanks(1);
        self.text(&axis.label, 20, "an axis label")?;
        self.blanks(1);
        self.text(&axis.units, 20, "the units label of an axis")?;
        self.end();
        Ok(())
    }
}
