//! Formats of recordings, told by a file's first bytes and not by its name; what people mistake for a
//! recording gets a hint.

use crate::ImportError;

/// Format of a file, told by its bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A universal file: its first line that is not blank is `    -1`.
    Universal,
    /// A table in text.
    Table,
    /// MATLAB v5 to v7: `MATLAB 5.0 MAT-file`.
    Mat5,
    /// MATLAB v7.3: HDF5.
    Mat73,
}

/// Start of an HDF5 file, or of what follows a user block of 512, 1024, … bytes.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Starts of files that people mistake for recordings, and what they are.
const OTHERS: [(&[u8], &str, &str); 7] = [
    (b"PK\x03\x04", "a ZIP archive or an Excel workbook (.xlsx)", "unpack it, or save the sheet as CSV"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook (.xls)", "save the sheet as CSV"),
    (b"\x1f\x8b", "compressed by gzip", "unpack it first"),
    (b"TDSm", "a TDMS file", "export the FRFs as UFF (dataset 58)"),
    (b"RIFF", "a WAVE file", "export the FRFs as UFF (dataset 58)"),
    (b"\xff\xfe", "text in UTF-16", "save it as CSV in UTF-8"),
    (b"%PDF", "a PDF document", "give the recording itself"),
];

impl Format {
    /// The format of a file.
    ///
    /// # Errors
    /// [`ImportError::Empty`], [`ImportError::Other`], [`ImportError::Unknown`].
    pub fn of(bytes: &[u8]) -> Result<Self, ImportError> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let Some(start) = text.iter().position(|byte| !byte.is_ascii_whitespace()) else {
            return Err(ImportError::Empty);
        };
        if bytes.starts_with(b"MATLAB 5.0 MAT-file") {
            return Ok(Format::Mat5);
        }
        if is_hdf5(bytes) {
            return Ok(Format::Mat73);
        }
        if let Some((_, what, remedy)) = OTHERS.iter().find(|(start, ..)| bytes.starts_with(start)) {
            return Err(ImportError::Other { what, remedy });
        }
        let first_line = text[start..].split(|byte| matches!(byte, b'\n' | b'\r')).next().unwrap_or_default();
        if first_line.trim_ascii_end() == b"-1" {
            return Ok(Format::Universal);
        }
        if first_line.starts_with(b"{") {
            return Err(ImportError::Other {
                what: "a JSON file, such as a fixture",
                remedy: "give the recording where a recording is expected",
            });
        }
        let head = text.get(..4096).unwrap_or(text);
        let binary = |byte: &u8| matches!(byte, 0..=8 | 14..=31 | 127);
        match head.iter().any(binary) {
            true => Err(ImportError::Unknown),
            false => Ok(Format::Table),
        }
    }
}

fn is_hdf5(bytes: &[u8]) -> bool {
    let blocks = std::iter::successors(Some(512_usize), |offset| offset.checked_mul(2));
    std::iter::once(0)
        .chain(blocks.take_while(|offset| *offset < bytes.len()))
        .any(|offset| bytes.get(offset..).is_some_and(|rest| rest.starts_with(HDF5)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_told_by_their_bytes() {
        let check = |bytes: &[u8], expected| assert_eq!(Format::of(bytes).ok(), expected, "{bytes:?}");
        check(b"    -1\n    58\n", Some(Format::Universal));
        check(b"\xef\xbb\xbf\n    -1    \r\n", Some(Format::Universal));
        check(b"frequency,4/1 real\n-1,2\n", Some(Format::Table));
        check(b"-1,2\n", Some(Format::Table));
        check(b"MATLAB 5.0 MAT-file, Platform: PCWIN64", Some(Format::Mat5));
        check(HDF5, Some(Format::Mat73));
        check(&[&[b'M'; 512][..], HDF5].concat(), Some(Format::Mat73));
        check(b"\x00\x01\x02", None);
        check(b" \n", None);
        check(b"{ \"bodies\": {} }", None);
        let message = Format::of(b"PK\x03\x04abc").unwrap_err().to_string();
        assert_eq!(
            message,
            "is a ZIP archive or an Excel workbook (.xlsx); unpack it, or save the sheet as CSV"
        );
    }
}
