//! From bytes to rows of fields: delimiter, decimal sign, numbers.

use crate::ImportError;

/// A line of the file, cut into fields without blanks around them.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub line: u64,
    pub fields: Vec<String>,
}

/// All lines that are neither blank nor remarks.
pub(super) struct Rows {
    pub rows: Vec<Row>,
    decimal_comma: bool,
}

/// How fields are parted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Delimiter {
    Byte(u8),
    Blanks,
}

impl Rows {
    pub(super) fn of(bytes: &[u8]) -> Result<Self, ImportError> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        // Columns of old analysers are in Latin-1.
        let text = match std::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
        };
        let delimiter = delimiter(&text);
        let decimal_comma = delimiter != Delimiter::Byte(b',');
        Ok(Rows { rows: rows(&text, delimiter)?, decimal_comma })
    }

    pub(super) fn number(&self, field: &str) -> Option<f64> {
        number(field, self.decimal_comma)
    }
}

/// What parts the fields of the first line that looks like one of numbers.
fn delimiter(text: &str) -> Delimiter {
    let candidates =
        [Delimiter::Byte(b';'), Delimiter::Byte(b'\t'), Delimiter::Byte(b','), Delimiter::Blanks];
    let numeric = |line: &str, delimiter| {
        let comma = delimiter != Delimiter::Byte(b',');
        let mut fields = 0;
        let all = cut(line, delimiter).all(|field| {
            fields += 1;
            field.is_empty() || number(field, comma).is_some()
        });
        all && fields > 1
    };
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    for line in lines {
        if let Some(found) = candidates.into_iter().find(|delimiter| numeric(line, *delimiter)) {
            // `1,5 2,5` is no row of three numbers.
            let blanks = numeric(line, Delimiter::Blanks);
            let commas_within =
                || cut(line, Delimiter::Blanks).all(|field| !field.ends_with(',') && !field.starts_with(','));
            return match found {
                Delimiter::Byte(b',') if blanks && commas_within() => Delimiter::Blanks,
                found => found,
            };
        }
    }
    Delimiter::Byte(b',')
}

fn cut(line: &str, delimiter: Delimiter) -> Box<dyn Iterator<Item = &str> + '_> {
    match delimiter {
        Delimiter::Byte(byte) => {
            Box::new(line.split(char::from(byte)).map(|field| field.trim().trim_matches('"')))
        }
        Delimiter::Blanks => Box::new(line.split_whitespace()),
    }
}

fn rows(text: &str, delimiter: Delimiter) -> Result<Vec<Row>, ImportError> {
    let is_remark = |first: &str| first.starts_with(['#', '%']);
    let Delimiter::Byte(byte) = delimiter else {
        let lines = (1..)
            .zip(text.lines())
            .filter(|(_, line)| !line.trim().is_empty() && !is_remark(line.trim_start()));
        return Ok(lines
            .map(|(line, text)| Row { line, fields: text.split_whitespace().map(str::to_owned).collect() })
            .collect());
    };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(byte)
        .has_headers(false)
        .flexible(true)
        .from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| ImportError::NoTable { why: error.to_string() })?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut fields: Vec<String> = record.iter().map(|field| field.trim().to_owned()).collect();
        // A delimiter at the end of every line is common.
        if fields.len() > 1 && fields.last().is_some_and(String::is_empty) {
            fields.pop();
        }
        let blank = fields.iter().all(String::is_empty);
        if !blank && !fields.first().is_some_and(|first| is_remark(first)) {
            rows.push(Row { line, fields });
        }
    }
    Ok(rows)
}

/// A finite number; Fortran's `D` exponents too.
fn number(field: &str, decimal_comma: bool) -> Option<f64> {
    let field = field.trim();
    let text = match decimal_comma && field.contains(',') {
        // A point beside a comma parts thousands: which of them is the decimal sign is not guessed.
        true if field.contains('.') => return None,
        true => field.replacen(',', ".", 1),
        false => field.to_owned(),
    };
    // The standard library also reads `inf` and `nan`, which are names.
    if !text.contains(|c: char| c.is_ascii_digit())
        || text.contains(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E' | 'd' | 'D'))
    {
        return None;
    }
    text.replace(['d', 'D'], "e").parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delimiters_and_decimal_signs_are_told_from_the_first_numbers() {
        let check = |text: &str, expected| assert_eq!(delimiter(text), expected, "{text}");
        check("f,re,im\n1.5,2,3\n", Delimiter::Byte(b','));
        check("f;re;im\n1,5;2;3\n", Delimiter::Byte(b';'));
        check("f\tre\tim\n1,5\t2\t3\n", Delimiter::Byte(b'\t'));
        check("f re im\n1.5 2 3\n", Delimiter::Blanks);
        check("f re im\n1,5 2,0 3,1\n", Delimiter::Blanks);
        check("f, re, im\n1.5, 2, 3\n", Delimiter::Byte(b','));
    }

    #[test]
    fn numbers_are_finite_and_of_one_decimal_sign() {
        assert_eq!(number("-1,5e-3", true), Some(-1.5e-3));
        assert_eq!(number("1.5D+02", false), Some(150.0));
        for bad in ["", "nan", "inf", "1.234,5", "1,2,3", "0x10", "1e400", "abc"] {
            assert_eq!(number(bad, true), None, "{bad}");
        }
        assert_eq!(number("1,5", false), None);
    }
}
