//! Resonances that move among FRFs of one response, and lines that break off.

use crate::common::{accelerances, mode};
use jointscope_frf::{Drift, breaks, lone_lines, resonant_lines};
use jointscope_samples::Noise;
use jointscope_spectra::{FrfForm, FrfSet, SpectralLines};
use num_complex::Complex64;

/// Half-width of the resonances, Hz: sharp enough to stand out of the lines beside them.
const WIDTH: f64 = 0.7;
const NATURAL: [f64; 2] = [310.2, 704.9];
const NOISE: f64 = 1e-6;

fn lines() -> SpectralLines {
    SpectralLines::even(1.0, 1.0, 1000).unwrap()
}

/// A mode of the half-width.
fn resonance(hz: f64, natural: f64) -> Complex64 {
    mode(hz, natural, WIDTH / natural)
}

/// Two modes; in FRF i those move by `shift[i]` of their half-widths.
fn drifting(channels: &[(&str, &str)], shift: &[f64], noise: f64, seed: u64) -> FrfSet {
    let mut random = Noise::from_state(seed);
    accelerances(&lines(), channels, |frf, hz| {
        let modes: Complex64 =
            NATURAL.iter().map(|natural| resonance(hz, natural + shift[frf] * WIDTH)).sum();
        modes + random.complex(noise)
    })
}

const ONE_RESPONSE: [(&str, &str); 4] = [("4", "1"), ("4", "2"), ("4", "3"), ("4", "5")];

#[test]
fn resonances_that_moved_are_told_with_how_far_and_how_wide_they_are() {
    let shift: [f64; 4] = [-0.3, 0.1, 0.4, 0.2];
    let mean = shift.iter().sum::<f64>() / 4.0;
    let deviation = (shift.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / 3.0).sqrt();
    let set = drifting(&ONE_RESPONSE, &shift, NOISE, 1);
    for form in [FrfForm::Accelerance, FrfForm::Receptance] {
        let drift = Drift::of(&set.to_form(form).unwrap()).unwrap();
        assert_eq!(drift.resonances.len(), 2);
        for ((hz, moved, width), natural) in drift.resonances.iter().zip(NATURAL) {
            assert!((hz - natural - mean * WIDTH).abs() < 0.01 * WIDTH, "{hz}");
            assert!((moved * hz / (deviation * WIDTH) - 1.0).abs() < 0.02, "{moved}");
            assert!((width * hz / WIDTH - 1.0).abs() < 0.02, "{width}");
        }
        assert_eq!((drift.at(0.0), drift.at(900.0)), (drift.resonances[0].1, drift.resonances[1].1));
        assert_eq!([drift.nearest(500.0), drift.nearest(520.0)], [0, 1]);
    }
}

#[test]
fn what_three_references_of_one_response_differ_by_beyond_a_twentieth_of_a_half_width_is_drift() {
    let by = |deviation: f64| {
        // Three with this standard deviation.
        let shift = [-deviation, 0.0, deviation];
        Drift::of(&drifting(&ONE_RESPONSE[..3], &shift, NOISE, 2)).is_some()
    };
    assert_eq!([0.0, 0.04, 0.06, 0.5].map(by), [false, false, true, true]);
    let moved = [-0.5, 0.0, 0.5];
    assert_eq!(Drift::of(&drifting(&ONE_RESPONSE[..2], &moved[..2], NOISE, 3)), None, "two are too few");
    let three_responses = [("4", "1"), ("3", "1"), ("2", "1")];
    assert_eq!(
        Drift::of(&drifting(&three_responses, &moved, NOISE, 4)),
        None,
        "an accelerometer that roves brings mass"
    );
}

#[test]
fn noise_as_large_as_what_resonances_differ_by_is_no_drift_and_noise_alone_is_none_at_any_level() {
    let told = |shift: f64, noise: f64| {
        let differs =
            |seed| Drift::of(&drifting(&ONE_RESPONSE[..3], &[-shift, 0.0, shift], noise, seed)).is_some();
        (100..120).filter(|&seed| differs(seed)).count()
    };
    assert_eq!(told(0.1, 10.0), 20);
    // The peaks are 220 high.
    assert!(told(0.1, 1000.0) <= 2, "{} of 20", told(0.1, 1000.0));
    for noise in [1.0, 30.0, 300.0] {
        assert!(told(0.0, noise) <= 1, "{} of 20 at {noise}", told(0.0, noise));
    }
}

#[test]
fn an_frf_struck_at_a_resonances_node_has_no_say_in_where_it_is() {
    let shift = [-0.3, 0.0, 0.3];
    let mut random = Noise::from_state(9);
    let set = accelerances(&lines(), &ONE_RESPONSE, |frf, hz| {
        let lower = shift.get(frf).map_or(Complex64::ZERO, |by| resonance(hz, NATURAL[0] + by * WIDTH));
        lower + resonance(hz, NATURAL[1]) + random.complex(NOISE)
    });
    let drift = Drift::of(&set).unwrap();
    let (hz, moved, _) = drift.resonances[0];
    assert!((hz - NATURAL[0]).abs() < 0.01 * WIDTH, "{hz}");
    assert!((moved * hz / (0.3 * WIDTH) - 1.0).abs() < 0.02, "{moved}");
    assert!(drift.resonances[1].1 * drift.resonances[1].0 < 0.01 * WIDTH, "the upper one stays");
}

#[test]
fn a_change_by_one_deviation_is_what_the_frf_itself_does_when_its_resonance_moves() {
    let shift = [-0.02, 0.0, 0.02, 0.1];
    let drift = Drift::of(&drifting(&ONE_RESPONSE, &shift, NOISE, 5)).unwrap();
    let hz = lines().hz().to_vec();
    let values: Vec<Complex64> = hz.iter().map(|&hz| resonance(hz, NATURAL[0])).collect();
    let near: Vec<usize> = (300..320).collect();
    let moved = drift.resonances[0].1;
    for (line, squared) in near.iter().zip(drift.squared_change(&hz, &values, &near)) {
        let at = |by: f64| resonance(hz[*line], NATURAL[0] * (1.0 + by));
        let expected = 0.25 * (at(moved) - at(-moved)).norm_sqr();
        assert!((squared / expected - 1.0).abs() < 0.05, "{} Hz: {squared} for {expected}", hz[*line]);
    }
    assert_eq!(drift.squared_change(&hz[..5], &values[..5], &[2]), [0.0], "too few lines tell nothing");
}

#[test]
fn drift_is_the_same_in_any_unit_and_on_lines_closer_together() {
    let shift = [-0.2, 0.0, 0.2];
    let set = drifting(&ONE_RESPONSE[..3], &shift, NOISE, 7);
    let expected = Drift::of(&set).unwrap().resonances;
    let scaled = |values: f64, hz: f64| {
        let lines = SpectralLines::even(hz, hz, 1000).unwrap();
        let values = set.all_values().iter().map(|value| value * values).collect();
        Drift::of(&FrfSet::new(lines, FrfForm::Accelerance, set.pairs().to_vec(), values).unwrap())
    };
    for (values, hz) in [(1e-6, 1.0), (1.0, 0.0625), (1e4, 8.0)] {
        let found = scaled(values, hz).unwrap().resonances;
        assert_eq!(found.len(), 2);
        for ((place, moved, width), (e_place, e_moved, e_width)) in found.iter().zip(&expected) {
            for (found, expected) in [(place / hz, e_place), (*moved, e_moved), (*width, e_width)] {
                assert!((found / expected - 1.0).abs() < 1e-6, "{found} for {expected}");
            }
        }
    }
}

#[test]
fn resonances_are_the_peaks_that_stand_out_of_their_neighbourhood() {
    assert_eq!(resonant_lines(&drifting(&ONE_RESPONSE, &[0.0; 4], NOISE, 6)), [309, 704]);
    // Damped to a third of critical, or none at all.
    let flat = accelerances(&lines(), &[("4", "1")], |_, hz| mode(hz, 300.0, 0.3));
    assert!(resonant_lines(&flat).is_empty());
    let empty = accelerances(&lines(), &[("4", "1")], |_, _| Complex64::ZERO);
    assert!(resonant_lines(&empty).is_empty());
}

#[test]
fn lines_break_off_where_half_of_the_frfs_leave_their_course_and_not_where_one_of_three_does() {
    let channels = [("4", "1"), ("3", "1"), ("2", "1")];
    let broken = |frfs: usize, by: f64| {
        let mut random = Noise::from_state(8);
        let set = accelerances(&lines(), &channels, |frf, hz| {
            let hum = if frf < frfs && hz == 150.0 { by } else { 0.0 };
            resonance(hz, NATURAL[0]) + random.complex(NOISE) + hum
        });
        breaks(&set, &vec![2.0 / NOISE; 3000])
    };
    assert!(broken(3, 0.0).is_empty());
    // χ² of 200 is reached at √100 of E|ε|², of which the local function follows a part.
    assert!(broken(3, 8.0 * NOISE.sqrt()).is_empty());
    let hum = 12.0 * NOISE.sqrt();
    assert_eq!([broken(3, hum), broken(2, hum)], [[149], [149]]);
    assert!(broken(1, hum).is_empty());
}

#[test]
fn a_single_wrong_line_stands_alone_however_far_off_it_is() {
    let channels = [("4", "1"), ("3", "1"), ("2", "1")];
    let set = |frfs: usize, by: f64| {
        let mut random = Noise::from_state(9);
        accelerances(&lines(), &channels, |frf, hz| {
            let tone = if frf < frfs && hz == 150.0 { by } else { 0.0 };
            resonance(hz, NATURAL[0]) + random.complex(NOISE) + tone * Complex64::cis(frf as f64)
        })
    };
    let weights = vec![2.0 / NOISE; 3000];
    let lone = |frfs: usize, by: f64| lone_lines(&set(frfs, by), &weights)[1].clone();
    let of_any = |frfs: usize, by: f64| lone_lines(&set(frfs, by), &weights)[0].clone();
    for deviations in [20.0, 200.0, 2e4] {
        let tone = deviations * NOISE.sqrt();
        assert_eq!([lone(3, tone), lone(2, tone)], [[149], [149]], "{deviations} deviations");
        assert!(lone(1, tone).is_empty(), "one FRF of three may have a fault of its own");
        assert_eq!(of_any(1, tone), [149]);
    }
    assert!(lone(3, 5.0 * NOISE.sqrt()).is_empty());
    assert!(of_any(3, 5.0 * NOISE.sqrt()).is_empty());
}

#[test]
fn a_peak_of_a_hundredth_of_a_lines_width_is_no_lone_line_wherever_it_lies() {
    for off in [0.0, 0.02, 0.1, 0.3, 0.5] {
        let mut random = Noise::from_state(10);
        let natural = 400.0 + off;
        let set = accelerances(&lines(), &[("4", "1")], |_, hz| {
            mode(hz, natural, 0.01 / natural) + random.complex(NOISE)
        });
        assert!(lone_lines(&set, &vec![2.0 / NOISE; 1000])[0].is_empty(), "{off} lines beside one");
    }
}
