//! Variances of FRFs against noise that is known, since it was added here: errors divided by their deviations
//! must have a variance of one.

use super::smoothing::smoothed;
use super::*;
use jointscope_samples::Noise;

fn resonance(line: usize) -> Complex64 {
    let x = line as f64 / 400.0;
    let square = |v: f64| v * v;
    -square(x) / (Complex64::new(square(0.37) - square(x), 2.0 * 0.01 * 0.37 * x))
}

/// Hits of one FRF: H1 and coherence of `n` averages with response noise `floor` and force noise `share`.
fn measure(random: &mut Noise, truth: Complex64, n: u32, floor: f64, share: f64) -> (Complex64, f64) {
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, Complex64::ZERO);
    for _ in 0..n {
        let x = Complex64::ONE + random.complex(share);
        let y = truth + random.complex(floor);
        xx += x.norm_sqr();
        yy += y.norm_sqr();
        xy += y * x.conj();
    }
    (xy / xx, xy.norm_sqr() / (xx * yy))
}

#[test]
fn smoothed_variances_of_few_averages_normalise_the_errors_to_one() {
    for averages in [5, 8, 20] {
        let mut random = Noise::from_state(averages as u64);
        let (mut chi2, mut count) = (0.0, 0.0);
        for _ in 0..20 {
            let lines: Vec<(Complex64, f64)> =
                (1..401).map(|l| measure(&mut random, resonance(l), averages, 1e-2, 1e-5)).collect();
            let values: Vec<Complex64> = lines.iter().map(|l| l.0).collect();
            let coherence: Vec<f64> = lines.iter().map(|l| l.1).collect();
            let variance = from_coherence(&values, &coherence, averages);
            for (i, v) in variance.iter().enumerate() {
                chi2 += (values[i] - resonance(i + 1)).norm_sqr() / v;
                count += 1.0;
            }
        }
        let ratio = chi2 / count;
        assert!((0.93..1.07).contains(&ratio), "{averages} averages: chi2 per degree of freedom {ratio}");
    }
}

/// Soft mounts: the first lines of the band lie below a resonance a thousand times as loud.
#[test]
fn quiet_lines_beside_a_loud_resonance_are_not_taken_for_known_exactly() {
    let suspended = |line: usize| {
        let x = line as f64 / 30.0;
        -x * x / Complex64::new(1.0 - x * x, 2.0 * 0.005 * x)
    };
    let floor = 1e-3;
    for seed in 0..100 {
        let mut random = Noise::from_state(seed);
        let lines: Vec<(Complex64, f64)> =
            (1..401).map(|l| measure(&mut random, suspended(l), 4, floor, 1e-4)).collect();
        let values: Vec<Complex64> = lines.iter().map(|l| l.0).collect();
        let coherence: Vec<f64> = lines.iter().map(|l| l.1).collect();
        let of_lines: Vec<f64> = lines.iter().map(|(h, c)| (1.0 - c) / (3.0 * c) * h.norm_sqr()).collect();
        let variance = smoothed(&values, &of_lines, &coherence, &[], 4.0);
        let least = variance.iter().copied().fold(f64::INFINITY, f64::min) / (floor / 4.0);
        assert!(least > 0.1, "seed {seed}: {least} of the noise's variance");
    }
}

#[test]
fn without_coherence_the_scatter_of_the_lines_gives_the_floor() {
    let mut random = Noise::from_state(7);
    let (mut chi2, mut count) = (0.0, 0.0);
    for _ in 0..20 {
        let values: Vec<Complex64> = (1..401).map(|l| resonance(l) + random.complex(1e-4)).collect();
        for (i, v) in from_scatter(&hz(400), &values).iter().enumerate() {
            chi2 += (values[i] - resonance(i + 1)).norm_sqr() / v;
            count += 1.0;
        }
    }
    let ratio: f64 = chi2 / count;
    assert!((0.8..1.2).contains(&ratio), "{ratio}");
}

fn hz(count: usize) -> Vec<f64> {
    (1..=count).map(|l| l as f64).collect()
}

/// A peak whose half-width is a third of a line's distance, noise a share of |H|.
#[test]
fn without_coherence_noise_that_grows_with_a_sharp_peak_is_seen_on_the_peak_too() {
    let sharp = |line: usize| {
        let x = line as f64;
        -x * x / Complex64::new(130.3 * 130.3 - x * x, 2.0 * 0.3 * x)
            - 0.7 * x * x / Complex64::new(341.6 * 341.6 - x * x, 0.5 * x)
    };
    let mut random = Noise::from_state(11);
    let (mut all, mut peak) = ((0.0, 0.0), (0.0, 0.0));
    for _ in 0..40 {
        let values: Vec<Complex64> =
            (1..401).map(|l| sharp(l) * (1.0 + random.complex(1e-4)) + random.complex(1e-6)).collect();
        for (i, v) in from_scatter(&hz(400), &values).iter().enumerate() {
            let chi2 = (values[i] - sharp(i + 1)).norm_sqr() / v;
            let near = (i as f64 + 1.0 - 130.3).abs() < 4.0;
            let sum = if near { &mut peak } else { &mut all };
            *sum = (sum.0 + chi2, sum.1 + 1.0);
        }
    }
    let ratios = [all.0 / all.1, peak.0 / peak.1];
    assert!(ratios.iter().all(|r| (0.8f64..1.3).contains(r)), "away from and on the peak: {ratios:?}");
}

#[test]
fn a_noiseless_frf_keeps_a_positive_variance() {
    let values: Vec<Complex64> = (1..100).map(resonance).collect();
    assert!(from_coherence(&values, &vec![1.0; 99], 5).iter().all(|v| *v > 0.0 && v.is_finite()));
    assert!(from_scatter(&hz(values.len()), &values).iter().all(|v| *v > 0.0 && v.is_finite()));
    assert!(from_scatter(&hz(3), &values[..3]).iter().all(|v| *v > 0.0));
}

/// A soft tip's blow, a half sine whose spectrum has its first zero within the band, as share of its force at
/// 0 Hz.
fn soft(line: usize) -> f64 {
    let a = 1.5 * line as f64 / 250.0;
    ((std::f64::consts::PI * a).cos() / (1.0 - 4.0 * a * a)).abs().max(0.03)
}

#[test]
fn where_the_force_dies_away_within_the_band_errors_are_normalised_to_one_all_the_same() {
    for averages in [5, 10] {
        let mut random = Noise::from_state(40 + u64::from(averages));
        // χ² and number of lines, where the blow is strong and where it is weak.
        let mut sums = [(0.0, 0.0); 2];
        for _ in 0..40 {
            let blow = |l: usize, random: &mut Noise| {
                let share = soft(l);
                measure(random, resonance(l), averages, 1e-4 / (share * share), 1e-9)
            };
            let lines: Vec<(Complex64, f64)> = (1..401).map(|l| blow(l, &mut random)).collect();
            let (values, coherence): (Vec<Complex64>, Vec<f64>) = lines.into_iter().unzip();
            for (i, v) in from_coherence(&values, &coherence, averages).iter().enumerate() {
                let sum = &mut sums[usize::from(soft(i + 1) < 0.1)];
                sum.0 += (values[i] - resonance(i + 1)).norm_sqr() / v;
                sum.1 += 1.0;
            }
        }
        for (chi2, count) in sums {
            let ratio: f64 = chi2 / count;
            assert!((0.93..1.07).contains(&ratio), "{averages} averages: chi2 per degree of freedom {ratio}");
        }
    }
}
