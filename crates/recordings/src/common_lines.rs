//! One axis for FRFs that were recorded over different parts of it: a soft tip up to 500 Hz and a hard one up
//! to 2000 Hz, or a sensor whose band ends sooner.

use jointscope_spectra::{SpectralLines, in_text};

use crate::RecordingError;
use crate::error::with_count;
use crate::function::LinesCache;
use crate::gather::Entry;

/// The part of the common lines on which an FRF was recorded.
pub(crate) struct Part {
    pub lines: SpectralLines,
    /// Common lines before them.
    pub start: usize,
    /// Common lines after them.
    pub beyond: usize,
}

impl Part {
    /// Values on its lines, and nothing on the others.
    pub(crate) fn over_all_lines(&self, values: &[f64]) -> Vec<f64> {
        let nothing = |count| std::iter::repeat_n(0.0, count);
        nothing(self.start).chain(values.iter().copied()).chain(nothing(self.beyond)).collect()
    }
}

/// The lines of all FRFs together, each of which was recorded on a part of them.
pub(crate) fn common_lines<'a>(
    frfs: &[&Entry<'a>],
    cache: &mut LinesCache<'a>,
) -> Result<(SpectralLines, Vec<Part>), RecordingError> {
    let own: Vec<SpectralLines> =
        frfs.iter().map(|entry| lines_of(entry, cache)).collect::<Result<_, _>>()?;
    // The first of the longest before all others: parts that do not overlap may both be parts of it.
    let longest = (0..own.len()).rev().max_by_key(|&index| own[index].len()).unwrap_or(0);
    let other = |index: usize| on_other_lines((frfs[longest], &own[longest]), (frfs[index], &own[index]));
    let mut all = own[longest].clone();
    for (index, lines) in own.iter().enumerate() {
        if !all.agrees_with(lines) {
            all = all.joined(lines).ok_or_else(|| other(index))?;
        }
    }
    let part = |(index, lines): (usize, &SpectralLines)| {
        let start = all.place_of(lines).ok_or_else(|| other(index))?;
        Ok(Part { lines: lines.clone(), start, beyond: all.len() - start - lines.len() })
    };
    let parts = own.iter().enumerate().map(part).collect::<Result<_, RecordingError>>()?;
    Ok((all, parts))
}

pub(crate) fn lines_of<'a>(
    entry: &Entry<'a>,
    cache: &mut LinesCache<'a>,
) -> Result<SpectralLines, RecordingError> {
    cache.lines(entry.function.dataset).map_err(|problem| entry.refuse(problem))
}

pub(crate) fn on_other_lines(
    (first, lines): (&Entry, &SpectralLines),
    (second, found): (&Entry, &SpectralLines),
) -> RecordingError {
    RecordingError::Lines {
        first: first.function.place(),
        first_lines: extent(lines),
        second: second.function.place(),
        second_lines: extent(found),
    }
}

/// `400 lines from 2.5 to 1000 Hz`.
fn extent(lines: &SpectralLines) -> String {
    let hz = lines.hz();
    format!("{} from {} to {} Hz", with_count(hz.len(), "line"), in_text(hz[0]), in_text(hz[hz.len() - 1]))
}
