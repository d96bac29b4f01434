//! FRFs under each other's labels.

use crate::levels::median;
use crate::settings::exchanged::{FEWEST_LINES, LIKE_FIXTURE, REMAINING_SHARE};
use jointscope_spectra::{FrfPair, FrfSet};
use num_complex::Complex64;

/// Pairs of FRFs, by place, each of which is like what the fixture makes of the other one, and neither like its own.
pub(crate) fn exchanged(frfs: &FrfSet, modelled: &[Complex64]) -> Vec<(usize, usize)> {
    let (count, lines) = (frfs.pairs().len(), frfs.lines().len());
    if lines < FEWEST_LINES {
        return Vec::new();
    }
    let distance = |recorded: usize, model: usize| {
        let pairs = frfs.values(recorded).iter().zip(&modelled[model * lines..(model + 1) * lines]);
        let apart: Vec<f64> =
            pairs.map(|(a, b)| (a / b).ln().norm_sqr()).filter(|apart| apart.is_finite()).collect();
        median(apart).unwrap_or(f64::INFINITY)
    };
    let own: Vec<f64> = (0..count).map(|index| distance(index, index)).collect();
    let mut taken = vec![false; count];
    let mut found = Vec::new();
    for a in 0..count {
        for b in a + 1..count {
            if taken[a] || taken[b] || own[a] < LIKE_FIXTURE || own[b] < LIKE_FIXTURE {
                continue;
            }
            let (there, back) = (distance(a, b), distance(b, a));
            if there < LIKE_FIXTURE
                && back < LIKE_FIXTURE
                && there + back < REMAINING_SHARE * (own[a] + own[b])
            {
                (taken[a], taken[b]) = (true, true);
                found.push((a, b));
            }
        }
    }
    found
}

/// The two points whose channels, all responses or all references of them, have each other's place, where that is all that was exchanged.
pub(crate) fn swapped(pairs: &[FrfPair], exchanged: &[(usize, usize)]) -> Option<(String, String)> {
    for is_reference in [false, true] {
        let channel = |index: usize| {
            let pair = &pairs[index];
            if is_reference { (&pair.reference, &pair.response) } else { (&pair.response, &pair.reference) }
        };
        let points = |&(a, b): &(usize, usize)| {
            let ((one, across), (other, also)) = (channel(a), channel(b));
            let both = if one <= other { (one, other) } else { (other, one) };
            (across == also).then_some(both)
        };
        let Some(first) = exchanged.first().and_then(points) else { continue };
        let own = (0..pairs.len()).filter(|&index| [first.0, first.1].contains(&channel(index).0)).count();
        if exchanged.len() > 1
            && own == 2 * exchanged.len()
            && exchanged.iter().all(|pair| points(pair) == Some(first))
        {
            return Some((first.0.to_string(), first.1.to_string()));
        }
    }
    None
}
