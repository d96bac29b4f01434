//! What FRFs lack where no modes can be told of them.

use jointscope_spectra::in_text;

/// Why no modes can be told.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModesError {
    /// The band holds too few lines.
    #[error(
        "{lines} spectral lines above 0 Hz are in use, from {} to {} Hz: at least {needed} are needed; widen the band",
        in_text(*from),
        in_text(*to)
    )]
    TooFewLines {
        /// Lines in use.
        lines: usize,
        /// First of the set, Hz.
        from: f64,
        /// Last of the set, Hz.
        to: f64,
        /// Fewest that do.
        needed: usize,
    },
    /// The FRFs are nothing but zero.
    #[error("the FRFs are zero on all lines in use; is a channel dead?")]
    Silent,
    /// The orders asked for cannot be computed.
    #[error("orders {from} to {to} are asked for; from 1 to {most} can be told from these lines")]
    Orders {
        /// Lowest order.
        from: usize,
        /// Highest order.
        to: usize,
        /// Highest order that the lines allow.
        most: usize,
    },
    /// The orders asked for are too few to tell what stays.
    #[error("orders {from} to {to} are asked for; at least {needed} of them tell which poles stay")]
    FewOrders {
        /// Lowest order.
        from: usize,
        /// Highest order.
        to: usize,
        /// Fewest that do.
        needed: usize,
    },
    /// No pole is the same from order to order, or none stands out of the noise.
    #[error(
        "no resonance stands out of the noise from {} to {} Hz: nothing is stable there over orders {lowest} to {highest}; choose another band, or poles of your own with `--pick`",
        in_text(*from),
        in_text(*to)
    )]
    NothingStable {
        /// First line, Hz.
        from: f64,
        /// Last line, Hz.
        to: f64,
        /// Lowest order.
        lowest: usize,
        /// Highest order.
        highest: usize,
    },
    /// A pole was picked where the chart has none.
    #[error("no pole of the stabilisation chart lies near {picked} Hz; the nearest is at {} Hz", in_text(*nearest))]
    NothingThere {
        /// Frequency picked, Hz.
        picked: f64,
        /// Nearest pole, Hz.
        nearest: f64,
    },
    /// Residues and poles are more than the lines can tell.
    #[error(
        "{modes} modes have more unknowns than the {lines} lines of each FRF can tell; choose fewer, or a wider band"
    )]
    Undetermined {
        /// Modes.
        modes: usize,
        /// Lines.
        lines: usize,
    },
    /// The set cannot be turned into accelerances.
    #[error(transparent)]
    Spectra(#[from] jointscope_spectra::SpectraError),
}
