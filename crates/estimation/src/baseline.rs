//! Offsets and drifts of charge amplifiers, told from the signal by the samples that it hardly moves.

use crate::Baseline;
use crate::pulse::spread;
use crate::settings::baseline::{FAR, FEWEST_BEFORE, LINE_PASSES};
use jointscope_spectra::median;

/// How a baseline drifts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drift {
    /// From the record's begin to its end, in the signal's unit.
    pub over_record: f64,
    /// The slope in deviations that it would have in white noise of this spread.
    pub significance: f64,
}

/// Takes off the baseline of a signal with so many samples `before` the hit; answers with its drift.
///
/// An offset is the mean of those samples, if they are enough: what comes after has a mean of its own,
/// H(0)·F(0), which is none. It shows on no line above 0 Hz but under a window.
pub(crate) fn remove(values: &mut [f64], baseline: Baseline, before: usize) -> Drift {
    let line = Line::through(values);
    match baseline {
        Baseline::Keep => {}
        Baseline::Offset => {
            let quiet = &values[..before.min(values.len())];
            let offset = match quiet.len() >= FEWEST_BEFORE {
                true => quiet.iter().sum::<f64>() / quiet.len() as f64,
                false => line.middle,
            };
            values.iter_mut().for_each(|value| *value -= offset);
        }
        Baseline::Drift => {
            let count = values.len();
            values.iter_mut().enumerate().for_each(|(i, value)| *value -= line.at(i, count));
        }
    }
    Drift { over_record: line.slope * values.len() as f64, significance: line.significance }
}

/// A straight line about the middle of a record.
struct Line {
    middle: f64,
    /// Per sample.
    slope: f64,
    significance: f64,
}

impl Line {
    fn through(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        let middle = median(&mut sorted).unwrap_or(0.0);
        let mut line = Line { middle, slope: 0.0, significance: 0.0 };
        let mut magnitudes = sorted;
        for _ in 0..LINE_PASSES {
            magnitudes.clear();
            magnitudes.extend(values.iter().enumerate().map(|(i, v)| (v - line.at(i, values.len())).abs()));
            let near = FAR * spread(&mut magnitudes);
            line = line.refined(values, near);
        }
        line
    }

    fn at(&self, i: usize, count: usize) -> f64 {
        self.middle + self.slope * (i as f64 + 0.5 - 0.5 * count as f64)
    }

    /// Least squares over the samples within `near` of the line.
    fn refined(self, values: &[f64], near: f64) -> Self {
        let half = 0.5 * values.len() as f64;
        let (mut count, mut sum, mut t, mut tt, mut ty, mut yy) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for (i, value) in values.iter().enumerate() {
            let (x, y) = (i as f64 + 0.5 - half, value - self.at(i, values.len()));
            if y.abs() <= near {
                count += 1.0;
                sum += y;
                t += x;
                tt += x * x;
                ty += x * y;
                yy += y * y;
            }
        }
        let spread_of_instants = tt - t * t / f64::max(count, 1.0);
        if count < 3.0 || spread_of_instants <= 0.0 {
            return self;
        }
        let change = (ty - t * sum / count) / spread_of_instants;
        let slope = self.slope + change;
        let rest = yy - sum * sum / count - change * change * spread_of_instants;
        let deviation = (rest / count).max(0.0).sqrt() / spread_of_instants.sqrt();
        Line {
            middle: self.middle + (sum - change * t) / count,
            slope,
            significance: if deviation > 0.0 { slope.abs() / deviation } else { 0.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ringing(i: usize) -> f64 {
        if i < 20 { 0.0 } else { 40.0 * (-0.02 * (i - 20) as f64).exp() * (0.9 * i as f64).sin() }
    }

    #[test]
    fn an_offset_is_found_beside_a_hits_ringing() {
        let mut values: Vec<f64> =
            (0..2000).map(|i| 0.7 + ringing(i) + 1e-3 * (1.7 * i as f64).sin()).collect();
        remove(&mut values, Baseline::Offset, 0);
        assert!(values[..20].iter().all(|value| value.abs() < 2e-3), "{:?}", &values[..3]);
    }

    #[test]
    fn a_drift_is_told_and_taken_off_on_request() {
        let drifting = |i: usize| 0.7 + 1e-3 * i as f64 + ringing(i) + 0.01 * (1.7 * i as f64).sin();
        let mut values: Vec<f64> = (0..2000).map(drifting).collect();
        assert!(remove(&mut values.clone(), Baseline::Offset, 0).significance > 60.0);
        remove(&mut values, Baseline::Drift, 0);
        assert!(values[1900..].iter().all(|value| value.abs() < 0.05), "{}", values[1999]);
    }
}
