//! Header, units and numbers of a table, each row checked.

use super::header::{is_header, is_line_of_units};
use super::rows::{Row, Rows};
use crate::ImportError;

/// Header, units and numbers.
pub(super) struct Table {
    pub headers: Vec<String>,
    /// Line of the header.
    pub line: u64,
    /// Units of the columns, where a line below the header states them.
    pub units: Vec<String>,
    numbers: Vec<Vec<f64>>,
    lines: Vec<u64>,
}

fn no_numbers(rows: &[Row]) -> ImportError {
    let found = rows.first().map_or(String::new(), |row| {
        let beginning: String = row.fields.join(" ").chars().take(40).collect();
        format!("; line {} reads `{beginning}`", row.line)
    });
    ImportError::NoTable { why: format!("no line holds a frequency and numbers beside it{found}") }
}

/// No row above the first one of numbers has as many fields: a header of another width says that this row
/// lacks some, or has too many.
fn no_header(above: &[Row], numbers: &Row) -> ImportError {
    let (line, found) = (numbers.line, numbers.fields.len());
    match above.iter().rev().find(|row| row.fields.len() > 1 && is_header(&row.fields)) {
        Some(header) => ImportError::Width { line, found, expected: header.fields.len() },
        None => ImportError::NoTable {
            why: format!("no header of {found} names stands above the numbers of line {line}"),
        },
    }
}

impl Table {
    /// The header is the last line above the first row of numbers that has as many fields; a line of units
    /// may stand between.
    pub(super) fn of(rows: &Rows) -> Result<Self, ImportError> {
        let all = &rows.rows;
        let is_numbers =
            |row: &Row| row.fields.len() > 1 && row.fields.iter().all(|field| rows.number(field).is_some());
        let first = all.iter().position(is_numbers).ok_or_else(|| no_numbers(all))?;
        let width = all[first].fields.len();
        // A row with a field that is no number, above the first that has none, is a row of the table all the
        // same.
        let holds_number = |row: &Row| row.fields.iter().any(|field| rows.number(field).is_some());
        let mut first = first;
        while let Some(before) = first.checked_sub(1).map(|before| &all[before])
            && before.fields.len() == width
            && holds_number(before)
            && !is_header(&before.fields)
        {
            first -= 1;
        }
        let mut above = all[..first].iter().rev().filter(|row| row.fields.len() == width);
        let Some(nearest) = above.next() else {
            return Err(no_header(&all[..first], &all[first]));
        };
        let is_number = |field: &str| rows.number(field).is_some();
        let with_units =
            above.next().filter(|header| is_line_of_units(&header.fields, &nearest.fields, is_number));
        let unit = |stated: &String| stated.trim_matches(['[', ']', '(', ')']).to_owned();
        let (header, units) = match with_units {
            Some(header) => (header, nearest.fields.iter().map(unit).collect()),
            None => (nearest, vec![String::new(); width]),
        };
        for row in all[..first].iter().filter(|row| row.line > nearest.line && holds_number(row)) {
            if row.fields.len() != width {
                return Err(ImportError::Width { line: row.line, found: row.fields.len(), expected: width });
            }
        }
        let mut table = Table {
            headers: header.fields.clone(),
            line: header.line,
            units,
            numbers: Vec::new(),
            lines: Vec::new(),
        };
        for row in &all[first..] {
            table.add(row, rows)?;
        }
        table.of_one_decimal_sign(&all[first..])?;
        Ok(table)
    }

    fn add(&mut self, row: &Row, rows: &Rows) -> Result<(), ImportError> {
        if row.fields.len() != self.headers.len() {
            return Err(ImportError::Width {
                line: row.line,
                found: row.fields.len(),
                expected: self.headers.len(),
            });
        }
        let mut values = Vec::with_capacity(row.fields.len());
        for (at, field) in row.fields.iter().enumerate() {
            let Some(value) = rows.number(field) else {
                let problem = match field.is_empty() {
                    true => "the field is blank; fill it in or leave the line out".to_owned(),
                    false => format!(
                        "`{}` is no finite number; write one or leave the line out",
                        field.chars().take(40).collect::<String>()
                    ),
                };
                return Err(self.error(row.line, at, problem));
            };
            values.push(value);
        }
        self.numbers.push(values);
        self.lines.push(row.line);
        Ok(())
    }

    /// Refuses a column in which one number has a decimal comma and another a point: one of the two parts
    /// thousands, or columns of two programs were put together.
    fn of_one_decimal_sign(&self, rows: &[Row]) -> Result<(), ImportError> {
        for at in 0..self.headers.len() {
            let first = |sign: char| rows.iter().find(|row| row.fields[at].contains(sign));
            if let (Some(comma), Some(point)) = (first(','), first('.')) {
                let (early, late) = if comma.line < point.line { (comma, point) } else { (point, comma) };
                let problem = format!(
                    "`{}`, but `{}` on line {}: a decimal comma and a decimal point in one column; export it with one of them",
                    late.fields[at], early.fields[at], early.line
                );
                return Err(self.error(late.line, at, problem));
            }
        }
        Ok(())
    }

    /// The numbers of a column.
    pub(super) fn values(&self, column: usize) -> Result<Vec<f64>, ImportError> {
        Ok(self.numbers.iter().filter_map(|row| row.get(column).copied()).collect())
    }

    fn error(&self, line: u64, column: usize, problem: String) -> ImportError {
        ImportError::Field { line, column: column + 1, header: self.header(column), problem }
    }

    /// The error of a field, by its row of numbers.
    pub(super) fn field_error(&self, row: usize, column: usize, problem: &str) -> ImportError {
        self.error(self.lines.get(row).copied().unwrap_or(0), column, problem.to_owned())
    }

    /// The error of a column.
    pub(super) fn column_error(&self, column: usize, problem: impl Into<String>) -> ImportError {
        ImportError::Column {
            line: self.line,
            column: column + 1,
            header: self.header(column),
            problem: problem.into(),
        }
    }

    fn header(&self, column: usize) -> String {
        self.headers.get(column).cloned().unwrap_or_default()
    }
}
