//! FRFs under each other's labels.

use crate::levels::median;
use crate::settings::exchanged::{FEWEST_LINES, LIKE_FIXTURE, REMAINING_SHARE};
use jointscope_spectra::{FrfPair, FrfSet};
use num_complex::Complex64;

/// Median |ln(±H/Ĥ)|² over the lines, with this sign.
fn distance(recorded: &[Complex64], modelled: &[Complex64], sign: f64) -> f64 {
    let pairs = recorded.iter().zip(modelled);
    let apart = pairs.map(|(a, b)| (sign * a / b).ln().norm_sqr()).filter(|apart| apart.is_finite());
    median(apart.collect()).unwrap_or(f64::INFINITY)
}

/// Pairs of FRFs, by place, each of which is like what the fixture makes of the other one, and neither like
/// its own, nor like that with the other sign: a sensor that was turned round is no exchange.
pub(crate) fn exchanged(frfs: &FrfSet, modelled: &[Complex64]) -> Vec<(usize, usize)> {
    let (count, lines) = (frfs.pairs().len(), frfs.lines().len());
    if lines < FEWEST_LINES {
        return Vec::new();
    }
    let signed = |recorded: usize, model: usize, sign: f64| {
        distance(frfs.values(recorded), &modelled[model * lines..(model + 1) * lines], sign)
    };
    let distance = |recorded: usize, model: usize| signed(recorded, model, 1.0);
    let own = |index: usize| distance(index, index).min(signed(index, index, -1.0));
    let own: Vec<f64> = (0..count).map(own).collect();
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

/// The two points whose channels, all responses or all references of them, have each other's place, with the
/// labels that are right: where some of `exchanged` say so, and all FRFs of both, of which some may have no
/// partner among the others, are like what `model` makes of these labels.
pub(crate) fn swapped(
    frfs: &FrfSet,
    modelled: &[Complex64],
    exchanged: &[(usize, usize)],
    model: impl Fn(&FrfSet) -> Option<Vec<Complex64>>,
) -> Option<(String, String, Vec<FrfPair>)> {
    let (pairs, lines) = (frfs.pairs(), frfs.lines().len());
    let &(one, other) = exchanged.first()?;
    [false, true].into_iter().find_map(|is_reference| {
        let channel =
            |pair: &FrfPair| if is_reference { pair.reference.clone() } else { pair.response.clone() };
        let (a, b) = (channel(&pairs[one]), channel(&pairs[other]));
        let right = |pair: &FrfPair| {
            let mut right = pair.clone();
            let own = if is_reference { &mut right.reference } else { &mut right.response };
            if *own == a {
                *own = b.clone();
            } else if *own == b {
                *own = a.clone();
            }
            right
        };
        let labels: Vec<FrfPair> = pairs.iter().map(right).collect();
        let anew = model(&frfs.clone().with_pairs(labels.clone()))?;
        let moved: Vec<usize> = (0..pairs.len()).filter(|&at| labels[at] != pairs[at]).collect();
        let sum = |all: &[Complex64]| -> f64 {
            let of = |&at: &usize| distance(frfs.values(at), &all[at * lines..(at + 1) * lines], 1.0);
            moved.iter().map(of).sum()
        };
        let (before, after) = (sum(modelled), sum(&anew));
        let is_right =
            a != b && after < REMAINING_SHARE * before && after < LIKE_FIXTURE * moved.len() as f64;
        let (a, b) = if a <= b { (a, b) } else { (b, a) };
        is_right.then(|| (a.to_string(), b.to_string(), labels))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_spectra::{FrfForm, SpectralLines};

    #[test]
    fn a_sensor_that_was_turned_round_is_no_exchange_of_frfs_of_opposite_sign() {
        // To impacts on either side of a node a sensor answers with opposite signs.
        let count = 2 * FEWEST_LINES;
        let one: Vec<Complex64> = (0..count).map(|k| Complex64::new(1.0 + 0.01 * k as f64, 0.1)).collect();
        let modelled: Vec<Complex64> = one.iter().copied().chain(one.iter().map(|v| -1.05 * v)).collect();
        let pairs = vec![FrfPair::transverse("6", "1"), FrfPair::transverse("6", "2")];
        let lines = SpectralLines::even(10.0, 1.0, count).unwrap();
        let frfs = FrfSet::new(lines, FrfForm::Accelerance, pairs, modelled.clone()).unwrap();
        let reversed = frfs.with_values(|_, value| -value);
        assert_eq!(exchanged(&reversed, &modelled), []);
    }
}
