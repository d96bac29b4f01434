//! What a free fit says of a recording against what the model that made it says, in the deviations that the
//! fit states.

use crate::common::*;
use jointscope_fixture::Fixture;
use jointscope_model_error::{Expected, RecordedMode, RecordedModes, WeightedFrfs};
use jointscope_modes::ModesOptions;
use jointscope_spectra::SpectralLines;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Highest lines, Hz: both modes of the blocks in the band, or the second above it, in the upper residual.
/// With them the largest difference of a feature, in standard deviations: what a few residual terms leave of
/// a mode above the band.
const BANDS: [(f64, f64); 2] = [(1500.0, 0.001), (600.0, 0.3)];

#[test]
fn without_noise_recorded_and_modelled_features_are_the_same() {
    let fixture = blocks("");
    let floor = Noise { floor: 0.01, share: 0.0, seed: None };
    for (to, largest) in BANDS {
        for (stated, words) in [(noise(None), "0.25 %"), (floor, "0.01 (m/s²)/N")] {
            let recorded = Recorded::of(&fixture, &four(), &lines(to), stated).modes();
            let compared = Compared::of(&fixture, recorded);
            assert_eq!(compared.pairing.pairs.len(), compared.recorded.modes.len(), "up to {to} Hz");
            let normalised = compared.normalised();
            println!("noise of {words} up to {to} Hz: {normalised:.2?}");
            for (normalised, (_, name)) in normalised.iter().zip(compared.names()) {
                assert!(
                    normalised.abs() < largest,
                    "noise of {words} up to {to} Hz: {name} off by {normalised:.3} deviations"
                );
            }
        }
    }
}

#[test]
fn the_resonance_of_a_channel_in_or_near_the_band_is_the_same_in_recording_and_model() {
    for (to, hz) in [(1500.0, 480.0), (600.0, 720.0), (600.0, 1100.0), (600.0, 480.0)] {
        let resonance = format!(
            r#"{{"kind": "channel_resonance", "place": "response 4", "frequency": {hz}, "damping_ratio": 0.022}}"#
        );
        let fixture = blocks(&resonance);
        let compared =
            Compared::of(&fixture, Recorded::of(&fixture, &four(), &lines(to), noise(None)).modes());
        for (normalised, (_, name)) in compared.normalised().iter().zip(compared.names()) {
            assert!(
                normalised.abs() < 0.5,
                "{hz} Hz, band to {to} Hz: {name} off by {normalised:.3} deviations"
            );
        }
    }
}

#[test]
fn many_modes_above_the_band_are_residual_terms_of_recording_and_model_alike() {
    // Ten masses in a row: four modes below 450 Hz, the fifth at 503 Hz, four more above.
    let fixture = chain(10);
    let few = pairs(&[("1", "1"), ("2", "1"), ("4", "1")]);
    let compared = Compared::of(&fixture, Recorded::of(&fixture, &few, &lines(450.0), noise(None)).modes());
    assert_eq!(compared.pairing.pairs.len(), 4);
    println!("modes above the band: {:.2?}", compared.normalised());
    for (normalised, (_, name)) in compared.normalised().iter().zip(compared.names()) {
        assert!(normalised.abs() < 0.2, "{name} off by {normalised:.3} deviations");
    }
}

#[test]
fn with_noise_they_differ_by_the_deviations_that_are_stated() {
    const SEEDS: u64 = 100;
    let fixture = blocks("");
    for (to, _) in BANDS {
        let mut squares: BTreeMap<&str, (f64, usize)> = BTreeMap::new();
        let (mut chi2, mut count) = (0.0, 0);
        for seed in 0..SEEDS {
            let recorded = Recorded::of(&fixture, &four(), &lines(to), noise(Some(seed))).modes();
            let compared = Compared::of(&fixture, recorded);
            for (normalised, (kind, _)) in compared.normalised().iter().zip(compared.names()) {
                let of_kind = squares.entry(kind).or_default();
                *of_kind = (of_kind.0 + normalised * normalised, of_kind.1 + 1);
            }
            chi2 += chi2_and_ln_determinant(&compared.noise(), &compared.difference()).0;
            count += compared.comparison.count();
        }
        println!("up to {to} Hz: χ² of all features per feature {:.3}", chi2 / count as f64);
        for (kind, (sum, count)) in &squares {
            println!("up to {to} Hz: {kind}: mean square {:.3}", sum / *count as f64);
        }
        let mean = chi2 / count as f64;
        assert!((mean - 1.0).abs() < 0.1, "up to {to} Hz: χ² of all features per feature {mean:.3}");
        for (kind, (sum, count)) in squares {
            let mean = sum / count as f64;
            assert!((0.7..1.35).contains(&mean), "up to {to} Hz: mean square of {kind} {mean:.3}");
        }
    }
}

#[test]
fn noise_that_is_understated_widens_the_deviations() {
    const SEEDS: u64 = 30;
    let fixture = blocks("");
    let (mut chi2, mut count) = (0.0, 0);
    for seed in 0..SEEDS {
        let set =
            Recorded::of(&fixture, &four(), &lines(1500.0), noise(Some(seed))).with_noise_stated_as(0.5);
        let compared = Compared::of(&fixture, set.modes());
        let per_dof = compared.recorded.chi2_per_dof;
        assert!((3.6..4.4).contains(&per_dof), "χ² per degree of freedom {per_dof:.3}, expected 4");
        chi2 += chi2_and_ln_determinant(&compared.noise(), &compared.difference()).0;
        count += compared.comparison.count();
    }
    let mean = chi2 / count as f64;
    println!("understated noise: χ² of all features per feature {mean:.3}");
    assert!((mean - 1.0).abs() < 0.15, "χ² of all features per feature {mean:.3}");
}

#[test]
fn a_band_from_0_hz_has_no_modes() {
    // Its mass line and what lies below the band are powers of frequency.
    let from_zero = SpectralLines::even(0.0, 2.5, 400).unwrap();
    let set = Recorded::of(&blocks(""), &four(), &from_zero, noise(Some(1)));
    let recording = WeightedFrfs { frfs: &set.set, weights: &set.weights };
    assert!(RecordedModes::of(recording, &ModesOptions::default(), |_| Expected::default()).is_none());
}

#[test]
fn close_modes_are_told_in_the_order_of_frequency() {
    // A sensor that loads its own response only makes two modes of each, a hertz apart.
    let fixture = blocks(r#"{"kind": "sensor_mass", "place": "response 4", "mass": 0.02}"#);
    for seed in 0..10 {
        let modes = Recorded::of(&fixture, &four(), &lines(1500.0), noise(Some(seed))).modes().modes;
        let hz: Vec<f64> = modes.iter().map(|mode| mode.pole.omega / TAU).collect();
        assert!(hz.is_sorted() && hz.len() == 4, "seed {seed}: modes at {hz:.2?} Hz");
    }
}

#[test]
fn mass_lines_beside_a_suspension_differ_by_the_deviations_that_are_stated() {
    const SEEDS: u64 = 20;
    let fixture = suspended();
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let (mut chi2, mut count) = (0.0, 0);
    for seed in 0..SEEDS {
        let set = Recorded::of(&fixture, &four(), &lines, noise(Some(seed)));
        let recording = WeightedFrfs { frfs: &set.set, weights: &set.weights };
        let expected = |alone: &RecordedModes| alone.expected_by(&fixture);
        let recorded = RecordedModes::of(recording, &ModesOptions::default(), expected).unwrap();
        assert_eq!(recorded.misfit.len(), lines.len());
        let compared = Compared::of(&fixture, recorded);
        let own = chi2_and_ln_determinant(&compared.noise(), &compared.difference()).0;
        println!("seed {seed}: χ² {own:.1} of {} features", compared.comparison.count());
        chi2 += own;
        count += compared.comparison.count();
    }
    let mean = chi2 / count as f64;
    assert!((mean - 1.0).abs() < 0.15, "χ² of all features per feature {mean:.3}");
}

#[test]
fn a_mode_low_in_the_band_is_told_by_the_lines_about_it_and_not_by_those_far_above() {
    // A line every 1.25 Hz to 40 Hz and one every 20 Hz above, as those are spread that tell most.
    let (close, far) = ((2..=32).map(|k| 1.25 * f64::from(k)), (3..=75).map(|k| 20.0 * f64::from(k)));
    let lines = SpectralLines::new(close.chain(far).collect()).unwrap();
    let held = suspended().to_json().replace("605.6", "60560.0");
    let fixture = Fixture::from_json(&held).unwrap();
    let set = Recorded::of(&fixture, &four(), &lines, noise(Some(1)));
    let recording = WeightedFrfs { frfs: &set.set, weights: &set.weights };
    let expected = |alone: &RecordedModes| alone.expected_by(&fixture);
    let recorded = RecordedModes::of(recording, &ModesOptions::default(), expected).unwrap();
    let hz = |mode: &RecordedMode| mode.pole.omega / TAU;
    let low = recorded.modes.iter().find(|mode| (15.0..40.0).contains(&hz(mode)));
    assert!(low.is_some_and(|mode| mode.resolved), "{:?}", recorded.modes);
}
