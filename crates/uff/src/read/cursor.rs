//! Where the reader stands in the file: lines, delimiters, and line numbers for messages.

use crate::{ReadError, TextProblem};

/// Reading position in the bytes of a file.
#[derive(Clone)]
pub(super) struct Cursor<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) position: usize,
    /// The dataset that is being read, counted from 1.
    pub(super) dataset: usize,
}

/// One line without its line end (LF or CRLF).
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    /// Byte offset of its first character.
    pub(super) start: usize,
    pub(super) bytes: &'a [u8],
}

/// Text as a message quotes it: what is printable of its first 40 characters.
pub(super) fn excerpt(text: &[u8]) -> String {
    let text = text.get(..160).unwrap_or(text);
    String::from_utf8_lossy(text.trim_ascii())
        .chars()
        .map(|character| if character.is_control() { '?' } else { character })
        .take(40)
        .collect()
}

/// Whether a line opens or closes a dataset: -1 in the first six columns and nothing else.
pub(super) fn is_delimiter(line: &[u8]) -> bool {
    let line = line.trim_ascii_end();
    line.len() <= 6 && line.trim_ascii_start() == b"-1"
}

impl<'a> Cursor<'a> {
    /// At the first line, behind a byte order mark if there is one.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let position = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Cursor { bytes, position, dataset: 0 }
    }

    /// What is left of the file.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.position..).unwrap_or_default()
    }

    /// The next line, or nothing at the end of the file.
    pub(super) fn next_line(&mut self) -> Option<Line<'a>> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let start = self.position;
        let line = match rest.iter().position(|&byte| byte == b'\n') {
            Some(length) => {
                self.position += length + 1;
                &rest[..length]
            }
            None => {
                self.position += rest.len();
                rest
            }
        };
        Some(Line { start, bytes: line.strip_suffix(b"\r").unwrap_or(line) })
    }

    /// The next line that is not blank.
    pub(super) fn next_filled_line(&mut self) -> Option<Line<'a>> {
        loop {
            let line = self.next_line()?;
            if !line.bytes.trim_ascii().is_empty() {
                return Some(line);
            }
        }
    }

    /// Where the text goes on if a closing delimiter stands at byte `end` of binary data. It should follow
    /// the data directly; many programs write a line end first.
    pub(super) fn after_closing_delimiter(&self, end: usize) -> Option<usize> {
        let tail = self.bytes.get(end..)?;
        let line_ends = tail.iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        let mut cursor = Cursor { position: end + line_ends, ..*self };
        // A delimiter line is at most 80 columns and some: no search through megabytes of binary data for its
        // end.
        let line = Cursor { bytes: self.bytes.get(..cursor.position + 200).unwrap_or(self.bytes), ..cursor }
            .next_line()?;
        if !is_delimiter(line.bytes) {
            return None;
        }
        cursor.next_line()?;
        Some(cursor.position)
    }

    /// Number of the line that holds byte `offset`, from 1. Counted only when a message needs it.
    pub(super) fn line_number(&self, offset: usize) -> usize {
        let before = self.bytes.get(..offset).unwrap_or(self.bytes);
        1 + before.iter().filter(|&&byte| byte == b'\n').count()
    }

    /// The error of a line.
    pub(super) fn error(&self, line: Line, problem: TextProblem) -> ReadError {
        ReadError::Text { dataset: self.dataset, line: self.line_number(line.start), problem }
    }

    /// The error of a line that holds something else than what is expected.
    pub(super) fn unexpected(&self, line: Line, expected: &'static str, found: &[u8]) -> ReadError {
        self.error(line, TextProblem::Field { expected, found: excerpt(found) })
    }

    /// The next line, which the file must have.
    pub(super) fn expect_line(&mut self, expected: &'static str) -> Result<Line<'a>, ReadError> {
        self.next_line().ok_or_else(|| self.truncated(expected))
    }

    /// The next line of a header, which must not close the dataset yet.
    pub(super) fn header_line(&mut self, expected: &'static str) -> Result<Line<'a>, ReadError> {
        let line = self.expect_line(expected)?;
        if is_delimiter(line.bytes) {
            return Err(self.error(line, TextProblem::ClosedEarly(expected)));
        }
        Ok(line)
    }

    /// The error of a file that ends too early.
    pub(super) fn truncated(&self, expected: &'static str) -> ReadError {
        let last = Line { start: self.bytes.len().saturating_sub(1), bytes: &[] };
        self.error(last, TextProblem::Truncated(expected))
    }
}

impl Cursor<'_> {
    /// Passes everything up to and with the next closing delimiter.
    pub(super) fn skip_to_delimiter(&mut self) -> Result<(), ReadError> {
        while let Some(line) = self.next_line() {
            if is_delimiter(line.bytes) {
                return Ok(());
            }
        }
        Err(self.truncated("the `    -1` line that closes the dataset"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_with_lf_or_crlf_or_the_file() {
        let mut cursor = Cursor::new(b"a\r\nb\n\nc");
        let lines: Vec<&[u8]> = std::iter::from_fn(|| cursor.next_line().map(|line| line.bytes)).collect();
        assert_eq!(lines, [b"a" as &[u8], b"b", b"", b"c"]);
        assert_eq!(cursor.line_number(5), 3);
    }

    #[test]
    fn a_delimiter_is_minus_one_in_six_columns_and_nothing_else() {
        assert!(is_delimiter(b"    -1"));
        assert!(is_delimiter(b"    -1                                "));
        assert!(!is_delimiter(b"          -1"));
        assert!(!is_delimiter(b"    -1  0.5"));
        assert!(!is_delimiter(b"    -10"));
    }
}
