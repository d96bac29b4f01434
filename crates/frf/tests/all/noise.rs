//! Variances: where they come from, that no form of the FRFs changes them, and what is done about dips of the
//! force.

use crate::common::{accelerances, mode};
use jointscope_frf::noise::{NoiseSource, from_scatter, of_lines, smoothed, with_variances};
use jointscope_samples::Noise;
use jointscope_spectra::{FrfForm, FrfSet, SpectralLines};
use num_complex::Complex64;

fn lines() -> SpectralLines {
    SpectralLines::even(5.0, 2.5, 300).unwrap()
}

/// One noisy FRF whose noise is `variance`, with the coherence that `averages` hits of it have, over and
/// over.
fn noisy(variance: f64, averages: u32) -> FrfSet {
    let mut random = Noise::from_state(5);
    let mut coherence = Vec::new();
    let mut set = accelerances(&lines(), &[("4", "1")], |_, hz| {
        let hits: Vec<Complex64> = (0..averages)
            .map(|_| mode(hz, 350.0, 0.02) + random.complex(variance * f64::from(averages)))
            .collect();
        let mean = hits.iter().sum::<Complex64>() / f64::from(averages);
        let power = hits.iter().map(|hit| hit.norm_sqr()).sum::<f64>() / f64::from(averages);
        coherence.push(mean.norm_sqr() / power);
        mean
    });
    set.set_coherence(0, coherence).unwrap();
    set
}

#[test]
fn the_noise_of_an_frf_is_the_same_in_every_form() {
    let mut stated = noisy(1e-4, 6);
    stated.set_averages(0, Some(6));
    let scattered =
        FrfSet::new(lines(), FrfForm::Accelerance, stated.pairs().to_vec(), stated.all_values().to_vec());
    for set in [stated, scattered.unwrap()] {
        let (expected, sources) = with_variances(&set).unwrap();
        for form in [FrfForm::Mobility, FrfForm::Receptance] {
            let (found, again) = with_variances(&set.to_form(form).unwrap()).unwrap();
            let back = found.to_form(FrfForm::Accelerance).unwrap();
            assert_eq!(sources, again);
            for (line, (found, expected)) in
                back.variance(0).unwrap().iter().zip(expected.variance(0).unwrap()).enumerate()
            {
                assert!((found / expected - 1.0).abs() < 1e-6, "{form:?} {line}: {found} for {expected}");
            }
        }
    }
}

#[test]
fn a_recording_says_where_its_variances_come_from() {
    let mut set = noisy(1e-4, 6);
    let mean = |set: &FrfSet| {
        let (with, sources) = with_variances(set).unwrap();
        let variance = with.variance(0).unwrap();
        (variance.iter().sum::<f64>() / variance.len() as f64, sources[0])
    };
    let (by_scatter, source) = mean(&set);
    assert_eq!((source, source.is_by_scatter()), (NoiseSource::CoherenceAlone, true));
    set.set_averages(0, Some(6));
    let (stated, source) = mean(&set);
    assert_eq!((source, source.is_by_scatter()), (NoiseSource::Coherence, false));
    assert!((stated / 1e-4 - 1.0).abs() < 0.1, "{stated}");
    assert!((by_scatter / stated - 1.0).abs() < 0.3, "six averages are told: {by_scatter} for {stated}");
    // One average states no noise: its coherence is 1 whatever the noise.
    set.set_averages(0, Some(1));
    let (alone, source) = mean(&set);
    assert_eq!((source, source.is_by_scatter()), (NoiseSource::Scatter, true));
    assert!((alone / 1e-4 - 1.0).abs() < 0.3, "{alone}");
    set.set_averages(0, Some(2));
    assert_eq!(mean(&set).1, NoiseSource::Coherence);
    // A coherence that says nothing of the scatter is left aside: the noise is 100,000 times what it would be
    // of two averages.
    set.set_averages(0, None);
    for coherence in [vec![1.0; 300], vec![0.0; 300], vec![1.0 - 1e-9; 300]] {
        set.set_coherence(0, coherence).unwrap();
        assert_eq!(mean(&set).1, NoiseSource::Scatter);
    }
    let words: Vec<&str> = [NoiseSource::Coherence, NoiseSource::CoherenceAlone, NoiseSource::Scatter]
        .map(NoiseSource::says)
        .to_vec();
    assert_eq!(words, ["coherence and averages", "coherence, averages by scatter", "scatter over the lines"]);
}

#[test]
fn a_line_states_its_noise_by_coherence_and_averages() {
    let values = [Complex64::new(3.0, 4.0)];
    let variance = |gamma2: f64, averages| of_lines(&values, &[gamma2], averages)[0];
    assert!((variance(0.8, 6) - 25.0 * 0.2 / (5.0 * 0.8)).abs() < 1e-12);
    assert_eq!(variance(1.0, 6), 0.0);
    assert_eq!(variance(0.8, 0), variance(0.8, 2));
    assert!((variance(0.0, 2) / 25e6 - 1.0).abs() < 1e-5, "no coherence is no information, and no infinity");
}

#[test]
fn where_the_force_dips_the_same_noise_of_the_sensor_counts_for_more() {
    // The sensor's noise is 1e-4 of the strongest line's force; on every third line the hammer gives a
    // hundredth of that power.
    let power = |line: usize| if line.is_multiple_of(3) { 0.02 } else { 2.0 };
    let mut random = Noise::from_state(6);
    let (mut values, mut raw) = (Vec::new(), Vec::new());
    for line in 0..3000 {
        let variance = 1e-4 * 2.0 / power(line);
        values.push(Complex64::ONE + random.complex(variance));
        raw.push(random.complex(variance).norm_sqr());
    }
    let force: Vec<f64> = (0..3000).map(power).collect();
    let smooth = smoothed(&values, &raw, &[1.0; 3000], &force, 1.0);
    for line in 0..3000 {
        let ratio = smooth[line] * power(line) / 2e-4;
        assert!((0.25..2.5).contains(&ratio), "line {line}: {ratio}");
    }
    let mean = (0..3000).map(|line| smooth[line] * power(line) / 2e-4).sum::<f64>() / 3000.0;
    assert!((mean - 1.0).abs() < 0.05, "{mean}");
    // No force at all on any line is a force that is the same on all.
    assert_eq!(
        smoothed(&values, &raw, &[1.0; 3000], &[0.0; 3000], 1.0),
        smoothed(&values, &raw, &[1.0; 3000], &[], 1.0)
    );
}

#[test]
fn lines_without_coherence_lend_their_noise_to_nobody() {
    let values = vec![Complex64::ONE; 200];
    let (mut raw, mut coherence) = (vec![1e-4; 200], vec![0.9; 200]);
    for line in 90..110 {
        (raw[line], coherence[line]) = (7.0, 0.0);
    }
    let smooth = smoothed(&values, &raw, &coherence, &[], 1.0);
    assert!(smooth.iter().all(|variance| (variance / 1e-4 - 1.0).abs() < 1e-6), "{smooth:?}");
    assert!(smoothed(&values, &raw, &[0.0; 200], &[], 1.0).iter().all(|v| *v > 0.0 && *v < 1e-9));
}

#[test]
fn lines_that_tell_the_same_are_averaged_over_more_of_them() {
    let mut random = Noise::from_state(7);
    let values = vec![Complex64::ONE; 2000];
    let raw: Vec<f64> = (0..2000).map(|_| random.complex(1.0).norm_sqr()).collect();
    let spread = |alike| {
        let smooth = smoothed(&values, &raw, &[1.0; 2000], &[], alike);
        smooth[200..1800].iter().map(|v| (v - 1.0).powi(2)).sum::<f64>() / 1600.0
    };
    // A mean of 51 lines scatters by 1/√51, one of 201 by half of that.
    assert!((spread(1.0) * 51.0 - 1.0).abs() < 0.5, "{}", spread(1.0) * 51.0);
    assert!((spread(4.0) * 201.0 - 1.0).abs() < 0.6, "{}", spread(4.0) * 201.0);
    assert_eq!(spread(0.2), spread(1.0));
}

#[test]
fn scatter_is_told_from_eleven_lines_on_in_any_unit_and_a_hundredth_of_the_loudest_is_taken_below() {
    let hz: Vec<f64> = (1..=60).map(f64::from).collect();
    let mut random = Noise::from_state(8);
    let values: Vec<Complex64> =
        hz.iter().map(|hz| Complex64::from(0.1 * hz) + random.complex(1e-6)).collect();
    for lines in [3, 8, 10] {
        let loudest = values[lines - 1].norm_sqr();
        let taken = from_scatter(&hz[..lines], &values[..lines]);
        assert!(taken.iter().all(|v| (v / (1e-4 * loudest) - 1.0).abs() < 1e-12), "{lines} lines: {taken:?}");
    }
    let of_eleven = from_scatter(&hz[..11], &values[..11]);
    assert!(of_eleven.iter().all(|v| (1e-8..1e-4).contains(v)), "{of_eleven:?}");
    let expected = from_scatter(&hz, &values);
    for scale in [1e-12, 1e9] {
        let scaled: Vec<Complex64> = values.iter().map(|value| value * scale).collect();
        for (found, expected) in from_scatter(&hz, &scaled).iter().zip(&expected) {
            assert!((found / (scale * scale * expected) - 1.0).abs() < 1e-6, "{scale}: {found}");
        }
    }
}
