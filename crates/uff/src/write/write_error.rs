//! What a universal file cannot hold.

use thiserror::Error;

/// Why functions could not be written.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("function {function}: {problem}")]
pub struct WriteError {
    /// Which function, counted from 1 in the order given.
    pub function: usize,
    /// What is wrong with it.
    pub problem: WriteProblem,
}

/// What is wrong with a function that is to be written.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum WriteProblem {
    /// Abscissa and data differ in length.
    #[error("{ordinates} ordinates on {abscissae} abscissae")]
    LengthMismatch {
        /// Number of ordinates.
        ordinates: usize,
        /// Number of abscissae.
        abscissae: usize,
    },
    /// NaN or infinity at this ordinate or abscissa, counted from 0.
    #[error("the value at spectral line (point) {0}, counted from 0, is not finite; nothing was written")]
    NotFinite(usize),
    /// NaN or infinity as abscissa start, step or z-value.
    #[error("abscissa start, step or z-value is not finite; nothing was written")]
    HeaderNotFinite,
    /// Too large for a 4-byte float, at this point.
    #[error(
        "the value at spectral line (point) {0}, counted from 0, is beyond single precision; write it in double"
    )]
    BeyondSingle(usize),
    /// Text that is wider than its columns, or that a reader would take for something else.
    #[error("{field} takes at most {width} characters of plain text, not `{found}`")]
    Text {
        /// Which field.
        field: &'static str,
        /// Its columns.
        width: usize,
        /// The text.
        found: String,
    },
    /// A number that is wider than its columns.
    #[error("{field} has {width} columns, too few for {found}")]
    Number {
        /// Which field.
        field: &'static str,
        /// Its columns.
        width: usize,
        /// The number.
        found: i64,
    },
    /// Unit factors that convert nothing.
    #[error("the unit factors of length, force and temperature must be above zero and all finite")]
    UnitFactors,
    /// No units after a function with units.
    #[error(
        "states no units but follows one that does, and a file cannot take units back; \
         state its units or write it first"
    )]
    UnitsWithdrawn,
}
