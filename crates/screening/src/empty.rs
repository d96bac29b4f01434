//! Lines of exactly zero, where nothing was recorded or exported.

use crate::Oddity;
use jointscope_spectra::FrfSet;

/// The lines above 0 Hz on which FRFs are exactly zero, as an [oddity](Oddity::Empty). At 0 Hz the
/// accelerance of a supported structure is.
pub fn empty_lines(frfs: &FrfSet) -> Option<Oddity> {
    let hz = frfs.lines().hz();
    let of_frf = |index: usize| {
        let lines: Vec<usize> = (0..hz.len()).filter(|&line| is_empty(frfs, index, line)).collect();
        let (first, last) = (lines.first()?, lines.last()?);
        Some((frfs.pairs()[index].clone(), lines.len(), [hz[*first], hz[*last]]))
    };
    let empty: Vec<_> = (0..frfs.pairs().len()).filter_map(of_frf).collect();
    (!empty.is_empty()).then_some(Oddity::Empty(empty))
}

/// The FRFs on the lines on which at least one of them is not empty.
pub(crate) fn without_empty_lines(frfs: FrfSet) -> FrfSet {
    let told = |line: usize| (0..frfs.pairs().len()).any(|index| !is_empty(&frfs, index, line));
    frfs.on_lines(told).unwrap_or(frfs)
}

fn is_empty(frfs: &FrfSet, index: usize, line: usize) -> bool {
    frfs.lines().hz()[line] > 0.0 && !frfs.has_value(index, line)
}
