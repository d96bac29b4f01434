//! One set of FRFs of levels that are alike.

use super::level::SteppedLevel;
use crate::settings::levels::SAME_LINE;
use jointscope_frf::noise::known;
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;

/// The FRFs of levels between which nothing changes, as one set: on every line that a level has, the mean of
/// the levels that have it, weighted by one over their variances, and the variance of that mean. FRFs that
/// some level lacks are left out; `None` where none is left, or the levels' forms cannot be turned into one
/// another.
///
/// Variances come from coherence and averages where a level has them, from its scatter over the lines
/// elsewhere.
pub fn pooled(levels: &[SteppedLevel]) -> Option<FrfSet> {
    let form = levels.first()?.frfs.form();
    let sets: Vec<FrfSet> =
        levels.iter().map(|level| noisy(&level.frfs).to_form(form).ok()).collect::<Option<_>>()?;
    let shared = |pair: &&FrfPair| sets.iter().all(|set| set.index_of(pair).is_some());
    let pairs: Vec<FrfPair> = sets[0].pairs().iter().filter(shared).cloned().collect();
    // By line of the union: where it stands in each set.
    let mut places: Vec<(f64, Vec<(usize, usize)>)> = Vec::new();
    let apart = sets.iter().flat_map(|set| set.lines().hz().windows(2)).map(|w| w[1] - w[0]);
    let same = SAME_LINE * apart.fold(f64::INFINITY, f64::min);
    let mut all: Vec<(f64, usize, usize)> = sets
        .iter()
        .enumerate()
        .flat_map(|(s, set)| set.lines().hz().iter().enumerate().map(move |(line, hz)| (*hz, s, line)))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (hz, set, line) in all {
        match places.last_mut() {
            Some((first, members)) if hz - *first <= same && members.iter().all(|m| m.0 != set) => {
                members.push((set, line));
            }
            _ => places.push((hz, vec![(set, line)])),
        }
    }
    let lines = SpectralLines::new(places.iter().map(|place| place.0).collect()).ok()?;
    let (mut values, mut variances) = (Vec::new(), Vec::new());
    for pair in &pairs {
        for (_, members) in &places {
            let (mut sum, mut weight) = (Complex64::ZERO, 0.0);
            for &(set, line) in members {
                let frf = sets[set].index_of(pair)?;
                let value = sets[set].values(frf)[line];
                let variance = sets[set].variance(frf)?[line].max(f64::MIN_POSITIVE);
                sum += value / variance;
                weight += 1.0 / variance;
            }
            values.push(sum / weight);
            variances.push(1.0 / weight);
        }
    }
    if pairs.is_empty() {
        return None;
    }
    FrfSet::new(lines, form, pairs, values).ok()?.with_variance(variances).ok()
}

/// A set with variances, its own where it carries them.
pub(crate) fn noisy(frfs: &FrfSet) -> FrfSet {
    known(frfs).map_or_else(|_| frfs.clone(), |(with, _)| with)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Held;
    use jointscope_spectra::FrfForm;

    fn level(hz: &[f64], value: f64, variance: f64) -> SteppedLevel {
        let lines = SpectralLines::new(hz.to_vec()).unwrap();
        let frfs = FrfSet::new(
            lines,
            FrfForm::Accelerance,
            vec![FrfPair::transverse("1", "1")],
            vec![value.into(); hz.len()],
        );
        SteppedLevel {
            held: Held::Force(1.0),
            frfs: frfs.unwrap().with_variance(vec![variance; hz.len()]).unwrap(),
        }
    }

    #[test]
    fn levels_on_lines_of_their_own_are_averaged_where_they_meet_by_their_variances() {
        let set =
            pooled(&[level(&[1.0, 2.0, 3.0], 1.0, 1.0), level(&[2.000_001, 3.0, 4.0], 4.0, 0.5)]).unwrap();
        assert_eq!(set.lines().hz(), [1.0, 2.0, 3.0, 4.0]);
        let values: Vec<f64> = set.values(0).iter().map(|v| v.re).collect();
        assert_eq!(values, [1.0, 3.0, 3.0, 4.0]);
        assert_eq!(set.variance(0).unwrap(), [1.0, 1.0 / 3.0, 1.0 / 3.0, 0.5]);
    }
}
