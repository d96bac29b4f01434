//! Lines of sampled signals, and signals of lines.

use jointscope_hits::{Fourier, InverseFourier};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

use crate::settings::hits::{FEWEST_IN_TAIL, TAIL_PARTS};

/// The lines that are compared, Hz.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Compared<'a> {
    /// From and to.
    pub band: (f64, f64),
    /// Bands within that are left out.
    pub exclude: &'a [(f64, f64)],
}

impl Compared<'_> {
    pub(crate) fn has(&self, hz: f64) -> bool {
        let within = |(from, to): (f64, f64)| (from..=to).contains(&hz);
        within(self.band) && !self.exclude.iter().any(|band| within(*band))
    }
}

/// Signals of one length under one window.
pub(crate) struct Windowed {
    pub window: Vec<f64>,
    fourier: Fourier,
    interval_s: f64,
}

impl Windowed {
    /// Signals as long as the window.
    pub(crate) fn new(window: Vec<f64>, interval_s: f64) -> Self {
        Windowed { fourier: Fourier::new(window.len()), window, interval_s }
    }

    /// Signals followed by as many zeros, so that what filters smear past the end does not come back at the
    /// beginning.
    pub(crate) fn padded(window: Vec<f64>, interval_s: f64) -> Self {
        Windowed { fourier: Fourier::new(2 * window.len()), window, interval_s }
    }

    /// All lines of a signal of at least the window's length.
    pub(crate) fn lines(&self, values: &[f64]) -> Vec<Complex64> {
        let mut windowed: Vec<f64> = values.iter().zip(&self.window).map(|(v, w)| v * w).collect();
        windowed.resize(self.fourier.length(), 0.0);
        self.fourier.lines(&mut windowed)
    }

    /// Those of a band.
    pub(crate) fn band(&self, values: &[f64], band: &Range<usize>) -> Vec<Complex64> {
        let mut lines = self.lines(values);
        lines.truncate(band.end);
        lines.drain(..band.start);
        lines
    }

    /// The signal of these lines, still under its window.
    pub(crate) fn signal(&self, mut lines: Vec<Complex64>) -> Vec<f64> {
        let length = self.fourier.length();
        let mut values = InverseFourier::new(length).signal(&mut lines);
        values.truncate(self.window.len());
        values.iter_mut().for_each(|v| *v /= length as f64);
        values
    }

    /// Σ of the window's squares: what white noise of unit variance comes to on a line.
    pub(crate) fn power(&self) -> f64 {
        self.window.iter().map(|w| w * w).sum()
    }

    pub(crate) fn frequency_hz(&self, line: usize) -> f64 {
        line as f64 / (self.fourier.length() as f64 * self.interval_s)
    }

    /// iω of a line.
    pub(crate) fn s(&self, line: usize) -> Complex64 {
        Complex64::new(0.0, TAU * self.frequency_hz(line))
    }
}

/// 0 below `from`, 1 above `to`, half a cosine between.
pub(crate) fn rising(at: f64, from: f64, to: f64) -> f64 {
    0.5 - 0.5 * (PI * ((at - from) / (to - from)).clamp(0.0, 1.0)).cos()
}

/// The band-limited signal through `samples`, at `factor` instants an interval from the first sample on:
/// sampling says nothing of what lies above half of its rate. The signal is taken to begin and end at rest.
pub(crate) fn oversampled(samples: &[f64], factor: usize) -> Vec<f64> {
    filtered(samples, factor, |_| 1.0)
}

/// As [`oversampled`], raised so that straight lines drawn between the instants have the spectrum of the
/// signal: drawing them lowers a line of angular frequency ω by (sin x/x)², x = ωh/2.
pub(crate) fn oversampled_for_lines(samples: &[f64], factor: usize) -> Vec<f64> {
    filtered(samples, factor, |x| if x > 0.0 { (x / x.sin()).powi(2) } else { 1.0 })
}

fn filtered(samples: &[f64], factor: usize, gain: impl Fn(f64) -> f64) -> Vec<f64> {
    let n = samples.len();
    if factor == 0 || n < 2 {
        return samples.to_vec();
    }
    let mut lines = Fourier::new(n).lines(&mut samples.to_vec());
    for (line, value) in lines.iter_mut().enumerate() {
        *value *= gain(PI * line as f64 / (n * factor) as f64) / n as f64;
    }
    if n.is_multiple_of(2) && factor > 1 {
        // The line at half the rate stands for both its sides.
        lines[n / 2] = Complex64::new(lines[n / 2].re * 0.5, 0.0);
    }
    let inverse = InverseFourier::new(n * factor);
    lines.resize(inverse.count(), Complex64::ZERO);
    inverse.signal(&mut lines)
}

/// Standard deviation of a signal's white noise, from the median line of its last quarter: what still rings
/// there is a few lines among many, and the median does not see them.
pub(crate) fn noise(values: &[f64]) -> f64 {
    let length = (values.len() / TAIL_PARTS).max(FEWEST_IN_TAIL.min(values.len()));
    let tail = &values[values.len() - length..];
    let mean = tail.iter().sum::<f64>() / length as f64;
    let hann = |i: usize| (PI * (i as f64 + 0.5) / length as f64).sin().powi(2);
    let mut windowed: Vec<f64> = tail.iter().enumerate().map(|(i, v)| (v - mean) * hann(i)).collect();
    let power: f64 = (0..length).map(|i| hann(i).powi(2)).sum();
    let lines = Fourier::new(length).lines(&mut windowed);
    let inner = lines.get(2..lines.len() - 1).unwrap_or_default();
    let mut squares: Vec<f64> = inner.iter().map(|line| line.norm_sqr()).collect();
    if squares.is_empty() || power == 0.0 {
        return 0.0;
    }
    squares.sort_by(f64::total_cmp);
    // The median of an exponential distribution is ln 2 of its mean.
    (squares[squares.len() / 2] / std::f64::consts::LN_2 / power).sqrt()
}

/// A length not shorter than `length` of factors 2, 3 and 5 alone, if one lies within `most`.
pub(crate) fn smooth_length(length: usize, most: usize) -> usize {
    let smooth = |mut n: usize| {
        for factor in [2, 3, 5] {
            while n.is_multiple_of(factor) {
                n /= factor;
            }
        }
        n == 1
    };
    (length.max(8)..=most).find(|n| smooth(*n)).unwrap_or(most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_samples::Noise;

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

    #[test]
    fn a_signal_comes_back_from_its_lines_and_its_rate_from_iω() {
        let values: Vec<f64> = (0..500).map(|i| (-((f64::from(i) - 200.0) / 20.0).powi(2)).exp()).collect();
        let lines = Windowed::padded(vec![1.0; 500], 1e-3);
        let back = lines.signal(lines.lines(&values));
        assert!(values.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-12));
        let rate = lines.lines(&values).iter().enumerate().map(|(i, v)| v * lines.s(i)).collect();
        let rate = lines.signal(rate);
        let expected = (values[191] - values[189]) / 2e-3;
        assert!((rate[190] / expected - 1.0).abs() < 1e-2);
    }

    #[test]
    fn noise_is_met_beside_what_still_rings() {
        let mut random = Noise::from_state(1);
        let mut uniform = || random.uniform() - 0.5;
        let std = (1.0f64 / 12.0).sqrt();
        let values: Vec<f64> = (0..8192).map(|i| uniform() + 30.0 * (0.2 * f64::from(i)).sin()).collect();
        assert!((noise(&values) / std - 1.0).abs() < 0.1, "{}", noise(&values));
        assert_eq!(noise(&[0.0; 100]), 0.0);
        assert!(noise(&[1.0, 2.0]).is_finite());
    }

    #[test]
    fn smooth_lengths_are_not_shorter_than_asked_and_within_what_there_is() {
        assert_eq!((smooth_length(1021, 2000), smooth_length(1021, 1022)), (1024, 1022));
    }
}
