//! Why nothing can be concealed.

use jointscope_fixture::FixtureError;
use jointscope_rig::StructureError;
use jointscope_spectra::SpectraError;

/// Why nothing can be concealed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConcealmentError {
    /// There would be no concealment.
    #[error(
        "{0} cases leave none to conceal anything in, for the first is a control; ask for two at the least"
    )]
    TooFew(usize),
    /// A case beyond the last.
    #[error("there is no case {only}: {cases} cases are numbered 0 to {}", cases - 1)]
    NoSuchCase {
        /// The case asked for.
        only: usize,
        /// Number of cases.
        cases: usize,
    },
    /// The fixture and the recording have room for nothing that was asked for.
    #[error("nothing can be concealed of the kinds asked for ({asked}): fixture and recording have room for {}",
        if there.is_empty() { "none of any kind" } else { there })]
    NoRoom {
        /// The kinds asked for.
        asked: String,
        /// The kinds that there is room for.
        there: String,
    },
    /// Every draw was impossible.
    #[error("case {0} could not be drawn: nothing of its kind suited the fixture")]
    Unlucky(usize),
    /// An edited fixture is impossible.
    #[error(transparent)]
    Fixture(#[from] FixtureError),
    /// An edited recording is impossible.
    #[error(transparent)]
    Spectra(#[from] SpectraError),
    /// No control can be drawn.
    #[error(transparent)]
    Structure(#[from] StructureError),
}
