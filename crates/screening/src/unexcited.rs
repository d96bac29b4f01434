//! Bands at the upper end in which a channel has no coherence.

use crate::Oddity;
use crate::levels::median;
use crate::settings::unexcited::{LEAST_COHERENCE, LEAST_SHARE, WINDOW_LINES};
use jointscope_spectra::{FrfPair, FrfSet};

/// Channels whose FRFs all lack coherence from some line to the end of the band.
pub(crate) fn unexcited(frfs: &FrfSet) -> Vec<Oddity> {
    let starts: Vec<Option<usize>> = (0..frfs.pairs().len()).map(|index| start_of(frfs, index)).collect();
    let mut found = Vec::new();
    let mut said = vec![false; starts.len()];
    // A hammer that does not excite the band shows in all FRFs of its blows, and no sensor is to blame then.
    for is_reference in [true, false] {
        let point = |pair: &FrfPair| if is_reference { &pair.reference } else { &pair.response }.to_string();
        let mut points: Vec<String> = frfs.pairs().iter().map(point).collect();
        points.sort();
        points.dedup();
        for name in points {
            let own: Vec<usize> = (0..starts.len()).filter(|&i| point(&frfs.pairs()[i]) == name).collect();
            let Some(from) = own.iter().map(|&i| starts[i]).collect::<Option<Vec<usize>>>() else { continue };
            if let Some(&line) = from.iter().max()
                && own.iter().any(|&i| !said[i])
            {
                own.iter().for_each(|&i| said[i] = true);
                let hz = frfs.lines().hz();
                found.push(Oddity::Unexcited {
                    point: name,
                    is_reference,
                    from: hz[line],
                    lines: hz.len() - line,
                });
            }
        }
    }
    found
}

/// The first line of those on which an FRF has a value from which on it has no coherence.
fn start_of(frfs: &FrfSet, index: usize) -> Option<usize> {
    let coherence = frfs.coherence(index)?;
    let with_value: Vec<usize> = (0..coherence.len()).filter(|&line| frfs.has_value(index, line)).collect();
    let of_these: Vec<f64> = with_value.iter().map(|&line| coherence[line]).collect();
    Some(with_value[start(&of_these)?])
}

/// The first line from which on there is no coherence, where that is a part of the band worth a word.
fn start(coherence: &[f64]) -> Option<usize> {
    let windows = coherence.chunks(WINDOW_LINES).map(|window| median(window.to_vec()).unwrap_or(1.0));
    let windows: Vec<f64> = windows.collect();
    let none = windows.iter().rev().take_while(|value| **value < LEAST_COHERENCE).count();
    let mut first = ((windows.len() - none) * WINDOW_LINES).min(coherence.len());
    // The first window without may begin with lines that have some, the last one with may end with lines that
    // have none.
    first += coherence[first..].iter().take_while(|gamma| **gamma >= LEAST_COHERENCE).count();
    first -= coherence[..first].iter().rev().take_while(|gamma| **gamma < LEAST_COHERENCE).count();
    let share = (coherence.len().saturating_sub(first)) as f64 / coherence.len().max(1) as f64;
    (share > LEAST_SHARE && first > 0).then_some(first)
}

/// The FRFs without the lines on which references are [unexcited](Oddity::Unexcited): left out where none is
/// excited, without weight otherwise. A coherence of zero is one of a value that tells nothing.
pub(crate) fn masked(mut frfs: FrfSet, found: &[Oddity]) -> FrfSet {
    let hz = frfs.lines().hz().to_vec();
    let starts: Vec<Option<f64>> = frfs
        .pairs()
        .iter()
        .map(|pair| {
            let own = found.iter().filter_map(|oddity| match oddity {
                Oddity::Unexcited { point, is_reference: true, from, .. } => Some((point, *from)),
                _ => None,
            });
            own.into_iter().find(|(point, _)| **point == pair.reference.to_string()).map(|(_, from)| from)
        })
        .collect();
    for (index, from) in starts.iter().enumerate() {
        let Some((from, coherence)) = from.zip(frfs.coherence(index)) else { continue };
        let none = |(gamma, hz): (&f64, &f64)| if *hz >= from { 0.0 } else { *gamma };
        let masked = coherence.iter().zip(&hz).map(none).collect();
        // Of as many values as before, each within its range.
        if frfs.set_coherence(index, masked).is_err() {
            return frfs;
        }
    }
    let all: Option<Vec<f64>> = starts.into_iter().collect();
    let end = all.and_then(|all| all.into_iter().reduce(f64::max));
    end.and_then(|end| frfs.on_lines(|line| hz[line] < end)).unwrap_or(frfs)
}
