//! What can be wrong with a universal file.

use thiserror::Error;

/// Why a file could not be read. Datasets are counted from 1 in file order, units and skipped ones included;
/// lines count line feeds from 1, those inside binary data too, as an editor does.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// There is nothing in it.
    #[error("the file is empty; copy or export it again")]
    Empty,
    /// The first line is no dataset delimiter.
    #[error(
        "does not start with a `    -1` line; export it as a universal file (UFF) whose lines end with LF or CR LF"
    )]
    NotUff,
    /// A line that closes a dataset, and nothing of the dataset before it.
    #[error(
        "starts with the `    -1` line that closes a dataset, and the dataset itself is missing, as where pyuff writes binary data in its `overwrite` mode: write all datasets anew in `add` mode, to a file that does not exist yet"
    )]
    FirstLost,
    /// Text between two datasets.
    #[error(
        "line {line}: expected the `    -1` line that opens dataset {dataset}, found `{found}`; a dataset stands between two such lines: put back the missing one, or export the file again"
    )]
    BetweenDatasets {
        /// The dataset expected next.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A line of text that cannot be what it must be.
    #[error("dataset {dataset}, line {line}: {problem}")]
    Text {
        /// Which dataset.
        dataset: usize,
        /// Line in the file.
        line: usize,
        /// What is wrong with it.
        problem: TextProblem,
    },
    /// NaN or infinity among the values.
    #[error(
        "dataset {dataset}: the value at spectral line (point) {point}, counted from 0, is not finite; \
         mask or remove it before export, or, where a binary dataset (58b) states the wrong byte order, export it again or as ASCII"
    )]
    NotFinite {
        /// Which dataset.
        dataset: usize,
        /// Which point, counted from 0.
        point: usize,
    },
    /// Binary data that does not end where the header says.
    #[error("dataset {dataset}, byte {offset}: {problem}")]
    Binary {
        /// Which dataset.
        dataset: usize,
        /// Where in the file the data starts, or where its end was expected.
        offset: usize,
        /// What is wrong with it.
        problem: BinaryProblem,
    },
}

/// What is wrong with a line of text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TextProblem {
    /// A field that cannot be what it must be.
    #[error("expected {expected}, found `{found}`; {remedy}", remedy = remedy_of_field(.found))]
    Field {
        /// The field and what it must be.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// A binary number format other than IEEE 754, by its code.
    #[error(
        "binary floating-point format {0} (1 DEC VMS, 3 IBM 5/370) is not supported, \
         only 2 (IEEE 754); export the file again as IEEE or ASCII"
    )]
    FloatFormat(i64),
    /// The file ends inside a dataset, where this should have come.
    #[error("the file ends where {0} was expected; copy or export it again")]
    Truncated(&'static str),
    /// The dataset is closed before its header is complete, where this should have come.
    #[error("the dataset is closed by `    -1` where {0} was expected; export the file again")]
    ClosedEarly(&'static str),
    /// A blank column among ASCII values, counted from 1.
    #[error("value {0} of the line is blank; fill it in or export the file again")]
    Blank(usize),
    /// ASCII data that is no number.
    #[error("expected a number, found `{0}`; correct it or export the file again")]
    NotANumber(String),
    /// Fewer ASCII values than the header promises.
    #[error("the dataset ends after {found} of {expected} values; export the file again")]
    TooFew {
        /// Values promised by number of points, data type and spacing.
        expected: usize,
        /// Values found.
        found: usize,
    },
    /// More ASCII values than the header promises, which is so many.
    #[error("more data than the {0} values the header states; is the number of points right?")]
    TooMany(usize),
}

/// Where binary data does not end as its header says; `points` and `stated` bytes are the header's.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the fields are said above and by their names")]
pub enum BinaryProblem {
    /// The file ends inside the data.
    #[error(
        "the binary data of {points} points needs {expected} bytes, \
         the file ends after {found}; copy or export it again"
    )]
    Truncated { points: usize, expected: u64, found: usize },
    /// No closing delimiter where the data should end.
    #[error(
        "no `    -1` line follows the binary data, neither after its {points} points \
         nor after the {stated} bytes stated; the header or the transfer is damaged: copy or export the file again"
    )]
    NoEnd { points: usize, stated: u64 },
    /// The closing delimiter agrees with the stated bytes, but not with the number of points.
    #[error(
        "the header states {points} points, but the {stated} bytes of binary data \
         it also states are not that many; export the file again"
    )]
    PointsAgainstBytes { points: usize, stated: u64 },
}

/// What to do about a field that cannot be what it must be.
fn remedy_of_field(found: &str) -> &'static str {
    match found.contains(',') {
        true => "universal files have decimal points: export it again with them, or replace the commas",
        false => "correct it, or export the file again",
    }
}
