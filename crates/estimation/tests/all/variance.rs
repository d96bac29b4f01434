//! Whether the stated variances are those of the FRFs, on average over lines, whatever the number of hits.

use crate::common::{TWO_MODES, Test};
use jointscope_estimation::{Estimate, EstimateOptions, Remark, ResponseWindow, Weighting};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

/// Mean of |H − truth|²/variance over the lines from 20 to 480 Hz of `tests` tests.
fn ratio(test: &Test, options: &EstimateOptions, tests: u64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for seed in 0..tests {
        let estimate = Estimate::of(&Test { seed, ..test.clone() }.hits(), options).unwrap();
        let hz = estimate.frfs.lines().hz();
        let variance = estimate.frfs.variance(0).unwrap();
        for line in (0..hz.len()).filter(|&l| (20.0..480.0).contains(&hz[l])) {
            let truth = TWO_MODES.frf(0.0, hz[line]);
            sum += (estimate.frfs.values(0)[line] - truth).norm_sqr() / variance[line];
            count += 1.0;
        }
    }
    sum / count
}

fn check(what: &str, ratio: f64, from: f64, to: f64) {
    println!("{what}: chi2 per degree of freedom {ratio:.3}");
    assert!((from..to).contains(&ratio), "{what}: {ratio}");
}

#[test]
fn stated_variances_are_right_on_average_from_two_hits_on() {
    for n in 2..=5 {
        let test = Test {
            response_noise: vec![0.02; n],
            force_noise: vec![0.02; n],
            strengths: (0..n).map(|k| 80.0 + 15.0 * k as f64).collect(),
            ..Test::quiet(n, 2048)
        };
        check(&format!("{n} hits of equal noise"), ratio(&test, &EstimateOptions::default(), 60), 0.94, 1.08);
    }
}

#[test]
fn hits_of_several_strengths_whose_noise_is_a_share_of_them_state_it_rightly_too() {
    for levels in
        [vec![30.0; 3], vec![30.0, 33.0, 160.0, 150.0], vec![30.0, 33.0, 160.0, 150.0, 500.0, 480.0]]
    {
        let n = levels.len();
        let share = |by: f64| levels.iter().map(|level| by * level).collect::<Vec<f64>>();
        let test = Test {
            response_noise: share(5e-4),
            force_noise: share(2e-4),
            strengths: levels.clone(),
            ..Test::quiet(n, 2048)
        };
        let auto = ratio(&test, &EstimateOptions::default(), 60);
        check(&format!("{n} hits, noise a share of their strength"), auto, 0.94, 1.08);
        let plain = EstimateOptions { weighting: Weighting::Plain, ..EstimateOptions::default() };
        check(&format!("the same, plain average of {n}"), ratio(&test, &plain, 60), 0.9, 1.15);
    }
}

#[test]
fn weights_by_noise_make_the_average_more_certain() {
    let levels = [30.0, 31.0, 32.0, 160.0, 150.0, 170.0, 500.0, 480.0, 460.0];
    let test = Test {
        response_noise: levels.map(|level| 5e-4 * level).to_vec(),
        force_noise: vec![0.0; 9],
        strengths: levels.to_vec(),
        ..Test::quiet(9, 2048)
    };
    let error = |weighting| {
        let options = EstimateOptions { weighting, ..EstimateOptions::default() };
        let estimate = Estimate::of(&test.hits(), &options).unwrap();
        let hz = estimate.frfs.lines().hz();
        let lines = (0..hz.len()).filter(|&l| (20.0..480.0).contains(&hz[l]));
        lines.map(|l| (estimate.frfs.values(0)[l] - TWO_MODES.frf(0.0, hz[l])).norm_sqr()).sum::<f64>()
    };
    let gain = error(Weighting::Plain) / error(Weighting::Auto);
    assert!((2.2..4.0).contains(&gain), "nine hits count as nine instead of about three: {gain}");
}

/// As [`ratio`], under an exponential window.
fn ratio_under(decay: f64, test: &Test) -> f64 {
    let options =
        EstimateOptions { response_window: ResponseWindow::Decay(decay), ..EstimateOptions::default() };
    let (mut sum, mut count) = (0.0, 0.0);
    for seed in 0..60 {
        let estimate = Estimate::of(&Test { seed, ..test.clone() }.hits(), &options).unwrap();
        let hz = estimate.frfs.lines().hz();
        let variance = estimate.frfs.variance(0).unwrap();
        for line in (0..hz.len()).filter(|&l| (20.0..480.0).contains(&hz[l])) {
            let truth = TWO_MODES.frf(decay, hz[line]);
            sum += (estimate.frfs.values(0)[line] - truth).norm_sqr() / variance[line];
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn a_window_leaves_the_variances_right() {
    // Under 14 1/s on one second the noise of some fourteen neighbouring lines is one.
    for (hits, decay) in [(4, 8.0), (3, 14.0), (4, 14.0), (6, 14.0)] {
        let noise = |share: f64| vec![share; hits];
        let test = Test { response_noise: noise(0.02), force_noise: noise(0.01), ..Test::quiet(hits, 2048) };
        check(&format!("{hits} hits under {decay} 1/s"), ratio_under(decay, &test), 0.96, 1.035);
    }
}

#[test]
fn a_single_hit_has_neither_coherence_nor_variance_and_says_what_that_costs() {
    let test = Test { response_noise: vec![0.02], ..Test::quiet(1, 2048) };
    let estimate = Estimate::of(&test.hits(), &EstimateOptions::default()).unwrap();
    assert_eq!((estimate.frfs.coherence(0), estimate.frfs.variance(0)), (None, None));
    assert_eq!(estimate.frfs.averages(0), Some(1));
    assert!(estimate.remarks.iter().any(|r| matches!(r, Remark::OneHit(_))), "{:?}", estimate.remarks);
}

/// Whoever fits something smooth to the FRFs sums errors over lines: the variance of that sum against what
/// lines of their own noise would make of it.
fn shared(options: &EstimateOptions, pick: impl Fn(&Estimate) -> FrfSet) -> f64 {
    let (tests, mut sum) = (60, 0.0);
    for seed in 0..tests {
        let test =
            Test { seed, response_noise: vec![0.02; 4], force_noise: vec![0.0; 4], ..Test::quiet(4, 4096) };
        let estimate = Estimate::of(&test.hits(), options).unwrap();
        let frfs = pick(&estimate);
        let (hz, variance) = (frfs.lines().hz(), frfs.variance(0).unwrap());
        let lines = (0..hz.len()).filter(|&l| (20.0..480.0).contains(&hz[l]));
        let error =
            |l: usize| (frfs.values(0)[l] - TWO_MODES.frf(estimate.decay, hz[l])) / variance[l].sqrt();
        let (total, count) = lines.fold((Complex64::ZERO, 0.0), |(s, n), l| (s + error(l), n + 1.0));
        sum += total.norm_sqr() / count;
    }
    sum / tests as f64
}

#[test]
fn of_lines_that_share_their_noise_under_a_window_or_by_zero_padding_one_is_used() {
    let windowed = |decay: f64, zero_padding: u32| EstimateOptions {
        response_window: if decay > 0.0 { ResponseWindow::Decay(decay) } else { ResponseWindow::None },
        zero_padding,
        ..EstimateOptions::default()
    };
    for (decay, padding) in [(0.0, 1), (4.0, 1), (0.0, 3)] {
        let options = windowed(decay, padding);
        let all = shared(&options, |estimate| estimate.frfs.clone());
        let what = format!("decay {decay}, padding {padding}");
        let usable = shared(&options, |estimate| estimate.usable().unwrap());
        println!("{what}, all lines: {all:.2}");
        assert!(all > 1.5 * usable || (decay, padding) == (0.0, 1), "{what}: all lines say as much: {all}");
        // What is the same on all lines is of the pulse's own instant, where the window's noise is loudest.
        check(&format!("{what}, usable lines"), usable, 0.8, 2.0);
    }
}

#[test]
fn h1_without_the_forces_noise_is_right_on_average_under_a_window_too() {
    // Noise of half a per cent of the blow: some per cent of the power of its spectrum within the band.
    let short_by = |decay: f64, unbiased: bool| {
        let (mut sum, mut count) = (0.0, 0.0);
        for seed in 0..60 {
            let test = Test {
                seed,
                force_noise: vec![1.0; 4],
                response_noise: vec![0.0; 4],
                ..Test::quiet(4, 4096)
            };
            let response_window =
                if decay > 0.0 { ResponseWindow::Decay(decay) } else { ResponseWindow::None };
            let options = EstimateOptions { response_window, unbiased, ..EstimateOptions::default() };
            let estimate = Estimate::of(&test.hits(), &options).unwrap();
            let frfs = estimate.usable().unwrap();
            let hz = frfs.lines().hz();
            for line in (0..hz.len()).filter(|&l| (20.0..480.0).contains(&hz[l])) {
                sum += 1.0 - (frfs.values(0)[line] / TWO_MODES.frf(estimate.decay, hz[line])).re;
                count += 1.0;
            }
        }
        sum / count
    };
    for decay in [0.0, 4.0] {
        let [textbook, unbiased] = [false, true].map(|unbiased| short_by(decay, unbiased));
        println!("decay {decay}: short by {textbook:.5}, without the force's noise by {unbiased:.5}");
        assert!(textbook > 5e-3 && unbiased.abs() < 0.15 * textbook, "{decay}: {textbook} {unbiased}");
    }
}
