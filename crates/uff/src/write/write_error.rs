//! What a universal file cannot hold.

use thiserror::Error;

/// Why functions could not be written. Functions are counted from 1 in the order given.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum WriteError {
    /// Abscissa and data differ in length.
    #[error("function {function}: {ordinates} ordinates on {abscissae} abscissae")]
    LengthMismatch {
        /// Which function.
        function: usize,
        /// Number of ordinates.
        ordinates: usize,
        /// Number of abscissae.
        abscissae: usize,
    },
    /// NaN or infinity among ordinates or abscissae.
    #[error(
        "function {function}: the value at spectral line (point) {point}, counted from 0, is not finite; nothing was written"
    )]
    NotFinite {
        /// Which function.
        function: usize,
        /// Which point, counted from 0.
        point: usize,
    },
    /// NaN or infinity as abscissa start, step or z-value.
    #[error("function {function}: abscissa start, step or z-value is not finite; nothing was written")]
    HeaderNotFinite {
        /// Which function.
        function: usize,
    },
    /// Too large for a 4-byte float.
    #[error(
        "function {function}: the value at spectral line (point) {point}, counted from 0, is beyond single precision; write it in double"
    )]
    BeyondSingle {
        /// Which function.
        function: usize,
        /// Which point, counted from 0.
        point: usize,
    },
    /// Text that is wider than its columns, or that a reader would take for something else.
    #[error("function {function}: {field} takes at most {width} characters of plain text, not `{found}`")]
    Text {
        /// Which function.
        function: usize,
        /// Which field.
        field: &'static str,
        /// Its columns.
        width: usize,
        /// The text.
        found: String,
    },
    /// A number that is wider than its columns.
    #[error("function {function}: {field} has {width} columns, too few for {found}")]
    Number {
        /// Which function.
        function: usize,
        /// Which field.
        field: &'static str,
        /// Its columns.
        width: usize,
        /// The number.
        found: i64,
    },
    /// Unit factors that convert nothing.
    #[error(
        "function {function}: the unit factors of length, force and temperature must be above zero and all finite"
    )]
    UnitFactors {
        /// Which function.
        function: usize,
    },
    /// No units after a function with units.
    #[error(
        "function {function} states no units but follows one that does, and a file cannot take units back; \
         state its units or write it first"
    )]
    UnitsWithdrawn {
        /// Which function.
        function: usize,
    },
}
