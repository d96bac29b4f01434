//! What can be wrong with a page.

/// A page that cannot be rendered: the pieces it was given do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PageError {
    /// A series has more or fewer values than its abscissa.
    #[error(
        "plot '{plot}': series '{series}' has {got} values over an abscissa of {expected}; pass one value per line, None where a line is masked"
    )]
    SeriesLength {
        /// Title of the plot.
        plot: String,
        /// Label of the series.
        series: String,
        /// Length of the abscissa.
        expected: usize,
        /// Length of the series, for a band that of the edge which differs.
        got: usize,
    },
    /// A series was added before any abscissa.
    #[error("plot '{plot}': series '{series}' has no abscissa; call `over` before adding series")]
    NoAbscissa {
        /// Title of the plot.
        plot: String,
        /// Label of the series.
        series: String,
    },
    /// An abscissa does not ascend.
    #[error(
        "plot '{plot}': the abscissa does not ascend at index {index}; sort the lines and drop those that repeat or are not finite"
    )]
    Abscissa {
        /// Title of the plot.
        plot: String,
        /// First index that is not finite or not above its predecessor.
        index: usize,
    },
}
