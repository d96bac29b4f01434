//! What keeps `prove` from drawing its concealed cases.

use jointscope_fem::FemError;
use jointscope_rig::{HammerError, StructureError};
use jointscope_spectra::SpectraError;

/// Why cases cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GenerationError {
    /// There would be none.
    #[error("there is no case to make: ask for at least one case of at least one family")]
    NoCases,
    /// A case beyond the last.
    #[error("there is no case {only}: {cases} cases are numbered 0 to {}", cases.saturating_sub(1))]
    NoSuchCase {
        /// The case asked for.
        only: usize,
        /// Number of cases.
        cases: usize,
    },
    /// Nothing fits the fixtures that were drawn.
    #[error("case {0} could not be drawn: no hidden physics suited its fixtures")]
    Unlucky(usize),
    /// The structure.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// The hammer.
    #[error(transparent)]
    Hammer(#[from] HammerError),
    /// The spectral lines.
    #[error(transparent)]
    Spectra(#[from] SpectraError),
    /// The solid.
    #[error(transparent)]
    Solid(#[from] FemError),
}
