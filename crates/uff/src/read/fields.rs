//! Header fields: by their columns, as the specification has it, and by their blanks where a writer was off.

/// Text of a header line. Columns count characters, so text that is not UTF-8 is taken as Latin-1.
pub(super) fn line_text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// One stretch of columns in a record.
#[derive(Clone, Copy)]
pub(super) enum Column {
    /// Columns that stay blank.
    Gap(usize),
    /// A number, right-justified; all of these hold exactly one word.
    Number(usize),
    /// Text, which may hold blanks.
    Text(usize),
}

/// A record cut by its columns.
pub(super) struct Cut<'a, const N: usize> {
    /// Number and text fields in order, without blanks around them.
    pub(super) fields: [&'a str; N],
    /// Every number is there, none is cut in two, and the gaps are blank: the columns are those of the
    /// specification.
    pub(super) clean: bool,
}

impl<'a, const N: usize> Cut<'a, N> {
    /// The fields, by the record's blanks where its columns are off.
    pub(super) fn or_by_blanks(self, by_blanks: impl FnOnce() -> Option<[&'a str; N]>) -> [&'a str; N] {
        if self.clean { self.fields } else { by_blanks().unwrap_or(self.fields) }
    }
}

/// Cuts a record by its columns. `N` is the number of number and text fields.
pub(super) fn cut<'a, 'c, const N: usize>(
    line: &'a str,
    columns: impl IntoIterator<Item = &'c Column>,
) -> Cut<'a, N> {
    let mut cut = Cut { fields: [""; N], clean: true };
    let mut slots = cut.fields.iter_mut();
    let mut start = 0;
    for column in columns {
        let column = *column;
        let (width, numeric) = match column {
            Column::Gap(width) => {
                cut.clean &= columns_of(line, start, start + width).trim().is_empty();
                start += width;
                continue;
            }
            Column::Number(width) => (width, true),
            Column::Text(width) => (width, false),
        };
        let field = columns_of(line, start, start + width);
        if numeric {
            let words = field.split_ascii_whitespace().count();
            let boundary = columns_of(line, start + width - 1, start + width + 1);
            let cuts_a_word = boundary.len() > 1 && !boundary.contains(char::is_whitespace);
            cut.clean &= words == 1 && !cuts_a_word;
        }
        if let Some(slot) = slots.next() {
            *slot = field.trim();
        }
        start += width;
    }
    cut
}

/// Characters `from..to` of a line, fewer where the line is shorter.
pub(super) fn columns_of(line: &str, from: usize, to: usize) -> &str {
    let byte = |column: usize| {
        if line.is_ascii() {
            column.min(line.len())
        } else {
            line.char_indices().nth(column).map_or(line.len(), |(byte, _)| byte)
        }
    };
    line.get(byte(from)..byte(to)).unwrap_or_default()
}

/// What the identification line of a binary dataset states behind its `b`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct BinaryForm {
    /// 1 little endian, 2 big endian.
    pub(super) byte_order: i64,
    /// 1 DEC VMS, 2 IEEE 754, 3 IBM 5/370.
    pub(super) float_format: i64,
    /// Text lines before the data.
    pub(super) text_lines: u64,
    /// Bytes of data; often wrong.
    pub(super) byte_count: u64,
}

impl BinaryForm {
    /// Reads `2I6, 2I12`, or the same numbers anywhere with blanks between. The counts may be missing: they
    /// are only a hint.
    pub(super) fn read(form: &[u8]) -> Option<Self> {
        let form = line_text(form);
        let columns = [Column::Number(6), Column::Number(6), Column::Number(12), Column::Number(12)];
        let mut words = form.split_ascii_whitespace();
        let by_blanks = || Some(std::array::from_fn(|_| words.next().unwrap_or_default()));
        let fields = cut::<4>(&form, &columns).or_by_blanks(by_blanks);
        Some(BinaryForm {
            byte_order: fields[0].parse().ok()?,
            float_format: fields[1].parse().ok()?,
            text_lines: fields[2].parse().unwrap_or(11),
            byte_count: fields[3].parse().unwrap_or(0),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_not_bytes() {
        assert_eq!(columns_of("m/s² N", 4, 6), " N");
        assert_eq!(columns_of("abc", 2, 9), "c");
        assert_eq!(columns_of("abc", 5, 9), "");
    }

    #[test]
    fn a_number_cut_by_its_columns_is_not_clean() {
        let columns = [Column::Number(5), Column::Number(5)];
        assert!(cut::<2>("    1    2", &columns).clean);
        assert!(!cut::<2>("     1   2", &columns).clean);
        assert!(!cut::<2>("   1234  2", &columns).clean);
    }

    #[test]
    fn a_binary_form_is_read_by_columns_or_by_blanks() {
        let expected = BinaryForm { byte_order: 1, float_format: 2, text_lines: 11, byte_count: 3200 };
        for form in
            ["     1     2          11        3200     0     0           0           0", " 1 2 11 3200"]
        {
            assert_eq!(BinaryForm::read(form.as_bytes()), Some(expected));
        }
        assert_eq!(BinaryForm::read(b"     x     2"), None);
    }
}
