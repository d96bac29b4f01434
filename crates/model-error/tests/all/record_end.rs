//! Records that ended while the structure still rang.

use crate::common::*;
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_model_error::{RecordEnd, WeightedFrfs};
use jointscope_modes::ModesOptions;
use jointscope_samples::of_records;
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

fn exact(fixture: &Fixture, lines: &SpectralLines) -> FrfSet {
    synthesize(fixture, &four(), lines, Instrument::AsRecorded).unwrap()
}

/// With noise of 0.3 % of each FRF's root mean square.
fn measured(frfs: &FrfSet, seed: u64) -> Recorded {
    let mut noise = jointscope_samples::Noise::new(seed);
    let n = frfs.lines().len();
    let (mut values, mut variances) = (Vec::new(), Vec::new());
    for frf in 0..frfs.pairs().len() {
        let mean: f64 = frfs.values(frf).iter().map(|v| v.norm_sqr()).sum::<f64>() / n as f64;
        let variance = 0.003_f64.powi(2) * mean;
        values.extend(frfs.values(frf).iter().map(|value| value + noise.complex(variance)));
        variances.extend(std::iter::repeat_n(variance, n));
    }
    let weights = variances.iter().map(|variance| 2.0 / variance).collect();
    let set = FrfSet::new(frfs.lines().clone(), frfs.form(), frfs.pairs().to_vec(), values).unwrap();
    Recorded { set: set.with_variance(variances).unwrap(), weights }
}

fn end_of(recorded: &Recorded) -> Option<(RecordEnd, Vec<Complex64>)> {
    let recording = WeightedFrfs { frfs: &recorded.set, weights: &recorded.weights };
    RecordEnd::of(recording, &ModesOptions::default())
}

/// χ² per degree of freedom of the recording with what is `missing`, of the FRFs that are true.
fn left_by(recorded: &Recorded, truth: &FrfSet, missing: &[Complex64]) -> f64 {
    let restored = recorded.set.all_values().iter().zip(missing).map(|(value, missing)| value + missing);
    let squares = restored.zip(truth.all_values()).zip(&recorded.weights);
    let sum: f64 = squares.map(|((value, truth), weight)| weight * (value - truth).norm_sqr()).sum();
    sum / (2 * missing.len()) as f64
}

#[test]
fn blows_on_other_spots_are_longer_or_shorter() {
    let lines = lines(1200.0);
    let fine = SpectralLines::even(0.25, 0.25, 12_000).unwrap();
    let blow = |pair: &FrfPair| if pair.reference.point == "1" { (0.0105, 1e-3) } else { (0.01025, 5e-4) };
    let recorded = measured(&of_records(&exact(&blocks(""), &fine), &lines, blow), 9);
    let (end, missing) = end_of(&recorded).unwrap();
    assert!((end.after - (0.4 - 0.010375)).abs() < 1e-4, "{end:?}");
    let after = left_by(&recorded, &exact(&blocks(""), &lines), &missing);
    assert!(after < 1.05, "{after}");
}

#[test]
fn what_followed_after_the_end_of_records_is_added_to_within_their_noise() {
    let lines = lines(1200.0);
    let fine = SpectralLines::even(0.25, 0.25, 12_000).unwrap();
    let (fixture, mut seed) = (blocks(""), 0);
    let truth = exact(&fixture, &lines);
    // Blows as triggers have them, and a late one; short and long ones.
    for (at, duration) in [(0.004, 8e-4), (0.0104, 8e-4), (0.0103, 5e-4), (0.08, 1.1e-3)] {
        seed += 1;
        let recorded = measured(&of_records(&exact(&fixture, &fine), &lines, |_| (at, duration)), seed);
        let (end, missing) = end_of(&recorded).unwrap();
        let nothing = vec![Complex64::ZERO; missing.len()];
        let [before, after] = [&nothing, &missing].map(|missing| left_by(&recorded, &truth, missing));
        println!("{at} s, {duration} s: {end:?}, χ² per degree of freedom {before:.1} and {after:.3}");
        assert!((end.after - (0.4 - at)).abs() < 2e-4, "{at} s: {end:?}");
        // Of 247 Hz and 0.4 %.
        let left = (-0.004 * TAU * 247.3 * (0.4 - at)).exp();
        assert!((end.left / left - 1.0).abs() < 0.02, "{at} s: {end:?}, {left}");
        assert!(before > 30.0 && after < 1.15, "{at} s: {before}, {after}");
    }
}

#[test]
fn frfs_that_no_record_was_cut_off_for_have_no_end() {
    let lines = lines(1200.0);
    // A model's, as lightly damped as structures are; under a delay, a filter, a resonance of a channel, a window.
    let delay = r#"{"kind": "channel_delay", "place": "force", "seconds": 5e-5}"#;
    let filter = r#"{"kind": "channel_highpass", "place": "responses", "corner": 3}"#;
    let resonance =
        r#"{"kind": "channel_resonance", "place": "response 4", "frequency": 2400, "damping_ratio": 0.02}"#;
    let window = r#"{"kind": "exponential_window", "place": "all", "decay": 7.6}"#;
    for (seed, physics) in
        [("", ""), ("delay", delay), ("filter", filter), ("resonance", resonance), ("window", window)]
            .into_iter()
            .enumerate()
    {
        let recorded = measured(&exact(&blocks(physics.1), &lines), seed as u64);
        assert!(end_of(&recorded).is_none(), "{}: {:?}", physics.0, end_of(&recorded));
    }
    // A ripple over the band, as a cable's end or an echo makes it.
    let frfs = exact(&blocks(""), &lines);
    let hz = frfs.lines().hz().to_vec();
    let n = hz.len();
    let rippled = frfs.with_values(|at, value| value * (1.0 + 0.05 * (TAU * hz[at % n] * 0.012).cos()));
    assert!(end_of(&measured(&rippled, 7)).is_none());
}

#[test]
fn records_that_outlast_the_motion_have_no_early_end() {
    let lines = SpectralLines::even(20.0, 0.625, 1800).unwrap();
    let fine = SpectralLines::even(0.3125, 0.3125, 9600).unwrap();
    // e^{−9.9} of the first mode is left after 1.6 s.
    let recorded = measured(&of_records(&exact(&blocks(""), &fine), &lines, |_| (0.0104, 8e-4)), 1);
    assert!(end_of(&recorded).is_none());
}
