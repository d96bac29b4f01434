//! FRFs without a phase: magnitudes, or real parts alone.

use crate::{Oddity, ScreeningError};
use jointscope_spectra::FrfSet;

/// Whether an FRF is real on all lines.
pub(crate) fn lacks(frfs: &FrfSet) -> bool {
    (0..frfs.pairs().len()).any(|index| !has_phase(frfs, index))
}

/// The FRFs that have an imaginary part, and which have none.
///
/// # Errors
/// [`ScreeningError::NoPhase`] where none has one.
pub(crate) fn with_phase(frfs: &FrfSet) -> Result<(FrfSet, Oddity), ScreeningError> {
    let left = frfs.of_frfs(|index| has_phase(frfs, index)).ok_or(ScreeningError::NoPhase)?;
    let without = (0..frfs.pairs().len()).filter(|&index| !has_phase(frfs, index));
    Ok((left, Oddity::NoPhase(without.map(|index| frfs.pairs()[index].clone()).collect())))
}

fn has_phase(frfs: &FrfSet, index: usize) -> bool {
    frfs.values(index).iter().any(|value| value.im != 0.0)
}
