//! FRFs without a phase: magnitudes, or real parts alone.

use crate::Oddity;
use jointscope_spectra::FrfSet;

/// Whether an FRF is real on all lines.
pub(crate) fn lacks(frfs: &FrfSet) -> bool {
    (0..frfs.pairs().len()).any(|index| !has_phase(frfs, index))
}

/// The FRFs that have an imaginary part, and which have none; `None` where all have none.
pub(crate) fn with_phase(frfs: &FrfSet) -> Option<(FrfSet, Oddity)> {
    let left = frfs.of_frfs(|index| has_phase(frfs, index))?;
    let without = (0..frfs.pairs().len()).filter(|&index| !has_phase(frfs, index));
    Some((left, Oddity::NoPhase(without.map(|index| frfs.pairs()[index].clone()).collect())))
}

fn has_phase(frfs: &FrfSet, index: usize) -> bool {
    frfs.values(index).iter().any(|value| value.im != 0.0)
}
