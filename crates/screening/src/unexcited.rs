//! Bands at the upper end in which a channel has no coherence.

use crate::Oddity;
use crate::levels::median;
use jointscope_spectra::{FrfPair, FrfSet};

/// Coherence below which nothing is told.
const NONE: f64 = 0.5;
/// Lines whose median counts.
const WINDOW: usize = 9;
/// Least share of the lines that is worth a word.
const SHARE: f64 = 0.1;

/// Channels whose FRFs all lack coherence from some line to the end of the band.
pub(crate) fn unexcited(frfs: &FrfSet) -> Vec<Oddity> {
    let starts: Vec<Option<usize>> =
        (0..frfs.pairs().len()).map(|index| start(frfs.coherence(index)?)).collect();
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
                found.push(Oddity::Unexcited { point: name, is_reference, from: frfs.lines().hz()[line] });
            }
        }
    }
    found
}

/// The first line from which on there is no coherence, where that is a part of the band worth a word.
fn start(coherence: &[f64]) -> Option<usize> {
    let windows = coherence.chunks(WINDOW).map(|window| median(window.to_vec()).unwrap_or(1.0));
    let windows: Vec<f64> = windows.collect();
    let none = windows.iter().rev().take_while(|value| **value < NONE).count();
    let first = (windows.len() - none) * WINDOW;
    let share = (coherence.len().saturating_sub(first)) as f64 / coherence.len().max(1) as f64;
    (share > SHARE && first > 0).then_some(first)
}
