//! The line that says which dataset follows.

use super::cursor::{Cursor, Line};
use crate::ReadError;

/// The line after the delimiter: dataset number, and for binary datasets how they are stored.
pub(super) struct Identification<'a> {
    pub line: Line<'a>,
    pub number: u32,
    /// What follows the `b` in column 7, if there is one.
    pub binary: Option<&'a [u8]>,
}

impl<'a> Identification<'a> {
    pub(super) fn read(cursor: &mut Cursor<'a>) -> Result<Self, ReadError> {
        let line = cursor.expect_line("a dataset number")?;
        let text = line.bytes.trim_ascii_start();
        let digits = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let (number, rest) = text.split_at(digits);
        let binary = match rest {
            [b'b' | b'B', form @ ..] => Some(Some(form)),
            [] => Some(None),
            [blank, ..] if blank.is_ascii_whitespace() => Some(None),
            _ => None,
        };
        let number = std::str::from_utf8(number).ok().and_then(|number| number.parse().ok());
        match (number, binary) {
            (Some(number), Some(binary)) => Ok(Identification { line, number, binary }),
            _ => Err(cursor.unexpected(line, "a dataset number in columns 1 to 6", line.bytes)),
        }
    }
}
