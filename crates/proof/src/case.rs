//! A case: what the diagnosis is given.

use jointscope_fixture::Fixture;
use jointscope_rig::universal_file::{FileError, Precision, to_bytes};
use jointscope_spectra::FrfSet;

/// What the diagnosis is given: the analyst's fixture and the recording, FRFs or hits.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<R = FrfSet> {
    /// The fixture as the analyst believes it.
    pub believed: Fixture,
    /// The measured accelerances with coherence, or force and accelerations of every hit.
    pub recorded: R,
}

impl Case {
    /// The recording as a universal file (58b), FRFs with coherence and averages.
    ///
    /// # Errors
    /// A point whose name is no node number.
    pub(crate) fn recording(&self, precision: Precision) -> Result<Vec<u8>, FileError> {
        to_bytes("hammer test", &self.recorded, precision)
    }
}
