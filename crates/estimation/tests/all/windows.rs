//! Windows, record lengths and what sensors measure.

use crate::common::{INTERVAL, TWO_MODES, Test, hit, pulse};
use jointscope_estimation::{Baseline, Estimate, EstimateOptions, ForceWindow, Remark, ResponseWindow};
use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_spectra::{Channel, FrfSet};
use proptest::prelude::*;

fn estimate(hits: &[Hit], options: &EstimateOptions) -> Estimate {
    Estimate::of(hits, options).unwrap()
}

/// Largest deviation from the FRF at s = decay + iω, relative to its largest value, over the lines that the
/// hammer excites.
fn deviation(found: &Estimate, decay: f64) -> f64 {
    let frfs: FrfSet = found.usable().unwrap();
    let lines = || frfs.values(0).iter().zip(frfs.lines().hz());
    let largest = lines().map(|(value, _)| value.norm()).fold(0.0, f64::max);
    let off = lines().map(|(value, hz)| (value - TWO_MODES.frf(decay, *hz)).norm()).fold(0.0, f64::max);
    off / largest
}

fn windowed(window: ResponseWindow) -> EstimateOptions {
    EstimateOptions { response_window: window, ..EstimateOptions::default() }
}

#[test]
fn a_record_that_has_died_away_gives_the_frf_to_rounding() {
    let found = estimate(&Test::quiet(2, 8192).hits(), &EstimateOptions::default());
    assert!(deviation(&found, 0.0) < 1e-12, "{}", deviation(&found, 0.0));
    assert!(found.remarks.is_empty(), "{:?}", found.remarks);
}

#[test]
fn under_an_exponential_window_the_frf_is_exactly_the_structures_beside_the_imaginary_axis() {
    // After 0.46 s the slower mode is still at e^-4.1 = 1.6 %.
    let hits = Test::quiet(2, 1024).hits();
    let plain = estimate(&hits, &EstimateOptions::default());
    assert!(deviation(&plain, 0.0) > 5e-3, "leakage: {}", deviation(&plain, 0.0));
    assert!(
        plain.remarks.iter().any(|r| matches!(r, Remark::StillRinging { window: None, .. })),
        "{:?}",
        plain.remarks
    );
    let found = estimate(&hits, &windowed(ResponseWindow::Decay(40.0)));
    assert_eq!(found.decay, 40.0);
    assert!(deviation(&found, 40.0) < 1e-8, "{}", deviation(&found, 40.0));
    assert!(deviation(&found, 0.0) > 0.1, "it is not the FRF at iω");
}

#[test]
fn a_window_on_demand_is_put_on_only_where_the_record_ends_too_early() {
    let long = estimate(&Test::quiet(2, 8192).hits(), &windowed(ResponseWindow::Auto));
    assert_eq!(long.decay, 0.0);
    let short = estimate(&Test::quiet(2, 1024).hits(), &windowed(ResponseWindow::Auto));
    assert!((5.0..20.0).contains(&short.decay), "{}", short.decay);
    assert!(deviation(&short, short.decay) < 3e-4, "{}", deviation(&short, short.decay));
    let is_of_window =
        |r: &Remark| matches!(r, Remark::Window(_) | Remark::StillRinging { window: Some(_), .. });
    assert!(short.remarks.iter().any(is_of_window), "{:?}", short.remarks);
}

#[test]
fn a_force_window_takes_the_forces_noise_and_leaves_the_frf() {
    let test = Test { force_noise: vec![0.5; 3], ..Test::quiet(3, 8192) };
    let off = |window| {
        let options = EstimateOptions { force_window: window, ..EstimateOptions::default() };
        let found = estimate(&test.hits(), &options);
        (deviation(&found, 0.0), found.excitations[0].h1_bias)
    };
    let (plain, windowed) = (off(ForceWindow::None), off(ForceWindow::Auto));
    assert!(windowed.0 < 0.3 * plain.0 && windowed.1 < 0.05 * plain.1, "{plain:?} {windowed:?}");
    let quiet = Test::quiet(2, 8192).hits();
    for seconds in [0.02, 1e3, 1e16, f64::MAX] {
        let options =
            EstimateOptions { force_window: ForceWindow::Length(seconds), ..EstimateOptions::default() };
        assert!(deviation(&estimate(&quiet, &options), 0.0) < 1e-12, "{seconds} s");
    }
}

#[test]
fn velocity_and_displacement_sensors_give_the_same_accelerance() {
    // Sampled sines of a steady kind: signals whose spectra are s and s² apart by their making.
    let force = pulse(4096, 80, 4, 100.0);
    let displacement = TWO_MODES.answer(&force);
    let with = |motion| {
        let response = Response::new(Channel::transverse("4"), motion, displacement.clone());
        let hit =
            |n| Hit::new(n, INTERVAL, 0.0, Channel::transverse("1"), force.clone(), vec![response.clone()]);
        estimate(&[hit(1).unwrap(), hit(2).unwrap()], &windowed(ResponseWindow::Decay(10.0))).frfs
    };
    let [raw, once, twice] =
        [MeasuredMotion::Acceleration, MeasuredMotion::Velocity, MeasuredMotion::Displacement].map(with);
    for line in [5, 300, 1500] {
        let s = num_complex::Complex64::new(10.0, raw.lines().omega(line));
        let value = raw.values(0)[line];
        assert!((once.values(0)[line] - s * value).norm() < 1e-12 * (s * value).norm());
        assert!((twice.values(0)[line] - s * s * value).norm() < 1e-12 * (s * s * value).norm());
    }
}

#[test]
fn zero_padding_puts_lines_between_and_moves_none() {
    let hits = Test::quiet(2, 4096).hits();
    let plain = estimate(&hits, &EstimateOptions::default()).frfs;
    let padded = estimate(&hits, &EstimateOptions { zero_padding: 3, ..EstimateOptions::default() });
    assert_eq!(padded.frfs.lines().len(), 3 * 2048 + 1);
    for line in [1, 100, 2000] {
        assert!((padded.frfs.values(0)[3 * line] - plain.values(0)[line]).norm() < 1e-9);
    }
    assert!(padded.remarks.contains(&Remark::ZeroPadding(3)), "{:?}", padded.remarks);
}

#[test]
fn offsets_change_no_line_above_0_hz() {
    let plain = Test::quiet(2, 4096).hits();
    let shifted: Vec<Hit> = plain
        .iter()
        .map(|h| {
            let force = h.force().iter().map(|f| f + 3.0).collect();
            hit(h.number(), force, h.responses()[0].values.iter().map(|v| v - 0.8).collect())
        })
        .collect();
    let options = windowed(ResponseWindow::Decay(5.0));
    let [a, b] = [&plain, &shifted].map(|hits| estimate(hits, &options).frfs);
    let off = a.all_values().iter().zip(b.all_values()).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(off < 1e-6, "{off}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    #[test]
    fn records_of_any_length_give_the_frf(samples in 6_000usize..9_000) {
        let found = estimate(&Test::quiet(2, samples).hits(), &EstimateOptions::default());
        prop_assert_eq!(found.frfs.lines().len(), samples / 2 + 1);
        prop_assert!(deviation(&found, 0.0) < 1e-9);
    }
}

#[test]
fn a_window_on_demand_leaves_no_more_of_a_record_that_ends_nearly_quiet() {
    // After 0.7 s the slower mode is at e^-6.3 = 0.18 %: nobody sees that, and it bends peaks by as much.
    let hits = Test::quiet(2, 1520).hits();
    let plain = estimate(&hits, &EstimateOptions::default());
    assert!(deviation(&plain, 0.0) > 5e-4, "{}", deviation(&plain, 0.0));
    assert!(plain.remarks.is_empty(), "{:?}", plain.remarks);
    let found = estimate(&hits, &windowed(ResponseWindow::Auto));
    assert!((1.0..8.0).contains(&found.decay), "{}", found.decay);
    assert!(deviation(&found, found.decay) < 2e-4, "{}", deviation(&found, found.decay));
}

#[test]
fn a_hit_without_its_baselines_is_the_same_wherever_amplifiers_rested() {
    let clean = Test::quiet(1, 4096).hits().remove(0);
    let moved = |by: f64, values: &[f64]| values.iter().map(|v| v + by).collect::<Vec<f64>>();
    let resting = |by: f64| hit(7, moved(2.0 * by, clean.force()), moved(-by, &clean.responses()[0].values));
    let prepared = |hits: &[Hit], baseline: Baseline| {
        estimate(hits, &EstimateOptions { baseline, ..EstimateOptions::default() }).prepared(hits)
    };
    let [settled, other] = [0.0, 3.0].map(|by| prepared(&[resting(by)], Baseline::Offset).remove(0));
    assert_eq!((other.number(), other.struck()), (7, clean.struck()));
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart(settled.force(), other.force()) < 1e-12 * clean.peak_force());
    assert!(apart(&settled.responses()[0].values, &other.responses()[0].values) < 1e-12 * 100.0);
    assert!(apart(settled.force(), clean.force()) < 1e-12, "nothing moves before the blow");
    assert_eq!(prepared(&[resting(3.0)], Baseline::Keep), [resting(3.0)]);
}
