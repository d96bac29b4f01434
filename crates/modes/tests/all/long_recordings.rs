//! Recordings of which neighbouring lines are merged: what is stated of their modes holds as it does of short
//! ones.

use crate::common::*;
use jointscope_modes::{ModalAnalysis, Mode, ModesOptions};
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use jointscope_wording::Remarks;
use num_complex::Complex64;

const FOUR: [(usize, usize); 4] = [(4, 1), (3, 1), (4, 2), (3, 2)];

fn two() -> Vec<TrueMode> {
    vec![mode(120.0, 0.004, &[1.0, 0.5, -0.6, -0.9]), mode(640.0, 0.002, &[0.8, -0.7, 0.6, 0.9])]
}

fn lines(count: usize) -> SpectralLines {
    SpectralLines::even(20.0, 880.0 / count as f64, count).unwrap()
}

fn analyse(set: &FrfSet) -> ModalAnalysis {
    ModalAnalysis::of(set, &ModesOptions::default()).unwrap()
}

/// Mean of the squared errors over the stated variances, of frequencies and of damping ratios.
fn pulls(count: usize, seeds: u64, recorded: impl Fn(&FrfSet) -> FrfSet) -> [f64; 2] {
    let (lines, truth) = (lines(count), two());
    let clean = accelerances(&truth, 2.0, &FOUR, &lines);
    let mut sums = [0.0; 2];
    for seed in 0..seeds {
        let analysis = analyse(&recorded(&noisy(&clean, &FOUR, &lines, 0.02, 0.02, seed)));
        assert!(analysis.merged_from == Some(count) && analysis.lines().len() < count / 4);
        assert_eq!(analysis.modes.len(), truth.len());
        for (found, truth) in analysis.modes.iter().zip(&truth) {
            sums[0] += ((found.frequency - truth.frequency) / found.frequency_std).powi(2);
            sums[1] += ((found.damping_ratio - truth.ratio) / found.damping_std).powi(2);
        }
    }
    sums.map(|sum| sum / (seeds as usize * truth.len()) as f64)
}

#[test]
fn errors_are_as_large_as_stated_where_lines_are_merged() {
    for (of, recorded) in [
        ("variances known", &FrfSet::clone as &dyn Fn(&FrfSet) -> FrfSet),
        ("noise by what modes leave", &without_variances),
    ] {
        for squared in pulls(12_800, 25, recorded) {
            // The mean of 50 squares is known to a fifth.
            assert!((0.5..1.6).contains(&squared), "{of}: {squared}");
        }
    }
}

/// FRFs of four records of a roving hammer, from each of which to the next every resonance moves by this
/// share of its half-width.
fn drifting(count: usize, share: f64) -> FrfSet {
    let lines = lines(count);
    let record = |(number, frf): (usize, &(usize, usize))| {
        let by = 1.0 + share * number as f64;
        let modes =
            two().into_iter().map(|m| TrueMode { frequency: m.frequency * (1.0 + by * m.ratio), ..m });
        accelerances(&modes.collect::<Vec<_>>(), 2.0, &[*frf], &lines)
    };
    let frfs = [(4, 1), (4, 2), (4, 3), (4, 4)];
    let clean: Vec<Vec<Complex64>> = frfs.iter().enumerate().map(record).collect();
    without_variances(&noisy(&clean.concat(), &frfs, &lines, 0.02, 0.01, 7))
}

#[test]
fn a_mode_that_drifts_from_record_to_record_is_known_no_better_by_many_lines() {
    let [few, many] = [6_400, 102_400].map(|count| analyse(&drifting(count, 0.05)));
    assert!(few.merged_from.is_none() && many.merged_from == Some(102_400));
    for (few, many) in few.modes.iter().zip(&many.modes) {
        assert!(few.drift.is_some() && many.drift.is_some(), "{} Hz", few.frequency);
        // Noise alone would be known four times as well.
        let ratio = many.frequency_std / few.frequency_std;
        assert!((0.8..1.2).contains(&ratio), "{} Hz: {ratio}", few.frequency);
        let apart = (many.frequency - few.frequency).abs() / few.frequency_std;
        assert!(apart < 0.2, "{} Hz: {apart} deviations apart", few.frequency);
    }
}

#[test]
fn a_resonance_that_moves_from_record_to_record_is_one_mode_however_many_lines_there_are() {
    for (count, share) in [(25_600, 0.1), (102_400, 0.1), (102_400, 0.4)] {
        let analysis = analyse(&drifting(count, share));
        let found: Vec<f64> = analysis.modes.iter().map(|mode| mode.frequency).collect();
        assert_eq!(found.len(), 2, "{count} lines, {share} of a half-width: {found:?} Hz");
        assert!(analysis.modes.iter().all(|mode| mode.drift.is_some()));
    }
}

#[test]
fn a_band_of_a_long_recording_tells_what_a_recording_of_that_band_tells() {
    let (lines, pairs) = (lines(20_000), [(4, 1), (3, 1)]);
    let clean = accelerances(&two(), 2.0, &pairs, &lines);
    let set = noisy(&clean, &pairs, &lines, 0.02, 0.0, 3);
    let band = ModesOptions { band: Some((400.0, 900.0)), ..ModesOptions::default() };
    let of_whole = ModalAnalysis::of(&set, &band).unwrap();
    let of_part = analyse(&set.on_lines(|line| (400.0..=900.0).contains(&lines.hz()[line])).unwrap());
    assert_eq!(of_whole.merged_from, of_part.merged_from);
    let [whole, part]: [&Mode; 2] = [&of_whole.modes[0], &of_part.modes[0]];
    assert!((whole.frequency - part.frequency).abs() < 0.3 * part.frequency_std);
    assert!((whole.damping_std / part.damping_std - 1.0).abs() < 0.1);
}

#[test]
fn lines_merged_are_told_and_the_relative_error_is_that_over_all_recorded_ones() {
    let (lines, pairs) = (lines(12_800), [(4, 1), (3, 1)]);
    let clean = accelerances(&two(), 2.0, &pairs, &lines);
    let set = noisy(&clean, &pairs, &lines, 0.05, 0.0, 3);
    let analysis = analyse(&set);
    let remarks = analysis.remarks();
    assert!(remarks.iter().any(|remark| remark.starts_with("of 12800 lines")), "{remarks:?}");
    for (frf, error) in analysis.relative_errors().into_iter().enumerate() {
        let squares =
            |value: &dyn Fn(usize) -> Complex64| (0..12_800).map(|i| value(i).norm_sqr()).sum::<f64>();
        let truth = &clean[frf * 12_800..(frf + 1) * 12_800];
        let noise = squares(&|i| set.values(frf)[i] - truth[i]) / squares(&|i| set.values(frf)[i]);
        assert!((error / noise.sqrt() - 1.0).abs() < 0.02, "{error} of {}", noise.sqrt());
    }
}

#[test]
fn receptances_of_a_long_recording_tell_the_same_modes() {
    let pairs = [(4, 1), (3, 1)];
    let lines = lines(12_800);
    let set = noisy(&accelerances(&two(), 2.0, &pairs, &lines), &pairs, &lines, 0.02, 0.0, 5);
    let pairs: Vec<FrfPair> = set.pairs().to_vec();
    let receptances = set.to_form(FrfForm::Receptance).unwrap();
    let [one, other] = [&set, &receptances].map(|set| analyse(&without_variances(set)));
    assert_eq!(one.pairs(), pairs);
    for (a, b) in one.modes.iter().zip(&other.modes) {
        assert!((a.frequency - b.frequency).abs() < 1e-3 * a.frequency_std, "{} Hz", a.frequency);
        assert!((a.damping_std / b.damping_std - 1.0).abs() < 1e-3, "{} Hz", a.frequency);
    }
}
