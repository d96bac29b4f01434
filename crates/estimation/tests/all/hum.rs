//! Mains hum in the records of hits.

use crate::common::{INTERVAL, Structure, TWO_MODES, Test, hit};
use jointscope_estimation::{Baseline, Estimate, EstimateOptions, Remark, Signal};
use jointscope_hits::Hit;
use jointscope_spectra::Channel;
use std::f64::consts::TAU;

/// Frequency in Hz and amplitude of the tones of a hum of 50.03 Hz, m/s².
const HUM: [(f64, f64); 2] = [(50.03, 0.8), (150.09, 0.3)];

fn noisy(seed: u64) -> Test {
    Test {
        seed,
        strengths: vec![60.0, 90.0, 120.0],
        response_noise: vec![0.05; 3],
        force_noise: vec![0.02; 3],
        ..Test::quiet(3, 4096)
    }
}

/// The hits with hum in the response, at another phase in every one.
fn humming(hits: &[Hit]) -> Vec<Hit> {
    let with_hum = |(k, clean): (usize, &Hit)| {
        let tone = |i: usize| {
            let of = |(hz, amplitude): (f64, f64)| {
                amplitude * (TAU * hz * INTERVAL * i as f64 + 2.4 * k as f64 + hz).sin()
            };
            HUM.map(of).iter().sum::<f64>()
        };
        let values = &clean.responses()[0].values;
        let values = values.iter().enumerate().map(|(i, v)| v + tone(i)).collect();
        hit(clean.number(), clean.force().to_vec(), values)
    };
    hits.iter().enumerate().map(with_hum).collect()
}

fn hum(found: &Estimate) -> Option<(f64, Vec<(Signal, f64)>)> {
    found.remarks.iter().find_map(|remark| match remark {
        Remark::Hum { hz, signals } => Some((*hz, signals.clone())),
        _ => None,
    })
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v * v, count + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}

#[test]
fn hum_at_another_phase_in_every_hit_is_named_and_taken_off_to_below_the_noise() {
    let clean = noisy(1).hits();
    let recorded = humming(&clean);
    let found = Estimate::of(&recorded, &EstimateOptions::default()).unwrap();
    let (hz, signals) = hum(&found).expect("hum is named");
    assert!((hz - 50.03).abs() < 0.02, "{hz} Hz");
    assert_eq!(signals.len(), 1, "not the force: {signals:?}");
    assert_eq!(signals[0].0, Signal::Response(Channel::transverse("4")));
    let of_clean = Estimate::of(&clean, &EstimateOptions::default()).unwrap();
    let (as_clean, without) = (of_clean.prepared(&clean), found.prepared(&recorded));
    for (clean, without) in as_clean.iter().zip(&without) {
        let values = |hit: &Hit| hit.responses()[0].values.clone();
        let apart = root_mean_square(values(clean).iter().zip(values(without)).map(|(a, b)| a - b));
        assert!(apart < 0.02, "hit {}: {apart} m/s² of the hum is left beside noise of 0.05", clean.number());
    }
}

#[test]
fn a_hum_that_is_kept_on_request_stays_to_the_last_digit() {
    let recorded = humming(&noisy(1).hits());
    let options = EstimateOptions { baseline: Baseline::Keep, ..EstimateOptions::default() };
    let kept = Estimate::of(&recorded, &options).unwrap();
    assert_eq!(hum(&kept), None);
    assert_eq!(kept.prepared(&recorded), recorded);
}

#[test]
fn a_mode_at_the_mains_frequency_that_rings_to_the_end_is_no_hum() {
    for (hz, decay) in [(50.0, 0.3), (100.0, 1.0), (60.01, 0.05)] {
        let structure = Structure { modes: [(hz, decay, 0.11), TWO_MODES.modes[1]], ..TWO_MODES };
        let hits = Test { structure, ..noisy(2) }.hits();
        let found = Estimate::of(&hits, &EstimateOptions::default()).unwrap();
        assert_eq!(hum(&found), None, "a mode at {hz} Hz of decay {decay} 1/s");
    }
}

#[test]
fn an_answer_that_wraps_round_a_periodic_record_is_no_hum() {
    // What is left of it at the record's end stands before the blow.
    let wrapped = |test: &Test| -> Vec<Hit> {
        let long = Test { samples: 4 * test.samples, ..test.clone() };
        let around = |hit_: &Hit| {
            let values = &hit_.responses()[0].values;
            let at = |i: usize| (0..4).map(|period| values[i + period * test.samples]).sum();
            hit(hit_.number(), hit_.force()[..test.samples].to_vec(), (0..test.samples).map(at).collect())
        };
        long.hits().iter().map(around).collect()
    };
    // A mode that is on the mains' frequency to a hundredth of a line, and hardly damped.
    let structure = Structure { modes: [(50.0, 0.05, 0.11), TWO_MODES.modes[1]], ..TWO_MODES };
    let test = Test { structure, ..Test::quiet(2, 4096) };
    let hits = wrapped(&Test { strengths: vec![80.0, 120.0], ..test });
    let found = Estimate::of(&hits, &EstimateOptions::default()).unwrap();
    assert_eq!(hum(&found), None);
}

#[test]
fn noise_alone_is_no_hum() {
    for seed in 0..100 {
        let found = Estimate::of(&noisy(seed).hits(), &EstimateOptions::default()).unwrap();
        assert_eq!(hum(&found), None, "seed {seed}");
    }
}
