//! Signals as lines: band limits, and integration without drift.

use crate::identification::spectra::Transform;
use num_complex::Complex64;
use realfft::RealFftPlanner;

/// Lines of signals of one length and interval, padded so that what filters smear past the end does not come back at the beginning.
pub(crate) struct Lines {
    samples: usize,
    padded: usize,
    transform: Transform,
    interval: f64,
}

impl Lines {
    pub fn new(samples: usize, interval: f64) -> Self {
        let padded = 2 * samples;
        Lines { samples, padded, transform: Transform::new(padded), interval }
    }

    pub fn of(&self, values: &[f64]) -> Vec<Complex64> {
        let mut all = values.to_vec();
        all.resize(self.padded, 0.0);
        self.transform.of(&mut all)
    }

    /// The signal of these lines, without the padding.
    pub fn signal(&self, mut lines: Vec<Complex64>) -> Vec<f64> {
        let plan = RealFftPlanner::<f64>::new().plan_fft_inverse(self.padded);
        let mut values = plan.make_output_vec();
        // A real signal's first line and the one at half the rate are real.
        if let Some(first) = lines.first_mut() {
            first.im = 0.0;
        }
        if let Some(last) = lines.last_mut() {
            last.im = 0.0;
        }
        if plan.process(&mut lines, &mut values).is_err() {
            return vec![0.0; self.samples];
        }
        values.truncate(self.samples);
        values.iter_mut().for_each(|v| *v /= self.padded as f64);
        values
    }

    pub fn frequency(&self, line: usize) -> f64 {
        line as f64 / (self.padded as f64 * self.interval)
    }

    /// iω of a line.
    pub fn s(&self, line: usize) -> Complex64 {
        Complex64::new(0.0, std::f64::consts::TAU * self.frequency(line))
    }
}

/// 0 below `from`, 1 above `to`, half a cosine between.
pub(super) fn rising(frequency: f64, (from, to): (f64, f64)) -> f64 {
    let at = ((frequency - from) / (to - from)).clamp(0.0, 1.0);
    0.5 - 0.5 * (std::f64::consts::PI * at).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_comes_back_from_its_lines_and_its_rate_from_iω() {
        let values: Vec<f64> = (0..500).map(|i| (-((f64::from(i) - 200.0) / 20.0).powi(2)).exp()).collect();
        let lines = Lines::new(500, 1e-3);
        let back = lines.signal(lines.of(&values));
        assert!(values.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-12));
        let rate = lines.of(&values).iter().enumerate().map(|(i, v)| v * lines.s(i)).collect();
        let rate = lines.signal(rate);
        let expected = (values[191] - values[189]) / 2e-3;
        assert!((rate[190] / expected - 1.0).abs() < 1e-2);
    }
}
