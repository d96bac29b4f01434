//! What of a long recording is used, and what its resonances did while it was made.

use crate::settings::lines::recordings::{
    ALL_LINES, ALL_VALUES, EVEN_SHARE, KEPT_LINES, ONE_BY_ONE, SEARCHED_FRFS,
};
use jointscope_frf::{Drift, resonant_lines};
use jointscope_spectra::FrfSet;

/// Which lines of a recording are used: all of a short one; of a long one those about resonances, ever more
/// sparsely with the distance, and evenly spread ones.
pub(crate) fn lines_in_use(frfs: &FrfSet) -> Vec<bool> {
    match is_short(frfs) {
        true => vec![true; frfs.lines().len()],
        false => most_informative(frfs, KEPT_LINES),
    }
}

/// Whether all lines of a recording are used.
pub(crate) fn is_short(frfs: &FrfSet) -> bool {
    let (lines, searched) = (frfs.lines().len(), frfs.pairs().len().min(SEARCHED_FRFS));
    lines <= ALL_LINES && lines * searched <= ALL_VALUES
}

/// At most so many lines: those about resonances, ever more sparsely with the distance, and evenly spread
/// ones.
pub(crate) fn most_informative(frfs: &FrfSet, most: usize) -> Vec<bool> {
    let n = frfs.lines().len();
    if n <= most {
        return vec![true; n];
    }
    let evenly = most as f64 * EVEN_SHARE;
    let evenly: Vec<bool> = (0..n).map(|line| line % n.div_ceil(evenly as usize) == 0).collect();
    let resonances = resonant_lines(frfs);
    let graded = |grade: usize| {
        let mut kept = evenly.clone();
        for &line in &resonances {
            let mut distance = 0;
            while distance < n {
                for at in [line.checked_sub(distance), line.checked_add(distance)].into_iter().flatten() {
                    if let Some(keep) = kept.get_mut(at) {
                        *keep = true;
                    }
                }
                distance += 1 + distance / grade;
            }
        }
        kept
    };
    let count = |kept: &Vec<bool>| kept.iter().filter(|keep| **keep).count();
    ONE_BY_ONE.iter().map(|grade| graded(*grade)).find(|kept| count(kept) <= most).unwrap_or(evenly)
}

/// The variances that drift adds to `variance` (by used line) of one FRF, given the |change of the FRF|² for
/// one standard deviation.
///
/// A resonance moves as a whole: its lines together must not say more about its place than the drift leaves
/// to be known, so each of them is given as much variance as makes their information that of the one move.
pub(crate) fn drift_variance(
    drift: &Drift,
    hz: &[f64],
    variance: &[f64],
    squared_change: &[f64],
) -> Vec<f64> {
    let mut added = vec![0.0; hz.len()];
    let nearest: Vec<usize> = hz.iter().map(|&hz| drift.nearest(hz)).collect();
    for resonance in 0..drift.resonances.len() {
        let lines: Vec<usize> =
            (0..hz.len()).filter(|&l| nearest[l] == resonance && variance[l] > 0.0).collect();
        // In units of the drift's own deviation; each part of a complex value has half of its variance.
        let information = |times: f64| -> f64 {
            lines.iter().map(|&l| 2.0 * squared_change[l] / (variance[l] + times * squared_change[l])).sum()
        };
        let alone = information(0.0);
        let together = alone / (1.0 + alone);
        let (mut low, mut high) = (0.0, 4.0 * lines.len() as f64 + 4.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if information(middle) > together { low = middle } else { high = middle }
        }
        lines.iter().for_each(|&l| added[l] = high * squared_change[l]);
    }
    added
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_spectra::{FrfForm, FrfPair, SpectralLines};
    use num_complex::Complex64;

    fn beam(lines: usize) -> FrfSet {
        let lines = SpectralLines::even(10.0, 0.02, lines).unwrap();
        let mode = |hz: f64, at: f64| -hz * hz / Complex64::new(at * at - hz * hz, 2e-4 * at * hz);
        let values = lines.hz().iter().map(|&hz| mode(hz, 111.3) + mode(hz, 306.9) + 0.1).collect();
        FrfSet::new(lines, FrfForm::Accelerance, vec![FrfPair::transverse("1", "1")], values).unwrap()
    }

    #[test]
    fn of_a_long_recording_every_line_of_a_peak_is_used_and_few_far_from_it() {
        let frfs = beam(30_000);
        let kept = lines_in_use(&frfs);
        let within = |from: f64, to: f64| {
            let hz = frfs.lines().hz();
            let inside: Vec<bool> =
                kept.iter().zip(hz).filter(|(_, hz)| (from..to).contains(*hz)).map(|(k, _)| *k).collect();
            inside.iter().filter(|k| **k).count() as f64 / inside.len() as f64
        };
        assert!(kept.iter().filter(|k| **k).count() <= KEPT_LINES);
        assert_eq!([within(111.2, 111.4), within(306.8, 307.0)], [1.0, 1.0]);
        assert!(within(180.0, 240.0) < 0.05 && within(180.0, 240.0) > 0.002);
        assert!(lines_in_use(&beam(ALL_LINES)).iter().all(|k| *k));
    }

    #[test]
    fn the_lines_of_a_resonance_that_drifts_tell_its_place_no_better_than_the_drift_leaves_it() {
        let drift = Drift { resonances: vec![(100.0, 2e-5, 1e-4)] };
        let hz: Vec<f64> = (0..200).map(|i| 99.0 + 0.01 * i as f64).collect();
        let change: Vec<f64> = hz.iter().map(|hz| 1.0 / (1.0 + ((hz - 100.0) / 0.05).powi(2))).collect();
        let variance = vec![1e-3; hz.len()];
        let added = drift_variance(&drift, &hz, &variance, &change);
        let information: f64 = (0..hz.len()).map(|l| 2.0 * change[l] / (variance[l] + added[l])).sum();
        assert!((information - 1.0).abs() < 1e-3, "{information}");
        let none = drift_variance(&drift, &hz, &variance, &vec![0.0; hz.len()]);
        assert!(none.iter().all(|v| *v == 0.0));
    }
}
