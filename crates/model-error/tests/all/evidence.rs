//! Evidence, and the sizes of a model's error at their most probable.

use crate::common::*;
use jointscope_model_error::{ErrorSizes, KINDS, Linear, SizePrior};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Ten masses in a row with nine modes, at two responses, compared with the model that made them.
static NINE: LazyLock<Compared> = LazyLock::new(|| {
    let fixture = chain(10);
    let recorded =
        Recorded::of(&fixture, &pairs(&[("1", "1"), ("2", "1")]), &lines(800.0), noise(None)).modes();
    let compared = Compared::of(&fixture, recorded);
    assert_eq!(compared.pairing.pairs.len(), 9, "modes of the chain that are compared");
    compared
});

/// Differences drawn from the noise of the nine modes' features, the frequencies' with an error besides.
fn drawn(frequency_error: f64, seed: u64) -> Linear {
    let n = NINE.comparison.count();
    let sizes = ErrorSizes::from_array([0.0; 8]);
    let covariance = NINE.covariance(&ErrorSizes { frequency: frequency_error, ..sizes });
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let white: Vec<f64> = (0..n).map(|_| normal(&mut random)).collect();
    let factor = lower(n, &covariance);
    let difference = (0..n).map(|i| (0..=i).map(|j| factor[i * n + j] * white[j]).sum()).collect();
    Linear { difference, slopes: Vec::new() }
}

/// L of S = L·Lᵀ.
fn lower(n: usize, s: &[f64]) -> Vec<f64> {
    let mut l = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let before: f64 = (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum();
            let left = s[i * n + j] - before;
            l[i * n + j] = if i == j { left.sqrt() } else { left / l[j * n + j] };
        }
    }
    l
}

#[test]
fn the_size_of_a_frequency_error_is_found() {
    let prior = ErrorSizes::default();
    let mut squares = 0.0;
    const DRAWS: u64 = 20;
    for seed in 0..DRAWS {
        let size = drawn(0.003, seed).evidence(&NINE.comparison, &prior, None).unwrap().sizes.frequency;
        // Nine modes tell a deviation to a quarter of it.
        assert!(
            (0.001..0.006).contains(&size),
            "draw {seed}: error of frequency {:.3} %, drawn with 0.3 %",
            100.0 * size
        );
        squares += size * size;
    }
    let size = (squares / DRAWS as f64).sqrt();
    println!("error of frequency {:.3} %, drawn with 0.3 %", 100.0 * size);
    assert!((0.0025..0.0035).contains(&size), "error of frequency {:.3} %, drawn with 0.3 %", 100.0 * size);
}

#[test]
fn without_an_error_sizes_go_to_their_least() {
    let prior = ErrorSizes::default();
    let nothing = Linear { difference: vec![0.0; NINE.comparison.count()], slopes: Vec::new() };
    let sizes = nothing.evidence(&NINE.comparison, &prior, None).unwrap().sizes;
    for (size, prior) in sizes.to_array().iter().zip(prior.to_array()) {
        assert!((size / prior - 1e-3).abs() < 1e-9, "size {size} of prior {prior}: {sizes:?}");
    }
    let noise = drawn(0.0, 1).evidence(&NINE.comparison, &prior, None).unwrap().sizes;
    assert!(noise.frequency < 1e-4, "error of frequency {:.4} % of noise alone", 100.0 * noise.frequency);
}

#[test]
fn an_error_of_one_kind_is_not_taken_for_another() {
    let prior = ErrorSizes::default();
    let sizes = drawn(0.003, 3).evidence(&NINE.comparison, &prior, None).unwrap().sizes;
    assert!(sizes.damping < 0.5 * prior.damping && sizes.shape < 0.5 * prior.shape, "{sizes:?}");
}

#[test]
fn the_sizes_found_are_the_most_probable_ones() {
    let prior = ErrorSizes::default();
    let linear = drawn(0.004, 5);
    let best = linear.evidence(&NINE.comparison, &prior, None).unwrap();
    let value = |sizes: &ErrorSizes| {
        let squares = sizes.to_array().into_iter().zip(prior.to_array()).map(|(s, p)| (s / p).powi(2));
        // Half-normal, and half-Cauchy for the gain, the last.
        let prior = squares.enumerate().map(|(kind, s)| if kind == 6 { -(1.0 + s).ln() } else { -0.5 * s });
        linear.ln_density(&NINE.comparison, sizes).unwrap() + prior.sum::<f64>()
    };
    assert!((value(&best.sizes) - best.ln).abs() < 1e-9, "{} against {}", value(&best.sizes), best.ln);
    for kind in 0..7 {
        for times in [0.05, 0.3, 0.7, 0.9, 1.1, 1.4, 3.0, 20.0] {
            let mut sizes = best.sizes.to_array();
            sizes[kind] = (sizes[kind] * times).max(1e-3 * prior.to_array()[kind]);
            let gain = value(&ErrorSizes::from_array(sizes)) - best.ln;
            assert!(gain < 0.02, "size {kind} times {times} gains {gain:.3} nats from {:?}", best.sizes);
        }
    }
}

#[test]
fn a_search_that_sets_out_elsewhere_ends_there_too() {
    let prior = ErrorSizes::default();
    let linear = drawn(0.003, 7);
    let cold = linear.evidence(&NINE.comparison, &prior, None).unwrap();
    for times in [1e-3, 0.1, 1.0, 10.0] {
        let start = ErrorSizes::from_array(prior.to_array().map(|s| times * s));
        let warm = linear.evidence(&NINE.comparison, &prior, Some(&start)).unwrap();
        assert!((warm.ln - cold.ln).abs() < 0.05, "from {times} of the prior: {:?} against {:?}", warm, cold);
    }
}

#[test]
fn what_a_recording_does_not_tell_keeps_its_prior() {
    // A parameter that moves each damping ratio at will leaves nothing to tell an error of damping from.
    let (prior, n) = (ErrorSizes::default(), NINE.comparison.count());
    let slope = |k: usize| (0..n).map(|i| if i == 2 * k + 1 { 1e3 } else { 0.0 }).collect();
    let linear = Linear { difference: vec![0.0; n], slopes: (0..9).map(slope).collect() };
    let best = linear.evidence(&NINE.comparison, &prior, None).unwrap();
    let mean = linear.mean_sizes(&NINE.comparison, &prior, &best);
    // The root mean square of a half-normal distribution is its scale.
    assert!(
        (mean.damping / prior.damping - 1.0).abs() < 0.02,
        "error of damping {}, prior {}",
        mean.damping,
        prior.damping
    );
    assert!(mean.frequency < 0.1 * prior.frequency, "frequencies are told: {}", mean.frequency);
}

#[test]
fn intervals_hold_the_size_of_a_frequency_error_as_often_as_they_say() {
    let prior = ErrorSizes::default();
    const DRAWS: u64 = 40;
    let holds = |seed: &u64| {
        let linear = drawn(0.003, *seed);
        let best = linear.evidence(&NINE.comparison, &prior, None).unwrap();
        let [low, high] = linear.size_interval(&NINE.comparison, &prior, &best, 0);
        assert!(low <= best.sizes.frequency && best.sizes.frequency <= high, "draw {seed}: {low} to {high}");
        low <= 0.003 && 0.003 <= high
    };
    let count = (0..DRAWS).filter(holds).count();
    assert!(count >= 34, "{count} of {DRAWS} intervals of 95 % hold the size drawn with");
}

#[test]
fn the_interval_of_an_error_that_is_not_there_begins_at_zero() {
    let prior = ErrorSizes::default();
    let linear = drawn(0.0, 1);
    let best = linear.evidence(&NINE.comparison, &prior, None).unwrap();
    let [low, high] = linear.size_interval(&NINE.comparison, &prior, &best, 0);
    assert!(low == 0.0 && high > 0.0 && high < prior.frequency, "{low} to {high}");
}

#[test]
fn a_stated_size_stays_whatever_the_recording_says() {
    let scales = ErrorSizes { frequency: 0.01, ..ErrorSizes::default() };
    let mut stated = [false; KINDS];
    stated[0] = true;
    let prior = SizePrior { scales, stated };
    let linear = drawn(0.003, 3);
    for start in [None, Some(&ErrorSizes::default())] {
        let best = linear.evidence(&NINE.comparison, prior, start).unwrap();
        assert_eq!(best.sizes.frequency, 0.01);
        assert_eq!(linear.mean_sizes(&NINE.comparison, prior, &best).frequency, 0.01);
        assert_eq!(linear.size_interval(&NINE.comparison, prior, &best, 0), [0.01; 2]);
        // A size that is known is no surprise: the density at it is all that counts.
        let density = linear.ln_density(&NINE.comparison, &best.sizes).unwrap();
        let others = best.sizes.to_array().into_iter().zip(scales.to_array()).skip(1).take(5);
        let surprise: f64 = others.map(|(size, scale)| 0.5 * (size / scale).powi(2)).sum();
        assert!((best.ln - density + surprise).abs() < 1e-3, "{} {density} {surprise}", best.ln);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn the_density_is_the_normal_one(
        times in prop::array::uniform8(0.0..3.0f64),
        values in prop::collection::vec(-0.01..0.01f64, 64),
        slopes in prop::collection::vec(prop::collection::vec(-0.01..0.01f64, 64), 0..3),
    ) {
        let n = NINE.comparison.count();
        let sized = |values: &[f64]| -> Vec<f64> { (0..n).map(|k| values[k % 64]).collect() };
        let prior = ErrorSizes::default().to_array();
        let sizes = ErrorSizes::from_array(std::array::from_fn(|k| times[k] * prior[k]));
        let linear = Linear { difference: sized(&values), slopes: slopes.iter().map(|s| sized(s)).collect() };
        let mut covariance = NINE.covariance(&sizes);
        for slope in &linear.slopes {
            for i in 0..n {
                for j in 0..n {
                    covariance[i * n + j] += slope[i] * slope[j];
                }
            }
        }
        let (chi2, ln_determinant) = chi2_and_ln_determinant(&covariance, &linear.difference);
        let expected = -0.5 * (chi2 + ln_determinant + n as f64 * TAU.ln());
        let found = linear.ln_density(&NINE.comparison, &sizes).unwrap();
        prop_assert!((found - expected).abs() < 1e-6 * expected.abs().max(chi2), "ln p {found}, expected {expected}");
    }
}
