//! What can be wrong with a universal file.

use thiserror::Error;

/// Why a file could not be read. Datasets are counted from 1 in file order, units and skipped ones included; lines count
/// line feeds from 1, those inside binary data too, as an editor does.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ReadError {
    /// There is nothing in it.
    #[error("the file is empty; copy or export it again")]
    Empty,
    /// The first line is no dataset delimiter.
    #[error("does not start with a `    -1` line; is it a UFF file?")]
    NotUff,
    /// Text between two datasets.
    #[error("line {line}: expected the `    -1` line that opens dataset {dataset}, found `{found}`")]
    BetweenDatasets {
        /// The dataset expected next.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// The line after the delimiter is no dataset number.
    #[error("dataset {dataset}, line {line}: expected a dataset number in columns 1 to 6, found `{found}`")]
    DatasetNumber {
        /// Which dataset.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A header field that cannot be what it must be.
    #[error("dataset {dataset}, line {line}: expected {expected}, found `{found}`")]
    Header {
        /// Which dataset.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// The field and what it must be.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// A binary number format other than IEEE 754.
    #[error(
        "dataset {dataset}, line {line}: binary floating-point format {code} (1 DEC VMS, 3 IBM 5/370) is not supported, \
         only 2 (IEEE 754); export the file again as IEEE or ASCII"
    )]
    FloatFormat {
        /// Which dataset.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// The stated format.
        code: i64,
    },
    /// The file ends inside a dataset.
    #[error(
        "dataset {dataset}, line {line}: the file ends where {expected} was expected; copy or export it again"
    )]
    Truncated {
        /// Which dataset.
        dataset: usize,
        /// Last line of the file.
        line: usize,
        /// What should have come.
        expected: &'static str,
    },
    /// The dataset is closed before its header is complete.
    #[error(
        "dataset {dataset}, line {line}: the dataset is closed by `    -1` where {expected} was expected; export the file again"
    )]
    HeaderEndsEarly {
        /// Which dataset.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// What should have come.
        expected: &'static str,
    },
    /// A blank column among ASCII values.
    #[error(
        "dataset {dataset}, line {line}: value {column} of the line is blank; fill it in or export the file again"
    )]
    BlankValue {
        /// Which dataset.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// Which value of that line, counted from 1.
        column: usize,
    },
    /// ASCII data that is no number.
    #[error(
        "dataset {dataset}, line {line}: expected a number, found `{found}`; correct it or export the file again"
    )]
    NotANumber {
        /// Which dataset.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// NaN or infinity among the values.
    #[error(
        "dataset {dataset}: the value at spectral line (point) {point}, counted from 0, is not finite; \
         mask or remove it before export"
    )]
    NotFinite {
        /// Which dataset.
        dataset: usize,
        /// Which point, counted from 0.
        point: usize,
    },
    /// Fewer ASCII values than the header promises.
    #[error(
        "dataset {dataset}, line {line}: the dataset ends after {found} of {expected} values; export the file again"
    )]
    TooFewValues {
        /// Which dataset.
        dataset: usize,
        /// Line of the closing `    -1`.
        line: usize,
        /// Values promised by number of points, data type and spacing.
        expected: usize,
        /// Values found.
        found: usize,
    },
    /// More ASCII values than the header promises.
    #[error(
        "dataset {dataset}, line {line}: more data than the {expected} values the header states; is the number of points right?"
    )]
    TooManyValues {
        /// Which dataset.
        dataset: usize,
        /// Line of the first value too many.
        line: usize,
        /// Values promised by number of points, data type and spacing.
        expected: usize,
    },
    /// The file ends inside binary data.
    #[error(
        "dataset {dataset}, byte {offset}: the binary data of {points} points needs {expected} bytes, \
         the file ends after {found}; copy or export it again"
    )]
    TruncatedBinary {
        /// Which dataset.
        dataset: usize,
        /// Where the data starts in the file.
        offset: usize,
        /// Points stated in the header.
        points: usize,
        /// Bytes that takes.
        expected: u64,
        /// Bytes left in the file.
        found: usize,
    },
    /// No closing delimiter where the binary data should end.
    #[error(
        "dataset {dataset}, byte {offset}: no `    -1` line follows the binary data, neither after its {points} points \
         nor after the {stated} bytes stated; the header or the transfer is damaged: copy or export the file again"
    )]
    BinaryEnd {
        /// Which dataset.
        dataset: usize,
        /// Where the delimiter should stand, by the number of points.
        offset: usize,
        /// Points stated in the header.
        points: usize,
        /// Bytes stated in the header.
        stated: u64,
    },
    /// The closing delimiter agrees with the stated bytes, but not with the number of points.
    #[error(
        "dataset {dataset}, byte {offset}: the header states {points} points, but the {stated} bytes of binary data \
         it also states are not that many; export the file again"
    )]
    PointsAgainstBytes {
        /// Which dataset.
        dataset: usize,
        /// Where the data starts in the file.
        offset: usize,
        /// Points stated in the header.
        points: usize,
        /// Bytes stated in the header.
        stated: u64,
    },
}
