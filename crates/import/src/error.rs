//! What can be wrong with a file of another format.

use thiserror::Error;

use crate::PairError;

/// Why a file could not be read: one sentence with place and remedy, to stand behind the file's name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ImportError {
    /// Nothing in it.
    #[error("the file is empty; copy or export it again")]
    Empty,
    /// A format that is known, but is no recording.
    #[error("is {what}; {remedy}")]
    Other {
        /// What it is.
        what: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// No format that is known.
    #[error(
        "is neither a universal file (UFF, UNV), a table (CSV) nor a MATLAB file (.mat); export the FRFs as UFF (dataset 58)"
    )]
    Unknown,
    /// Damage of a universal file.
    #[error(transparent)]
    Uff(#[from] jointscope_uff::ReadError),
    /// A table without a row of numbers under a header.
    #[error(
        "is no universal file (it does not start with a `    -1` line) and no table of FRFs: {why}; a table needs a header such as `frequency [Hz],4/1 real,4/1 imag` over its numbers"
    )]
    NoTable {
        /// What is missing.
        why: String,
    },
    /// A column that cannot be used.
    #[error("line {line}, column {column} (`{header}`): {problem}")]
    Column {
        /// Line of the header.
        line: u64,
        /// Column, counted from 1.
        column: usize,
        /// Its header.
        header: String,
        /// Why.
        problem: String,
    },
    /// A field that is no value.
    #[error("line {line}, column {column} (`{header}`): {problem}")]
    Field {
        /// Line in the file.
        line: u64,
        /// Column, counted from 1.
        column: usize,
        /// Its header.
        header: String,
        /// Why.
        problem: String,
    },
    /// A row of another width than the header.
    #[error(
        "line {line}: {found} fields where the header has {expected}; is a delimiter or a decimal comma missing?"
    )]
    Width {
        /// Line in the file.
        line: u64,
        /// Fields there.
        found: usize,
        /// Fields of the header.
        expected: usize,
    },
    /// A MATLAB file that is damaged.
    #[error("byte {offset}: {what}; copy or save the file again")]
    Damaged {
        /// Where.
        offset: usize,
        /// What is wrong.
        what: String,
    },
    /// A MATLAB v7.3 file that cannot be read.
    #[error(
        "the HDF5 file cannot be read ({0}); save it again with `save(..., '-v7')`, or export the FRFs as UFF (dataset 58)"
    )]
    Hdf5(String),
    /// A MATLAB or HDF5 file without anything that is read.
    #[error(
        "is a MATLAB or HDF5 file without FRFs that are known here ({0}); export the FRFs as UFF (dataset 58)"
    )]
    NoFrfInMat(String),
    /// A variable that cannot be used.
    #[error("variable `{variable}`: {problem}")]
    Variable {
        /// Which.
        variable: String,
        /// Why.
        problem: String,
    },
    /// A name that should say response and reference.
    #[error(
        "variable `{variable}`: {problem}; say which FRF it is with `--columns`, such as `--columns \"{variable}=4/1\"`"
    )]
    Pair {
        /// Which.
        variable: String,
        /// Why.
        problem: PairError,
    },
}
