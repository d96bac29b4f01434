//! A sampled signal between its samples.

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

/// The band-limited signal through `samples`, at `factor` instants an interval from the first sample on: sampling says nothing of what lies
/// above half of its rate. The signal is taken to begin and end at rest.
pub(crate) fn oversampled(samples: &[f64], factor: usize) -> Vec<f64> {
    filtered(samples, factor, |_| 1.0)
}

/// As [`oversampled`], raised so that straight lines drawn between the instants have the spectrum of the signal: drawing them lowers a line of
/// angular frequency ω by (sin x/x)², x = ωh/2.
pub(crate) fn oversampled_for_lines(samples: &[f64], factor: usize) -> Vec<f64> {
    filtered(samples, factor, |x| if x > 0.0 { (x / x.sin()).powi(2) } else { 1.0 })
}

fn filtered(samples: &[f64], factor: usize, gain: impl Fn(f64) -> f64) -> Vec<f64> {
    let n = samples.len();
    if factor == 0 || n < 2 {
        return samples.to_vec();
    }
    let mut planner = RealFftPlanner::<f64>::new();
    let forward = planner.plan_fft_forward(n);
    let backward = planner.plan_fft_inverse(n * factor);
    let mut values = samples.to_vec();
    let mut spectrum = forward.make_output_vec();
    let mut fine = backward.make_output_vec();
    let mut wide = backward.make_input_vec();
    // Buffers made by the plans are of the right size.
    if forward.process(&mut values, &mut spectrum).is_err() {
        return samples.to_vec();
    }
    for (line, (to, from)) in wide.iter_mut().zip(&spectrum).enumerate() {
        *to = from * (gain(std::f64::consts::PI * line as f64 / (n * factor) as f64) / n as f64);
    }
    if n.is_multiple_of(2) && factor > 1 {
        // The line at half the rate stands for both its sides.
        wide[n / 2] = Complex::new(wide[n / 2].re * 0.5, 0.0);
    }
    wide[0].im = 0.0;
    if backward.process(&mut wide, &mut fine).is_err() {
        return samples.to_vec();
    }
    fine
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_pulse_is_met_between_its_samples_and_on_them() {
        let pulse = |t: f64| (-0.5 * ((t - 40.0) / 2.0).powi(2)).exp();
        for n in [90, 91] {
            let samples: Vec<f64> = (0..n).map(|i| pulse(f64::from(i))).collect();
            let fine = oversampled(&samples, 4);
            assert_eq!(fine.len(), 4 * samples.len());
            for (i, value) in fine.iter().enumerate() {
                assert!((value - pulse(i as f64 / 4.0)).abs() < 1e-6, "sample {i} of {n}");
            }
        }
    }
}
